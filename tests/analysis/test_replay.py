"""A replay has every signal, up to the failure if there is one, and what its reader should know."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gaitsim.errors import Usage
from gaitsim.model import recorded_signals

from .swinging import model, replay


def test_states_are_recorded_in_step_with_outputs() -> None:
    run = replay(("simulate.duration", "0.5 s"))
    trajectory = run.trajectory
    assert trajectory.signals == tuple(signal.address for signal in recorded_signals(run.model))
    assert trajectory.units == ("rad", "rad/s", "N m", "rad s", "rad", "1")
    # One instant after the angle is left of the vertical, the state says so.
    expected = np.append(0.0, (trajectory["pivot.angle"][:-1] > 0).astype(float))
    np.testing.assert_array_equal(trajectory["watch.side"], expected)
    error = -trajectory["pivot.angle"]
    np.testing.assert_allclose(trajectory["brake.accumulated"][1:], np.cumsum(error * 1e-3)[:-1], atol=1e-12)


def test_both_modes_record_the_same_states() -> None:
    from pathlib import Path

    from gaitsim.analysis.replays.replay import replayed

    made = model(("simulate.duration", "0.3 s"))
    rapid, normal = (replayed(made, Path("x"), mode=mode).trajectory for mode in ("rapid", "normal"))
    assert rapid.signals == normal.signals
    np.testing.assert_allclose(rapid.values, normal.values, rtol=1e-9, atol=1e-12)


def test_instants_are_the_decimal_numbers_that_they_are() -> None:
    times = replay(("simulate.step", "0.1 ms"), ("simulate.duration", "0.1 s")).times
    assert [repr(float(time)) for time in times[[3, 6, 7, 999]]] == ["0.0003", "0.0006", "0.0007", "0.0999"]


def test_a_whole_run_has_no_ending_to_tell() -> None:
    run = replay(("simulate.duration", "0.1 s"))
    assert (run.ending, run.reaches_end, run.folder, run.label) == ("", True, None, "swinging")
    assert run.values == (0.2,)


def test_a_run_that_fails_is_known_up_to_its_failure() -> None:
    run = replay(("watch.limit", "-20 deg"))
    assert run.outcome.status == "failed"
    assert len(run.times) == run.outcome.steps == 644
    assert run.trajectory["pivot.angle"].min() > -math.pi / 9
    assert run.ending.startswith("failed: watch (controller/side) raised in output at 0.644 s (")
    assert run.ending.endswith("): ValueError: it broke")
    assert run.reaches_end


def test_a_window_keeps_both_of_its_ends() -> None:
    run = replay(("simulate.duration", "0.1 s"))
    part = run.between(0.02, 0.05)
    assert (part.times[0], part.times[-1], len(part.times)) == (0.02, 0.05, 31)
    assert part.outcome.metrics == run.outcome.metrics
    assert not part.reaches_end
    assert run.between(None, None).times.size == run.times.size
    assert run.between(7, None).times.size == 0


def test_instants_are_left_out_evenly() -> None:
    run = replay(("simulate.duration", "0.1 s")).between(0.02, None)
    assert run.every(0.03).times.tolist() == [0.02, 0.05, 0.08]
    assert run.every(0.001).times.size == 80
    for interval in (0.0015, 0.0, -1.0):
        with pytest.raises(Usage) as error:
            run.every(interval)
        rule = "the time step is 0.001 s; write a multiple of it."
        assert str(error.value) == f"one instant every {interval:g} s: {rule}"


def test_the_pendulum_swings_as_a_pendulum_does() -> None:
    run = replay(("brake.derivative", "0 N m s/rad"), ("initial.pivot.angle", "1 deg"))
    angle = run.trajectory["pivot.angle"]
    crossings = run.times[1:][np.diff(np.sign(angle)) != 0]
    # A thin rod about its end: T = 2 pi sqrt(2 l / (3 g)).
    assert np.diff(crossings).mean() == pytest.approx(math.pi * math.sqrt(2 / (3 * 9.81)), rel=2e-3)
