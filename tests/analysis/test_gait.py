"""Gait over the cycle, steps and comparison with people, on a hand-made walk with known answers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.gait.comparison import compared_signals, later, matched_moments, norm_numbers
from gaitsim.analysis.gait.figures import gait_figures, lacking_gait, symmetry_pairs
from gaitsim.analysis.gait.footsteps import double_support, margin, steps, symmetry, symmetry_index
from gaitsim.analysis.gait.joint_moments import joint_moment, joint_power
from gaitsim.analysis.gait.legs import Leg, mass, on_side, side_of, stands, two_legs, unsided
from gaitsim.analysis.gait.norms import POINTS, read_norm
from gaitsim.analysis.hopping.figures import hopping_figures
from gaitsim.analysis.muscles.figures import figures_of, matching_muscles, muscle_figures
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.motion import motion_figures
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from tests.analysis.replays import cut, of_spec
from tests.analysis.walking import STRIDE, TIMES, WEIGHT, Floats, extended, on_ground, phase, walk

LIBRARY = Library((shipped_folder(),))
ANGLES = "norms/fukuchi2018_walking"
MOMENTS = "norms/fukuchi2018_walking_moments"


def legs_of(replay: Replay) -> tuple[Leg, Leg]:
    found = two_legs(replay)
    assert found is not None
    return found


def people(column: str, side: str, late: float = 0.0) -> Floats:
    """People's curve along the hand-made strides of a side, as many strides late."""
    mean = read_norm(column, LIBRARY).mean
    return np.interp(np.mod(phase(side) - late, 1.0), np.linspace(0, 1, POINTS), mean)


def like_people() -> Replay:
    """Right: people's hip, half of their knee, their ankle a tenth of a stride late. Left: their hip, 10 deg more."""
    return walk(
        {
            "leg_r.hip.angle": math.pi - people("hip_flexion", "r"),
            "leg_l.hip.angle": math.pi - people("hip_flexion", "l") - math.radians(10),
            "leg_r.knee.angle": math.pi - 0.5 * people("knee_flexion", "r"),
            "leg_r.ankle.angle": math.pi / 2 - people("ankle_dorsiflexion", "r", 0.1),
        }
    )


def test_sides_are_told_by_the_first_word() -> None:
    assert [side_of(a) for a in ("leg_l.knee.angle", "leg_r", "trunk.arm_l", "root.x")] == ["l", "r", "", ""]
    assert on_side("leg_l.knee.angle", "r") == "leg_r.knee.angle"
    assert on_side("root.x", "r") == "root.x"
    assert (unsided("leg_l.knee.angle"), unsided("root.x")) == ("knee.angle", "root.x")


def test_a_change_that_does_not_last_is_none() -> None:
    times, load = 0.01 * np.arange(100), np.zeros(100)
    load[20:60] = 1
    load[22] = 0  # a bounce of one instant
    load[80] = 1  # a scuff of one instant
    load[97:] = 1  # a touchdown that has not lasted yet
    standing = stands(times, load, 0.05, 0.04)
    # Two instants do not last, so that the first touchdown is where the load comes back.
    assert np.flatnonzero(standing).tolist() == list(range(23, 60))
    assert np.flatnonzero(stands(times, load, 0.05, 0.02)).tolist() == [*range(20, 60), 97, 98, 99]
    assert not stands(times, 0.04 * load, 0.05, 0.02).any()


def test_the_strides_of_both_legs() -> None:
    left, right = legs_of(walk({}))
    # Those that begin in the first 2 s do not count, nor does a touchdown in the last instant.
    assert right.touchdowns == pytest.approx([STRIDE * n for n in range(2, 10)], abs=0.0051)
    assert left.touchdowns == pytest.approx([STRIDE * (n + 0.5) for n in range(2, 10)], abs=0.0051)
    assert right.share(right.standing) == pytest.approx(0.6, abs=0.005)
    # Two double supports of a tenth of a stride each.
    assert double_support(right, left) == pytest.approx(0.2, abs=0.01)
    assert left.weight == pytest.approx(WEIGHT)
    assert mass(walk({}), left) == pytest.approx(80)


