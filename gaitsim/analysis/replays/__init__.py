"""A recorded run, its cycles, and known values beside it."""
