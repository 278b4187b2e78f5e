"""The body of Geyer & Herr at another height and mass: lengths, masses, inertias, muscle lengths and forces."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.study.opening import Opening

WALKER = Path(__file__).parents[2] / "specs" / "walking_geyer2010.yaml"
LENGTHS = ("length", "center_of_mass", "ankle", "optimal_fiber_length", "tendon_slack_length", "moment_arm")
FORCES = ("mass", "max_isometric_force")


def numbers(*settings: str) -> dict[str, float]:
    """The numbers of the walker's trunk and legs, in SI."""
    model = Opening(WALKER, settings).open().model()
    values = dict(zip((number.address for number in model.numbers), model.values(), strict=True))
    return {address: value for address, value in values.items() if address.startswith(("trunk.", "leg_"))}


@pytest.fixture(scope="module")
def published() -> dict[str, float]:
    return numbers()


def test_the_default_is_the_published_body_to_the_last_bit(published: dict[str, float]) -> None:
    expected = {
        "trunk.mass": 53.5,
        "leg_l.thigh.length": 0.5,
        "leg_l.shank.inertia": 0.05,
        "leg_l.foot.center_of_mass": 0.06,
        "leg_l.soleus.max_isometric_force": 4000.0,
        "leg_r.hamstrings.tendon_slack_length": 0.31,
        "leg_r.gastrocnemius.path.second.moment_arm": -0.05,
    }
    assert {address: published[address] for address in expected} == expected
    segments = [published[f"leg_{side}.{name}.mass"] for side in "lr" for name in ("thigh", "shank", "foot")]
    assert sum(segments) + published["trunk.mass"] == 80.0


def test_lengths_follow_height_masses_and_forces_follow_mass(published: dict[str, float]) -> None:
    scaled = numbers("body_height=1.62 m", "body_mass=100 kg")
    ratios: dict[str, set[float]] = {}
    for address, value in published.items():
        if value and scaled[address] != value:
            ratios.setdefault(address.rpartition(".")[2], set()).add(round(scaled[address] / value, 12))
    for name in LENGTHS:
        assert ratios.pop(name) == {0.9}, name
    for name in FORCES:
        assert ratios.pop(name) == {1.25}, name
    assert ratios.pop("inertia") == {round(1.25 * 0.81, 12)}
    derived = {"body_height", "body_mass", "meter", "newton"}
    # What follows from these: reference lengths of paths, and what the metabolics of a muscle take of it.
    assert {name for name in ratios if name not in derived} == {"reference_length"}
    assert ratios["reference_length"] == {0.9}


def test_a_weaker_body_has_weaker_muscles_only(published: dict[str, float]) -> None:
    weak = numbers("leg.strength=0.8 N/kg")
    changed = {address for address, value in published.items() if weak[address] != value}
    names = {address.rpartition(".")[2] for address in changed}
    assert names == {"strength", "newton", "max_isometric_force"}


def test_fall_and_cost_know_the_body() -> None:
    model = Opening(WALKER, ("body_height=1.62 m", "body_mass=100 kg")).open().model()
    values = dict(zip((number.address for number in model.numbers), model.values(), strict=True))
    assert values["fall_time.below"] == pytest.approx(0.675)
    assert values["cost_of_transport.mass"] == 100
