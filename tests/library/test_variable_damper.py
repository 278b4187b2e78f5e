"""The variable damper: its moment on plain arrays, and that it takes exactly what a pendulum loses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pytest
from components.calls import FOLDER

from gaitsim.components.find import Library
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

from .play import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
B = 4.0  # N m s/rad


def braked(
    rates: Sequence[float], command: Sequence[float], mode: Mode = "rapid", **more: float
) -> Mapping[str, np.ndarray]:
    """Outputs while the joint has these angular velocities, in rad/s, and the command these values."""
    found = played("device/variable_damper", {"angular_velocity": rates, "command": command}, mode, damping=B, **more)
    return {name: np.array(values) for name, values in found.items()}


@modes
def test_the_moment_is_the_commanded_share_of_the_damping_times_the_rate(mode: Mode) -> None:
    found = braked([2, 2, -2, 2, 2, 0], [1, 0.25, 0.5, -1, 3, 1], mode)
    assert found["moment"] == pytest.approx([-2 * B, -0.5 * B, B, 0, -2 * B, 0])


@modes
@pytest.mark.parametrize(("direction", "moments"), [(1, [-3 * B, 0]), (-1, [0, 3 * B]), (0, [-3 * B, 3 * B])])
def test_it_brakes_one_direction_or_both(mode: Mode, direction: float, moments: list[float]) -> None:
    assert braked([3, -3], [1, 1], mode, direction=direction)["moment"] == pytest.approx(moments)


@modes
def test_it_only_takes_energy_and_books_all_of_it(mode: Mode) -> None:
    draw = np.random.default_rng(1)
    rates, command = draw.normal(0, 5, 400), draw.uniform(-0.5, 1.5, 400)
    found = braked(list(rates), list(command), mode)
    share = np.clip(command, 0, 1)
    assert np.all(found["dissipated_power"] >= 0)
    assert found["dissipated_power"] == pytest.approx(share * B * rates**2, rel=1e-12)
    booked = np.concatenate([[0], np.cumsum(share * B * rates**2)[:-1]]) * 1e-3
    assert found["dissipated_energy"] == pytest.approx(booked, rel=1e-12)


PENDULUM = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 3 kg, length: 1 m}
  hinge: {use: joint/spatial_hinge, parent: world, child: rod.proximal, axis_left: 1}
  brake: {use: device/variable_damper, joint: hinge, damping: 1 N m s/rad, direction: 1}
  energy: {use: sensor/mechanical_energy}
initial: {hinge.angle: -60 deg}
simulate: {duration: 3 s, step: 0.1 ms}
"""


def test_a_pendulum_loses_what_the_damper_books_and_only_in_the_braked_direction() -> None:
    made = Simulator(resolve(parse(PENDULUM, "spec.yaml"), Library((FOLDER,)), "spec")).run(recorded=True).trajectory
    assert made is not None
    total, booked = made["energy.total"], made["brake.dissipated_energy"]
    assert booked[-1] > 2
    assert total + booked == pytest.approx(total[0], abs=1e-3 * booked[-1])
    falling = made["hinge.angular_velocity"] < 0
    assert not np.any(made["brake.moment"][falling])
