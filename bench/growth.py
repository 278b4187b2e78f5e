"""How cost grows with a model: muscles, reflexes and delayed connections on one hinge."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator

from rows import Report, Section
from steps import per_step, repeats_of

from gaitsim.components.find import Library, library_folders
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

COUNTS = (14, 50, 200, 1000)
REPEATS = 3
_BEGINNING = """
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
"""
_MUSCLE = """
  muscle_{i}:
    use: muscle/geyer2003
    max_isometric_force: {force} N
    optimal_fiber_length: 10 cm
    tendon_slack_length: 20 cm
    path:
      use: path/constant_arm
      moment_arm: 2 cm
      reference_length: 30 cm
      reference_angle: 0 deg
      angle: {{from: pivot.angle}}
      angular_velocity: {{from: pivot.velocity}}
      to: {{moment: pivot.torque}}
"""
_EXCITED = "    excitation: 0.2\n"
_REFLEX = """
  reflex_{i}:
    use: controller/muscle_feedback
    gain: {gain}
    bias: {bias}
    signal: {{from: muscle_{source}.normalized_force{delay}}}
    to: muscle_{target}.excitation
"""
_END = """
initial: {pivot.angle: 30 deg}
measures: {swing: {use: measure/range, signal: {from: pivot.angle}}}
simulate: {duration: 0.05 s, step: 0.1 ms}
"""
GROWTH = Section(
    "Growth",
    {"parts": "1", "connections": "1", "prepared": "s", "step": "ns", "each more": "ns"},
    "A pendulum with so many muscles (`muscle/geyer2003` with an activation and a path each); with 14 muscles and so "
    "many force reflexes; and the same reflexes with a delay of 10 ms each. Prepared: from the text to the end of the "
    f"first run, components compiled before. A step is the median of {REPEATS} times 0.3 s. Each more: what one more "
    "costs, from the smaller model of the kind.",
)


def _muscles(count: int) -> str:
    return "".join(_MUSCLE.format(i=i, force=1000 / count) + _EXCITED for i in range(count))


def _reflexes(count: int, delay: str = "") -> str:
    muscles = "".join(_MUSCLE.format(i=i, force=1000 / 14) for i in range(14))
    share = 14 / count  # of each muscle's reflexes, so that all models are excited alike
    return muscles + "".join(
        _REFLEX.format(i=i, gain=0.5 * share, bias=0.1 * share, source=i % 14, target=(3 * i) % 14, delay=delay)
        for i in range(count)
    )


def text_of(kind: str, count: int) -> str:
    """A spec with so many muscles, reflexes or delayed reflexes."""
    delay = ", delay: 10 ms" if kind == "delayed reflexes" else ""
    parts = _muscles(count) if kind == "muscles" else _reflexes(count, delay)
    return f"{_BEGINNING.strip()}\n{parts}{_END}"


def growth(report: Report) -> Iterator[str]:
    """Rows of growing models; yields those that failed."""
    report.begin(GROWTH)
    library = Library(library_folders(None))
    before: dict[str, tuple[int, float]] = {}
    for count in COUNTS:  # small models of all kinds first, as time may end
        for kind in ("muscles", "reflexes", "delayed reflexes"):
            name = f"{count} {kind}"
            if not report.has_time(name):
                continue
            began = time.perf_counter()
            model = resolve(parse(text_of(kind, count), name), library, "growth")
            simulator = Simulator(model)
            first = simulator.run()
            prepared = time.perf_counter() - began
            if first.status != "completed":
                yield f"{name} failed: {first.reason}"
                continue
            repeats = repeats_of(simulator)
            step = statistics.median(per_step(simulator, repeats) for _ in range(REPEATS))
            values: dict[str, float] = {"parts": len(model.parts), "connections": len(model.connections)}
            values |= {"prepared": prepared, "step": step}
            if kind in before:
                values["each more"] = (step - before[kind][1]) / (count - before[kind][0])
            before[kind] = (count, step)
            report.add(name, values)
