"""The application: open, run, tune, look for limits and analyze, as functions that return values."""
