from gaitsim.component import Component, Output, Parameter


class Mine(Component):
    """A number."""

    level = Parameter("*", "Level.", default=1)
    value = Output("1", "The level.", like="lebel")

    @staticmethod
    def output(p, u, x, y):
        y.value = p.level
