"""The report, and the list of all figures."""
