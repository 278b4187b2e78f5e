"""The muscle of Millard et al. (2013): curves and states against values of OpenSim 4.6."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

MUSCLE = "muscle/millard2012"
SIZES = {"max_isometric_force": 4000.0, "optimal_fiber_length": 0.04, "tendon_slack_length": 0.26}
_GLOBALS: dict[str, Any] = primitive(MUSCLE).cls.__dict__["output"].__func__.__globals__
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])

# Fiber length: f_l with the least value 0.1 that OpenSim has without damping, and f_PE.
LENGTHS = {
    0.5: (0.117653, 0),
    0.6: (0.451102, 0),
    0.7: (0.767020, 0),
    0.8: (0.870677, 0),
    0.9: (0.956760, 0),
    1.0: (1, 0),
    1.1: (0.957376, 0.017045),
    1.2: (0.823681, 0.049692),
    1.3: (0.684032, 0.126111),
    1.4: (0.543731, 0.262890),
    1.5: (0.403369, 0.460262),
    1.6: (0.263662, 0.717070),
    1.7: (0.132657, 1),
    1.8: (0.100010, 1.285714),
}
VELOCITIES = {
    -1: 0,
    -0.75: 0.051519,
    -0.5: 0.158086,
    -0.25: 0.387333,
    -0.1: 0.625214,
    0: 1,
    0.1: 1.225154,
    0.25: 1.283211,
    0.5: 1.331132,
    1: 1.4,
}
STRAINS = {0.01: 0.099678, 0.02: 0.260936, 0.03: 0.479399, 0.04: 0.747449, 0.049: 1, 0.06: 1.308673}


def function(name: str) -> Any:
    return _GLOBALS[name]


def muscle(mode: str = "rapid", **values: float) -> Any:
    return computed(MUSCLE, mode, **SIZES, **values)


@pytest.mark.parametrize("length", LENGTHS)
def test_active_force_length(length: float) -> None:
    with_floor = function("active_sections")(0.1)
    section = next(s for s in with_floor if s[0] <= length <= s[3])
    assert function("value")(length, section) == pytest.approx(LENGTHS[length][0], abs=1e-6)
    # Without the floor only the two outer sections differ.
    if 0.6 < length < 1.4:
        assert function("active_force")(length) == pytest.approx(LENGTHS[length][0], abs=1e-6)


def test_active_force_vanishes_at_its_ends() -> None:
    for length in (0.1, 0.4441, 1.8123, 2.5):
        assert function("active_force")(length) == 0
    lengths = np.linspace(0.4, 1.9, 15001)
    forces = np.array([function("active_force")(length) for length in lengths])
    assert np.abs(np.diff(forces)).max() < 5 * 1e-4  # no jump between sections
    assert lengths[forces.argmax()] == pytest.approx(1)


@pytest.mark.parametrize("length", LENGTHS)
def test_passive_force(length: float) -> None:
    assert function("passive_force")((length - 1) / 0.7) == pytest.approx(LENGTHS[length][1], abs=1e-6)


@pytest.mark.parametrize("strain", STRAINS)
def test_tendon_force(strain: float) -> None:
    assert function("tendon_force")(strain / 0.049) == pytest.approx(STRAINS[strain], abs=1e-6)


@modes
@pytest.mark.parametrize("velocity", VELOCITIES)
def test_force_velocity(velocity: float, mode: str) -> None:
    assert function("force_velocity")(velocity)[0] == pytest.approx(VELOCITIES[velocity], abs=1e-6)
    # In the whole muscle: at the tendon force that balances active and damping force.
    force = 0.6 * function("force_velocity")(velocity)[0] + 0.1 * velocity
    if force <= 0:
        return
    strains = np.linspace(0, 0.1, 200001)
    strain = float(np.interp(force, [function("tendon_force")(s / 0.049) for s in strains[::100]], strains[::100]))
    now = muscle(mode, activation_level=0.6, length=0.04, path_length=0.04 + 0.26 * (1 + strain))
    assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=2e-3)
    assert now.fiber_velocity == pytest.approx(now.normalized_fiber_velocity * 0.4, rel=1e-12)
    assert now.normalized_force == pytest.approx(0.1 * now.normalized_fiber_velocity + now.fiber_force / 4000, abs=1e-9)


@pytest.mark.parametrize("damping", [0.02, 0.1, 1.0])
@pytest.mark.parametrize("active", [1e-9, 0.01, 0.3, 1.0, 1.2])
def test_the_inverse_is_one_over_all_forces(active: float, damping: float) -> None:
    for force in np.linspace(-0.5, 2.5, 1501):
        velocity = function("velocity_from_force")(force, active, damping)
        assert active * function("force_velocity")(velocity)[0] + damping * velocity == pytest.approx(force, abs=1e-11)


def test_slopes_are_those_of_the_curves() -> None:
    for name, low, high in (("tendon_and_slope", -0.2, 1.6), ("force_velocity", -1.2, 1.2)):
        for x in np.linspace(low, high, 57):
            after, before = (function(name)(x + d)[0] for d in (1e-6, -1e-6))
            assert function(name)(x)[1] == pytest.approx((after - before) / 2e-6, abs=2e-5)


def test_energies_are_integrals_of_forces() -> None:
    for name in ("tendon", "passive"):
        strains = np.linspace(0, 1.5, 30001)
        forces = [function(f"{name}_force")(s) for s in strains]
        for end in (1000, 5000, 12000, 20000, 30000):
            area = np.trapezoid(forces[: end + 1], strains[: end + 1])
            assert function(name)(strains[end])[1] == pytest.approx(area, abs=1e-7)


@modes
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("activation", [0.01, 0.4, 1.0])
@pytest.mark.parametrize("slack", [-0.02, 0.0, 0.01, 0.03])
def test_it_starts_in_equilibrium(slack: float, activation: float, angle: float, mode: str) -> None:
    tables = Tables(primitive(MUSCLE)).put(SIZES | {"activation_level": activation, "pennation_angle": angle})
    path = 0.04 * math.cos(angle) + 0.26 + slack
    tables.put({"path_length": path})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    if path - 0.26 < 0.5 * 0.04:
        return  # it hangs slack on its floor
    now = tables.y
    assert abs(now.normalized_fiber_velocity) < 1e-6
    assert math.sin(now.pennation) * now.fiber_length == pytest.approx(0.04 * math.sin(angle), abs=1e-12)
    stretch = function("passive_force")((now.normalized_fiber_length - 1) / 0.7)
    fiber = activation * now.normalized_isometric_force + stretch
    assert now.normalized_force == pytest.approx(fiber * math.cos(now.pennation), abs=1e-9)
    assert now.fiber_length * math.cos(now.pennation) + 0.26 * (1 + now.tendon_strain_now) == pytest.approx(path)


def test_it_shortens_at_v_max_without_a_load() -> None:
    # Damping alone brakes: at v_max the active force is gone, so a slack tendon lets it shorten more slowly.
    now = muscle(activation_level=1.0, length=0.04, path_length=0.2)
    velocity = now.normalized_fiber_velocity
    assert function("force_velocity")(velocity)[0] == pytest.approx(-0.1 * velocity, abs=1e-9)
    assert -1 < velocity < -0.5
