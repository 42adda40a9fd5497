"""The free tube of paper 2 with the relaxed energy: wrinkled beside the disks, by two methods."""
