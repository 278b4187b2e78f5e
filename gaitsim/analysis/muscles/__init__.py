"""Figures of muscles and of the energy that they spend."""
