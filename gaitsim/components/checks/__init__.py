"""Checks of component files, by their text and their declarations."""
