"""Figures of a hopper: apexes, return map, force of the ground."""
