"""The polynomial muscle of Millard et al. (2013): curves as Hyfydy's manual prints them, and its solver."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

MUSCLE = "muscle/millard2012_polynomial"
SIZES = {"max_isometric_force": 4000.0, "optimal_fiber_length": 0.04, "tendon_slack_length": 0.26}
_GLOBALS: dict[str, Any] = primitive(MUSCLE).cls.__dict__["output"].__func__.__globals__
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])

# By hand from the printed constants.
ACTIVE = {0.46899: 0, 0.5: 0.125, 0.8: 0.878, 1.0: 1, 1.2: 0.902, 1.5: 0.5, 1.80528: 0}
PASSIVE = {0.5: 0, 1.0: 0, 1.2: 0.05958936, 1.5: 0.45345375, 2.0: 2.35395}
VELOCITY = {-2: 0, -1: 0, -0.5: 0.1561210454, -0.227: 0.3865, 0: 1, 0.11: 1.3, 0.5: 1.4918032787, 1: 1.5405405405}
TENDON = {-0.01: 0, 0: 0, 0.01: 0.1058032, 0.03: 0.4739928, 0.0485: 1.000445487, 0.06: 1.4177352}


def function(name: str) -> Any:
    return _GLOBALS[name]


def test_curves() -> None:
    for name, values in (
        ("active_force", ACTIVE),
        ("passive_force", PASSIVE),
        ("force_velocity", VELOCITY),
        ("tendon_force", TENDON),
    ):
        assert {x: pytest.approx(function(name)(x), abs=1e-9) for x in values} == values


def test_the_active_force_vanishes_where_the_manual_says() -> None:
    for end in (function("SHORTEST"), function("LONGEST")):
        x = end - 1
        assert 1.5 * x**3 - 2.75 * x**2 + 1 == pytest.approx(0, abs=2e-5)  # five digits are printed
    assert function("active_force")(0.3) == function("active_force")(2.0) == 0


def test_slopes_and_energies_belong_to_their_forces() -> None:
    for force, slope, ends in (
        ("tendon_force", "tendon_stiffness", (-0.01, 0.06)),
        ("force_velocity", "force_velocity_slope", (-1.2, 1.2)),
    ):
        for x in np.linspace(*ends, 60):
            rise = (function(force)(x + 1e-7) - function(force)(x - 1e-7)) / 2e-7
            assert function(slope)(x) == pytest.approx(rise, rel=1e-5, abs=1e-6)
    for force, energy, end in (("tendon_force", "tendon_energy", 0.06), ("passive_force", "passive_energy", 1.8)):
        stretched = np.linspace(0, end, 20001)
        area = np.trapezoid([function(force)(x) for x in stretched], stretched)
        assert function(energy)(end) == pytest.approx(area, abs=1e-7)


@pytest.mark.parametrize("damping", [0.02, 0.1, 10.0])
@pytest.mark.parametrize("active", [0, 1e-9, 0.01, 0.3, 1.0, 1.2])
def test_the_inverse_is_one_over_all_forces(active: float, damping: float) -> None:
    for force in np.linspace(-12, 12, 2401):
        velocity = function("velocity_from_force")(force, active, damping)
        found = active * function("force_velocity")(velocity) + damping * velocity
        assert found == pytest.approx(force, abs=1e-12)


@pytest.mark.parametrize("guess", [-50.0, -1.0, 0.0, 3.0, 50.0])
@pytest.mark.parametrize("loss", [1e-6, 1e-3, 0.1])
def test_the_balance_within_a_step_is_found_from_anywhere(guess: float, loss: float) -> None:
    for strain in (-0.02, 0, 0.01, 0.1):
        for strength in (0, 0.01, 1.0):
            velocity = function("velocity_after")(guess, strain, loss, 0.9, 0.2, strength, 0.1)
            fiber = strength * function("force_velocity")(velocity) + 0.1 * velocity + 0.2
            assert function("tendon_force")(strain - loss * velocity) / 0.9 == pytest.approx(fiber, abs=1e-6)


@modes
@pytest.mark.parametrize("velocity", [-0.75, -0.5, -0.1, 0, 0.25, 0.5])
def test_force_velocity_in_the_whole_muscle(velocity: float, mode: str) -> None:
    wanted = 0.8 * function("force_velocity")(velocity) + 0.1 * velocity
    if wanted <= 0:
        return
    strain = (math.sqrt(7.9706**2 + 4 * 260.972 * wanted) - 7.9706) / (2 * 260.972)
    now = computed(MUSCLE, mode, **SIZES, activation_level=0.8, length=0.04, path_length=0.04 + 0.26 * (1 + strain))
    assert now.normalized_force == pytest.approx(wanted, abs=1e-9)
    assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=1e-9)
    assert now.fiber_velocity == pytest.approx(now.normalized_fiber_velocity * 10 * 0.04, rel=1e-12)
    assert now.fiber_force == pytest.approx(4000 * (wanted - 0.1 * velocity), abs=1e-5)


@modes
@pytest.mark.parametrize("angle", [0.0, 0.4939, 0.8])
@pytest.mark.parametrize("activation", [0.01, 0.4, 1.0])
@pytest.mark.parametrize("slack", [-0.01, 0.0, 0.01, 0.03])
def test_it_starts_in_equilibrium(slack: float, activation: float, angle: float, mode: str) -> None:
    tables = Tables(primitive(MUSCLE)).put(SIZES | {"activation_level": activation, "pennation_angle": angle})
    path = 0.04 * math.cos(angle) + 0.26 + slack
    tables.put({"path_length": path})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    now = tables.y
    assert abs(now.normalized_fiber_velocity) < 1e-6
    assert math.sin(now.pennation) * now.fiber_length == pytest.approx(0.04 * math.sin(angle), abs=1e-12)
    fiber = activation * now.normalized_isometric_force + function("passive_force")(now.normalized_fiber_length)
    assert now.normalized_force == pytest.approx(fiber * math.cos(now.pennation), abs=1e-9)
    assert now.fiber_length * math.cos(now.pennation) + 0.26 * (1 + now.tendon_strain_now) == pytest.approx(path)


@modes
def test_it_hangs_slack_on_its_shortest_fiber(mode: str) -> None:
    tables = Tables(primitive(MUSCLE)).put(SIZES | {"activation_level": 1.0, "path_length": 0.27})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    assert tables.y.force == 0
    assert tables.y.normalized_fiber_length == pytest.approx(0.46899)
    assert not tables.call("update", mode, 1e-3)
    assert tables.x.length == pytest.approx(0.46899 * 0.04)


def test_damping_alone_brakes_a_fiber_without_a_load() -> None:
    now = computed(MUSCLE, **SIZES, activation_level=1.0, length=0.04, path_length=0.2)
    velocity = now.normalized_fiber_velocity
    assert function("force_velocity")(velocity) == pytest.approx(-0.1 * velocity, abs=1e-9)
    assert -1 < velocity < -0.5
