"""The order of calls: every output finds its inputs done; a loop is printed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from simulation.models import HOPPER, OWN, SPECS, model, simulator, written

from gaitsim.compiler.program import Program
from gaitsim.errors import InvalidSpec
from gaitsim.simulation.run import Simulator

RELAYS = """\
gaitsim: 1
parts:
  clock: {use: controller/clock}
  third: {use: controller/relay, signal: {from: second.passed}}
  second: {use: controller/relay, signal: {from: first.passed}}
  first: {use: controller/relay, signal: {from: clock.signal}}
simulate: {duration: 10 ms, step: 1 ms}
"""
RING = """\
gaitsim: 1
parts:
  outside: {use: controller/relay, signal: {from: one.passed}}
  one: {use: controller/relay, signal: {from: two.passed}}
  two: {use: controller/relay, signal: {from: three.passed}}
  three: {use: controller/relay, signal: {from: one.passed}}
simulate: {duration: 10 ms, step: 1 ms}
"""


def order(program: Program) -> list[str]:
    return [program.model.parts[call.part].address for call in program.calls]


def test_senders_come_before_receivers() -> None:
    calls = order(Program(written(RELAYS)))
    assert calls == ["clock", "first", "second", "third"]
    trajectory = Simulator(written(RELAYS)).run(recorded=True).trajectory
    assert trajectory is not None
    for name in ("first", "second", "third"):
        np.testing.assert_array_equal(trajectory[f"{name}.passed"], trajectory["clock.signal"])


def test_a_part_is_called_twice_when_its_outputs_wait_for_each_other() -> None:
    program = Program(model(HOPPER))
    calls = order(program)
    legs = [i for i, address in enumerate(calls) if address == "leg"]
    paths = [i for i, address in enumerate(calls) if address == "extensor.path"]
    # The knee's angle gives the path's length, that the force, that the moment, that the leg's force.
    assert len(legs) == len(paths) == 2
    assert legs[0] < paths[0] < calls.index("extensor") < paths[1] < legs[1]
    assert [program.calls[i].last for i in legs + paths] == [False, True, False, True]
    assert len(calls) == len(program.model.parts) + 2


def test_what_waits_twice_is_of_one_instant() -> None:
    trajectory = simulator(HOPPER, [("simulate.duration", "0.5 s")]).run(recorded=True).trajectory
    assert trajectory is not None
    length = trajectory["extensor.path.length"]
    angle = trajectory["leg.knee_angle"]
    np.testing.assert_allclose(length, 0.5 - 0.04 * (angle - math.radians(110)), rtol=1e-13)
    half_base = np.sqrt(0.25 - np.minimum(trajectory["leg.length"], 0.99) ** 2 / 4)
    force = trajectory["leg.in_stance"] * 0.04 * trajectory["extensor.force"] / half_base
    np.testing.assert_allclose(trajectory["leg.force"], force, rtol=1e-12)
    assert trajectory["leg.force"].max() > 1000


@pytest.mark.parametrize("path", [*SPECS, *sorted(OWN.glob("*.yaml"))], ids=lambda path: path.stem)
def test_when_an_output_is_final_all_that_it_needs_has_been_computed(path) -> None:
    program = Program(model(path))
    parts = program.model.parts
    assert {call.part for call in program.calls} == set(range(len(parts)))
    done = {
        program.outputs.place(i, name)
        for i, part in enumerate(parts)
        for name in part.type.outputs
        if "output" not in part.type.functions
    }
    for call in program.calls:
        kind = parts[call.part].type
        for output, inputs in kind.dependencies.items():
            slots = [program.inputs.place(call.part, name) for name in inputs]
            senders = [s for slot in slots for s, line in program.senders[slot] if line < 0]
            if set(senders) <= done:
                done.add(program.outputs.place(call.part, output))
        if call.last:
            assert {program.outputs.place(call.part, name) for name in kind.outputs} <= done
    lasts = [call.part for call in program.calls if call.last]
    assert sorted(lasts) == list(range(len(parts)))


def test_a_loop_without_state_or_delay_is_printed() -> None:
    with pytest.raises(InvalidSpec) as caught:
        Simulator(written(RING))
    assert str(caught.value) == (
        "spec.yaml:4:3: one: a loop without a state or a delay: "
        "one.passed -> three.passed -> two.passed -> one.passed; "
        "give one of these connections a delay.\n"
        "    4 |   one: {use: controller/relay, signal: {from: two.passed}}\n"
        "      |   ^"
    )


@pytest.mark.parametrize(
    ("way_out", "calls"),
    [
        ("{from: one.passed, delay: 2 ms}", ["three", "two", "one", "outside"]),
        # What `one` remembers is known at once, what it passes on is not: it is called again.
        ("{from: one.before}", ["one", "three", "two", "one", "outside"]),
    ],
    ids=["delay", "state"],
)
def test_a_delay_or_a_state_opens_the_loop(way_out: str, calls: list[str]) -> None:
    made = written(RING.replace("{from: one.passed}}\nsimulate", f"{way_out}}}\nsimulate"))
    assert order(Program(made)) == calls
    assert Simulator(made).run().status == "completed"


def test_a_delay_of_zero_opens_nothing() -> None:
    text = RING.replace("{from: two.passed}", "{from: two.passed, delay: 0 s}")
    with pytest.raises(InvalidSpec, match="a loop without a state or a delay"):
        Simulator(written(text))
