"""The muscle on a tendon that does not yield: forces from length and velocity of the path alone."""

from __future__ import annotations

import math
from typing import Any

import pytest
from components.calls import computed

from .test_degroote2016 import ACTIVE, PASSIVE, VELOCITY

MUSCLE = "muscle/rigid_tendon"
SIZES = {"max_isometric_force": 4000.0, "optimal_fiber_length": 0.04, "tendon_slack_length": 0.26}
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def muscle(mode: str, **values: float) -> Any:
    return computed(MUSCLE, mode, **SIZES, **values)


@modes
@pytest.mark.parametrize("length", [0.5, 0.8, 1.0, 1.2, 1.4])
@pytest.mark.parametrize("velocity", VELOCITY)
def test_force_without_pennation(length: float, velocity: float, mode: str) -> None:
    now = muscle(mode, activation_level=0.5, path_length=0.26 + 0.04 * length, path_velocity=velocity * 0.4)
    assert now.normalized_force == pytest.approx(0.5 * ACTIVE[length] * VELOCITY[velocity] + PASSIVE[length], abs=2e-6)
    assert now.fiber_force == pytest.approx(4000 * 0.5 * ACTIVE[length] * VELOCITY[velocity], abs=8e-3)
    assert now.normalized_fiber_length == pytest.approx(length)
    assert now.normalized_fiber_velocity == pytest.approx(velocity)


@modes
def test_pennation(mode: str) -> None:
    # Height 3 cm, along the tendon 4 cm: the fiber is 5 cm long.
    width = math.asin(0.03 / 0.04)
    now = muscle(mode, activation_level=1.0, pennation_angle=width, path_length=0.30, path_velocity=0.1)
    assert now.fiber_length == pytest.approx(0.05)
    assert math.cos(now.pennation) == pytest.approx(0.8)
    assert now.fiber_velocity == pytest.approx(0.08)
    straight = muscle(mode, activation_level=1.0, path_length=0.31, path_velocity=0.08)
    assert now.force == pytest.approx(0.8 * straight.force)
    # What the path takes up is what the fiber takes up.
    fiber = now.force / math.cos(now.pennation)
    assert now.force * 0.1 == pytest.approx(fiber * now.fiber_velocity)


@modes
def test_a_slack_path_has_no_force_and_faster_than_v_max_no_active_one(mode: str) -> None:
    assert muscle(mode, activation_level=1.0, path_length=0.25, path_velocity=-0.1).force == 0
    assert muscle(mode, activation_level=1.0, path_length=0.30, path_velocity=-0.5).fiber_force == 0
