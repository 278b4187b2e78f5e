"""Figures of limits over another number: a polar one over an angle, a line over other numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gaitsim
from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.searches.limits import limit_figures
from gaitsim.errors import Usage
from tests.analysis.replays import of_result

STONE = """
gaitsim: 1
parts:
  stone: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/planar, parent: world, child: stone.center}
  push: {use: perturbation/push, frame: stone.center, strength: 0 N, onset: 0.1 s, duration: 0.1 s}
initial: {guide.z: 2 m}
measures:
  way: {use: measure/range, signal: {from: guide.x}}
simulate: {duration: 0.5 s, step: 1 ms}
"""


def drawn(folder: Path, over: dict[str, str]) -> list[Drawing]:
    path = folder / "stone.yaml"
    path.write_text(STONE)
    ranges = {"push.strength": "0 N:20 N"}
    made = gaitsim.limit(path, ranges, over=over, until="way=10 cm", results=folder / "results", points=5)
    assert made.folder is not None
    return limit_figures(of_result(made.folder))


def test_limits_over_an_angle_are_polar(tmp_path: Path) -> None:
    (figure,) = drawn(tmp_path, {"push.azimuth": "-90 deg:240 deg:12"})
    assert figure.name == "limit_push.strength"
    assert "0 deg is up, and angles grow to the left" in figure.caption
    (axes,) = figure.figure.axes
    assert axes.name == "polar"
    ring, whole = axes.get_lines()
    turns, sizes = ring.get_data()
    # A closed ring around the origin, from the front on: 2.86 N / cos of the angle to the way of the guide.
    assert turns[0] == pytest.approx(0) and turns[-1] == turns[0] and len(turns) == 13
    expected = np.minimum(20, 0.1 / 0.035 / np.maximum(1e-9, np.abs(np.cos(turns))))
    assert sizes == pytest.approx(expected, abs=0.4)
    assert np.degrees(whole.get_xdata()) == pytest.approx([-90, 90])
    assert axes.get_theta_offset() == pytest.approx(np.pi / 2) and axes.get_theta_direction() == 1


def test_limits_over_other_numbers_are_a_line(tmp_path: Path) -> None:
    (figure,) = drawn(tmp_path, {"stone.mass": "1 kg,2 kg,3 kg"})
    axes = figure.figure.axes[0]
    masses, sizes = axes.get_lines()[0].get_data()
    assert list(masses) == [1, 2, 3]
    assert sizes == pytest.approx(0.1 / 0.035 * masses, abs=0.25)
    assert axes.get_xlabel() == "stone.mass (kg)" and axes.get_ylabel() == "push.strength (N)"


def test_limits_over_two_numbers_are_refused(tmp_path: Path) -> None:
    with pytest.raises(Usage, match="limits are found over one number; give one of them to set"):
        drawn(tmp_path, {"stone.mass": "1 kg,2 kg", "push.azimuth": "0 deg,90 deg"})


def test_limits_without_another_number_have_no_such_figure(tmp_path: Path) -> None:
    assert drawn(tmp_path, {}) == []
