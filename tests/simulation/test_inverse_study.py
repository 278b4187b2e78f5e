"""The inverse study as it is shipped: springs with clutches carry the knee of a recorded walk."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

from .models import ROOT

STUDY = ROOT / "specs" / "inverse_endo_herr.yaml"
PERIOD, STEP = 1.1, 0.5e-3  # s


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    found = Simulator(Opening(STUDY).open().model()).run(recorded=True)
    assert found.status == "completed"
    return found


def test_springs_alone_give_the_moment_of_the_knee(outcome: Outcome) -> None:
    found = outcome.metrics
    assert found["knee_moment"] > 0.985
    assert found["knee_error.root"] < 0.03  # N m/kg
    # A soleus would hardly have to push, and no clutch pulls much against another.
    assert found["soleus_push.root"] < 0.015 and found["soleus_balance"] < 1e-4


def test_a_clutch_does_what_plain_arrays_do(outcome: Outcome) -> None:
    """The vastus, from the table of knee angles: engaged once, held, let go where its path is as long again."""
    model = Opening(STUDY).open().model()
    values = model.values()
    number = {p.address: p.numbers for p in model.parts}
    stiffness = values[number["vastus"]["stiffness"]]
    engages = values[number["vastus_engagement"]["engages"]]
    flexion = Library((shipped_folder(),)).table("norms/fukuchi2018_walking_1p2").columns["knee_flexion"]
    scale = math.acos(0.04 / 0.06) / math.radians(120)
    cycle = np.linspace(0, 1, 101)
    length = -0.06 / scale * np.sin(scale * (math.pi - flexion - math.radians(165)))
    stretch = length - np.interp(engages, cycle, length)
    after = np.flatnonzero((cycle > engages) & (stretch <= 0))[0]
    force = np.where((cycle > engages) & (np.arange(101) < after), stiffness * stretch, 0)
    made = outcome.trajectory
    assert made is not None
    at = np.rint((1 + cycle[:-1]) * PERIOD / STEP).astype(int)
    assert made["vastus.force"][at] == pytest.approx(force[:-1], abs=0.02 * force.max())
    assert force.max() > 500 and 25 < after < 40


def test_every_clutch_gives_back_what_it_took(outcome: Outcome) -> None:
    made = outcome.trajectory
    assert made is not None
    second = made.times >= PERIOD
    for unit in ("vastus", "hamstrings", "rectus_femoris", "gastrocnemius", "tibialis_anterior", "biceps_femoris"):
        force = made[f"{unit}.force"][second]
        assert force.max() > 50 and force.min() == 0
        assert made[f"{unit}.dissipated_energy"][-1] < 0.01
