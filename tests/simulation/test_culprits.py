"""What fails in a run is named alike in both modes: which part, where, when, and with which numbers."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from gaitsim.components.find import Library, display_path
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

from .models import OWN

COMPONENT = '''\
import math

from gaitsim.component import Component, Input, Output, Parameter, State


def failing(steps, limit):
    if steps >= limit:
        raise ValueError("enough")
    return 0.0


class Trial(Component):
    """Does something odd after a while."""

    after = Parameter("1", "Steps until then.", default=1000, source="definition: a test")
    signal = Input("1", "A signal.", default=0)
    steps = State("1", "Steps since the start.")
    last = State("1", "Something odd.")
    list = State("1", "Some numbers.", size=3)
    value = Output("1", "A number.")
    other = Output("1", "Another.")

    @staticmethod
    def start(p, u, x):
        x.last = START

    @staticmethod
    def output(p, u, x, y):
        y.value = u.signal + x.steps
        y.other = OUTPUT

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.last = UPDATE
'''
SPEC = """\
gaitsim: 1
parts:
  clock: {use: controller/clock}
  trial: {use: controller/trial, signal: {from: clock.signal}, to: {other: relay.more}}
  relay: {use: controller/relay, signal: {from: trial.value}}
  wrap: {use: controller/wrap, angle: {from: trial.other}}
simulate: {duration: 20 s, step: 1 ms}
"""
WRAP = '''\
import math

from gaitsim.component import Component, Input, Output


class Wrap(Component):
    """An angle within half a turn: this never ends on infinity."""

    angle = Input("1", "Any angle.")
    wrapped = Output("1", "The same direction.")

    @staticmethod
    def output(p, u, x, y):
        angle = u.angle
        while angle > math.pi:
            angle = angle - 2 * math.pi
        y.wrapped = angle
'''


def run(folder: Path, mode: str, spec: str = SPEC, /, **said: str) -> Outcome:
    """The run of a trial that says something else in some places."""
    text = COMPONENT
    for name, expression in {"START": "0", "OUTPUT": "0", "UPDATE": "0"}.items():
        text = text.replace(f"= {name}\n", f"= {said.get(name, expression)}\n")
    kinds = folder / "components" / "controller"
    kinds.mkdir(parents=True, exist_ok=True)
    (kinds / "trial.py").write_text(text)
    (kinds / "wrap.py").write_text(WRAP)
    for own in (OWN / "components" / "controller").glob("*.py"):
        (kinds / own.name).write_text(own.read_text())
    return Simulator(resolve(parse(spec, "spec.yaml"), Library((kinds.parent, shipped_folder())), "spec"), mode).run()


CASES = {
    "output": (
        {"OUTPUT": "1 / (p.after - x.steps)"},
        "trial (controller/trial) gives no finite number in output at 1 s: other = inf",
    ),
    "update": (
        {"UPDATE": "math.sqrt(p.after - x.steps)"},
        "trial (controller/trial) gives no finite number in update at 1 s: last = nan",
    ),
    "raise in output": (
        {"OUTPUT": "failing(x.steps, p.after)"},
        "trial (controller/trial) raised in output at 1 s ({file}:8): ValueError: enough",
    ),
    "raise in update": (
        {"UPDATE": "failing(x.steps, p.after)"},
        "trial (controller/trial) raised in update at 0.999 s ({file}:8): ValueError: enough",
    ),
    "index": (
        {"UPDATE": "x.list[int(x.steps)]"},
        "trial (controller/trial) raised in update at 0.002 s ({file}:35): "
        "IndexError: index 3 is out of bounds for axis 0 with size 3",
    ),
    "start": (
        {"START": "math.sqrt(999 - p.after)"},
        "trial (controller/trial) gives no finite number in start at 0 s: last = nan",
    ),
    "raise in start": (
        {"START": "failing(p.after, p.after)"},
        "trial (controller/trial) raised in start at 0 s ({file}:8): ValueError: enough",
    ),
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("case", CASES)
def test_the_culprit_and_its_moment_are_told_alike_in_both_modes(case: str, tmp_path: Path) -> None:
    said, reason = CASES[case]
    rapid, normal = (run(tmp_path, mode, **said) for mode in ("rapid", "normal"))
    assert rapid.reason == reason.format(file=display_path(tmp_path / "components" / "controller" / "trial.py"))
    assert (rapid.status, rapid.reason, rapid.steps) == (normal.status, normal.reason, normal.steps)


def test_what_has_ended_a_run_does_not_keep_the_next_part_busy_for_ever(tmp_path: Path) -> None:
    """Infinity reaches a part that would never come back from it; the run has ended by then."""
    ended = threading.Event()

    def watched() -> None:
        assert "gives no finite number in output" in run(tmp_path, "rapid", **CASES["output"][0]).reason
        ended.set()

    threading.Thread(target=watched, daemon=True).start()
    assert ended.wait(60)
