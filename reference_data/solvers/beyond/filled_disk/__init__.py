"""Disks of uneven thickness under gas or a liquid, by shooting and by collocation."""
