"""A joint without freedom: two segments swing as the one that they make together."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.simulation.run import Simulator

from .plane import body_of, model_of, played

SEGMENT = "use: segment/spatial, inertia_forward: 1 kg m^2, inertia_up: 1 kg m^2"
TWO = f"""
gaitsim: 1
parts:
  upper: {{{SEGMENT}, mass: 3 kg, inertia_left: 0.2 kg m^2, proximal_up: 50 cm}}
  lower: {{{SEGMENT}, mass: 1 kg, inertia_left: 0.1 kg m^2, proximal_forward: -10 cm, proximal_up: 20 cm}}
  held: {{use: joint/fixed, parent: {{on: upper.center, at: [10 cm, 0 cm, -40 cm]}}, child: lower.proximal}}
  hinge: {{use: joint/hinge, parent: world, child: upper.proximal}}
initial: {{hinge.angle: 40 deg}}
simulate: {{duration: 1 s, step: 0.5 ms}}
"""
# The lower center is 20 cm in front of the upper one and 60 cm below: a quarter of that to the common center.
INERTIA = 0.3 + 0.75 * (0.2**2 + 0.6**2)
ONE = f"""
gaitsim: 1
parts:
  body: {{{SEGMENT}, mass: 4 kg, inertia_left: {INERTIA} kg m^2, proximal_forward: -5 cm, proximal_up: 65 cm}}
  hinge: {{use: joint/hinge, parent: world, child: body.proximal}}
initial: {{hinge.angle: 40 deg}}
simulate: {{duration: 1 s, step: 0.5 ms}}
"""


def test_two_segments_held_together_swing_as_one(tmp_path: Path) -> None:
    together, alone = (played(text, tmp_path)["hinge.angle"] for text in (TWO, ONE))
    assert alone.min() < 0
    assert together == pytest.approx(alone, abs=1e-9)


def test_it_adds_no_degree_of_freedom(tmp_path: Path) -> None:
    assert body_of(Simulator(model_of(TWO, tmp_path))).model.nv == 1
