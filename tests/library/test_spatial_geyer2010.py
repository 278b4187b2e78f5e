"""Geyer's stiction in space: along a line the planar law, the same in every direction, and on slopes across."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import primitive

from gaitsim.simulation.run import Mode
from gaitsim.simulation.trial import Trial

from .plane import played

WEIGHT = 80 * 9.81
# Position along a line, velocity along it, and height: it lands, sticks, slips, slides back and sticks again.
STEPS = [
    (2.0, 0.1, 0.001),
    (2.0, 0.1, -0.01),
    (2.01, 0.06, -0.01),
    (2.01, -0.06, -0.008),
    (2.01, 0.3, -0.01),
    (2.02, 0.3, -0.01),
    (2.02, -0.3, -0.012),
    (2.05, 0.009, -0.01),
    (2.045, 0.009, -0.01),
    (2.05, 0.0, 0.001),
]


@pytest.mark.parametrize("mode", ["rapid", "normal"])
@pytest.mark.parametrize("azimuth", [0, 90, 217])
def test_along_any_line_it_is_the_law_of_the_plane(azimuth: float, mode: Mode) -> None:
    plane, space = Trial(primitive("contact/geyer2010")), Trial(primitive("contact/spatial_geyer2010"))
    cosine, sine = math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth))
    for position, slip, height in STEPS:
        common = {"place_height": height, "velocity": -0.002, "weight": WEIGHT}
        plane.put({**common, "position": position, "slip_velocity": slip})
        places = {"position": position * cosine, "side_position": position * sine}
        space.put({**common, **places, "slip_velocity": slip * cosine, "side_slip_velocity": slip * sine})
        for tables in (plane, space):
            assert not tables.call("output", mode) and not tables.call("update", mode)
        for name in ("in_contact", "sticks", "spring", "force", "drag", "energy", "load"):
            assert getattr(space.y, name) == pytest.approx(getattr(plane.y, name), rel=1e-9, abs=1e-9)
        for along, aside in (("friction_force", "side_force"), ("shear_spring", "side_shear_spring")):
            assert getattr(space.y, along) == pytest.approx(getattr(plane.y, along) * cosine, rel=1e-9, abs=1e-8)
            assert getattr(space.y, aside) == pytest.approx(getattr(plane.y, along) * sine, rel=1e-9, abs=1e-8)


BLOCK = """
gaitsim: 1
use_for: {terrain: {use: terrain/slope, angle: 0 deg, across: ANGLE}}
parts:
  block: {use: segment/spatial, mass: 60 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center}
  side: {use: contact/spatial_geyer2010, sides: [l, r], frame: {on: block.center, at: [-12 cm, -20 cm, -3 cm]}}
  front: {use: contact/spatial_geyer2010, frame: {on: block.center, at: [24 cm, 0 cm, -3 cm]}}
initial: {root.roll: ANGLE}
simulate: {duration: 1.5 s, step: 0.5 ms}
"""
POINTS = ("side_l", "side_r", "front")


def test_a_block_sticks_on_a_slope_across(tmp_path: Path) -> None:
    found, slope = played(BLOCK, tmp_path, ANGLE="15 deg"), math.radians(15)
    # Three springs of a weight a 10 cm give way by a third of it, and then nothing moves: stiction does not creep.
    assert abs(found["root.left_velocity"][-1]) < 1e-4
    assert found["side_l.sticks"][-1] == found["side_r.sticks"][-1] == found["front.sticks"][-1] == 1
    assert sum(found[f"{name}.side_force"][-1] for name in POINTS) == pytest.approx(
        60 * 9.81 * math.sin(slope), rel=1e-3
    )
    assert sum(found[f"{name}.force"][-1] for name in POINTS) == pytest.approx(60 * 9.81 * math.cos(slope), rel=1e-3)
    assert abs(found["root.x"][-1] - found["root.x"][0]) < 1e-3


def test_a_block_slides_down_a_slope_across_that_is_too_steep(tmp_path: Path) -> None:
    lower = BLOCK.replace(
        "contact/spatial_geyer2010,", "contact/spatial_geyer2010, static_friction: 0.3, sliding_friction: 0.2,"
    )
    found = played(lower, tmp_path, ANGLE="25 deg")
    along = -found["root.left_velocity"] / math.cos(math.radians(25))
    growth = (along[-1] - along[-401]) / 0.2
    assert growth == pytest.approx(9.81 * (math.sin(math.radians(25)) - 0.2 * math.cos(math.radians(25))), rel=0.02)


SLIDER = """
gaitsim: 1
parts:
  arm: {use: segment/spatial, mass: 5 kg, inertia_forward: 0.01 kg m^2, inertia_left: 0.01 kg m^2,
    inertia_up: 0.01 kg m^2, proximal_forward: -60 cm}
  lift: {use: joint/vertical, parent: world, child: arm.proximal}
  turn: {use: joint/spatial_hinge, parent: world, child: arm.proximal, axis_up: 1}
  foot: {use: contact/spatial_geyer2010, frame: arm.center, sliding_friction: 0.5, static_friction: 0.5}
  energy: {use: sensor/mechanical_energy}
initial: {lift.position: -1 cm, turn.angular_velocity: 5 rad/s}
simulate: {duration: 0.4 s, step: 0.2 ms}
"""


def test_a_point_that_slides_in_a_circle_loses_what_friction_takes(tmp_path: Path) -> None:
    found: Any = played(SLIDER, tmp_path)
    late = found.times > 0.02  # it sticks for a moment, until the shear is too large
    assert (found["foot.sticks"][late] == 0).all()
    slowing = 0.5 * 5 * 9.81 * 0.6 / (5 * 0.36 + 0.01)
    rate = found["turn.angular_velocity"][late]
    assert np.polyfit(found.times[late], rate, 1)[0] == pytest.approx(-slowing, rel=1e-3)
    way = 0.6 * np.ptp(found["turn.angle"][late])
    total = found["energy.total"][late]
    assert total[0] - total[-1] == pytest.approx(0.5 * 5 * 9.81 * way, rel=2e-3)
