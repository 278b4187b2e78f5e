from gaitsim.component import Component, Input, Metric, State


class Last(Component):
    """The last angle."""

    angle = Input("rad", "Any angle.")
    kept = State("rad", "The last one.")
    value = Metric("rad", "The last one.")

    @staticmethod
    def update(p, u, x, y, dt):
        x.kept = u.angle

    @staticmethod
    def finish(p, x, m):
        if x.kept < 10:
            raise ValueError("there is no angle above 10")
        m.value = x.kept
