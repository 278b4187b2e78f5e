"""Figures of muscles and of their energy."""
