"""The center of pressure under hand-made feet with known answers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.gait.pressure import Pressure, pressure, pressure_figures
from gaitsim.analysis.replays.replay import Replay
from tests.analysis.walking import STANCE, WEIGHT, Floats, on_ground, phase, walk

STANDS = np.linspace(0, 1, 101)


def pressed(side: str, heel: Floats, ball: Floats) -> dict[str, Floats]:
    """Forces in body weights of both contacts of a foot."""
    found = {}
    for name, share in (("heel", heel), ("ball", ball)):
        found[f"leg_{side}.{name}.load"] = share * on_ground(side)
        found[f"leg_{side}.{name}.force"] = WEIGHT * share * on_ground(side)
    return found


def stood(side: str) -> Floats:
    """Place in the stance of a leg, from 0 to 1."""
    return np.minimum(phase(side) / STANCE, 1)


def placed(side: str, heel: Floats | float, ball: Floats | float) -> dict[str, Floats | float]:
    return {f"leg_{side}.heel.position": heel, f"leg_{side}.ball.position": ball}


def of(replay: Replay, side: str) -> Pressure:
    legs = two_legs(replay)
    assert legs is not None
    found = pressure(replay, legs[side == "r"])
    assert found is not None
    return found


def test_it_goes_from_heel_to_ball_as_the_load_does() -> None:
    share = stood("r")
    replay = walk({**pressed("r", 1 - share, share), **placed("r", 0.3, 0.5)})
    found = of(replay, "r")
    assert (found.heel, found.front, found.length) == ("leg_r.heel", "leg_r.ball", pytest.approx(0.2))
    assert found.over_stance.rows.shape == (7, 101)
    # Of 144 instants in a stance the last one is at 143/144 of it.
    assert found.over_stance.mean == pytest.approx(0.2 * STANDS * 143 / 144, abs=1e-9)
    assert found.over_stance.deviation == pytest.approx(0, abs=1e-9)
    assert found.middle_at == pytest.approx(0.51)


@pytest.mark.parametrize("slap", [0.4, 0.8])
def test_a_slap_of_the_foot_is_no_passing_of_its_middle(slap: float) -> None:
    """At 4 % of stance the ball strikes the ground with less or more than half of the load, and rebounds."""
    share = stood("r")
    ball = np.where(np.abs(share - 0.04) < 0.01, slap, share)
    found = of(walk({**pressed("r", 1 - ball, ball), **placed("r", 0.3, 0.5)}), "r")
    assert (found.over_stance.mean.max() > 0.1, bool((found.over_stance.mean[:10] > 0.1).any())) == (True, slap > 0.5)
    assert found.middle_at == pytest.approx(0.51)


def test_forces_weigh_the_places() -> None:
    replay = walk({**pressed("r", 0.3 + 0 * stood("r"), 0.9 + 0 * stood("r")), **placed("r", 0.3, 0.5)})
    assert of(replay, "r").over_stance.mean == pytest.approx(0.15)
    assert of(replay, "r").middle_at == 0


def test_a_foot_that_only_its_ball_carries_counts_from_where_its_heel_is_at_touchdown() -> None:
    toes = {**pressed("l", 0 * stood("l"), 1 + 0 * stood("l")), **placed("l", 0.3 + 0.05 * stood("l"), 0.5)}
    assert of(walk(toes), "l").over_stance.mean == pytest.approx(0.2)
    assert of(walk(toes), "l").length == pytest.approx(0.2)


def test_a_heel_that_rolls_counts_from_the_mean_of_its_places() -> None:
    share = stood("r")
    rolls = {**pressed("r", (share < 0.5).astype(float), (share >= 0.5).astype(float)), **placed("r", 0.29, 0.5)}
    rolls["leg_r.heel.position"] = 0.29 + 0.04 * np.minimum(share, 0.5)  # on average 0.30 while it carries
    mean = of(walk(rolls), "r").over_stance.mean
    assert mean[[0, 25, 75, 100]] == pytest.approx([-0.01, 0, 0.2, 0.2], abs=3e-4)


def test_an_instant_without_force_is_passed_over() -> None:
    share = stood("r")
    carries = np.where(np.abs(share - 0.25) < 0.004, 0.0, 1.0)
    replay = walk({**pressed("r", (1 - share) * carries, share * carries), **placed("r", 0.3, 0.5)})
    # The heel's mean place is still its only place, and between the instants it goes straight on.
    assert of(replay, "r").over_stance.mean == pytest.approx(0.2 * STANDS * 143 / 144, abs=1e-9)


def test_a_foot_that_never_rolls_is_never_past_its_middle() -> None:
    assert math.isnan(of(walk(placed("r", 0.3, 0.5)), "r").middle_at)
    legs = two_legs(walk({}))
    assert legs is not None
    alone = replace(legs[0], contacts=("leg_l.heel",))
    assert pressure(walk({}), alone) is None
    assert pressure_figures(walk({}), [alone]) == []


def test_the_figure_has_centimetres_and_foot_lengths() -> None:
    share = stood("r")
    replay = walk({**pressed("r", 1 - share, share), **placed("r", 0.3, 0.5)})
    legs = two_legs(replay)
    assert legs is not None
    (drawing,) = pressure_figures(replay, legs)
    assert drawing.caption.endswith("right from 0.0 to 19.9 cm, at 51 % of stance past the middle of a foot of 20 cm.")
    (panel,) = drawing.figure.axes
    assert (panel.get_ylabel(), panel.get_xlabel()) == ("from the heel (cm)", "stance (%)")
    drawn = {str(line.get_label()): line.get_ydata() for line in panel.lines}
    assert np.asarray(drawn["right"])[50] == pytest.approx(10 * 143 / 144)
    (shares,) = panel.child_axes
    assert shares.get_ylabel() == "foot lengths (–)"
