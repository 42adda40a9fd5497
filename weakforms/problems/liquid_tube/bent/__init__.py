"""The fluid-loaded tube as a surface in space, which may bend sideways."""
