"""Pushes and moments: their impulse, their time, the event they wait for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

from .play import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
both = pytest.mark.parametrize(("reference", "output"), [("push", "force"), ("torque", "torque")])

FLOATING = """
gaitsim: 1
parts:
  ball: {use: segment/rod, mass: 4 kg, length: 1 m, direction: forward}
  root: {use: joint/planar, parent: world, child: ball.center}
  push: {use: perturbation/push, frame: ball.center, strength: 50 N, onset: 0.2 s, duration: 103.3 ms}
initial: {root.z: 1 m}
simulate: {duration: 0.5 s, step: 1 ms, gravity: 0 m/s^2}
"""
TURNING = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 3 kg, length: 1 m}
  hinge: {use: joint/hinge, parent: world, child: rod.proximal}
  push: {use: perturbation/torque, strength: -2 N m, onset: 0.1 s, duration: 50.5 ms, to: hinge.torque}
simulate: {duration: 0.3 s, step: 2 ms, gravity: 0 m/s^2}
"""


def last(text: str, signal: str, mode: Mode) -> float:
    model = resolve(parse(text, "spec.yaml"), Library((shipped_folder(),)), "spec")
    outcome = Simulator(model, mode).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    return float(outcome.trajectory[signal][-1])


@modes
@pytest.mark.parametrize(
    ("direction", "signal", "strength"),
    [("forward", "forward_velocity", 50), ("up", "upward_velocity", 50), ("forward", "forward_velocity", -50)],
)
def test_a_push_changes_the_momentum_by_its_impulse(direction: str, signal: str, strength: float, mode: Mode) -> None:
    """50 N for 103.3 ms on 4 kg, although that is not a whole number of steps."""
    text = FLOATING.replace("strength: 50 N", f"strength: {strength} N, direction: {direction}")
    assert last(text, f"root.{signal}", mode) == pytest.approx(strength * 0.1033 / 4, rel=1e-9)


@modes
def test_a_push_off_center_turns(mode: Mode) -> None:
    """Up at the front end, 0.5 m from the center: a moment about -y on m l^2 / 12."""
    text = FLOATING.replace("ball.center, strength: 50 N", "ball.distal, strength: 0.5 N, direction: up")
    assert last(text, "root.pitch_velocity", mode) == pytest.approx(-0.5 * 0.5 * 0.1033 / (4 / 12), rel=1e-3)


@modes
def test_a_moment_changes_the_angular_momentum(mode: Mode) -> None:
    assert last(TURNING, "hinge.velocity", mode) == pytest.approx(-2 * 0.0505 / 1.0, rel=1e-3)


@modes
@both
def test_at_a_time(reference: str, output: str, mode: Mode) -> None:
    values = {"strength": 10.0, "onset": 0.003, "duration": 0.0025}
    found = played(f"perturbation/{reference}", {"event": [0] * 8}, mode, **values)
    assert found[output] == pytest.approx([0, 0, 0, 10, 10, 5, 0, 0])


@modes
@both
def test_from_the_first_instant(reference: str, output: str, mode: Mode) -> None:
    values = {"strength": 10.0, "onset": 0.0, "duration": 0.002}
    found = played(f"perturbation/{reference}", {"event": [0] * 4}, mode, **values)
    assert found[output] == pytest.approx([10, 10, 0, 0])


@modes
@both
def test_after_the_second_event(reference: str, output: str, mode: Mode) -> None:
    """It begins one step after the event, plus the onset; later events do not begin it again."""
    events = [0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]
    values = {"strength": 10.0, "onset": 0.001, "duration": 0.002, "event_number": 2.0}
    found = played(f"perturbation/{reference}", {"event": events}, mode, **values)
    assert found[output] == pytest.approx([0, 0, 0, 0, 0, 0, 10, 10, 0, 0, 0, 0])


@pytest.mark.parametrize("dt", [1e-3, 7e-4, 3e-3])
def test_the_impulse_is_exact_at_any_step(dt: float) -> None:
    values = {"strength": 10.0, "onset": 0.0123, "duration": 0.0318}
    found = played("perturbation/push", {"event": [0] * int(0.1 / dt + 2)}, "rapid", dt=dt, **values)
    assert np.sum(found["force"]) * dt == pytest.approx(0.318, rel=1e-9)


SPACE = """
gaitsim: 1
parts:
  block: {use: segment/spatial, mass: 10 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center, pose: free}
  push: {use: perturbation/push, frame: block.center, direction: WAY, azimuth: AZIMUTH, strength: 50 N, onset: 0 s,
    duration: 0.1 s}
simulate: {duration: 0.2 s, step: 1 ms, gravity: 0 m/s^2}
"""


@pytest.mark.parametrize(
    ("way", "azimuth", "velocity"),
    [
        ("forward", 0, (0.5, 0, 0)),
        ("forward", 90, (0, 0.5, 0)),
        ("forward", -30, (0.5 * math.cos(math.pi / 6), -0.25, 0)),
        ("left", 90, (-0.5, 0, 0)),
        ("up", 45, (0, 0, 0.5)),
    ],
)
def test_a_push_in_any_direction(way: str, azimuth: float, velocity: tuple[float, ...]) -> None:
    text = SPACE.replace("WAY", way).replace("AZIMUTH", f"{azimuth} deg")
    for name, expected in zip(("forward", "left", "upward"), velocity, strict=True):
        assert last(text, f"root.{name}_velocity", "rapid") == pytest.approx(expected, abs=1e-9)
