"""A component or a model by itself: its curves, moment arms, costs, and how step size matters."""