def test_a_signal_over_the_cycle_has_mean_and_band() -> None:
    left, _ = legs_of(walk({}))
    alternate = np.where(np.floor(TIMES / STRIDE + 0.5) % 2, 1.0, 3.0)
    even = left.over_cycle(phase("l") * alternate)
    assert even.rows.shape == (7, 101)
    assert even.rows[0][50] in (pytest.approx(0.5, abs=0.01), pytest.approx(1.5, abs=0.01))
    steady = left.over_cycle(np.sin(2 * np.pi * phase("l")))
    assert steady.mean[[25, 75]] == pytest.approx([1, -1], abs=1e-3)
    assert steady.deviation == pytest.approx(0, abs=1e-3)


def test_stances_and_the_highest_value_of_each_stride() -> None:
    _, right = legs_of(walk({}))
    begins = [right.times[one.start] for one in right.stances]
    assert begins == pytest.approx(right.touchdowns[:-1])
    assert [one.stop - one.start for one in right.stances] == [144] * 7  # 0.72 s
    # A blow of one instant, which the 101 points of a stride pass over.
    blow = np.zeros(len(TIMES))
    blow[right.stances[2].start + 3] = 2.2
    assert right.highest(blow).tolist() == [0, 0, 2.2, 0, 0, 0, 0]


def test_a_leg_needs_contacts_on_its_side_and_two_strides() -> None:
    assert two_legs(of_spec("hopping_geyer2003", [("simulate.duration", "0.5 s")])) is None
    whole = walk({})
    assert two_legs(cut(whole, 1)) is None
    assert two_legs(cut(whole, 480)) is None  # 2.4 s: not two strides of either leg
    # 4 s have two strides of each leg, if those count that begin early.
    assert [len(leg.strides) for leg in legs_of(cut(whole, 800))] == [2, 2]
    assert gait_figures(cut(whole, 480)) == []
    assert norm_numbers(cut(whole, 480)) == {}


def test_what_is_followed_is_read_from_the_measures() -> None:
    found = compared_signals(walk({}))
    assert [one.name for one in found] == ["hip flexion", "knee flexion", "ankle dorsiflexion"]
    assert [one.signal for one in found] == ["leg_r.hip.angle", "leg_r.knee.angle", "leg_r.ankle.angle"]
    assert [(round(math.degrees(one.zero)), one.direction) for one in found] == [(180, -1), (180, -1), (90, -1)]
    assert all(one.norm.deviation is not None and one.norm.unit == "deg" for one in found)


def test_numbers_beside_people() -> None:
    found = norm_numbers(like_people())
    hip = found[f"{ANGLES}.hip_flexion"]
    assert (hip["right"]["unit"], hip["right"]["strides"], hip["left"]["strides"]) == ("deg", 7, 7)
    assert hip["right"]["correlation"] == pytest.approx(1, abs=1e-4)
    assert hip["right"]["error"] == pytest.approx(0, abs=0.1)
    assert hip["right"]["fit"] == 100
    assert hip["right"]["timing_difference"] == pytest.approx(0, abs=1)
    assert hip["left"]["error"] == pytest.approx(10, abs=0.1)
    assert hip["left"]["shape_error"] == pytest.approx(0, abs=0.1)
    assert (hip["left"]["shape_fit"], hip["left"]["range_of_motion_difference"]) == (100, pytest.approx(0, abs=0.1))
    knee = found[f"{ANGLES}.knee_flexion"]["right"]
    assert knee["correlation"] == pytest.approx(1, abs=1e-3)
    assert knee["range_of_motion"] == pytest.approx(60.4 / 2, abs=0.1)
    assert knee["range_of_motion_difference"] == pytest.approx(-60.4 / 2, abs=0.1)
    ankle = found[f"{ANGLES}.ankle_dorsiflexion"]["right"]
    assert ankle["timing_difference"] == pytest.approx(10, abs=1)
    assert ankle["lowest_timing_difference"] == pytest.approx(10, abs=1)
    # A curve that does not change has no correlation.
    assert found[f"{ANGLES}.ankle_dorsiflexion"]["left"]["correlation"] is None
    assert found[f"{MOMENTS}.hip_extension_moment"]["left"]["fit"] is None


