"""Joints that follow a recorded cycle, and what is compared with recorded moments."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import FOLDER, computed, metrics
from simulation.models import written

from gaitsim.components.find import Library
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.run import Mode, Simulator

from .play import played

SPEC = """
gaitsim: 1
parts:
  thigh: {use: segment/rod, mass: 8 kg, length: 44 cm}
  shank: {use: segment/rod, mass: 4 kg, length: 43 cm}
  hip:
    {use: joint/prescribed, parent: world, child: thigh.proximal, grows: backwards, neutral: 180 deg, period: 1.1 s,
    motion: norms/fukuchi2018_walking_1p2.hip_flexion, zero: 180 deg, sign: -1, first_phase: 0.5}
  knee:
    {use: joint/prescribed, parent: thigh.distal, child: shank.proximal, grows: forwards, neutral: 180 deg,
    motion: norms/fukuchi2018_walking_1p2.knee_flexion, zero: 180 deg, sign: -1, period: 1.1 s, first_phase: 0.5}
  strong:
    {use: controller/pid, proportional: 900 N m/rad, angle: {from: knee.angle},
    angular_velocity: {from: knee.angular_velocity}, to: {torque: knee.moment}}
simulate: {duration: 1.3 s, step: 1 ms}
"""
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def moved(mode: Mode, *settings: tuple[str, str]) -> Trajectory:
    outcome = Simulator(written(SPEC, list(settings)), mode=mode).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None
    return outcome.trajectory


@modes
@pytest.mark.parametrize("joint", ["hip", "knee"])
def test_it_is_on_the_recorded_points_whatever_pulls(joint: str, mode: Mode) -> None:
    found = moved(mode, ("simulate.duration", "0.2 s") if mode == "normal" else ("simulate.duration", "1.3 s"))
    curve = np.degrees(Library((FOLDER,)).table("norms/fukuchi2018_walking_1p2").columns[f"{joint}_flexion"])
    # 11 steps are a hundredth of the cycle, which begins in its middle and again where it ends.
    at = (50 + np.arange(len(found.times[::11]))) % 100
    assert 180 - np.degrees(found[f"{joint}.angle"][::11]) == pytest.approx(curve[at], abs=1e-5)
    assert np.abs(found["knee.muscle_moment"]).max() > 500


def test_its_velocity_is_that_of_the_motion_from_the_first_instant() -> None:
    found = moved("rapid")
    for joint in ("hip", "knee"):
        angle, velocity = found[f"{joint}.angle"], found[f"{joint}.angular_velocity"]
        # A velocity is that over the step before.
        assert velocity[1:] == pytest.approx(np.diff(angle) / np.diff(found.times), abs=1e-6)
        assert velocity[0] == pytest.approx(velocity[1], abs=0.05)
        assert np.abs(velocity).max() > 3


@modes
def test_a_clutch_is_engaged_at_its_instant_until_it_has_given_back_what_it_took(mode: Mode) -> None:
    phase = [0.28, 0.29, 0.3, 0.31, 0.32, 0.33, 0.34, 0.9, 0.1, 0.29, 0.31, 0.32]
    stretch = [0.0, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    found = played("controller/engagement", {"phase": phase, "stretch": stretch}, mode, engages=0.305)
    assert found["gate"] == [0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 1]


@modes
def test_a_window_may_reach_past_the_end_of_the_cycle(mode: Mode) -> None:
    for phase, gate in ((0.0, 1), (0.29, 1), (0.31, 0), (0.79, 0), (0.81, 1)):
        assert computed("controller/phase_window", mode, begins=0.8, ends=0.3, phase=phase).gate == gate


@modes
def test_what_muscles_lack_of_a_recorded_moment(mode: Mode) -> None:
    given = {"curve": np.linspace(0, 1, 101), "mass": 80.0, "muscle_moment": 10.0}
    found = computed("sensor/recorded_moment", mode, **given, phase=0.255)
    assert (found.moment, found.lacking) == (pytest.approx(0.255 * 80), pytest.approx(0.255 * 80 - 10))
    assert found.muscle_moment_per_mass == pytest.approx(0.125)


def test_mean_squares() -> None:
    signal = {"signal": [9.0, 2.0, -4.0, 0.0]}
    both = metrics("measure/mean_square", signal, 1.0, unit=2.0, settle=1.0)
    assert (both["value"], both["root"]) == (pytest.approx(5 / 3), pytest.approx(math.sqrt(5 / 3)))
    pushing = metrics("measure/mean_square", signal, 1.0, unit=2.0, settle=1.0, positive=0.0)
    assert pushing["value"] == pytest.approx(4 / 3)
    assert math.isnan(metrics("measure/mean_square", signal, 1.0, settle=9.0)["value"])


def test_co_contraction() -> None:
    signals = {"opening": [4.0, 4.0, -4.0, 4.0], "closing": [-6.0, 6.0, -6.0, -2.0]}
    assert metrics("measure/co_contraction", signals, 1.0, unit=2.0)["value"] == pytest.approx((4 + 1) / 4)


def test_work_of_whole_strides() -> None:
    signals = {
        "force": [0.0, 100.0, 100.0, 100.0, 0.0, 900.0, 900.0],
        "length": [0.5, 0.5, 0.46, 0.44, 0.5, 0.4, 0.3],
        "stance": [0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0],
    }
    found = metrics("measure/work", signals, 0.1, settle=0.0)
    # From the second to the fifth instant: 4 J and 2 J given, 3 J taken.
    assert (found["given"], found["taken"], found["value"]) == pytest.approx((6, 3, 3))
    assert math.isnan(metrics("measure/work", signals, 0.1, settle=0.2)["value"])
