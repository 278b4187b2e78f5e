"""Activation dynamics: time constants against an independent simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import Tables, primitive

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
THELEN = {"activation_time": 0.015, "deactivation_time": 0.050}
SHARP = {"smoothing": 10.0}


def time_to(reference: str, begin: float, excitation: float, level: float, **values: float) -> float:
    """When the activation passes a level, in s."""
    dt = 5e-6
    tables = Tables(primitive(reference)).put({"min_excitation": 0.0, "excitation": excitation, **values})
    tables.put({"level": begin})
    steps = 0
    while (tables.x.level - level) * (begin - level) > 0:
        tables.call("update", "rapid", dt)
        steps += 1
    return steps * dt


@pytest.mark.parametrize(
    ("reference", "values", "rise", "fall"),
    [
        ("activation/first_order", {}, 0.010, 0.010),
        ("activation/two_constants", THELEN, 0.01578, 0.03574),
        ("activation/two_constants", {}, 0.01052, 0.02859),
        ("activation/excitation_rate", {}, 0.010, 0.040),
        ("activation/degroote2016", SHARP, 0.01578, 0.04288),
        # With the paper's b = 0.1: the inverse of the rate, integrated over the activation.
        ("activation/degroote2016", {}, 0.023163, 0.028439),
    ],
)
def test_times_of_a_step(reference: str, values: dict[str, float], rise: float, fall: float) -> None:
    assert time_to(reference, 0.0, 1.0, 1 - math.exp(-1), **values) == pytest.approx(rise, abs=1.5e-5)
    assert time_to(reference, 1.0, 0.0, math.exp(-1), **values) == pytest.approx(fall, abs=1.5e-5)


@modes
@pytest.mark.parametrize(
    "reference", ["activation/two_constants", "activation/excitation_rate", "activation/degroote2016"]
)
@pytest.mark.parametrize(("excitation", "activation"), [(0.5, 0.5), (-3, 0.01), (0, 0.01), (7, 1)])
def test_it_clips_and_starts_settled(reference: str, excitation: float, activation: float, mode: str) -> None:
    tables = Tables(primitive(reference)).put({"excitation": excitation})
    tables.call("start", mode)
    assert tables.x.level == activation
    tables.call("update", mode, 1e-3)
    assert tables.x.level == pytest.approx(activation)


@modes
def test_the_smooth_one_is_the_other_far_from_rest(mode: str) -> None:
    """Its rate is that of Thelen (2003) where tanh has come to its end."""
    rates = []
    for reference in ("activation/two_constants", "activation/degroote2016"):
        values = {"activation_time": 0.015, "deactivation_time": 0.060, "excitation": 1.0, "level": 0.1}
        values |= SHARP if "degroote2016" in reference else {}
        tables = Tables(primitive(reference)).put(values)
        tables.call("update", mode, 1e-6)
        rates.append((tables.x.level - 0.1) / 1e-6)
    assert rates[0] == pytest.approx(0.9 / (0.015 * 0.65), rel=1e-9)
    assert rates[1] == pytest.approx(rates[0], rel=1e-6)


@pytest.mark.parametrize(("values", "smoothing"), [({}, 0.1), (SHARP, 10)])
def test_the_smooth_one_by_its_equation(values: dict[str, float], smoothing: float) -> None:
    for level, excitation in np.random.default_rng([1]).uniform(0.02, 1, (50, 2)):
        tables = Tables(primitive("activation/degroote2016")).put({"excitation": excitation, "level": level, **values})
        tables.call("update", "rapid", 1e-4)
        f, s = 0.5 * math.tanh(smoothing * (excitation - level)), 0.5 + 1.5 * level
        rate = ((f + 0.5) / (0.015 * s) + s / 0.060 * (0.5 - f)) * (excitation - level)
        assert tables.x.level - level == pytest.approx(rate * 1e-4, rel=1e-9)


@pytest.mark.parametrize("excitation", [0.1, 0.4])
def test_the_rate_of_a_muscle_grows_with_its_excitation(excitation: float) -> None:
    """Rising or falling, it approaches the excitation exponentially, at the rate 25 + 75 u."""
    for begin in (0.0, 1.0):
        level = excitation + (begin - excitation) * math.exp(-1)
        found = time_to("activation/excitation_rate", begin, excitation, level)
        assert found == pytest.approx(1 / (25 + 75 * excitation), abs=1.5e-5)
