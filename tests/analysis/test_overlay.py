"""Several runs over one another: gaits of hand-made walks, and the last cycles of hoppers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.gait.overlay import gait_overlays
from gaitsim.analysis.gait.panels import PEOPLE
from gaitsim.analysis.signals.plots import signal_overlays
from tests.analysis.replays import cut, of_spec
from tests.analysis.walking import bent, phase, walk


def lines(drawing: Drawing, row: int, column: int) -> dict[str, np.ndarray]:
    panel = drawing.figure.axes[2 * row + column]
    return {str(line.get_label()): np.asarray(line.get_ydata()) for line in panel.get_lines()}


def test_each_run_is_a_line_in_the_panel_of_each_leg() -> None:
    angles, forces, *_ = gait_overlays([bent("bob", 40), bent("alice", 60), bent("carl", 20)])
    assert (angles.name, forces.name) == ("overlaid_angles", "overlaid_forces")
    for column in (0, 1):
        knee = lines(angles, 1, column)
        assert list(knee) == ["people", "bob", "alice", "carl"]
        assert [knee[name].max() for name in ("bob", "alice", "carl")] == pytest.approx([40, 60, 20], abs=0.1)
    assert lines(forces, 0, 0)["bob"].max() == pytest.approx(1)
    assert "(strides of both legs: bob 14, alice 14, carl 14)" in angles.caption
    assert [text.get_text() for text in angles.figure.legends[0].get_texts()] == ["people", "bob", "alice", "carl"]


def test_both_legs_have_one_scale_that_shows_all() -> None:
    limp = replace(walk({"leg_r.knee.angle": np.pi - np.radians(170) * np.sin(np.pi * phase("r"))}), label="limp")
    left, right = gait_overlays([bent("bob", 40), limp])[0].figure.axes[2:4]
    assert left.get_ylim() == right.get_ylim()
    assert right.get_ylim()[1] > 170


def test_people_have_a_colour_of_their_own() -> None:
    angles = gait_overlays([bent(f"run {number}", number) for number in range(9)])[0]
    found = {str(line.get_label()): (line.get_color(), line.get_linestyle()) for line in angles.figure.axes[0].lines}
    assert len(set(found.values())) == len(found) == 10
    assert [label for label, (colour, _) in found.items() if colour == PEOPLE] == ["people"]


def test_a_run_that_does_not_walk_is_named() -> None:
    fallen = replace(cut(walk({}), 400), label="fallen")
    angles = gait_overlays([bent("bob", 40), fallen, bent("alice", 60)])[0]
    assert list(lines(angles, 0, 0)) == ["people", "bob", "alice"]
    assert angles.caption.endswith(" fallen does not take two strides with each leg.")
    assert gait_overlays([bent("bob", 40), fallen]) == []


def test_hoppers_are_compared_from_touchdown_on() -> None:
    hops = [of_spec("hopping_geyer2003", [("simulate.duration", "2.5 s"), ("feedback.gain", gain)]) for gain in "24"]
    found = {drawing.name: drawing for drawing in signal_overlays(hops)}
    assert list(found) == ["motion", "ground", "muscles", "control"]
    assert found["motion"].title == "Coordinates of the joints, last cycles from touchdown"
    for line in found["motion"].figure.axes[0].get_lines():
        assert np.asarray(line.get_xdata())[0] == 0
        assert np.asarray(line.get_ydata())[0] == pytest.approx(0.99, abs=1e-3)  # the landing length
    # A run that falls is looked at as a whole.
    failed = replace(hops[0], outcome=replace(hops[0].outcome, status="stopped", reason="fall"))
    assert signal_overlays([hops[0], failed])[0].title == "Coordinates of the joints"
