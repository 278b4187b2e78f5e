"""A run that is looked at, its cycles, and known values beside it."""
