"""Units through every path of a component's functions."""

from __future__ import annotations

import pytest

from gaitsim.components.checks.audit import Audit, audit

MUSCLE = '''\
"""A Hill-type muscle."""

import math

from gaitsim.component import Component, Input, Output, Parameter, State

WIDTH = 0.56
EDGE = math.log(0.05)


def force_length(stretch):
    """Bell curve."""
    return math.exp(EDGE * abs((stretch - 1) / WIDTH) ** 3)


def force_velocity(velocity, fastest):
    if velocity < 0:
        if velocity < -fastest:
            return 0.0
        return (fastest + velocity) / (fastest - 5 * velocity)
    return 1.5 - 0.5 * (fastest - velocity) / (fastest + 7.56 * 5 * velocity)


class Hill(Component):
    """A muscle with a series elastic element."""

    max_force = Parameter("N", "Isometric force.", default=4000, bounds=(0, 20000))
    optimal_length = Parameter("cm", "Fibre length.", default=4, bounds=(1, 20))
    slack_length = Parameter("cm", "Tendon.", default=26, bounds=(1, 50))
    fastest = Parameter("1/s", "Fibre lengths per second.", default=12)
    time_constant = Parameter("ms", "Activation.", default=10, bounds=(1, 100))
    path_length = Input("m", "Length of the path.")
    path_velocity = Input("m/s", "Its rate.")
    excitation = Input("1", "Neural drive.", default=0.01, sums=True)
    fibre = State("m", "Fibre length.")
    velocity = State("m/s", "Fibre velocity.")
    activation = State("1", "Activation.")
    force = Output("N", "Tendon force.")
    normalized_force = Output("1", "Tendon force over max_force.")
    drive = Output("1", "Clipped excitation.")

    @staticmethod
    def start(p, u, x):
        x.activation = max(0.01, min(u.excitation, 1))
        fibre = p.optimal_length
        for _ in range(20):
            strain = (u.path_length - fibre - p.slack_length) / p.slack_length
            error = p.max_force * (strain / 0.04) ** 2 - p.max_force * force_length(
                fibre / p.optimal_length
            )
            if abs(error) < 1e-6 * p.max_force:
                break
            fibre += 0.1 * error / p.max_force * p.optimal_length
        x.fibre = fibre
        x.velocity = 0

    @staticmethod
    def output(p, u, x, y):
        strain = (u.path_length - x.fibre - p.slack_length) / p.slack_length
        force = 0.0
        if strain > 0:
            force = p.max_force * (strain / 0.04) ** 2
        y.force = force
        y.normalized_force = force / p.max_force
        y.drive = min(max(u.excitation, 0), 1)

    @staticmethod
    def update(p, u, x, y, dt):
        x.activation += dt * (y.drive - x.activation) / p.time_constant
        if x.activation < 0.01:
            x.activation = 0.01
        elif x.activation > 1:
            x.activation = 1
        stretch = x.fibre / p.optimal_length
        active = x.activation * force_length(stretch)
        passive = 0.0
        if stretch > 1:
            passive = ((stretch - 1) / WIDTH) ** 2
        wanted = max(y.normalized_force - passive, 0) / max(active, 1e-3)
        velocity = p.fastest * (wanted - force_velocity(x.velocity / p.optimal_length, p.fastest))
        if velocity > p.fastest:
            velocity = p.fastest
        x.velocity = velocity * p.optimal_length
        x.fibre = x.fibre + dt * x.velocity
'''

HEAD = """import math
from gaitsim.component import Component, Input, Metric, Output, Parameter, State

LIMIT = 2.5

def arm(angle, radius):
    return radius * math.cos(angle)

class Probe(Component):
    gain = Parameter("N", "A force.", default=1)
    width = Parameter("cm", "A length.", default=1)
    angle = Input("deg", "An angle.")
    load = Input("N", "A force.")
    speed = Input("m/s", "A velocity.")
    phase = State(levels=("swing", "stance"))
    count = State("1", "Samples so far.")
    samples = State("N", "Loads of a stride.", size=8)
    force = Output("N", "A force.")
    ratio = Output("1", "A plain number.")
    peak = Metric("N", "A force.")
"""


def audited(function: str, *lines: str) -> Audit:
    body = "\n".join(f"        {line}" for line in lines)
    return audit(f"{HEAD}\n    @staticmethod\n    def {function}:\n{body}\n", "probe.py")


def output(*lines: str) -> list[str]:
    return [fault.message for fault in audited("output(p, u, x, y)", *lines).faults]


def test_a_muscle_with_ifs_and_loops_is_consistent_and_wholly_reached() -> None:
    assert audit(MUSCLE, "hill.py") == Audit((), (), True)


