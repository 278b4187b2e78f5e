"""The style of figures and tables, and the files that they are written to."""
