"""The tube that holds a liquid, Paper 3."""
