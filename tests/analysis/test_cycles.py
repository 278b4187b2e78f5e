from __future__ import annotations

import numpy as np
import pytest

from gaitsim.analysis.replays.cycles import arriving, last_cycles, stance, thinned, touchdowns
from tests.analysis.replays import of_spec, of_text

DELAYED = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/spring_damper, frame: ball.center, stiffness: 1 kN/m, damping: 0 N s/m}
  near: {use: controller/muscle_feedback, gain: 2, bias: 0, signal: {from: ground.load}}
  far:
    use: controller/muscle_feedback
    gain: 1
    bias: 0.5
    signal: {from: ground.load, delay: 25 ms}
initial: {guide.position: -2 cm}
simulate: {duration: 0.2 s, step: 10 ms}
"""


def test_touchdowns_are_ends_of_flights_and_not_of_bounces() -> None:
    times = np.arange(0, 3, 0.01)
    standing = ((times % 1) > 0.605).astype(float)
    assert [round(float(times[i]), 2) for i in touchdowns(times, standing)] == [0.61, 1.61, 2.61]
    standing[(times > 1.7) & (times < 1.75)] = 0  # the foot bounces
    assert [round(float(times[i]), 2) for i in touchdowns(times, standing)] == [0.61, 1.61, 2.61]


def test_who_never_lands_has_no_touchdown() -> None:
    times = np.arange(0, 1, 0.01)
    assert touchdowns(times, np.zeros_like(times)) == []
    assert touchdowns(times, np.ones_like(times)) == []


def test_the_last_cycles_of_the_hopper_last_one_period_each() -> None:
    replay = of_spec("hopping_geyer2003")
    span = last_cycles(replay, 3)
    assert span is not None
    assert (span[1] - span[0]) / 3 == pytest.approx(1 / replay.outcome.metrics["hopping_frequency"], abs=2e-3)
    assert last_cycles(of_spec("pendulum_pid"), 3) is None
    assert stance(of_spec("pendulum_pid")) is None


def test_what_arrives_is_delayed_as_in_the_simulation() -> None:
    replay = of_spec("hopping_geyer2003", [("simulate.duration", "1 s")])
    signal, gate = arriving(replay, "feedback.signal"), arriving(replay, "feedback.gate")
    made = 0.01 + gate * 2.64 * signal
    assert made == pytest.approx(replay.trajectory["feedback.stimulation"], abs=1e-9)


def test_constants_defaults_and_delays_between_two_steps() -> None:
    replay = of_text(DELAYED)
    assert arriving(replay, "near.gate").tolist() == [1.0] * 20
    late, load = arriving(replay, "far.signal"), replay.trajectory["ground.load"]
    assert np.ptp(load) > 1
    assert late[10] == pytest.approx(0.5 * (load[7] + load[8]))
    assert late[:3].tolist() == [load[0]] * 3
    assert 0.5 + late == pytest.approx(replay.trajectory["far.stimulation"])
    # Of a part of the run, what was sent before is not known.
    assert np.isnan(arriving(replay.between(0.1, None), "far.signal")[:3]).all()


def test_a_thinned_line_keeps_its_ends_and_its_peaks() -> None:
    times = np.linspace(0, 10, 100_001)
    values = np.sin(times)
    values[54_321] = 7.0
    x, y = thinned(times, values, 1000)
    assert len(x) <= 1002
    assert (x[0], x[-1]) == (0, 10)
    assert y.max() == 7 and y.min() == values.min()
    assert (np.diff(x) > 0).all()
