"""The numbers of a hand-made walk with known answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.gait.joint_moments import joint_work
from gaitsim.analysis.gait.keypoints import FORWARDS, ON, POWERS, VERTICAL
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.gait.muscles import metabolic_power
from gaitsim.analysis.gait.numbers import gait_numbers, gait_table, norms_table
from gaitsim.analysis.report.report import write
from tests.analysis.replays import cut
from tests.analysis.test_gait import like_people
from tests.analysis.walking import STANCE, STRIDE, TIMES, WEIGHT, on_ground, phase, walk


def test_steps_and_their_times() -> None:
    found = gait_numbers(walk({}))
    assert found["strides"] == {"left": 7, "right": 7}
    length = found["step_length"]
    assert (length["unit"], length["left"]) == ("m", pytest.approx(0.65, abs=0.003))
    assert length["right"] == pytest.approx(0.75, abs=0.003)
    assert length["mean"] == pytest.approx(0.7, abs=0.006)
    assert length["deviation"] == pytest.approx(0.05, abs=0.001)
    assert found["step_time"]["mean"] == pytest.approx(STRIDE / 2, rel=0.01)
    assert found["cadence"]["mean"] == pytest.approx(100, rel=0.01)
    assert found["stance"]["left"] == found["stance"]["right"] == pytest.approx(60, abs=0.5)
    assert found["double_support"]["mean"] == pytest.approx(20, abs=1)


def test_forces_are_those_of_all_instants() -> None:
    shear = 0.2 * WEIGHT * -np.sin(2 * np.pi * phase("r") / STANCE) * on_ground("r")
    load = on_ground("r") + 0.5 * (np.abs(phase("r") - 0.1) < 1e-6)  # a blow of one instant in each stride
    signals = {"leg_r.heel.friction_force": shear, "leg_r.heel.load": load, "leg_r.heel.force": WEIGHT * load}
    found = gait_numbers(walk(signals))
    assert (found["braking"]["right"], found["propulsion"]["right"]) == pytest.approx((-0.2, 0.2), abs=1e-3)
    assert found["braking"]["left"] == 0
    assert (found["peak_force"]["left"], found["peak_force"]["right"]) == pytest.approx((1, 1.5))
    assert found["symmetry"]["peak ground force"] == pytest.approx(40)


def test_the_center_of_pressure_in_numbers() -> None:
    share = np.minimum(phase("r") / STANCE, 1)
    signals = {"leg_r.heel.position": 0.3, "leg_r.ball.position": 0.5}
    for name, part in (("heel", 1 - share), ("ball", share)):
        signals[f"leg_r.{name}.load"] = part * on_ground("r")
        signals[f"leg_r.{name}.force"] = WEIGHT * part * on_ground("r")
    found = gait_numbers(walk(signals))
    assert found["foot_length"]["right"] == pytest.approx(0.2)
    assert found["center_of_pressure_at_touchdown"]["right"] == pytest.approx(0, abs=1e-8)
    assert found["center_of_pressure_mean"]["right"] == pytest.approx(0.1, abs=1e-3)
    assert found["center_of_pressure_at_takeoff"]["right"] == pytest.approx(0.2, abs=2e-3)
    past = found["center_of_pressure_past_middle"]
    # The left foot stands on its heel only.
    assert (past["right"], past["left"], past["mean"]) == (pytest.approx(51), None, None)


def test_work_and_metabolic_power() -> None:
    signals = {"leg_r.soleus.path.moment": 80.0, "leg_r.ankle.angular_velocity": np.where(TIMES % 0.4 < 0.1, -1.0, 2.0)}
    muscles = ("soleus", "tibialis_anterior", "gastrocnemius", "vastus", "hamstrings", "gluteus", "hip_flexor")
    replay = walk({**signals, **{f"leg_r.{name}.metabolics.power": 20.0 for name in muscles}})
    found = gait_numbers(replay)
    # In a stride of 1.2 s: 80 N m at 2 rad/s for 0.9 s, and at -1 rad/s for 0.3 s, of 80 kg.
    assert found["ankle_positive_work"]["right"] == pytest.approx(1.8, rel=0.02)
    assert found["ankle_negative_work"]["right"] == pytest.approx(-0.3, rel=0.06)
    assert found["ankle_positive_work"]["left"] == 0
    assert (found["metabolic_power"]["right"], found["metabolic_power"]["left"]) == pytest.approx((7 * 20 / 80, 0))
    legs = two_legs(replay)
    assert legs is not None
    power = metabolic_power(replay, legs[1])
    assert power == pytest.approx(1.75)
    assert joint_work(replay, legs[1], "root") is None


def test_work_that_paths_make() -> None:
    """A moment of 80 N m at 2 rad/s is 160 W; the unit pulls with 1.5 kN while it shortens by 5 cm/s, 75 W."""
    signals = {"leg_r.soleus.path.moment": 80.0, "leg_r.ankle.angular_velocity": 2.0}
    signals |= {"leg_r.soleus.force": 1500.0, "leg_r.soleus.path.velocity": -0.05}
    found = gait_numbers(walk(signals))["work_created_at_paths"]
    assert (found["unit"], found["right"], found["left"]) == ("J/kg", pytest.approx(85 * STRIDE / 80, rel=0.01), 0)
    assert "work_created_at_paths" not in gait_numbers(walk({}))


def test_what_does_not_walk_has_no_numbers() -> None:
    short = cut(walk({}), 480)
    assert (gait_numbers(short), gait_table(short), norms_table(short)) == ({}, None, None)


def test_tables_and_their_page(tmp_path: Path) -> None:
    replay = like_people()
    gait, norms = gait_table(replay), norms_table(replay)
    assert gait is not None and norms is not None
    rows = {row[0]: row[1:] for row in gait.rows}
    assert rows["foot_length"] == ("m", "0.2", "0", "0.2", "0.2")
    compared = {row[:2]: row[2:] for row in norms.rows}
    correlation, error, reach, people, later, fit = compared["knee_flexion (deg)", "right"]
    assert (correlation, people, later) == ("1", "60.4", "0")
    assert float(reach) == pytest.approx(60.4 / 2, abs=0.11)
    assert 10 < float(error) < 20 and 0 < float(fit) < 100
    assert compared["hip_flexion (deg)", "right"][-1] == "100"
    page = write(tmp_path / "report.html", [replay], []).read_text(encoding="utf-8")
    assert "<h3>Gait</h3>" in page and "<h3>Compared with people</h3>" in page
    # A long name may be broken at its dots and strokes, so that a telephone shows its unit too.
    assert '<th scope="row">center_<wbr>of_<wbr>pressure_<wbr>mean</th><td>m</td>' in page


def test_people_do_what_books_say_at_their_places() -> None:
    for peaks in (VERTICAL, FORWARDS, *POWERS.values()):
        assert all(peak.low <= peak.high and 0 <= peak.begin <= peak.end <= 100 for peak in peaks)
        assert [peak.begin for peak in peaks] == sorted(peak.begin for peak in peaks)
    # Two humps with a trough, braking before propulsion, and the push-off of the ankle the largest power.
    assert VERTICAL[1].high < 1 < min(VERTICAL[0].low, VERTICAL[2].low)
    assert FORWARDS[0].high < 0 < FORWARDS[1].low
    assert max(peak.high for peaks in POWERS.values() for peak in peaks) == POWERS["ankle"][1].high
    assert all(0 <= begin < end <= 100 for spans in ON.values() for begin, end in spans)
