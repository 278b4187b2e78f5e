from gaitsim.component import Component, Curve, Input, Output, Parameter, Refused


class PhaseWindow(Component):
    """A gate that is open from one phase of a cycle to another, also across the end of the cycle."""

    begins = Parameter("1", "Phase at which the gate opens.", bounds=(0, 1))
    ends = Parameter("1", "Phase at which the gate closes.", bounds=(0, 1))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    gate = Output("1", "1 while the gate is open.")

    window = Curve(
        "gate", "phase", (0, 1), "The gate, open over the end of the cycle.", at={"begins": 0.8, "ends": 0.3}
    )

    @staticmethod
    def output(p, u, x, y):
        y.gate = 1.0 if (u.phase - p.begins) % 1 < (p.ends - p.begins) % 1 else 0.0

    @staticmethod
    def build(p, mj):
        if p.begins % 1 == p.ends % 1:
            raise Refused(f"begins and ends are both {100 * p.begins:g} %, so the gate never opens; change one")
