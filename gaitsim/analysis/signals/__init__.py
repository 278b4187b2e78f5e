"""Any signal over time, over another signal, and as a return map."""
