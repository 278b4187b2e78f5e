"""Comparison with human curves, on hand-made curves with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import metrics

from gaitsim.analysis.gait.norms import (
    Norm,
    compared,
    correlation,
    fit_percentage,
    read_norm,
    root_mean_square_error,
    strides,
)
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder

LIBRARY = Library((shipped_folder(),))
CYCLE = np.linspace(0, 1, 101)
LINE, ONES = CYCLE.copy(), np.ones(101)


def test_fit_is_whole_within_the_band_and_none_far_outside() -> None:
    low, high = LINE - 0.1, LINE + 0.1
    for curve in (LINE, low, high):
        assert fit_percentage(curve, low, high, 1e-6) == 100
    # A quarter of the width outside, everywhere: a quarter is lost.
    assert fit_percentage(high + 0.05, low, high, 1e-6) == pytest.approx(75)
    assert fit_percentage(low - 0.05, low, high, 1e-6) == pytest.approx(75)
    # Outside by half a width, but only in the last fifth of the points (20 of 101).
    part = np.where(np.arange(101) > 80, high + 0.1, LINE)
    assert fit_percentage(part, low, high, 1e-6) == pytest.approx(100 * (1 - 0.5 * 20 / 101))
    assert fit_percentage(high + 5, low, high, 1e-6) == 0


def test_fit_weighs_each_point_by_the_width_there() -> None:
    width = np.where(np.arange(101) < 50, 0.1, 1.0)
    low, high = -width / 2, width / 2
    # 0.05 outside: half a width in 50 points, a twentieth in 51.
    assert fit_percentage(high + 0.05, low, high, 1e-6) == pytest.approx(100 * (1 - (50 * 0.5 + 51 * 0.05) / 101))
    # A band without width counts as wide as the least width.
    assert fit_percentage(0.001 * ONES, 0 * ONES, 0 * ONES, 0.01) == pytest.approx(90)


def test_error_and_correlation() -> None:
    assert root_mean_square_error(LINE + 0.3, LINE) == pytest.approx(0.3)
    assert root_mean_square_error(np.where(np.arange(101) < 1, 5.0, 0.0), 0 * ONES) == pytest.approx(5 / math.sqrt(101))
    assert correlation(3 * LINE - 7, LINE) == pytest.approx(1)
    assert correlation(-LINE, LINE) == pytest.approx(-1)
    # Quarter-period shift of a sine: nothing in common over a whole period.
    turn = 2 * np.pi * np.arange(101) / 101
    assert correlation(np.sin(turn), np.cos(turn)) == pytest.approx(0, abs=1e-12)
    assert math.isnan(correlation(ONES, LINE))


def test_strides_are_cut_at_touchdowns() -> None:
    times = np.arange(0, 5, 0.01)
    values = np.mod(times, 1.0) * np.where(times < 2, 1.0, 2.0)
    found = strides(times, values, [-0.5, 0.5, 1.5, 2.5, 4.9, 5.5])
    assert found.shape == (3, 101)  # the first and the last are not covered
    # From 0.5 to 1.5 s the signal begins at a half, rises, falls to nothing and is back at a half.
    assert found[0][[0, 25, 60, 100]] == pytest.approx([0.5, 0.75, 0.1, 0.5])
    assert found[1][100] == pytest.approx(1.0)
    assert strides(times, values, [1.0]).shape == (0, 101)


def test_the_walking_norm_compared_with_itself() -> None:
    knee = read_norm("knee_flexion", LIBRARY)
    assert (knee.name, knee.unit, knee.recorded_by) == ("norms/fukuchi2018_walking.knee_flexion", "deg", "fukuchi2018")
    found = compared(knee.mean, knee)
    assert (found.error, found.shape_error) == pytest.approx((0, 0), abs=1e-12)
    assert found.correlation == pytest.approx(1)
    assert (found.fit, found.shape_fit) == (100, 100)
    assert math.degrees(found.reach) == math.degrees(found.norm_reach) == pytest.approx(62.4 - 2.0)
    assert (found.highest_at, found.lowest_at) == (0.74, 0.98)


def test_a_shifted_and_an_offset_curve() -> None:
    hip = read_norm("hip_flexion", LIBRARY)
    offset = compared(hip.mean + math.radians(20), hip)
    assert math.degrees(offset.error) == pytest.approx(20)
    assert math.degrees(offset.shape_error) == pytest.approx(0, abs=1e-9)
    assert offset.fit < 70 and offset.shape_fit == 100 and offset.correlation == pytest.approx(1)
    late = compared(np.roll(hip.mean[:100], 10)[np.arange(101) % 100], hip)
    assert late.highest_at == pytest.approx(offset.norm_highest_at - 0.9)
    assert late.correlation < 0.9


def test_fit_of_an_offset_of_one_and_a_half_deviations() -> None:
    ankle = read_norm("ankle_dorsiflexion", LIBRARY)
    assert ankle.deviation is not None
    # Half a deviation outside a band of two: a quarter is lost at every point.
    assert compared(ankle.mean + 1.5 * ankle.deviation, ankle).fit == pytest.approx(75)


def test_a_norm_without_deviation_has_a_band_without_width() -> None:
    hip = read_norm("hip_extension_moment", LIBRARY, "norms/fukuchi2018_walking_moments")
    assert hip.deviation is None
    low, high = hip.band
    assert np.array_equal(low, high)
    assert compared(hip.mean, hip).fit == 100


def test_the_measure_in_the_loop_finds_the_same() -> None:
    knee = read_norm("knee_flexion", LIBRARY)
    norm = Norm("line", "rad", knee.mean, None, "")
    times = np.arange(12000) * 0.001
    angle = 0.2 + 0.8 * np.interp(np.mod(times + 1e-9 - 0.03, 1.1) / 1.1, CYCLE, knee.mean)  # a little late
    stance = (np.mod(times + 1e-9, 1.1) < 0.7).astype(float)
    loop = metrics("measure/gait_curve", {"signal": angle, "stance": stance}, 0.001, curve=norm.mean)
    touchdowns = [t for t in 1.1 * np.arange(12) if t >= 2]
    mean = np.mean(strides(times, angle, touchdowns), axis=0)
    after = compared(mean, norm)
    assert loop["value"] == pytest.approx(after.correlation, abs=1e-4)
    assert loop["error"] == pytest.approx(after.error, abs=1e-3)
    assert loop["shape_error"] == pytest.approx(after.shape_error, abs=1e-3)
    assert loop["reach"] == pytest.approx(after.reach, abs=2e-3)
    assert loop["highest_at"] == pytest.approx(after.highest_at, abs=0.011)
