"""Devices: springs with clutches, torque profiles, hip assistance and loads, against closed forms."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pytest
from components.calls import FOLDER, computed
from simulation.models import ROOT

from gaitsim.components.find import Library
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.study.opening import Opening
from gaitsim.text.document import parse

from .play import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
K = 180.0  # N m/rad
SLACK = math.radians(95)


def worn(
    angles: Sequence[float], gate: Sequence[float], mode: Mode = "rapid", **more: float
) -> Mapping[str, np.ndarray]:
    """Outputs of the ankle spring while the joint has these angles, in rad, and the gate these values."""
    values = {"stiffness": K, "slack_angle": SLACK, **more}
    found = played("device/ankle_spring", {"angle": angles, "gate": gate}, mode, **values)
    return {name: np.array(series) for name, series in found.items()}


@modes
def test_without_a_gate_the_spring_pulls_below_its_slack_angle_and_never_pushes(mode: Mode) -> None:
    found = worn([SLACK + 0.2, SLACK, SLACK - 0.1, SLACK - 0.3], [1] * 4, mode)
    assert found["moment"] == pytest.approx([0, 0, 0.1 * K, 0.3 * K])
    assert found["elastic_energy"] == pytest.approx([0, 0, 0.5 * K * 0.1**2, 0.5 * K * 0.3**2])


def test_direction_mirrors_it() -> None:
    found = worn([SLACK - 0.2, SLACK + 0.1], [1, 1], direction=-1)
    assert found["moment"] == pytest.approx([0, -0.1 * K])


@modes
def test_a_clutch_takes_up_slack_and_is_free_when_released(mode: Mode) -> None:
    angles = [1.40, 1.40, 1.50, 1.40, 1.80, 1.60, 1.50]
    found = worn(angles, [0, 1, 1, 1, 1, 1, 0], mode)
    # Engaged at 1.40, taken up to 1.50, then to no more than the slack angle.
    assert found["moment"] == pytest.approx([0, 0, 0, 0.1 * K, 0, (SLACK - 1.6) * K, 0])


def test_a_closed_cycle_returns_all_energy_and_a_release_books_what_it_held() -> None:
    angles = SLACK - 0.3 + 0.4 * np.cos(np.linspace(0, 4 * math.pi, 401))
    found = worn(list(angles), [1] * 401)
    moment = found["moment"]
    straight = np.flatnonzero((moment[1:] > 0) & (moment[:-1] > 0))
    middle, change = (moment[1:] + moment[:-1]) / 2, np.diff(angles)
    stored = np.diff(found["elastic_energy"])
    assert -(middle * change)[straight] == pytest.approx(stored[straight], abs=1e-12)
    assert found["elastic_energy"][[0, -1]] == pytest.approx([0, 0])
    assert found["dissipated_energy"][-1] == 0
    lost = worn([1.6, 1.6, 1.4, 1.4, 1.4], [1, 1, 1, 0, 0])["dissipated_energy"]
    assert lost == pytest.approx([0, 0, 0, 0, 0.5 * K * (SLACK - 1.4) ** 2])  # an always-on spring rests at SLACK


PENDULUM = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 3 kg, length: 1 m}
  hinge: {use: joint/spatial_hinge, parent: world, child: rod.proximal, axis_left: 1}
  exo: {use: device/ankle_spring, joint: hinge, stiffness: 50 N m/rad, slack_angle: 20 deg}
  energy: {use: sensor/mechanical_energy}
initial: {hinge.angle: -40 deg}
simulate: {duration: 1.5 s, step: 0.1 ms}
"""


def test_a_rod_that_swings_against_the_spring_keeps_its_energy() -> None:
    made = Simulator(resolve(parse(PENDULUM, "spec.yaml"), Library((FOLDER,)), "spec")).run(recorded=True).trajectory
    assert made is not None
    total = made["energy.total"] + made["exo.elastic_energy"]
    turnover = np.ptp(made["exo.elastic_energy"])
    assert turnover > 10
    assert np.ptp(total) < 1e-3 * turnover


SHAPE = ((0.0, 0.0), (0.15, 0.5), (0.3, 1.0), (0.35, 0.5), (0.4, 0.0), (0.7, 0.0))


@pytest.mark.parametrize(("after", "share"), SHAPE)
def test_a_timed_torque_rises_to_its_peak_and_falls(after: float, share: float) -> None:
    found = computed("device/timed_torque", peak=40.0, peak_time=0.3, rise=0.3, fall=0.1, steps=1, since=after)
    assert found.moment == pytest.approx(40 * share, abs=1e-9)


@modes
def test_a_timed_torque_begins_anew_at_each_event_and_waits_for_the_first(mode: Mode) -> None:
    values = {"peak": 10.0, "peak_time": 0.002, "rise": 0.002, "fall": 0.002}
    found = played("device/timed_torque", {"event": [0, 0, 1, 0, 0, 1, 0, 0, 0, 0]}, mode, **values)
    assert found["moment"] == pytest.approx([0, 0, 0, 5, 10, 5, 5, 10, 5, 0])


@modes
def test_a_phase_torque_needs_one_whole_stride_and_stretches_with_it(mode: Mode) -> None:
    values = {"peak": 10.0, "peak_phase": 0.5, "rise": 0.5, "fall": 0.5}
    touchdown = [0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0]  # strides of 4 and of 6 steps
    found = played("device/phase_torque", {"touchdown": touchdown}, mode, **values)
    third = [10 * (s * s * (3 - 2 * s)) for s in (1 / 3, 2 / 3)]
    assert found["moment"] == pytest.approx([0] * 6 + [5, 10, 5, 0, 0, 0] + [*third, 10], abs=1e-9)


