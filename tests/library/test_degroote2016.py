"""The muscle of De Groote et al. (2016): curves against values computed independently from the paper."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

MUSCLE = "muscle/degroote2016"
SIZES = {"max_isometric_force": 4000.0, "optimal_fiber_length": 0.04, "tendon_slack_length": 0.26}
_GLOBALS: dict[str, Any] = primitive(MUSCLE).cls.__dict__["output"].__func__.__globals__
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
ACTIVE = {
    0.5: 0.054112,
    0.6: 0.302103,
    0.7: 0.684233,
    0.8: 0.836440,
    0.9: 0.937123,
    1.0: 1,
    1.1: 0.953159,
    1.2: 0.793690,
    1.3: 0.581189,
    1.4: 0.380243,
    1.5: 0.226149,
}
PASSIVE = {0.5: 0.000565, 0.8: 0.004740, 1.0: 0.018229, 1.2: 0.069401, 1.4: 0.263532, 1.6: 1}
VELOCITY = {-1: 0, -0.75: 0.096484, -0.5: 0.234036, -0.25: 0.470826, 0: 1, 0.25: 1.400766, 0.5: 1.588423, 1: 1.794343}
TENDON = {0.01: 0.088295, 0.02: 0.215569, 0.03: 0.399031, 0.04: 0.663486, 0.049: 1}


def function(name: str) -> Any:
    return _GLOBALS[name]


def test_curves() -> None:
    assert {x: pytest.approx(function("active_force")(x), abs=1e-6) for x in ACTIVE} == ACTIVE
    assert {x: pytest.approx(function("passive_force")(x), abs=1e-6) for x in PASSIVE} == PASSIVE
    assert {x: pytest.approx(function("force_velocity")(x), abs=1e-6) for x in VELOCITY} == VELOCITY
    stiffness = function("tendon_stiffness")(0.049)
    assert stiffness == pytest.approx(36.5665, abs=1e-4)
    assert {x: pytest.approx(function("tendon_force")(x, stiffness), abs=1e-6) for x in TENDON} == TENDON


@pytest.mark.parametrize("muscle", [MUSCLE, "muscle/rigid_tendon"])
def test_curves_to_the_last_digit(muscle: str) -> None:
    """Against the published equations with OpenSim's digits, evaluated with 40 digits."""
    functions = primitive(muscle).cls.__dict__["output"].__func__.__globals__
    active = {0.5: 0.0541121530142743, 0.8: 0.8364395661146517, 1: 1, 1.3: 0.5811888983785029}
    velocity = {-1: 0, -0.5: 0.2340363935488038, -0.1: 0.745171585030237, 0: 1, 0.25: 1.4007657507180785}
    assert {x: pytest.approx(functions["active_force"](x), abs=5e-16) for x in active} == active
    assert {x: pytest.approx(functions["force_velocity"](x), abs=5e-16) for x in velocity} == velocity


def test_passive_force_begins_at_a_fifth() -> None:
    assert function("passive_force")(0.2) == 0
    assert function("passive_force")(0.1) == 0
    assert function("passive_energy")(0.1) == 0


def test_a_slack_tendon_does_not_push() -> None:
    assert function("tendon_force")(-0.05, 36.5665) == 0


@pytest.mark.parametrize("velocity", np.linspace(-1.2, 1.2, 49))
def test_the_inverse_and_its_continuation(velocity: float) -> None:
    force, slope = function("force_and_slope")(velocity)
    assert function("velocity_from_force")(force) == pytest.approx(velocity, abs=1e-12)
    if abs(velocity) < 1:
        assert force == function("force_velocity")(velocity)
        after, before = (function("force_velocity")(velocity + d) for d in (1e-6, -1e-6))
        assert slope == pytest.approx((after - before) / 2e-6, rel=1e-6)


@modes
@pytest.mark.parametrize("velocity", [-0.75, -0.5, -0.25, 0, 0.25, 0.5])
def test_force_velocity_in_the_whole_muscle(velocity: float, mode: str) -> None:
    wanted = 0.6 * VELOCITY[velocity] + PASSIVE[1.0]
    strain = math.log(wanted / 0.2 + 1) / (math.log(6) / 0.049)
    now = computed(MUSCLE, mode, **SIZES, activation_level=0.6, length=0.04, path_length=0.04 + 0.26 * (1 + strain))
    # f_l is 1 to six digits at the optimal length.
    assert now.normalized_force == pytest.approx(wanted, abs=1e-9)
    assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=5e-6)
    assert now.fiber_velocity == pytest.approx(now.normalized_fiber_velocity * 10 * 0.04, rel=1e-12)
    assert now.fiber_force == pytest.approx(4000 * 0.6 * VELOCITY[velocity], abs=0.01)


def test_energies_are_integrals_of_forces() -> None:
    stretched = np.linspace(0.2, 1.6, 20001)
    area = np.trapezoid([function("passive_force")(x) for x in stretched], stretched)
    assert function("passive_energy")(1.6) == pytest.approx(area, abs=1e-7)
    strains = np.linspace(0, 0.06, 20001)
    stiffness = function("tendon_stiffness")(0.049)
    work = 4000 * 0.26 * np.trapezoid([function("tendon_force")(x, stiffness) for x in strains], strains)
    now = computed(MUSCLE, **SIZES, activation_level=0.5, length=0.008, path_length=0.008 + 0.26 * 1.06)
    assert now.elastic_energy == pytest.approx(work, rel=1e-7)


@modes
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("activation", [0.01, 0.4, 1.0])
@pytest.mark.parametrize("slack", [-0.01, 0.0, 0.01, 0.03])
def test_it_starts_in_equilibrium(slack: float, activation: float, angle: float, mode: str) -> None:
    tables = Tables(primitive(MUSCLE)).put(SIZES | {"activation_level": activation, "pennation_angle": angle})
    tables.put({"path_length": 0.04 * math.cos(angle) + 0.26 + slack})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    now = tables.y
    assert abs(now.normalized_fiber_velocity) < 1e-6
    fiber = activation * now.normalized_isometric_force + function("passive_force")(now.normalized_fiber_length)
    assert now.normalized_force == pytest.approx(fiber * math.cos(now.pennation), abs=1e-9)
