"""Verbs of mechanics: what `build(p, mj)` of a component can make."""
