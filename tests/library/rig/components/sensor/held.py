from gaitsim.component import Component, Output, Parameter


class Held(Component):
    """A signal of one kind that stays as it is."""

    number = Parameter("1", "A number.", default=0, bounds=(-1e6, 1e6), source="definition: none")
    place = Parameter("m", "A length.", default=0, bounds=(-1e6, 1e6), source="definition: none")
    angle = Parameter("rad", "An angle.", default=0, bounds=(-1e6, 1e6), source="definition: none")
    rate = Parameter("rad/s", "A rate.", default=0, bounds=(-1e6, 1e6), source="definition: none")
    held_number = Output("1", "The number.")
    held_place = Output("m", "The length.")
    held_angle = Output("rad", "The angle.")
    held_rate = Output("rad/s", "The rate.")

    @staticmethod
    def output(p, u, x, y):
        y.held_number = p.number
        y.held_place = p.place
        y.held_angle = p.angle
        y.held_rate = p.rate
