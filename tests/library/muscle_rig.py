"""A bench for muscles: held, stretched and released, or lifting a weight."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitsim.components.find import Library, library_folders
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

FOLDER = Path(__file__).parent / "rig"
MUSCLES = ("geyer2003", "geyer2010", "millard2012", "millard2012_polynomial", "degroote2016", "rigid_tendon")
TRIALS = ("isometric", "passive ramp", "active ramp", "lift")


@dataclass(frozen=True)
class Size:
    """F_max in N, l_opt and l_slack in m, v_max in l_opt/s."""

    force: float
    fiber: float
    tendon: float
    velocity: float


# Of Geyer & Herr (2010): from the softest to the stiffest tendon for its fiber.
SIZES = {"SOL": Size(4000, 0.04, 0.26, 6), "VAS": Size(6000, 0.08, 0.23, 12), "HFL": Size(2000, 0.11, 0.10, 12)}
_MUSCLE = """
gaitsim: 1
parts:
  muscle:
    use: muscle/{muscle}
    max_isometric_force: {size.force} N
    optimal_fiber_length: {size.fiber} m
    tendon_slack_length: {size.tendon} m
    max_contraction_velocity: {size.velocity} 1/s
"""
# Begun just before a step: whether 0.2 s are 400 steps must not hang on rounding.
_DRIVEN = """    path: {{use: path/driven, rate: {rate} m/s, time: {time} s, stretch: 49.999 ms, release: 199.999 ms}}
  switch: {{use: controller/switch, low: {low}, high: {high}, on: 49.999 ms, off: 249.999 ms, to: muscle.excitation}}
simulate: {{duration: 0.4 s, step: {step} s}}
"""
_LIFT = """    excitation: {excitation}
    path: {{use: path/sites, points: [{{on: world, at: [0 m, 0 m, 1 m]}}, {{on: load.center, at: [0 m, 0 m, 0 m]}}]}}
  load: {{use: segment/point_mass, mass: {mass} kg}}
  guide: {{use: joint/vertical, parent: world, child: load.center}}
initial: {{guide.position: {height} m}}
simulate: {{duration: 0.15 s, step: {step} s}}
"""


def trial(name: str, muscle: str, size: Size, step: float, more: str = "", excitation: float = 1) -> Trajectory:
    """What a muscle does in a trial; `more` are further lines of its entry, `excitation` is that of a lift."""
    rate = 0.5 * size.velocity * size.fiber
    words = {"rate": 0.0, "time": 0.05, "low": 0.01, "high": 0.01}
    if name == "isometric":
        words["high"] = 1
    if name.endswith("ramp"):
        words |= {"rate": rate, "time": 0.3 * size.fiber / rate}
    if name == "active ramp":
        words |= {"low": 0.5, "high": 0.5}
    # The lift begins where the muscle holds about F_max; the weight is 0.3 of that.
    lifting = {"mass": 0.3 * size.force / 9.81, "height": 1 - size.fiber - 1.04 * size.tendon}
    text = _MUSCLE + more + (_LIFT if name == "lift" else _DRIVEN)
    text = text.format(muscle=muscle, size=size, step=step, excitation=excitation, **words, **lifting)
    document = parse(text, "rig.yaml")
    library = Library([FOLDER / "components", *library_folders(FOLDER)])
    outcome = Simulator(resolve(document, library, "rig")).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    assert outcome.trajectory is not None
    return outcome.trajectory


def largest_error(name: str, muscle: str, size: Size, step: float, exact: float = 5e-6) -> float:
    """The largest difference of force from that at a tiny step, in F_max."""
    force = trial(name, muscle, size, step)["muscle.force"]
    best = trial(name, muscle, size, exact)["muscle.force"]
    every = round(step / exact)
    return float(np.abs(force - best[::every][: len(force)]).max()) / size.force
