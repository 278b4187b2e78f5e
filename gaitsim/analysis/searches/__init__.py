"""Figures of searches, studies and draws."""
