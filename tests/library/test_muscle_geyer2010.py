"""The muscle of Geyer & Herr (2010): curves, buffer spring, start, elastic energy."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
MUSCLE = {
    "max_isometric_force": 2000.0,
    "optimal_fiber_length": 0.1,
    "tendon_slack_length": 0.4,
    "tendon_strain": 0.04,
}
# Computed independently from the published equations: force-length at w .56, and the force-velocity relation.
FORCE_LENGTH = {0.44: 0.05, 0.5: 0.118564, 0.6: 0.335632, 0.7: 0.630919, 0.8: 0.872435, 0.9: 0.983086, 1.0: 1.0}
FORCE_VELOCITY = {-0.9: 0.018182, -0.5: 0.142857, -0.25: 0.333333, -0.1: 0.6, -0.01: 0.942857, 0.0: 1.0}
FORCE_VELOCITY |= {0.01: 1.140784, 0.05: 1.33564, 0.1: 1.405858, 0.25: 1.464115, 0.5: 1.487437, 1.0: 1.5}


def strained(force: float, length: float) -> float:
    """Length of the unit whose tendon has a force (in F_max) at a fiber length (in optimal ones)."""
    return 0.1 * length + 0.4 * (1 + 0.04 * math.sqrt(force))


@modes
def test_the_curves_of_geyer2010(mode: str) -> None:
    for length, velocity in itertools.product([*FORCE_LENGTH, 1.2, 1.4], FORCE_VELOCITY):
        if length > 1:
            isometric = FORCE_LENGTH[round(2 - length, 1)] * 0.3 + ((length - 1) / 0.56) ** 2
        else:
            isometric = FORCE_LENGTH[length] * 0.3
        force = isometric * FORCE_VELOCITY[velocity]
        state = {"activation_level": 0.3, "length": 0.1 * length, "path_length": strained(force, length)}
        now = computed("muscle/geyer2010", mode, **MUSCLE, **state)
        place = f"length {length}, velocity {velocity}"
        assert now.normalized_force == pytest.approx(force, rel=1e-9), place
        # Near +-1 the relation is flat and the printed six digits say little about the velocity.
        near = 0.02 if velocity > 0.4 else 1e-4
        assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=near), place
        assert now.fiber_velocity == pytest.approx(1.2 * now.normalized_fiber_velocity), place


@modes
def test_the_buffer_keeps_the_fiber_from_collapsing(mode: str) -> None:
    def velocity(length: float) -> float:
        now = computed("muscle/geyer2010", mode, **MUSCLE, activation_level=0.5, length=0.1 * length, path_length=0.1)
        assert now.force == 0
        return float(now.normalized_fiber_velocity)

    assert velocity(0.5) == pytest.approx(-1)  # slack: it shortens at v_max
    buffer = ((0.42 - 0.44) / 0.28) ** 2
    ratio = buffer / (0.5 * math.exp(math.log(0.05) * (0.58 / 0.56) ** 3))
    assert velocity(0.42) == pytest.approx((ratio - 1) / (1 + 5 * ratio), rel=1e-9)
    assert -1 < velocity(0.42) < 0 < velocity(0.4)


@modes
@pytest.mark.parametrize("path", [0.42, 0.46, 0.5, 0.52, 0.55, 0.6])
@pytest.mark.parametrize("activation", [0.01, 0.2, 1.0])
def test_geyer2010_starts_at_rest(path: float, activation: float, mode: str) -> None:
    tables = Tables(primitive("muscle/geyer2010")).put({**MUSCLE, "activation_level": activation})
    tables.put({"path_length": path})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    assert abs(tables.y.normalized_fiber_velocity) < 1e-6
    stretch = max(0.0, tables.y.normalized_fiber_length - 1) / 0.56
    squeeze = max(0.0, 0.44 - tables.y.normalized_fiber_length) / 0.28
    offset = abs(tables.y.normalized_fiber_length - 1) / 0.56
    active = activation * math.exp(math.log(0.05) * offset**3)
    assert tables.y.normalized_force == pytest.approx(active + stretch**2 - squeeze**2, abs=1e-9)


def test_geyer2010_is_geyer2003_where_neither_spring_acts() -> None:
    for length in (0.065, 0.08, 0.1):
        for strain in (0.0, 0.01, 0.03, 0.05):
            values = {
                **MUSCLE,
                "width": 0.4,
                "activation_level": 0.4,
                "length": length,
                "path_length": length + 0.4 * (1 + strain),
            }
            new, old = (computed(f"muscle/geyer{year}", **values) for year in (2010, 2003))
            for name in primitive("muscle/geyer2003").outputs:
                assert getattr(new, name) == pytest.approx(getattr(old, name), rel=1e-12), name


def test_elastic_energy_of_geyer2010_is_the_work_of_its_springs() -> None:
    def springs(length: float, strain: float) -> tuple[float, float]:
        now = computed(
            "muscle/geyer2010",
            **MUSCLE,
            activation_level=0.1,
            length=0.1 * length,
            path_length=0.1 * length + 0.4 * (1 + strain),
        )
        return float(now.tendon_energy), float(now.elastic_energy)

    strains = np.linspace(0, 0.05, 2001)
    work = np.trapezoid(2000 * (strains / 0.04) ** 2, 0.4 * strains)
    assert springs(0.9, 0.05) == pytest.approx((work, work), rel=1e-5)
    stretched = np.linspace(1, 1.5, 2001)
    parallel = np.trapezoid(2000 * ((stretched - 1) / 0.56) ** 2, 0.1 * stretched)
    assert springs(1.5, 0) == pytest.approx((0, parallel), rel=1e-5, abs=1e-9)
    squeezed = np.linspace(0.3, 0.44, 2001)
    buffer = np.trapezoid(2000 * ((0.44 - squeezed) / 0.28) ** 2, 0.1 * squeezed)
    assert springs(0.3, 0) == pytest.approx((0, buffer), rel=1e-5, abs=1e-9)
