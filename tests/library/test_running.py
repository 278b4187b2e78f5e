"""The running leg after Wang et al. (2012): its gates, its whole law, and the measures of running."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import computed, metrics
from numpy.typing import NDArray
from simulation.models import ROOT

from gaitsim.analysis.replays.replay import Replay
from gaitsim.simulation.run import Mode
from gaitsim.study.opening import Opening
from gaitsim.study.replays import replay_of

Floats = NDArray[np.float64]
RUNNER = ROOT / "specs" / "running_wang2012.yaml"
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
NAN = pytest.approx(math.nan, nan_ok=True)


@modes
@pytest.mark.parametrize(
    ("distance", "stands", "double", "open_"),
    [
        (-0.3, 1, 0, {"stance", "balance"}),
        (0.5, 1, 0, {"stance", "balance"}),
        (0.7, 1, 0, {"stance", "balance", "initiation"}),  # far behind
        (0.1, 1, 1, {"stance", "trailing", "initiation"}),  # the other leg has landed
        (-0.1, 1, 1, {"stance", "trailing"}),
        (0.3, 0, 0, {"swing", "early_swing"}),
        (-0.1, 0, 0, {"swing", "early_swing"}),
        (-0.3, 0, 0, {"swing", "preparation"}),
    ],
)
def test_which_laws_are_open(distance: float, stands: float, double: float, open_: set[str], mode: Mode) -> None:
    sizes = {"leg_length": 0.9, "initiation_distance": 0.6, "preparation_distance": -0.2}
    where = {"center": 5.0, "foot": 5.0 - 0.9 * distance, "in_stance": stands, "in_double_support": double}
    found = computed("controller/running_gates", mode, **sizes, **where)
    assert found.distance == pytest.approx(distance)
    gates = ("stance", "balance", "trailing", "initiation", "swing", "early_swing", "preparation")
    assert {gate for gate in gates if getattr(found, gate) == 1} == open_
    assert all(getattr(found, gate) in (0, 1) for gate in gates)


@modes
@pytest.mark.parametrize(("total", "clipped"), [(-0.4, 0.01), (0.3, 0.3), (1.7, 1.0)])
def test_a_sum_is_clipped_before_its_gate(total: float, clipped: float, mode: Mode) -> None:
    assert computed("controller/clipped_sum", mode, stimulations=total).stimulation == pytest.approx(clipped)
    assert computed("controller/clipped_sum", mode, stimulations=total, gate=0.0).stimulation == 0


def excitation(run: Replay, muscle: str) -> Floats:
    """What the parts of the model send to a muscle, as it clips it."""
    sent = [c.sender for c in run.model.connections if c.target == f"{muscle}.excitation"]
    total = np.sum([run.trajectory[source] for source in sent], axis=0)
    return np.clip(total, 0.01, 1)


class Law:
    """The law of one leg as one piece, from the recorded signals of a run; lists of instants."""

    def __init__(self, run: Replay, leg: str) -> None:
        self.signals, self.leg, self.step = run.trajectory, leg, run.outcome.step
        free = zip((f.address.removeprefix("leg.") for f in run.model.free), run.values, strict=True)
        self.values = dict(free)

    def of(self, name: str, delay: float = 0) -> Floats:
        late = round(delay / self.step)
        values = self.signals[f"{self.leg}.{name}"]
        return np.concatenate([np.full(late, values[0]), values[: len(values) - late]])

    def force(self, muscle: str, delay: float) -> Floats:
        return self.of(f"{muscle}.normalized_force", delay)

    def fiber(self, muscle: str, delay: float) -> Floats:
        return self.of(f"{muscle}.normalized_fiber_length", delay)

    def trunk(self, muscle: str) -> Floats:
        v, late = self.values, round(0.005 / self.step)
        pitch, rate = (
            np.concatenate([np.full(late, row[0]), row[:-late]])
            for row in (self.signals["root.pitch"], self.signals["root.pitch_velocity"])
        )
        return v[f"{muscle}_proportional"] * (pitch - v["lean"]) + v[f"{muscle}_derivative"] * rate

    def target(self, muscle: str, joint: str, delay: float) -> Floats:
        """K (flexion - its target) + D flexion' of the preparation of stance."""
        v = self.values
        flexion = math.pi - self.of(f"{joint}.angle", delay)
        rate = -self.of(f"{joint}.angular_velocity", delay)
        gain, damping = v[f"{muscle}_preparation_proportional"], v[f"{muscle}_preparation_derivative"]
        return gain * (flexion - v[f"{joint}_target"]) + damping * rate

    def takeoff_lean(self) -> Floats:
        late = round(0.005 / self.step)
        pitch = self.signals["root.pitch"]
        pitch = np.concatenate([np.full(late, pitch[0]), pitch[:-late]])
        held, kept = [], pitch[0]
        for now, leaves in zip(pitch, self.of("phase.takeoff"), strict=True):
            kept = now if leaves > 0.5 else kept
            held.append(kept)
        return np.array(held)

    def stimulations(self) -> dict[str, Floats]:
        v, pos = self.values, lambda x: np.maximum(x, 0)
        stands, trails = self.of("phase.in_stance") > 0.5, self.of("phase.in_double_support") > 0.5
        distance = self.signals["center.forward"] - self.of("foot_position.x")  # leg of 1 m
        starts = stands & ((distance > v["initiation_distance"]) | (trails & (distance > 0)))
        prepares = ~stands & (distance < v["preparation_distance"])

        flexion, extends = math.pi - self.of("knee.angle", 0.01), self.of("knee.angular_velocity", 0.01) > 0
        straight = np.where(extends, v["knee_gain"] * pos(v["knee_offset"] - flexion), 0)
        balance = {m: np.where(trails, 0, self.trunk(m)) for m in ("hamstrings", "gluteus", "hip_flexor")}
        stance = {
            "soleus": v["soleus_stance"] + v["soleus_gain"] * self.force("soleus", 0.02),
            "tibialis_anterior": v["tibialis_stance"]
            - v["soleus_tibialis_gain"] * self.force("soleus", 0.02)
            + pos(v["tibialis_stance_gain"] * (self.fiber("tibialis_anterior", 0.02) - v["tibialis_stance_offset"])),
            "gastrocnemius": v["gastrocnemius_stance"] + v["gastrocnemius_gain"] * self.force("gastrocnemius", 0.02),
            "vastus": v["vastus_stance"] + v["vastus_gain"] * self.force("vastus", 0.01) - straight,
            "hamstrings": v["hamstrings_stance"] + pos(balance["hamstrings"]),
            "rectus_femoris": v["rectus_femoris_stance"] + 0 * distance,
            "gluteus": v["gluteus_stance"] + pos(balance["gluteus"]),
            "hip_flexor": v["hip_flexor_stance"] + pos(-balance["hip_flexor"]),
        }
        for muscle, sign in (("vastus", -1), ("rectus_femoris", 1), ("gluteus", -1), ("hip_flexor", 1)):
            clipped = np.clip(stance[muscle], 0.01, 1)
            stance[muscle] = np.where(starts, clipped + sign * v[f"{muscle}_initiation"], clipped)

        hip = (
            v["lean_gain"] * (self.takeoff_lean() - v["lean"])
            + pos(v["hip_flexor_gain"] * (self.fiber("hip_flexor", 0.005) - v["hip_flexor_offset"]))
            - pos(v["hamstrings_hip_flexor_gain"] * (self.fiber("hamstrings", 0.005) - v["hamstrings_offset"]))
        )
        knee_back, hip_back = self.target("vastus", "knee", 0.01), self.target("gluteus", "hip", 0.005)
        hip_on = -self.target("hip_flexor", "hip", 0.005)
        swing = {
            "soleus": v["soleus_swing"] + 0 * distance,
            "tibialis_anterior": v["tibialis_swing"]
            + pos(v["tibialis_swing_gain"] * (self.fiber("tibialis_anterior", 0.02) - v["tibialis_swing_offset"])),
            "gastrocnemius": v["gastrocnemius_swing"] + 0 * distance,
            "vastus": v["vastus_swing"] + np.where(prepares, pos(knee_back), 0),
            "hamstrings": v["hamstrings_swing"] + v["hamstrings_gain"] * self.force("hamstrings", 0.005),
            "rectus_femoris": v["rectus_femoris_swing"] + 0 * distance,
            "gluteus": v["gluteus_swing"]
            + np.where(prepares, pos(hip_back), v["gluteus_gain"] * self.force("gluteus", 0.005)),
            "hip_flexor": v["hip_flexor_swing"] + np.where(prepares, pos(hip_on), hip),
        }
        return {m: np.clip(np.where(stands, stance[m], swing[m]), 0.01, 1) for m in stance}


