"""The application: open, run, tune, find limits and analyze, as functions that return values."""
