"""All measures of walking and the staged objective together, on a walker that only pretends to walk."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

# Two legs that stand for 62 % of 1.1 s, half a stride apart; the feet are set down at 1.3 m/s.
_PRETENDER = '''\
import math

from gaitsim.component import Component, Output, Parameter, Series, State


class Pretender(Component):
    """Signals of a walk that was made up."""

    knee = Series("rad", "Flexion of the knee over the gait cycle.", size=101)
    speed = Parameter("m/s", "Forward speed.", default=1.3, bounds=(0, 10), source="definition: 1.3 m/s")
    stride = Parameter("s", "Duration of a stride.", default=1.1, bounds=(0.1, 9), source="definition: 1.1 s")
    upright = Parameter("m", "Height of the hip.", default=0.9, bounds=(0, 2), source="definition: 0.9 m")
    trips = Parameter("s", "When it falls.", default=1000, bounds=(0, 1e4), source="definition: never")
    steps = State("1", "Steps.")
    time = State("s", "Time.")
    height = Output("m", "Height of the hip.")
    position = Output("m", "Forward position of the hip.")
    left_load = Output("1", "Load of the left leg.")
    right_load = Output("1", "Load of the right leg.")
    left_foot = Output("m", "Position of the left heel.")
    right_foot = Output("m", "Position of the right heel.")
    knee_angle = Output("rad", "The right knee: 180 deg when straight.")

    @staticmethod
    def output(p, u, x, y):
        y.height = p.upright if x.time < p.trips else 0.0
        y.position = p.speed * x.time
        strides = x.time / p.stride
        left = strides % 1.0
        right = (strides + 0.5) % 1.0
        y.left_load = 1.0 + 0.1 * math.cos(4 * math.pi * left / 0.62) if left < 0.62 else 0.0
        y.right_load = 1.0 + 0.1 * math.cos(4 * math.pi * right / 0.62) if right < 0.62 else 0.0
        y.left_foot = p.speed * p.stride * math.floor(strides)
        y.right_foot = p.speed * p.stride * (math.floor(strides + 0.5) - 0.5)
        at = min(int(100 * right), 99)
        rest = 100 * right - at
        y.knee_angle = math.pi - ((1 - rest) * p.knee[at] + rest * p.knee[at + 1])

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.time = x.steps * dt
'''
SPEC = """\
gaitsim: 1
parts:
  walker: {use: walker/pretender, knee: norms/fukuchi2018_walking.knee_flexion}
measures:
  stance_l: {use: measure/stance, load: {from: walker.left_load}}
  stance_r: {use: measure/stance, load: {from: walker.right_load}}
  fall_time: {use: measure/fall, below: 0.6 m, height: {from: walker.height}}
  speed: {use: measure/speed, position: {from: walker.position}}
  stance_fraction:
    use: measure/stance_fraction
    left: {from: stance_l.in_stance}
    right: {from: stance_r.in_stance}
  cadence: {use: measure/cadence, left: {from: stance_l.in_stance}, right: {from: stance_r.in_stance}}
  step_length:
    use: measure/step_length
    left: {from: stance_l.in_stance}
    right: {from: stance_r.in_stance}
    left_position: {from: walker.left_foot}
    right_position: {from: walker.right_foot}
  peak_knee_flexion:
    use: measure/swing_angle
    direction: -1
    zero: 180 deg
    angle: {from: walker.knee_angle}
    stance: {from: stance_r.in_stance}
  correlation_knee:
    use: measure/gait_curve
    curve: norms/fukuchi2018_walking.knee_flexion
    direction: -1
    zero: 180 deg
    signal: {from: walker.knee_angle}
    stance: {from: stance_r.in_stance}
    delay: {from: stance_r.delay}
  force: {use: measure/force_peaks, load: {from: walker.right_load}, stance: {from: stance_r.in_stance}}
  overload:
    use: measure/load_limit
    limit: 1.3
    left: {from: walker.left_load}
    right: {from: walker.right_load}