def test_the_leg_computes_the_law() -> None:
    """Every muscle's stimulation at each instant, from the equations as one piece."""
    run = replay_of(Opening(RUNNER, tuned=False).open(), RUNNER, duration=1.5)
    for leg in ("leg_l", "leg_r"):
        for muscle, wanted in Law(run, leg).stimulations().items():
            found = excitation(run, f"{leg}.{muscle}")[100:]  # delays reach back before the start
            assert found == pytest.approx(wanted[100:], abs=1e-9), muscle
            assert np.ptp(found) > 0, muscle


def contacts(times: Floats, stride: float, stance: float, late: float) -> Floats:
    return (np.mod(times - late + 1e-9, stride) < stance * stride - 1e-9).astype(float)


def test_flight_of_a_run_and_of_a_walk() -> None:
    dt = 0.01
    times = np.arange(1000) * dt
    left, right = contacts(times, 0.7, 3 / 7, 0), contacts(times, 0.7, 3 / 7, 0.35)
    found = metrics("measure/flight", {"left": left, "right": right}, dt)
    assert found == pytest.approx({"value": 1, "duration": 0.05, "least": 0.05})
    left, right = contacts(times, 1.0, 0.6, 0), contacts(times, 1.0, 0.6, 0.5)
    found = metrics("measure/flight", {"left": left, "right": right}, dt)
    assert found == {"value": 0, "duration": 0, "least": 0}
    # The left leg stands once until the right one has landed.
    left = np.where((times > 5.1) & (times < 5.3), 1, contacts(times, 0.7, 3 / 7, 0))
    right = contacts(times, 0.7, 3 / 7, 0.35)
    found = metrics("measure/flight", {"left": left, "right": right}, dt)
    assert 0.9 < found["value"] < 1 and found["least"] == 0
    nothing = metrics("measure/flight", {"left": 0 * times, "right": 0 * times}, dt)
    assert nothing == {"value": NAN, "duration": NAN, "least": NAN}


