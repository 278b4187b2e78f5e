"""Figures of a component or a model: curves, moment arms, costs of a step, convergence over step sizes."""