def test_the_shorter_way_round_the_cycle() -> None:
    assert later(0.95, 0.05) == pytest.approx(-10)
    assert later(0.05, 0.95) == pytest.approx(10)
    assert later(0.4, 0.1) == pytest.approx(30)


def test_moments_of_muscles_stops_and_damping() -> None:
    replay = walk(
        {
            "leg_r.soleus.path.moment": 80.0,
            "leg_r.gastrocnemius.path.first.moment": 16.0,
            "leg_r.gastrocnemius.path.second.moment": -24.0,
            "leg_r.ankle.stop_moment": -8.0,
            "leg_r.ankle.angular_velocity": 2.0,
            "leg_r.gluteus.path.moment": 40.0,
        }
    )
    ankle, power = joint_moment(replay, "leg_r.ankle"), joint_power(replay, "leg_r.ankle")
    assert ankle == pytest.approx(88) and power == pytest.approx(176)
    assert joint_moment(replay, "root") is None and joint_moment(replay, "leg_r.heel") is None
    means = {one.name: one.cycles["r"].mean[0] for one in matched_moments(replay, legs_of(replay))}
    # The soleus plantarflexes, the gluteus extends, the gastrocnemius flexes the knee: of 80 kg.
    assert means["ankle plantarflexion moment"] == pytest.approx(88 / 80)
    assert means["hip extension moment"] == pytest.approx(0.5)
    assert means["knee extension moment"] == pytest.approx(-0.3)


def test_damping_is_part_of_a_moment(tmp_path: Path) -> None:
    damped = extended(tmp_path, "parts: {leg: {ankle: {damping: 3 N m s/rad}}}\n")
    replay = walk({"leg_r.soleus.path.moment": 80.0, "leg_r.ankle.angular_velocity": 2.0}, damped)
    assert joint_moment(replay, "leg_r.ankle") == pytest.approx(74)


def test_steps_are_from_print_to_print() -> None:
    replay = walk({})
    left, right = legs_of(replay)
    found = steps(replay, (left, right))
    assert [step.side for step in found[:3]] == ["l", "r", "l"]
    for step in found:
        assert step.length == pytest.approx(0.65 if step.side == "l" else 0.75, abs=0.003)
        assert step.cadence == pytest.approx(100, rel=0.01)
    pairs = symmetry_pairs(replay, (left, right))
    assert symmetry(pairs)["step length"] == pytest.approx(100 * 0.1 / 0.7, rel=0.02)
    assert symmetry(pairs)["peak ground force"] == 0


def test_symmetry_index() -> None:
    assert symmetry_index(1, 3) == pytest.approx(100)
    assert symmetry_index(3, 1) == pytest.approx(-100)
    assert (symmetry_index(0, 2), symmetry_index(2, 2)) == (200, 0)
    assert math.isnan(symmetry_index(0, 0))


def test_margin_to_falling(tmp_path: Path) -> None:
    signals = {"center.forward": 0.3, "center.forward_velocity": 1.0, "center.height": 1.0}
    replay = walk({**signals, "leg_r.heel.position": 0.7, "leg_l.heel.position": 0.1})
    legs = legs_of(replay)
    found = margin(replay, legs)
    assert found is not None
    ahead = 0.3 + 1 / math.sqrt(9.81)
    # The right foot is the foremost while it stands; then it is the left one.
    assert found[on_ground("r") > 0] == pytest.approx(0.7 - ahead)
    assert found[on_ground("r") == 0] == pytest.approx(0.1 - ahead)
    assert "gait_margin" in [drawing.name for drawing in gait_figures(replay)]
    assert margin(walk({}, extended(tmp_path, "parts: {center: null}\n")), legs) is None


