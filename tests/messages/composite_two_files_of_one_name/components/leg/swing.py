from gaitsim.component import Component


class Swing(Component):
    pass
