"""Terrain: heights by hand, and every contact at rest on it; a spec changes it in one line."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from components.calls import computed

from gaitsim.errors import GaitsimError
from gaitsim.simulation.run import Mode, Simulator

from .plane import model_of, played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])

BLOCK = """
gaitsim: 1
use_for: {terrain: TERRAIN}
parts:
  block: {use: segment/rod, mass: 80 kg, length: 10 m, center_of_mass: 0, radius_of_gyration: 1}
  root: {use: joint/planar, parent: world, child: block.center}
  first: {use: contact/CONTACT, frame: block.center}
  second: {use: contact/CONTACT, frame: block.center}
initial: {root.x: PLACE}
simulate: {duration: 1 s, step: 1 ms}
"""
CONTACTS = {
    "geyer2010": 0.0,
    "hunt_crossley, radius: 3 cm, stiffness: 1e9 Pa": 0.03,
    "mujoco, radius: 2 cm": 0.02,
    "yielding_sole, radius: 2 cm, depth: 1 mm": 0.02,
}


@modes
def test_heights_of_steps(mode: Mode) -> None:
    stairs = {"first": 2.0, "rise": -0.1, "run": 0.5, "count": 3.0}
    for position, height in {-5: 0, 1.99: 0, 2.01: -0.1, 2.49: -0.1, 2.51: -0.2, 3.2: -0.3, 9: -0.3}.items():
        now = computed("terrain/steps", mode, **stairs, position=float(position))
        assert now.height == pytest.approx(height, abs=1e-12)
        assert now.slope == 0


@modes
def test_flat_and_sloped_ground(mode: Mode) -> None:
    flat, slope = computed("terrain/flat", mode, position=3.0), computed("terrain/slope", mode, angle=0.1, position=3.0)
    assert (flat.height, flat.slope) == (0, 0)
    assert (slope.height, slope.slope) == (0, pytest.approx(0.1))


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize(
    ("terrain", "place", "height"),
    [
        ("terrain/flat", 1.0, 0.0),
        ("{use: terrain/slope, angle: 5 deg}", 1.0, math.tan(math.radians(5))),
        ("{use: terrain/slope, angle: -5 deg}", 1.0, -math.tan(math.radians(5))),
        ("{use: terrain/steps, first: 0.5 m, rise: 3 cm}", 0.3, 0.0),
        ("{use: terrain/steps, first: 0.5 m, rise: 3 cm}", 1.0, 0.03),
        ("{use: terrain/steps, first: 0.5 m, rise: -3 cm, run: 30 cm, count: 2}", 1.0, -0.06),
    ],
)
def test_every_contact_stands_on_every_terrain(
    tmp_path: Path, contact: str, terrain: str, place: float, height: float
) -> None:
    found = played(BLOCK, tmp_path, CONTACT=contact, TERRAIN=terrain, PLACE=f"{place} m")
    radius = CONTACTS[contact]
    # Before it has sunk in or crept down, the block begins where the ground is: the initial pose stands on it.
    rise = math.atan(height / place) if "slope" in terrain else 0.0
    assert found["root.z"][0] == pytest.approx(height + radius / math.cos(rise), abs=1e-9)
    assert abs(found["root.z"][-1] - found["root.z"][0]) < 0.012
    first = "first.sphere" if "sole" in contact else "first"
    assert found[f"{first}.load"][-1] == pytest.approx(0.5 * math.cos(rise), rel=0.01)


def test_one_ground_is_enough(tmp_path: Path) -> None:
    text = BLOCK.replace("use_for: {terrain: TERRAIN}\n", "").replace(
        "second: {use: contact/CONTACT, frame: block.center}",
        "second: {use: contact/CONTACT, frame: block.center, terrain: {use: terrain/slope, angle: 1 deg}}",
    )
    with pytest.raises(GaitsimError, match="there is one ground"):
        Simulator(model_of(text, tmp_path, CONTACT="mujoco", PLACE="0 m"))
