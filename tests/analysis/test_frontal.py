"""What is drawn out of the sagittal plane, of a walk made by hand in the model of a walker in space."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gaitsim.analysis.gait.figures import gait_figures
from gaitsim.analysis.gait.frontal import _curves, frontal_figures
from gaitsim.analysis.gait.joint_moments import joint_moment, pulled
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.replays.cycles import arriving
from gaitsim.analysis.replays.replay import Replay
from tests.analysis.replays import of_spec
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
        "hip abduction moment",
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


def test_moments_of_paths_through_points_do_the_work_of_their_muscles() -> None:
    """What all joints get from the paths is what these give by shortening, at each instant."""
    replay = of_spec("walking_scone_h1922", [("simulate.duration", "0.1 s")])
    signals = replay.trajectory
    hinges = [p.address for p in replay.model.parts if p.type.reference == "joint/spatial_hinge"]
    at_joints = sum(pulled(replay, hinge) * signals[f"{hinge}.angular_velocity"] for hinge in hinges)
    paths = [p.address for p in replay.model.parts if p.type.kind == "path"]
    given = sum(-signals[f"{path}.velocity"] * arriving(replay, f"{path}.tension") for path in paths)
    assert len(paths) == 22 and np.max(np.abs(given)) > 20
    # In W. Arms are interpolated over 5 ms, and the foot shakes as it takes the weight.
    assert at_joints == pytest.approx(given, rel=0.01, abs=3)
    assert at_joints[60:] == pytest.approx(given[60:], abs=0.02)


def test_the_moment_of_a_hip_is_that_of_its_muscles_and_its_stop() -> None:
    replay = of_spec("walking_scone_h1922", [("simulate.duration", "0.05 s")])
    hip = "leg_r.hip_adduction"
    moment = joint_moment(replay, hip)
    assert moment == pytest.approx(pulled(replay, hip) + replay.trajectory[f"{hip}.stop_moment"])
    assert -1.5 < moment[-1] / 74.53 < -0.3  # N m/kg: it abducts, and carries the body over the right foot