objective:
  use: objective/walk
  fall_time: {from: fall_time}
  fell: {from: fall_time.fell}
  distance: {from: speed.distance}
  speed: {from: speed}
  cost_of_transport: 3.2 J/(kg m)
  load_excess: {from: overload}
  terms:
    knee: {use: objective/shortfall, value: {from: correlation_knee}, threshold: 0.9, weight: 10}
    peaks: {use: objective/shortfall, value: {from: force.two_peaks}, threshold: 1}
simulate: {duration: 10 s, step: 1 ms}
"""


def outcome(folder: Path, text: str = SPEC, mode: Mode = "rapid") -> Outcome:
    (folder / "walker").mkdir(exist_ok=True)
    (folder / "walker" / "pretender.py").write_text(_PRETENDER)
    library = Library((folder, shipped_folder()))
    return Simulator(resolve(parse(text, "spec.yaml"), library, "spec"), mode).run()


def test_the_metrics_of_a_walk(tmp_path: Path) -> None:
    found = outcome(tmp_path)
    assert found.status == "completed"
    m = found.metrics
    assert m["fall_time"] == pytest.approx(10)
    assert m["speed"] == pytest.approx(1.3)
    assert m["stance_fraction"] == pytest.approx(0.62, abs=0.002)
    assert m["stance_fraction.double_support"] == pytest.approx(0.24, abs=0.004)
    assert m["cadence"] == pytest.approx(60 * 2 / 1.1, abs=0.2)
    assert m["step_length"] == pytest.approx(1.3 * 0.55)
    assert m["peak_knee_flexion"] == pytest.approx(62.4, abs=0.05)
    assert m["correlation_knee"] == pytest.approx(1, abs=1e-4)
    assert m["correlation_knee.highest_at"] == pytest.approx(74, abs=1)
    assert (m["force.first"], m["force.two_peaks"]) == (pytest.approx(1.1, abs=0.002), 1)
    assert m["overload"] == 0
    assert found.score == pytest.approx(3.2)


def test_rapid_and_normal_give_the_same(tmp_path: Path) -> None:
    short = SPEC.replace("duration: 10 s", "duration: 4.5 s")
    rapid, normal = outcome(tmp_path, short), outcome(tmp_path, short, "normal")
    assert dict(rapid.metrics) == pytest.approx(dict(normal.metrics), rel=1e-12, nan_ok=True)
    assert rapid.score == pytest.approx(normal.score, rel=1e-12)


def test_a_fall_ends_the_run_and_is_scored_by_its_time(tmp_path: Path) -> None:
    scores = []
    for time in (1, 3, 8):
        fallen = SPEC.replace("{use: walker/pretender,", f"{{use: walker/pretender, trips: {time} s,")
        found = outcome(tmp_path, fallen)
        assert (found.status, found.reason) == ("stopped", "fall_time")
        assert found.metrics["fall_time"] == pytest.approx(time)
        assert found.metrics["fall_time.fell"] == 1
        assert found.score == pytest.approx(200 + 100 * 5 / (5 + time), abs=0.1)
        scores.append(found.score)
    assert scores == sorted(scores, reverse=True)


def test_a_walk_at_another_speed_beats_a_fall(tmp_path: Path) -> None:
    slow = outcome(tmp_path, SPEC.replace("{use: walker/pretender,", "{use: walker/pretender, speed: 0.8 m/s,"))
    assert slow.score == pytest.approx(100 + 100 * 0.4 / 1.7)


def test_a_walk_half_the_step_is_measured_alike(tmp_path: Path) -> None:
    one, half = outcome(tmp_path), outcome(tmp_path, SPEC.replace("step: 1 ms", "step: 0.5 ms"))
    for name in ("stance_fraction", "cadence", "step_length", "peak_knee_flexion", "correlation_knee", "force.first"):
        assert half.metrics[name] == pytest.approx(one.metrics[name], rel=3e-3), name