def test_hip_assistance_follows_the_difference_of_the_sines_up_to_its_limit() -> None:
    values = {"gain": 10.0, "neutral": math.pi, "limit": 4.0}
    for angle, other, moment in (
        (math.pi, math.pi, 0),
        (math.pi + 0.2, math.pi - 0.1, None),
        (4.5, 2.0, -4),
        (2.0, 4.5, 4),
    ):
        found = computed("device/hip_assist", **values, angle=angle, opposite_angle=other).moment
        law = 10 * (math.sin(angle - math.pi) - math.sin(other - math.pi))
        assert found == pytest.approx(max(-4, min(4, law)))
        if moment is not None:
            assert abs(found) == pytest.approx(abs(moment), abs=1e-12)


HANGING = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 3 kg, length: 1 m}
  hinge: {use: joint/hinge, parent: world, child: rod.proximal}
  pack: {use: device/backpack, parent: {on: rod.proximal, at: [30 cm, 0 cm, 0 cm]}, mass: 2 kg, radius: 10 cm}
simulate: {duration: 1 ms, step: 0.01 ms}
"""


def test_a_backpack_moves_with_its_segment_as_one_body() -> None:
    """m g 0.3 m on 3 l^2 / 3 + 2 (0.3 m)^2 + 2/5 m r^2: the first acceleration of a rod that hangs straight down."""
    made = Simulator(resolve(parse(HANGING, "spec.yaml"), Library((FOLDER,)), "spec")).run(recorded=True).trajectory
    assert made is not None
    inertia = 3 / 3 + 2 * 0.3**2 + 0.4 * 2 * 0.1**2
    velocity = made["hinge.velocity"][-1]
    assert abs(velocity) == pytest.approx(2 * 9.81 * 0.3 / inertia * made.times[-1], rel=2e-3)


LINES = {
    "spring": "{use: device/ankle_spring, joint: leg_l.ankle, stiffness: 150 N m/rad, slack_angle: 90 deg}",
    "timed": "{use: device/timed_torque, joint: leg_l.ankle, event: {from: leg_l.phase.touchdown}, peak: 5 N m, "
    "peak_time: 0.5 s, rise: 0.2 s, fall: 0.1 s}",
    "phase": "{use: device/phase_torque, joint: leg_l.ankle, touchdown: {from: leg_l.phase.touchdown}, "
    "peak: 5 N m, peak_phase: 50 %, rise: 20 %, fall: 10 %}",
    "hip": "{use: device/hip_assist, angle: {from: leg_l.hip.angle, delay: 250 ms}, opposite_angle: {from: "
    "leg_r.hip.angle, delay: 250 ms}, gain: -5 N m, neutral: 180 deg, limit: 10 N m, to: leg_l.hip.moment}",
    "pack": "{use: device/backpack, parent: {on: trunk.hip, at: [-15 cm, 0 cm, 40 cm]}, mass: 2 kg}",
}


def test_one_line_adds_each_device_to_the_walker() -> None:
    spec = ROOT / "specs" / "walking_geyer2010.yaml"
    settings = (*(f"{name}={line}" for name, line in LINES.items()), "simulate.duration=0.5 s")
    outcome = Simulator(Opening(spec, settings).open().model()).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    for name in ("spring", "timed", "hip"):
        assert np.ptp(outcome.trajectory[f"{name}.moment"]) > 0, name


def test_an_elastic_ankle_has_a_stiffness_on_each_side_and_a_damper() -> None:
    values = {"stiffness": 500.0, "return_stiffness": 80.0, "slack_angle": SLACK, "damping": 1.5}
    for turned, rate, moment, energy, power in ((-0.1, 0, 50, 2.5, 0), (0.2, 0, -16, 1.6, 0), (0, 2, -3, 0, 6)):
        found = computed("device/elastic_ankle", **values, angle=SLACK + turned, angular_velocity=rate)
        assert [found.moment, found.elastic_energy, found.damping_power] == pytest.approx([moment, energy, power])


def test_a_prosthesis_replaces_the_muscles_of_one_ankle_and_emulates_one() -> None:
    spec = ROOT / "specs" / "walking_geyer2010_powered_prosthesis.yaml"
    model = Opening(spec, ("simulate.duration=0.5 s",)).open().model()
    muscles = {part.address for part in model.parts if part.type.kind == "muscle"}
    assert "prosthesis.plantarflexor" in muscles and "leg_r.soleus" in muscles
    assert muscles.isdisjoint({"leg_l.soleus", "leg_l.gastrocnemius", "leg_l.tibialis_anterior"})
    outcome = Simulator(model).run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None, outcome.reason
    signal = outcome.trajectory
    # The motor gives the moment that the soleus of the paper would give at this angle.
    arm = 0.05 * np.cos(signal["leg_l.ankle.angle"] - math.radians(110))
    moment = signal["prosthesis.plantarflexor.path.moment"]
    assert moment.max() > 20
    assert moment == pytest.approx(arm * signal["prosthesis.plantarflexor.force"], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["prosthesis", "powered_prosthesis"])
def test_walkers_with_a_prosthesis_walk(name: str) -> None:
    outcome = Simulator(Opening(ROOT / "specs" / f"walking_geyer2010_{name}.yaml").open().model()).run()
    assert outcome.metrics["fall_time"] == 20 and outcome.metrics["speed"] > 0.8