def test_the_leg_as_a_spring() -> None:
    """A body of 80 kg that sinks by 6 cm while it moves by 60 cm over each contact of 0.3 s; stance is told late."""
    dt = 0.001
    times = np.arange(6000) * dt
    inside = np.mod(times, 0.7)
    loaded = inside < 0.3
    push = np.sin(np.pi * inside / 0.3)
    late = np.roll(loaded, 20).astype(float)
    signals = {
        "load": np.where(loaded, np.maximum(2.4 * push, 0.06), 0),
        "stance": late,
        "forward": 2 * times,
        "height": 1 - np.where(loaded, 0.06 * push, 0),
    }
    found = metrics("measure/leg_spring", signals, dt, leg_length=1.0, mass=80.0)
    force, sunk = 2.4 * 80 * 9.81, 0.06 + 1 - math.sqrt(1 - 0.3**2)
    assert found["contact_time"] == pytest.approx(0.3, abs=2 * dt)
    assert found["fall"] == pytest.approx(0.06, rel=1e-3)
    assert found["compression"] == pytest.approx(sunk, rel=0.01)
    assert found["vertical"] == pytest.approx(force / 0.06, rel=1e-3)
    assert found["value"] == pytest.approx(force / sunk, rel=0.01)
    aloft = metrics(
        "measure/leg_spring", {**signals, "load": 0 * times, "stance": 0 * times}, dt, leg_length=1, mass=80
    )
    assert all(math.isnan(value) for value in aloft.values())
