"""Controls of inflation: a gas of given pressure, given mass or given volume."""
