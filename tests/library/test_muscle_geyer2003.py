"""The muscle of Geyer et al. (2003): equations first, against values computed independently."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

from gaitsim.simulation.view import View

MUSCLE = "muscle/geyer2003"
F_MAX, OPTIMAL, SLACK, V_MAX = 22e3, 0.1, 0.4, 12 * 0.1
SIZES = {
    "max_isometric_force": F_MAX,
    "optimal_fiber_length": OPTIMAL,
    "tendon_slack_length": SLACK,
}
_GLOBALS: dict[str, Any] = primitive(MUSCLE).cls.__dict__["output"].__func__.__globals__
force_length = _GLOBALS["force_length"]
velocity_from_force = _GLOBALS["velocity_from_force"]


def force_velocity(velocity: float) -> float:
    """f_v as published: N = 1.5, K = 5."""
    if velocity <= 0:
        return (1 + velocity) / (1 - 5 * velocity)
    return 1.5 + 0.5 * (-1 + velocity) / (7.56 * 5 * velocity + 1)


def muscle(fiber: float, strain: float, activation: float, **more: float) -> View:
    """The outputs of native code for l_CE in optimal lengths and a tendon strain."""
    path = SLACK * (1 + strain) + fiber * OPTIMAL
    return computed(
        MUSCLE,
        **SIZES,
        **more,
        length=fiber * OPTIMAL,
        path_length=path,
        activation_level=activation,
    )


@pytest.mark.parametrize(
    ("width", "length", "value"),
    [
        (0.4, 0.6, 0.05),
        (0.4, 1.4, 0.05),
        (0.4, 0.7, 0.282571),
        (0.4, 0.8, 0.687656),
        (0.4, 0.9, 0.95427),
        (0.4, 1.0, 1.0),
        (0.4, 1.1, 0.95427),
        (0.56, 0.44, 0.05),
        (0.56, 0.5, 0.118564),
        (0.56, 0.6, 0.335632),
        (0.56, 0.7, 0.630919),
        (0.56, 0.8, 0.872435),
        (0.56, 0.9, 0.983086),
    ],
)
def test_force_length(width: float, length: float, value: float) -> None:
    assert force_length(length, width) == pytest.approx(value, abs=1e-6)
    # Natively: the tendon force at which the fiber stands still is A F_max f_l.
    strain = 0.04 * math.sqrt(0.5 * force_length(length, width))
    assert muscle(length, strain, 0.5, width=width).fiber_velocity == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("velocity", "value"),
    [
        (-1, 0),
        (-0.9, 0.018182),
        (-0.75, 0.052632),
        (-0.5, 0.142857),
        (-0.25, 0.333333),
        (-0.1, 0.6),
        (-0.05, 0.76),
        (-0.01, 0.942857),
        (0, 1),
        (0.01, 1.140784),
        (0.05, 1.33564),
        (0.1, 1.405858),
        (0.25, 1.464115),
        (0.5, 1.487437),
        (1, 1.5),
    ],
)
def test_force_velocity(velocity: float, value: float) -> None:
    assert force_velocity(velocity) == pytest.approx(value, abs=1e-6)
    assert velocity_from_force(force_velocity(velocity), 1.5, 5) == pytest.approx(velocity, abs=1e-9)
    # Natively, at the optimal length and full activation: F/F_max is f_v itself.
    now = muscle(1.0, 0.04 * math.sqrt(force_velocity(velocity)), 1.0)
    assert now.normalized_force == pytest.approx(value, abs=1e-6)
    assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=1e-9)
    assert now.fiber_velocity == pytest.approx(velocity * V_MAX, abs=1e-9)


def test_the_inverse_is_increasing_and_continuous_over_all_forces() -> None:
    ratios = np.linspace(0, 3, 30001)
    velocities = np.array([velocity_from_force(r, 1.5, 5) for r in ratios])
    assert np.all(np.diff(velocities) > 0)
    # The steepest place is just below N: (7.56 K + 1) / (N - 1).
    assert np.diff(velocities).max() < 1.01 * (7.56 * 5 + 1) / 0.5 * 1e-4
    below = velocities[ratios <= 1.5]
    back = np.array([force_velocity(v) for v in below])
    np.testing.assert_allclose(back, ratios[ratios <= 1.5], rtol=0, atol=1e-12)
    assert velocity_from_force(2.5, 1.5, 5) == pytest.approx(1.01)


def test_the_largest_power_is_where_the_sheet_says() -> None:
    ratios = np.linspace(0, 1, 100001)
    power = -ratios * np.array([velocity_from_force(r, 1.5, 5) for r in ratios])
    best = int(np.argmax(power))
    assert power[best] == pytest.approx(0.084041, abs=1e-6)
    assert velocity_from_force(ratios[best], 1.5, 5) == pytest.approx(-0.28990, abs=1e-4)


@pytest.mark.parametrize("fiber", [0.7, 0.9, 1.0, 1.2])
@pytest.mark.parametrize("activation", [0.01, 0.3, 1.0])
def test_isometric_equilibrium(fiber: float, activation: float) -> None:
    force = activation * force_length(fiber, 0.4)
    strain = 0.04 * math.sqrt(force)
    now = muscle(fiber, strain, activation)
    assert now.force == pytest.approx(F_MAX * force, rel=1e-9)
    assert now.fiber_velocity == pytest.approx(0, abs=1e-9)
    assert now.activation == activation
    assert now.tendon_strain_now == pytest.approx(strain, rel=1e-9)
    # Held at this length, the muscle comes back to it (above the optimal length slowly, if at all).
    if fiber <= 1:
        path = SLACK * (1 + strain) + fiber * OPTIMAL
        tables = Tables(primitive(MUSCLE)).put({**SIZES, "path_length": path, "activation_level": activation})
        tables.put({"length": fiber * OPTIMAL * 1.01})
        for _ in range(20_000):
            tables.call("output", "rapid")
            tables.call("update", "rapid", 1e-4)
            if abs(tables.y.fiber_velocity) < 1e-9:
                break
        assert tables.y.normalized_fiber_length == pytest.approx(fiber, abs=1e-4)


def test_without_load_it_shortens_at_its_largest_velocity() -> None:
    for activation in (0.01, 1.0):
        for strain in (0.0, -0.02):
            now = muscle(1.0, strain, activation)
            assert now.force == 0
            assert now.normalized_fiber_velocity == -1
            assert now.fiber_velocity == pytest.approx(-V_MAX)


def test_the_tendon_s_force_is_the_slope_of_its_energy() -> None:
    for strain in (0.005, 0.02, 0.04, 0.06):
        step = 1e-6 * SLACK
        more, less = (muscle(1.0, strain + s * step / SLACK, 1.0) for s in (1, -1))
        slope = (more.tendon_energy - less.tendon_energy) / (2 * step)
        assert muscle(1.0, strain, 1.0).force == pytest.approx(slope, rel=1e-6)
    at_maximum = muscle(1.0, 0.04, 1.0)
    assert at_maximum.force == pytest.approx(F_MAX)
    assert at_maximum.tendon_energy == pytest.approx(F_MAX * SLACK * 0.04 / 3)
    assert muscle(1.0, -0.01, 1.0).tendon_energy == 0


def test_it_starts_with_the_tendon_just_taut() -> None:
    tables = Tables(primitive(MUSCLE)).put({**SIZES, "path_length": 0.47, "activation_level": 0.01})
    for mode in ("rapid", "normal"):
        assert not tables.call("start", mode)
        assert tables.x.length == pytest.approx(0.07)
        tables.call("output", mode)
        assert tables.y.force == pytest.approx(0, abs=1e-12)


def test_held_it_follows_its_path_and_let_go_it_has_a_floor() -> None:
    tables = Tables(primitive(MUSCLE)).put({**SIZES, "activation_level": 1.0, "length": 0.1})
    tables.put({"path_length": 0.48, "hold": 1.0}).call("update", "rapid", 1e-3)
    assert tables.x.length == pytest.approx(0.08)
    # Slack for ever, it shortens no further than 5 % of the optimal length.
    tables.put({"path_length": 0.2, "hold": 0.0})
    for _ in range(200):
        tables.call("output", "rapid")
        tables.call("update", "rapid", 1e-3)
    assert tables.x.length == pytest.approx(0.05 * OPTIMAL)
