"""Tables of closed forms (balloons, long tubes, homogeneous bodies), some up to the root of an equation."""
