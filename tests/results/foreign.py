"""A spec whose numbers are declared in units that are not SI's, with the values that they are in SI."""

from __future__ import annotations

from pathlib import Path

SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
  odd:
    use: odd/one
    angle: {value: 20 deg, tune: [5 deg, 40 deg]}
    tension: {value: 0.25 MPa, tune: [100 kPa, 1 MPa], spread: 50 kPa}
    width: {value: 1.2 cm, tune: [3 mm, 4 cm]}
    delay: {value: 15 ms, tune: [1 ms, 0.1 s]}
    share: {value: 35 %, tune: [0.1, 0.9]}
    mass: {value: 70 g, tune: [10 g, 0.5 kg]}
    speed: 90 deg/s
    any_of: {value: 30 deg, tune: [10 deg, 0.7 rad]}
measures:
  seen: {use: measure/range, signal: {from: odd.turned}}
  told: {use: measure/told, angle: {from: odd.turned}}
objective: {use: objective/minimize, value: {from: told.cost}}
simulate: {duration: 20 ms, step: 1 ms}
"""
_ODD = '''\
from gaitsim.component import Component, Output, Parameter, State


class One(Component):
    """Nothing but numbers, in units that are not SI's."""

    angle = Parameter("deg", "An angle.", default=12, bounds=(0, 90))
    tension = Parameter("MPa", "A pressure.", default=0.3, bounds=(0, 2))
    width = Parameter("cm", "A length.", default=2, bounds=(0, 10))
    delay = Parameter("ms", "A time.", default=15, bounds=(0, 1e3))
    share = Parameter("%", "A share.", default=50, bounds=(0, 100))
    mass = Parameter("g", "A mass.", default=100, bounds=(0, 1e4))
    speed = Parameter("deg/s", "An angular velocity.", default=60, bounds=(0, 1e3))
    rest = Parameter("ms", "A time that no spec sets.", default=23)
    any_of = Parameter("*", "Any quantity.", default=0)
    steps = State("1", "Steps.")
    turned = Output("deg", "The angle, after half the time.")

    @staticmethod
    def output(p, u, x, y):
        y.turned = p.angle if x.steps > 9.5 else 0.0 * p.angle

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
'''
_TOLD = '''\
from gaitsim.component import Component, Input, Metric, State


class Told(Component):
    """An angle as a metric in degrees."""

    angle = Input("rad", "An angle.")
    last = State("rad", "The angle.")
    value = Metric("deg", "The angle.")
    cost = Metric("rad", "The same.")

    @staticmethod
    def update(p, u, x, y, dt):
        x.last = u.angle

    @staticmethod
    def finish(p, x, m):
        m.value = x.last
        m.cost = x.last
'''
# address: number in the declared unit, the unit, the value in SI
SAID = {
    "odd.angle": (20.0, "deg", 0.3490658503988659),
    "odd.tension": (0.25, "MPa", 250000.0),
    "odd.width": (1.2, "cm", 0.012),
    "odd.delay": (15.0, "ms", 0.015),
    "odd.share": (35.0, "%", 0.35),
    "odd.mass": (70.0, "g", 0.07),
    "odd.speed": (90.0, "deg/s", 1.5707963267948966),
    "odd.rest": (23.0, "ms", 0.023),
    "odd.any_of": (30.0, "deg", 0.5235987755982988),
}
BOUNDS = {
    "odd.angle": (5.0, 40.0),
    "odd.tension": (0.1, 1.0),
    "odd.width": (0.3, 4.0),
    "odd.delay": (1.0, 100.0),
    "odd.share": (10.0, 90.0),
    "odd.mass": (10.0, 500.0),
    "odd.any_of": (10.0, 40.10704565915762),
}


def make(folder: Path) -> Path:
    """The spec and its components in a folder; the path of the spec."""
    for name, text in (("odd/one", _ODD), ("measure/told", _TOLD)):
        path = folder / "components" / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    spec = folder / "spec.yaml"
    spec.write_text(SPEC)
    return spec
