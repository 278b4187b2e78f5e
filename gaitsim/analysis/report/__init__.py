"""The report, and which figures a run has."""
