"""Delay lines: the signal of a while ago, exactly, in both modes and for every candidate."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from simulation.models import written

from gaitsim.compiler import machine
from gaitsim.errors import InvalidSpec
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator

SPEC = """\
gaitsim: 1
parameters:
  lag: {unit: s, default: 5 ms}
parts:
  clock: {use: controller/clock}
  relay: {use: controller/relay, signal: {from: clock.signal, delay: 7 ms}}
simulate: {duration: 0.2 s, step: 1 ms}
"""
TUNED = "delay: {value: 7 ms, tune: [1 ms, 60 ms]}"
COMPUTED = SPEC.replace("default: 5 ms", "default: {value: 5 ms, tune: [0 s, 60 ms]}").replace(
    "delay: 7 ms", "delay: =2 * lag"
)
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def signals(outcome: Outcome) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What was sent and what arrived."""
    assert outcome.trajectory is not None, outcome.reason
    return outcome.trajectory["clock.signal"], outcome.trajectory["relay.passed"]


def delayed(sent: NDArray[np.float64], steps: float, before: float) -> NDArray[np.float64]:
    """The signal `steps` ago, between two steps on the line between them."""
    known = np.concatenate([np.full(200, before), sent])
    whole = int(np.floor(steps))
    rest = steps - whole
    newer = known[200 - whole : 200 - whole + len(sent)]
    older = known[199 - whole : 199 - whole + len(sent)]
    return (1 - rest) * newer + rest * older


@modes
@pytest.mark.parametrize("steps", [1, 2, 7, 60, 1.5, 7.25, 59.999])
def test_the_signal_of_a_while_ago(steps: float, mode: str) -> None:
    made = written(SPEC.replace("delay: 7 ms", f"delay: {steps} ms"))
    sent, arrived = signals(Simulator(made, mode).run(recorded=True))
    assert np.ptp(sent) > 1.9
    np.testing.assert_allclose(arrived, delayed(sent, steps, sent[0]), rtol=0, atol=1e-12)
    if steps == int(steps):
        np.testing.assert_array_equal(arrived[int(steps) :], sent[: -int(steps)])


@modes
@pytest.mark.parametrize("steps", [7, 7.25])
def test_before_the_start_it_has_the_value_that_is_given(steps: float, mode: str) -> None:
    made = written(SPEC.replace("delay: 7 ms", f"delay: {steps} ms, initial: -3"))
    sent, arrived = signals(Simulator(made, mode).run(recorded=True))
    assert list(arrived[:7]) == [-3] * 7
    np.testing.assert_allclose(arrived, delayed(sent, steps, -3), rtol=0, atol=1e-12)


@modes
def test_a_delay_at_the_sender(mode: str) -> None:
    text = SPEC.replace("{from: clock.signal, delay: 7 ms}", "{from: clock.signal, delay: 2 ms}")
    text = text.replace(
        "{use: controller/clock}",
        "{use: controller/clock, to: {signal: {port: relay.more, delay: 9 ms}}}",
    )
    sent, arrived = signals(Simulator(written(text), mode).run(recorded=True))
    both = delayed(sent, 2, sent[0]) + delayed(sent, 9, sent[0])
    np.testing.assert_allclose(arrived, both, rtol=0, atol=1e-12)


@modes
def test_update_reads_the_same_past_as_output(mode: str) -> None:
    trajectory = Simulator(written(SPEC), mode).run(recorded=True).trajectory
    assert trajectory is not None
    passed, before = trajectory["relay.passed"], trajectory["relay.before"]
    np.testing.assert_array_equal(before[1:], passed[:-1])


@modes
def test_a_tuned_delay_changes_without_compiling_anything(mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    simulator = Simulator(written(SPEC.replace("delay: 7 ms", TUNED)), mode)
    simulator.run()
    assembly, loads = simulator._loop.physics.assembly, []
    monkeypatch.setattr(machine, "code", loads.append)
    for steps in (7, 1, 60, 12.5, 1):
        sent, arrived = signals(simulator.run([steps * 1e-3], recorded=True))
        np.testing.assert_allclose(arrived, delayed(sent, steps, sent[0]), rtol=0, atol=1e-12)
    assert loads == []
    assert simulator._loop.physics.assembly is assembly


@modes
def test_a_delay_computed_from_a_tuned_number_may_outgrow_its_start(mode: str) -> None:
    simulator = Simulator(written(COMPUTED), mode)
    for lag in (5, 30, 60, 0.75):
        sent, arrived = signals(simulator.run([lag * 1e-3], recorded=True))
        np.testing.assert_allclose(arrived, delayed(sent, 2 * lag, sent[0]), rtol=0, atol=1e-12)
    failed = simulator.run([0.4e-3])
    assert failed.status == "failed"
    assert failed.reason == "relay.signal.delay: 0.0008 s is shorter than one step of 0.001 s"


@modes
def test_a_delay_of_zero_is_none(mode: str) -> None:
    made = written(SPEC.replace("delay: 7 ms", "delay: 0 s"))
    sent, arrived = signals(Simulator(made, mode).run(recorded=True))
    np.testing.assert_array_equal(arrived, sent)


@pytest.mark.parametrize(
    ("delay", "said", "move"),
    [
        ("delay: 0.5 ms", "0.0005 s", "write 0 s or a longer delay"),
        (TUNED.replace("[1 ms", "[0 s"), "0 s", "begin tune at 0.001 s or above"),
    ],
    ids=["fixed", "tuned"],
)
def test_a_delay_shorter_than_a_step_is_refused(delay: str, said: str, move: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        Simulator(written(SPEC.replace("delay: 7 ms", delay)))
    (fault,) = caught.value.faults
    assert fault.address == "relay.signal.delay"
    assert fault.message == f"{said} is shorter than one step of 0.001 s; {move}."
