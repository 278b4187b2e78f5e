"""What a hop scores: stored energy, hop height, objective."""

from __future__ import annotations

import math

import pytest
from components.calls import computed, metrics


def test_stored_energy_is_that_of_the_start() -> None:
    signals = {"energy": [12.0, 50.0, 80.0], "weight": [600.0] * 3}
    assert metrics("measure/stored_energy", signals, 0.1) == {
        "value": pytest.approx(0.02),
        "energy_at_start": pytest.approx(12),
    }


def hops(apexes: list[float], touchdowns: list[float]) -> dict[str, list[float]]:
    """Down from 1.2 to a first touchdown at 0.9; then contact, apex, touchdown, each in turn."""
    height, contact = [1.2, 1.0, 0.9, 0.7], [0.0, 0.0, 1.0, 1.0]
    for apex, touchdown in zip(apexes, touchdowns, strict=True):
        height += [0.85, 0.95, apex, apex - 0.01, touchdown, 0.8, 0.75]
        contact += [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0]  # it chatters on landing
    return {"height": height, "contact": contact}


def test_hop_height_is_counted_from_each_touchdown() -> None:
    found = metrics("measure/hop_height", hops([1.1, 1.2, 1.3, 1.32], [0.9, 0.91, 0.92, 0.9]), 0.1)
    assert found["hops"] == 4
    assert found["value"] == pytest.approx((0.29 + 0.38 + 0.42) / 3)
    assert found["spread"] == pytest.approx(0.12)
    assert found["apex_height"] == pytest.approx((1.2 + 1.3 + 1.32) / 3)
    assert found["touchdown"] == pytest.approx(0.9)
    assert found["rebound"] == 1


def test_hop_height_without_a_hop() -> None:
    found = metrics("measure/hop_height", {"height": [1.2, 0.9, 0.7, 0.75], "contact": [0.0, 1.0, 1.0, 1.0]}, 0.1)
    assert found["hops"] == 0 and math.isnan(found["value"]) and math.isnan(found["spread"])
    assert found["rebound"] == pytest.approx(0.25)
    assert metrics("measure/hop_height", {"height": [1.2, 1.1], "contact": [0.0, 0.0]}, 0.1)["rebound"] == 0


def cost(**values: float) -> float:
    usual = {"height": 0.2, "spread": 0.002, "hops": 8.0, "rebound": 1.0, "upright": 8.0, "stored_height": 0.0}
    return float(computed("objective/hop", "normal", **(usual | values)).cost)


def test_the_score_of_a_hop() -> None:
    assert cost() == pytest.approx(-0.2)
    assert cost(stored_height=0.05) == pytest.approx(-0.15)
    assert cost(stored_height=0.05, correction=0.0) == pytest.approx(-0.2)
    assert cost(spread=0.02) == pytest.approx(0.5)


def test_a_failed_hop_costs_the_more_the_more_is_missing() -> None:
    nothing = {"height": math.nan, "spread": math.nan}
    ladder = [
        cost(hops=0.0, rebound=0.0, upright=0.3, **nothing),
        cost(hops=0.0, rebound=0.0, upright=0.5, **nothing),
        cost(hops=0.0, rebound=0.4, upright=0.5, **nothing),
        cost(hops=0.0, rebound=0.9, upright=8.0, **nothing),
        cost(hops=1.0, upright=2.0, spread=0.0),
        cost(hops=3.0, upright=4.0),
        cost(hops=4.0),
        cost(spread=0.3),
        cost(spread=0.03),
        cost(spread=0.0101),
        cost(),
    ]
    assert ladder == sorted(ladder, reverse=True) and len(set(ladder)) == len(ladder)
    assert all(math.isfinite(each) for each in ladder)
    assert min(ladder[:-1]) > 0 > ladder[-1]
