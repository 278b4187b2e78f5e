"""How high a place is above the ground, whatever the ground is; steps on a slope."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from components.calls import computed

from gaitsim.simulation.run import Mode, Simulator

from .plane import model_of, played

BLOCK = """
gaitsim: 1
use_for: {terrain: TERRAIN}
parts:
  block: {use: segment/rod, mass: 80 kg, length: 2 m, center_of_mass: 0.5, direction: up}
  root: {use: joint/planar, parent: world, child: block.proximal, pose: free}
  top: {use: sensor/clearance, frame: block.distal}
initial: {root.x: 3 m, root.z: 1 m}
simulate: {duration: 2 ms, step: 1 ms}
"""
SLOPE = math.radians(10)
ALONG = 3 * math.cos(SLOPE) + 3 * math.sin(SLOPE)
ABOVE = 3 * math.cos(SLOPE) - 3 * math.sin(SLOPE)


@pytest.mark.parametrize(
    ("terrain", "position", "height"),
    [
        ("terrain/flat", 3, 3),
        ("{use: terrain/slope, angle: 10 deg}", ALONG, ABOVE),
        ("{use: terrain/steps, first: 2.9 m, rise: -0.2 m}", 3, 3.2),
        ("{use: terrain/steps, first: 3.1 m, rise: -0.2 m}", 3, 3),
        ("{use: terrain/steps, first: 2.9 m, rise: -0.2 m, angle: 10 deg}", ALONG, ABOVE + 0.2),
        ("{use: terrain/steps, first: 2.9 m, rise: 0 m, angle: 10 deg}", ALONG, ABOVE),
    ],
)
def test_the_top_of_a_block(tmp_path: Path, terrain: str, position: float, height: float) -> None:
    found = played(BLOCK, tmp_path, TERRAIN=terrain)
    assert found["top.position"][0] == pytest.approx(position, abs=1e-9)
    assert found["top.height"][0] == pytest.approx(height, abs=1e-9)


@pytest.mark.parametrize("mode", ["rapid", "normal"])
def test_steps_on_a_slope(mode: Mode) -> None:
    now = computed("terrain/steps", mode, first=2.0, rise=-0.1, angle=0.2, position=2.5)
    assert now.height == pytest.approx(-0.1, abs=1e-12)
    assert now.slope == pytest.approx(0.2)


@pytest.mark.parametrize(("rise", "kinds"), [("0 m", ["plane"]), ("-1 cm", ["box", "box"])])
def test_steps_of_no_height_are_one_plane(tmp_path: Path, rise: str, kinds: list[str]) -> None:
    terrain = f"{{use: terrain/steps, first: 2 m, rise: {rise}, angle: 3 deg}}"
    xml = Simulator(model_of(BLOCK, tmp_path, TERRAIN=terrain)).xml
    ground = [line for line in xml.splitlines() if 'name="world.ground' in line]
    assert [line.split('type="')[1].split('"')[0] for line in ground] == kinds
