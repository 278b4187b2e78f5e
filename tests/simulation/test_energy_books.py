"""The energy books of a passive double pendulum with one activated muscle close, to the order of the scheme."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from gaitsim.compiler.program import Floats
from gaitsim.simulation.run import Simulator

from .models import written

STEP = 0.1e-3  # s, as the spec declares it
SPEC = """
gaitsim: 1
parts:
  thigh: {use: segment/rod, mass: 8 kg, length: 44 cm}
  shank: {use: segment/rod, mass: 4 kg, length: 43 cm}
  hip: {use: joint/hinge, parent: world, child: thigh.proximal, damping: 1 N m s/rad}
  knee: {use: joint/hinge, parent: thigh.distal, child: shank.proximal, damping: 0.5 N m s/rad}
  muscle:
    use: muscle/geyer2010
    max_isometric_force: 1500 N
    optimal_fiber_length: 12 cm
    tendon_slack_length: 27 cm
    excitation: 0.4
    path:
      use: path/sites
      points: [{on: thigh, at: [-4 cm, 0 m, -6 cm]}, {on: shank, at: [-5 cm, 0 m, -6 cm]}]
  energy: {use: sensor/mechanical_energy}
initial: {hip.angle: 20 deg, knee.angle: 5 deg, muscle.activation_dynamics.level: 0.01}
simulate: {duration: 2 s, step: 0.1 ms}
"""


@dataclass(frozen=True)
class Books:
    """Energy in J over the run: what the muscle's active element gave, what is there more, what was lost."""

    given: float
    change: float
    lost: float
    turnover: float

    @property
    def error(self) -> float:
        """What the books do not explain."""
        return abs(self.given - self.change - self.lost)


def work(force: Floats, place: Floats) -> float:
    """The integral of a force over a place, or of a moment over an angle."""
    return float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(place)))


def books(step: float) -> Books:
    outcome = Simulator(written(SPEC, [("simulate.step", f"{step} s")])).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    made = outcome.trajectory
    assert made is not None
    force, fiber = made["muscle.force"], made["muscle.fiber_length"]
    springs = made["muscle.elastic_energy"] - made["muscle.tendon_energy"]
    # The fiber's force is the tendon's; what its parallel springs took of it is in their energy.
    given = -work(force, fiber) + float(springs[-1] - springs[0])
    stored = made["energy.total"] + made["muscle.elastic_energy"]
    lost = work(made["hip.velocity"], made["hip.angle"]) + 0.5 * work(made["knee.velocity"], made["knee.angle"])
    turnover = float(np.sum(np.abs((force[1:] + force[:-1]) / 2 * np.diff(fiber))))
    return Books(given, float(stored[-1] - stored[0]), lost, turnover)


def test_the_muscle_lifts_and_brakes() -> None:
    """Otherwise the books would close on nothing."""
    found = books(STEP)
    assert found.given > 3
    assert found.change < -3
    assert found.lost > 6
    assert found.turnover > 4 * found.given


def test_input_is_change_and_loss_at_the_declared_step() -> None:
    found = books(STEP)
    assert found.given == pytest.approx(found.change + found.lost, rel=1e-3)


def test_the_error_falls_with_the_step_at_the_order_of_the_scheme() -> None:
    """Semi-implicit Euler is of first order: half the step, half the error."""
    errors = [books(STEP * factor).error for factor in (4, 2, 1, 0.5)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders == pytest.approx([1, 1, 1], abs=0.05)
