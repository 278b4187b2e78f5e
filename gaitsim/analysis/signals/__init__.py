"""Any signal over time, over another signal, and over itself one event before."""