def test_a_wrong_unit_in_one_branch_is_found_with_its_place() -> None:
    right = "(strain / 0.04) ** 2\n        y."
    wrong = MUSCLE.replace(right, "strain * p.slack_length\n        y.")
    assert wrong != MUSCLE
    fault = audit(wrong, "hill.py").faults[0]
    line = wrong.splitlines().index("        y.force = force") + 1
    assert str(fault) == (
        f"hill.py:{line}:9: y.force is declared in N (a force); "
        "this gives a moment or an energy (m^2 kg/s^2).\n"
        f"{line:>5} |         y.force = force\n"
        "      |         ^"
    )


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("y.ratio = (p.width + 1) / p.width", "adds a length to a plain number."),
        ("y.force = p.gain - u.speed", "subtracts a velocity from a force."),
        ("y.ratio = 1 if u.load > p.width else 0", "compares a force with a length."),
        ("y.force = max(u.load, 0, p.width)", "takes the max of a force and a length."),
        ("y.ratio = math.exp(u.load)", "math.exp needs a plain number; this is a force."),
        ("y.ratio = math.atan2(u.load, p.width)", "math.atan2 of a force and a length."),
        ("y.ratio = int(u.load)", "int needs a plain number; this is a force."),
        ("y.ratio = round(p.width)", "round needs a plain number; this is a length."),
        ("y.ratio = 2 ** p.width", "a power needs a plain number; this is a length."),
        ("y.ratio = u.load ** u.angle", "a force can only be raised to a literal power."),
        ("y.force = x.samples[u.load]", "an index needs a plain number; this is a force."),
        ("y.force = arm(u.angle, p.width)", "N (a force); this gives a length (m)."),
        ("y.force = 3", "N (a force); this gives a plain number (1)."),
        ("y.ratio = u.nothing", "(AttributeError: u.nothing is not declared)."),
        ("y.ratio = [1] + p.gain", "(TypeError: a number is needed here, not list)."),
    ],
)
def test_each_rule(line: str, message: str) -> None:
    found = output(line)
    assert found[0].endswith(message)


@pytest.mark.parametrize(
    "line",
    [
        "y.force = 0",
        "y.force = math.inf",
        "y.force = 0 * p.width",
        "y.force = max(0, u.load)",
        "y.force = math.sqrt(u.load ** 2 + p.gain ** 2)",
        "y.force = math.hypot(u.load, p.gain) * LIMIT",
        "y.force = math.copysign(p.gain, u.speed)",
        "y.force = p.gain * arm(u.angle, p.width) / p.width",
        "y.ratio = u.angle + math.atan2(u.speed, 0)",
        "y.ratio = (u.load / p.gain) ** u.angle",
        "y.ratio = u.load > p.gain",
        "y.ratio = x.phase == 1 and not math.isnan(u.load)",
        "y.ratio = len(x.samples) * LIMIT",
    ],
)
def test_consistent_lines(line: str) -> None:
    assert output(line) == []


def test_an_array_state_is_written_and_read_in_a_loop() -> None:
    lines = [
        "i = int(x.count)",
        "x.samples[i] = u.load",
        "x.samples[0] += u.load",
        "x.count = x.count + 1",
        "total = 0.0",
        "for i in range(len(x.samples)):",
        "    total += x.samples[i] * dt",
        "x.count = total / p.gain",
    ]
    found = audited("update(p, u, x, y, dt)", *lines).faults
    assert [fault.message for fault in found] == ["x.count is declared in 1 (a plain number); this gives a time (s)."]
    lines[1] = "x.samples[i] = u.speed"
    found = audited("update(p, u, x, y, dt)", *lines[:2]).faults
    assert [fault.message for fault in found] == ["x.samples is declared in N (a force); this gives a velocity (m/s)."]


def test_a_metric_is_checked() -> None:
    found = audited("finish(p, x, m)", "m.peak = p.width").faults
    assert [fault.message for fault in found] == ["m.peak is declared in N (a force); this gives a length (m)."]


def test_a_dimension_that_grows_in_a_loop_is_found() -> None:
    found = output("a = p.width", "for _ in range(9):", "    a = a * a", "y.force = a")
    assert found == ["y.force is declared in N (a force); this gives a quantity of length^4 (m^4)."]


def test_the_components_own_exception_ends_a_path_and_hides_nothing() -> None:
    found = output("if u.load < 0:", "    raise ValueError('negative')", "y.force = p.width")
    assert found == ["y.force is declared in N (a force); this gives a length (m)."]


def test_a_local_that_is_not_always_set_is_named() -> None:
    assert output("if u.load > 0:", "    f = u.load", "y.force = f") == ["f is not set on every path that leads here."]


def test_lines_that_no_path_reaches_are_named() -> None:
    result = audited("output(p, u, x, y)", "if LIMIT < 1:", "    y.force = 0", "y.force = arm(0, p.gain)")
    begin = HEAD.count("\n") + 4
    assert (result.faults, result.unreached) == ((), (begin + 1,))


def test_twelve_ifs_in_a_row_stay_cheap_and_complete() -> None:
    lines = ["f = 0.0"] + [f"if u.load > {n} * p.gain:\n            f = p.gain" for n in range(12)]
    result = audited("output(p, u, x, y)", *lines, "y.force = f", "y.ratio = arm(f / p.gain, 1)")
    assert result == Audit((), ())


def test_the_branches_of_two_ifs_are_followed_in_every_combination() -> None:
    found = output(
        "a = p.gain if u.load > 0 else p.width",
        "b = p.gain if u.speed > 0 else p.width",
        "y.ratio = (a + b) / b",
    )
    assert {"adds a force to a length.", "adds a length to a force."} <= set(found)


def test_an_endless_loop_ends() -> None:
    result = audited("output(p, u, x, y)", "n = 0", "while True:", "    n += 1")
    assert not result.complete
