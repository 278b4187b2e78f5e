"""Maxima, and the fixed point of the map from one to the next, on numbers whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.analysis.signals.return_map import at_passages, fixed_point, maxima


def test_maxima_of_a_sine() -> None:
    times = np.arange(0, 5, 0.001)
    assert times[maxima(np.sin(2 * np.pi * times))] == pytest.approx([0.25, 1.25, 2.25, 3.25, 4.25], abs=1e-9)


def test_an_end_is_no_maximum_and_a_plateau_is_one() -> None:
    assert maxima(np.array([3.0, 1, 2, 2, 2, 0, 5])).tolist() == [2]
    assert maxima(np.array([3.0, 2, 1])).tolist() == []
    assert maxima(np.array([1.0, 1, 1, 1])).tolist() == []
    assert maxima(np.array([1.0, np.nan, 2, 1])).tolist() == []
    assert maxima(np.zeros(0)).tolist() == []


def test_a_ripple_is_no_maximum() -> None:
    times = np.arange(0, 3, 0.001)
    rippled = np.sin(2 * np.pi * times) + 0.01 * np.sin(2 * np.pi * 40 * times)
    assert maxima(rippled).size == 3
    # At the slopes the ripple rises too little to turn the signal.
    assert maxima(rippled, prominence=0.001).size == 27


def events(first: float, slope: float, fixed: float, count: int) -> np.ndarray:
    return np.array([fixed + (first - fixed) * slope**k for k in range(count)])


@pytest.mark.parametrize("slope", [0.5, -0.5, 0.9, 1.5, -1.5])
def test_a_linear_map_has_its_fixed_point_and_slope(slope: float) -> None:
    found = fixed_point(events(1.2, slope, 1.0, 40 if abs(slope) < 1 else 6))
    if slope > 1:  # it leaves on one side: no two points of the map lie around the diagonal
        assert found is None
        return
    assert found is not None and found.slope is not None
    assert found.value == pytest.approx(1.0, abs=1e-9)
    assert found.slope == pytest.approx(slope, abs=1e-6)


def test_the_step_s_noise_is_no_slope() -> None:
    noise = np.random.default_rng(1).normal(0, 5e-6, 30)
    found = fixed_point(events(1.1, 0.2, 1.0, 30) + noise)
    assert found is not None and found.slope is not None
    assert found.value == pytest.approx(1.0, abs=2e-5)
    assert found.slope == pytest.approx(0.2, abs=0.01)


def test_events_that_begin_at_the_fixed_point_tell_no_slope() -> None:
    found = fixed_point(np.full(5, 1.3))
    assert found is not None
    assert (found.value, found.slope) == (1.3, None)


def test_two_events_are_too_few() -> None:
    assert fixed_point(np.array([1.0, 1.1])) is None


def test_passages_lie_between_instants() -> None:
    times = np.arange(0, 3, 0.01)
    guard = np.sin(2 * np.pi * (times - 0.2034))
    assert at_passages(times, guard) == pytest.approx([0.2034, 1.2034, 2.2034], abs=1e-5)
    assert at_passages(times, np.ones_like(times)).size == 0
