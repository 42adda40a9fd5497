"""A tube under gas, thinner on one side, which bows: its limit pressures."""