def test_a_walker_has_figures_with_words_and_units() -> None:
    drawings = {drawing.name: drawing for drawing in gait_figures(like_people())}
    names = ["angles", "forces", "pressure", "moments", "activations", "metabolics", "steps", "margin", "symmetry"]
    assert list(drawings) == [f"gait_{name}" for name in names]
    for name in ("gait_angles", "gait_moments"):
        assert "RMSE" not in drawings[name].caption
        assert "in the table Compared with people" in drawings[name].caption
    # A walker whose sides are alike has bars of no length; a dot stands where each is.
    (dots,) = drawings["gait_symmetry"].figure.axes[0].collections
    assert len(dots.get_offsets()) == len(drawings["gait_symmetry"].figure.axes[0].patches) > 5
    assert "fukuchi2018" in drawings["gait_angles"].caption
    assert "step length 0.697 ± 0.05 m, cadence 100 ± 0 steps" in drawings["gait_steps"].caption
    assert "7 strides of the right leg" in drawings["gait_forces"].caption
    assert len(drawings["gait_angles"].figure.axes) == 3
    assert len(drawings["gait_moments"].figure.axes) == 6
    for name in ("gait_angles", "gait_forces", "gait_pressure", "gait_moments", "gait_metabolics", "gait_steps"):
        assert all(axes.get_ylabel().endswith(")") for axes in drawings[name].figure.axes)
    assert [axes.get_title(loc="left") for axes in drawings["gait_activations"].figure.axes[:2]] == [
        "soleus",
        "tibialis anterior",
    ]


def test_a_walk_says_what_it_lacks(tmp_path: Path) -> None:
    (center,) = lacking_gait(walk({}, extended(tmp_path, "parts: {center: null}\n")))
    assert center == (
        "walk does not tell its center of mass, so no margin to falling is drawn; "
        "add center: {use: sensor/center_of_mass} to its parts."
    )
    assert lacking_gait(walk({})) == []
    assert lacking_gait(of_spec("hopping_geyer2003", [("simulate.duration", "0.1 s")])) == []
    (short,) = lacking_gait(cut(walk({}), 480))
    assert short == "walk takes fewer than two strides with each leg, so nothing is drawn over the gait cycle."
    bare = "".join(f"  correlation_{joint}: null\n" for joint in ("hip", "knee", "ankle"))
    alone = extended(tmp_path, f"measures:\n{bare}objective: null\n")
    (words,) = lacking_gait(walk({}, alone))
    assert words == (
        "walk does not say which angles people have too, so none is compared; add a measure/gait_curve for each joint."
    )
    assert [d.name for d in gait_figures(walk({}, alone))][:3] == [
        "gait_forces",
        "gait_pressure",
        "gait_activations",
    ]
    assert norm_numbers(walk({}, alone)) == {}


def test_many_muscles_are_drawn_together_for_each_leg() -> None:
    replay = walk({})
    assert [d.name for d in muscle_figures(replay)] == ["muscles_l", "excitations_l", "muscles_r", "excitations_r"]
    assert matching_muscles(replay, "leg_*.soleus") == ["leg_l.soleus", "leg_r.soleus"]
    assert [d.name for d in figures_of(replay, "leg_r.soleus")] == ["muscle_leg_r.soleus"]
    sent = muscle_figures(replay)[3].figure.axes[3]
    assert sent.get_title(loc="left") == "vastus"
    assert [line.get_label() for line in sent.lines] == ["force", "knee overextension", "unloading"]
    # The joints of the two legs have panels of their own; the signals of 40 controllers have none.
    (joints,) = motion_figures(replay)
    assert [len(axes.lines) for axes in joints.figure.axes] == [3, 3]
    assert hopping_figures(replay) == []
