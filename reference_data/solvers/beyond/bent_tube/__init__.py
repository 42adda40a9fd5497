"""The tube under gas, bent or with more waves around its axis, by two methods."""
