"""Events located within the step, in both modes: against closed forms of springs, and the spring-mass runner."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode

from .models import ROOT, simulator
from .test_modes_agree import agree, model

RUNNER = ROOT / "specs" / "running_slip.yaml"
HOPPER = ROOT / "specs" / "hopping_spring_mass.yaml"


def metrics(path: Path, mode: Mode = "rapid", **settings: str) -> dict[str, float]:
    outcome = simulator(path, [(key.replace("__", "."), value) for key, value in settings.items()], mode).run()
    assert outcome.status == "completed", outcome.reason
    return dict(outcome.metrics)


def hop(mass: float, stiffness: float, height: float) -> dict[str, float]:
    """Contact time, peak force and period of a drop onto a spring, in closed form (Blickhan 1989)."""
    omega, speed, weight = math.sqrt(stiffness / mass), math.sqrt(2 * 9.81 * height), 9.81 * mass
    ratio = speed * omega / 9.81
    contact = 2 / omega * (math.pi - math.atan(ratio))
    deepest = 9.81 / omega**2 * (1 + math.sqrt(1 + ratio**2))
    return {
        "contact_time": contact,
        "peak_force": weight * (1 + math.sqrt(1 + ratio**2)),
        "lowest_height": 1 - deepest,
        "apex_height": 1 + height,
        "apex_height.period": contact + 2 * speed / 9.81,
    }


@pytest.mark.parametrize(("mass", "stiffness", "height"), [(80, 20e3, 0.05), (80, 20e3, 0.1), (60, 35e3, 0.2)])
def test_a_hop_on_a_spring_has_its_closed_form(mass: float, stiffness: float, height: float) -> None:
    given = {"body__mass": f"{mass} kg", "leg__stiffness": f"{stiffness} N/m"}
    found = metrics(HOPPER, **given, initial__guide__z=f"{1 + height} m", simulate__duration="3 s")
    expected = hop(mass, stiffness, height)
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=1e-7)


def test_steps_with_events_are_of_order_four() -> None:
    """The second apex of the runner, at steps that no event falls on."""
    apex = [metrics(RUNNER, simulate__step=f"{h} ms", simulate__duration="1 s")["apex_height"] for h in (8, 4, 2, 0.5)]
    errors = [abs(each - apex[-1]) for each in apex[:-1]]
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx([4, 4], abs=0.6)


@pytest.mark.parametrize(
    ("start", "following"), [("0.94", 0.94031143), ("0.96", 0.94126245), ("1", 0.95574041), ("1.1", 1.02715288)]
)
def test_the_return_map_of_the_runner(start: str, following: float) -> None:
    """Values of an independent integration with events (scipy, tolerance 1e-12)."""
    found = metrics(RUNNER, initial_apex_height=f"{start} m", simulate__duration="1 s")
    assert found["apex_height.first"] == pytest.approx(following, abs=1e-8)


def test_the_runner_settles_at_its_fixed_point() -> None:
    found = metrics(RUNNER, simulate__duration="8 s")
    assert found["apex_height"] == pytest.approx(0.94026714, abs=1e-8)
    assert found["contact_time"] == pytest.approx(0.14924, abs=5e-6)
    assert found["peak_force"] == pytest.approx(2086.9, abs=0.05)


@pytest.mark.parametrize("path", [RUNNER, HOPPER], ids=lambda path: path.stem)
def test_both_modes_agree_bit_for_bit_through_events(path: Path) -> None:
    agree(model(path, [("simulate.duration", "0.32 s"), ("simulate.step", "2 ms")]))


def test_a_leg_that_starts_below_the_ground_lands_only_after_it_was_above() -> None:
    spec = simulator(RUNNER, [("simulate.duration", "0.1 s"), ("initial.guide.z", "0.92 m")])
    outcome: Outcome = spec.run(recorded=True)
    assert outcome.trajectory is not None
    assert outcome.trajectory["leg.in_stance"].max() == 0
