"""Figures of a hopper: apexes, return map, ground force."""
