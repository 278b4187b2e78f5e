"""How figures and tables look, and the files that they become."""
