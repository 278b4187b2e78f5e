"""Neighbours of a start: repeatable by seed and number alone, as far as they may go, inside the bounds."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.optimization.draws import Draws
from gaitsim.optimization.problem import Problem, Variable
from gaitsim.units import parse_unit

STARTS = {"gain": (0, 5, 1.2), "offset": (-1, 0, -0.5), "edge": (0, 2, 2.0), "none": (-1, 1, 0.0)}
PLAIN = parse_unit("1")
PROBLEM = Problem(tuple(Variable(name, PLAIN, low, high, at, 1.0) for name, (low, high, at) in STARTS.items()))


def test_draws_are_these_numbers_on_every_machine() -> None:
    # PCG64, seeded by [seed, draw], gives these bits everywhere: 2 u - 1 of the first two uniform numbers.
    (values,) = Draws(1, 0.01, 1).values(PROBLEM)
    shares = [(values["gain"] / 1.2 - 1) / 0.01, (values["offset"] / -0.5 - 1) / 0.01]
    assert shares == pytest.approx([-0.33625521626379906, 0.22379194729131746], abs=1e-12)


def test_a_draw_depends_on_its_seed_and_its_number_only() -> None:
    few, many = Draws(3, 0.01, 1).values(PROBLEM), Draws(40, 0.01, 1).values(PROBLEM)
    assert many[:3] == few == Draws(3, 0.01, 1).values(PROBLEM)
    assert len({values["gain"] for values in many}) == 40
    other = Draws(40, 0.01, 2).values(PROBLEM)
    assert not {values["gain"] for values in many} & {values["gain"] for values in other}


def test_numbers_stay_within_the_share_and_the_bounds() -> None:
    found = Draws(400, 0.02, 1).values(PROBLEM)
    gains, edges = (np.array([values[name] for values in found]) for name in ("gain", "edge"))
    assert gains.min() == pytest.approx(1.2 * 0.98, abs=5e-4) and gains.max() == pytest.approx(1.2 * 1.02, abs=5e-4)
    assert (np.abs(gains / 1.2 - 1) <= 0.02).all()
    # Uniform: its mean and its standard deviation, width / sqrt(12), within four standard errors.
    assert gains.mean() == pytest.approx(1.2, abs=4 * 0.048 / 12**0.5 / 20)
    assert gains.std() == pytest.approx(0.048 / 12**0.5, rel=0.1)
    assert edges.max() == 2.0 and edges.min() >= 2 * 0.98
    assert 0.4 < (edges == 2.0).mean() < 0.6
    assert {values["none"] for values in found} == {0.0}
    assert all(-0.51 <= values["offset"] <= -0.49 for values in found)


def test_a_wider_share_moves_the_same_numbers_further() -> None:
    near, far = (Draws(5, within, 1).values(PROBLEM) for within in (0.01, 0.02))
    for one, two in zip(near, far, strict=True):
        assert two["gain"] - 1.2 == pytest.approx(2 * (one["gain"] - 1.2), rel=1e-9)


def test_no_share_is_the_start_itself() -> None:
    assert Draws(4, 0.0, 1).values(PROBLEM) == [{name: at for name, (_, _, at) in STARTS.items()}] * 4
