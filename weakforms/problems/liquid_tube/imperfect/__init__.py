"""The over-filled tube with an imperfection: gravity that is tilted, or a thickness that varies around."""
