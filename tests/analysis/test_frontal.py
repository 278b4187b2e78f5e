"""What is drawn out of the sagittal plane, of a walk made by hand in the model of a walker in space."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gaitsim.analysis.gait.figures import gait_figures
from gaitsim.analysis.gait.frontal import _curves, frontal_figures
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.replays.replay import Replay
from tests.analysis.walking import WEIGHT, on_ground, phase, walk
from tests.simulation.models import ROOT
from tests.simulation.models import model as model_of


@cache
def in_space() -> Replay:
    """Each side of the pelvis is raised by 4 deg in its stance; each foot is pushed inwards by 40 N."""
    signals = {}
    for side, inwards in (("l", -1), ("r", 1)):
        signals[f"leg_{side}.pelvis_orientation.rise"] = np.radians(4) * np.sin(2 * np.pi * phase(side))
        signals[f"leg_{side}.hip_adduction.angle"] = np.radians(5) * np.sin(2 * np.pi * phase(side))
        signals[f"leg_{side}.medial_toe.side_force"] = 40.0 * inwards * on_ground(side)
    return walk(signals, model_of(ROOT / "specs" / "walking_scone_h1922.yaml"))


def test_both_legs_have_the_same_curves_out_of_the_plane() -> None:
    replay = in_space()
    legs = two_legs(replay)
    assert legs is not None
    curves = _curves(replay, legs)
    assert list(curves) == [
        "pelvic obliquity",
        "pelvic rotation",
        "hip adduction",
        "hip rotation",
        "medial force",
    ]
    for leg in legs:
        obliquity = leg.over_cycle(curves["pelvic obliquity"][leg.side]).mean
        assert np.degrees(obliquity[25]) == pytest.approx(4, abs=0.05)
        assert np.degrees(obliquity[75]) == pytest.approx(-4, abs=0.05)
        medial = leg.over_cycle(curves["medial force"][leg.side]).mean
        assert medial[30] == pytest.approx(40 / WEIGHT)
        assert medial[80] == 0


def test_the_figure_is_drawn_in_space_and_not_in_the_plane() -> None:
    replay = in_space()
    legs = two_legs(replay)
    assert legs is not None
    (drawing,) = frontal_figures(replay, legs)
    assert [axes.get_ylabel() for axes in drawing.figure.axes][-1] == "medial (body weights)"
    assert "Rajagopal and others 2016" in drawing.caption
    assert "gait_frontal" not in [each.name for each in gait_figures(walk({}))]
