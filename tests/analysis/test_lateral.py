"""Footprints, step width and margin to the side, of a walk made by hand that goes straight or askew."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gaitsim.analysis.gait.figures import gait_figures
from gaitsim.analysis.gait.frontal import _curves
from gaitsim.analysis.gait.lateral import (
    footprints,
    lateral_figures,
    lateral_margins,
    least_margins,
    step_widths,
    way_of,
)
from gaitsim.analysis.gait.legs import Leg, two_legs
from gaitsim.analysis.replays.replay import Replay
from tests.analysis.walking import STRIDE, TIMES, phase, position, walk
from tests.simulation.models import ROOT
from tests.simulation.models import model as model_of

ASIDE = {"l": 0.07, "r": -0.06}  # m: both heels; the lateral toe is 4 cm further out
SPEED = 1.4 / STRIDE


def askew(heading: float) -> tuple[Replay, tuple[Leg, Leg]]:
    """A walk along a heading, whose center of mass sways by 2 cm to the standing foot, 1 m above the ground."""
    rate = 2 * np.pi / STRIDE
    sway = {"aside": -0.02 * np.sin(rate * TIMES), "rate": -0.02 * rate * np.cos(rate * TIMES)}
    cosine, sine = math.cos(heading), math.sin(heading)
    ways = {"forward": SPEED * TIMES, "forward_velocity": SPEED + 0 * TIMES}
    signals = {
        "center.forward": ways["forward"] * cosine - sway["aside"] * sine,
        "center.left": ways["forward"] * sine + sway["aside"] * cosine,
        "center.forward_velocity": ways["forward_velocity"] * cosine - sway["rate"] * sine,
        "center.left_velocity": ways["forward_velocity"] * sine + sway["rate"] * cosine,
    }
    used = model_of(ROOT / "specs" / "walking_scone_h1922.yaml")
    for side, outwards in (("l", 1), ("r", -1)):
        contacts = [p.address for p in used.parts if p.type.kind == "contact" and p.address.startswith(f"leg_{side}")]
        for contact in contacts:
            aside = ASIDE[side] + (0.04 * outwards if contact.endswith("lateral_toe") else 0)
            signals[f"{contact}.position"] = position(side) * cosine - aside * sine
            signals[f"{contact}.side_position"] = position(side) * sine + aside * cosine
    replay = walk(signals, used)
    legs = two_legs(replay)
    assert legs is not None
    return replay, legs


@pytest.mark.parametrize("heading", [0, 0.4])
def test_prints_and_step_width_do_not_depend_on_the_heading(heading: float) -> None:
    replay, legs = askew(heading)
    way = way_of(replay, "center", legs)
    assert way.heading == pytest.approx(heading, abs=3e-3)
    prints = footprints(replay, way, legs)
    for foot in prints:
        assert foot.aside - prints[0].aside == pytest.approx(ASIDE[foot.side] - ASIDE[prints[0].side], abs=0.02)
    widths = step_widths(prints)
    assert len(widths) == len(prints) - 2
    assert [width for _, width in widths] == pytest.approx([0.13] * len(widths), abs=1e-9)


@pytest.mark.parametrize("heading", [0, 0.4])
def test_the_margin_is_that_of_the_extrapolated_center_of_mass(heading: float) -> None:
    replay, legs = askew(heading)
    way = way_of(replay, "center", legs)
    margins = lateral_margins(replay, "center", way, legs)
    rate = 2 * np.pi / STRIDE
    reached = -0.02 * np.sin(rate * TIMES) - 0.02 * rate * np.cos(rate * TIMES) / math.sqrt(9.81)
    for leg, other in (legs, legs[::-1]):
        outwards = 1 if leg.side == "l" else -1
        exact = 0.04 + outwards * (ASIDE[leg.side] - reached)
        standing = leg.standing > 0
        # The way is the line between two places of a center that sways, 3 mm beside the mean of it.
        assert margins[leg.side][standing] == pytest.approx(exact[standing], abs=0.02)
        assert np.isnan(margins[leg.side][~standing]).all()
        alone = standing & (other.standing == 0)
        least = least_margins(leg, other, margins[leg.side])
        assert len(least) == len(leg.stances)
        assert least == pytest.approx(np.min(exact[alone]), abs=0.02)


def test_the_figure_is_drawn_in_space_and_not_in_the_plane() -> None:
    replay, legs = askew(0)
    (drawing,) = lateral_figures(replay, legs)
    labels = [axes.get_ylabel() for axes in drawing.figure.axes]
    assert labels == ["to the left (cm)", "step width (cm)", "margin to the side (cm)"]
    assert "13 ± 0 cm" in drawing.caption
    assert "gait_lateral" not in [each.name for each in gait_figures(walk({}))]


def test_abduction_is_drawn_as_adduction() -> None:
    signals = {f"leg_{s}.hip_abduction.angle": np.radians(5) * np.sin(2 * np.pi * phase(s)) for s in "lr"}
    used = model_of(ROOT / "specs" / "walking_song2015.yaml")
    replay = walk(signals, used)
    legs = two_legs(replay)
    assert legs is not None
    curves = _curves(replay, legs)
    for leg in legs:
        adduction = leg.over_cycle(curves["hip adduction"][leg.side]).mean
        assert np.degrees(adduction[25]) == pytest.approx(-5, abs=0.05)
        assert leg.side in curves["hip abduction moment"]
