"""Segments: the explicit 80 kg body, de Leva's fractions for men and women, feet with heel and ball."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gaitsim.simulation.run import Simulator

from .plane import body_of, model_of

BODY = """
gaitsim: 1
parts:
  trunk: {use: segment/hat_MASK}
  thigh: {use: segment/thigh_MASK}
  shank: {use: segment/shank_MASK}
  foot: {use: segment/foot_MASK}
  root: {use: joint/planar, parent: world, child: trunk.hip}
  hip: {use: joint/hinge, parent: trunk.hip, child: thigh.proximal}
  knee: {use: joint/hinge, parent: thigh.distal, child: shank.proximal}
  ankle: {use: joint/hinge, parent: shank.distal, child: foot.ankle}
  ball: {use: contact/spring_damper, frame: foot.ball, stiffness: 1 kN/m, damping: 0 N s/m}
  heel: {use: contact/spring_damper, frame: foot.heel, stiffness: 1 kN/m, damping: 0 N s/m}
initial: {root.z: 0 m}
simulate: {duration: 1 s, step: 1 ms}
"""
# Geyer & Herr (2010): mass, center of mass from the parent's joint (forwards, up), inertia.
GEYER = {
    "trunk": (53.5, (0, 0.35), 3.0),
    "thigh": (8.5, (0, -0.20), 0.15),
    "shank": (3.5, (0, -0.20), 0.05),
    "foot": (1.25, (0.02, 0), 0.005),
}


def test_the_body_of_geyer_and_herr(tmp_path: Path) -> None:
    body = body_of(Simulator(model_of(BODY.replace("MASK", "geyer2010"), tmp_path)))
    for name, (mass, center, inertia) in GEYER.items():
        found = body.model.body(f"{name}.body")
        assert found.mass[0] == pytest.approx(mass, rel=1e-12)
        assert found.ipos == pytest.approx([center[0], 0, center[1]], abs=1e-12)
        assert found.inertia == pytest.approx([inertia] * 3, rel=1e-12)
    assert sum(mass for mass, _, _ in GEYER.values()) * 2 - 53.5 == pytest.approx(80)
    # The sole: 20 cm, the ankle 16 cm behind the ball, all 1 m below the hip.
    ball, heel = (body.data.site(f"{name}.place").xpos for name in ("ball", "heel"))
    assert ball == pytest.approx([0.16, 0, -1.0], abs=1e-12)
    assert heel == pytest.approx([-0.04, 0, -1.0], abs=1e-12)


# de Leva (1996): mass, center of mass, radius of gyration about the axis from left to right.
DE_LEVA = {
    0: {"thigh": (0.1416, 0.4095, 0.329), "shank": (0.0433, 0.4395, 0.246), "foot": (0.0137, 0.4415, 0.245)},
    1: {"thigh": (0.1478, 0.3612, 0.364), "shank": (0.0481, 0.4352, 0.263), "foot": (0.0129, 0.4014, 0.279)},
}
LENGTHS = {"thigh": 0.245 * 1.7, "shank": 0.246 * 1.7, "foot": 0.152 * 1.7}


@pytest.mark.parametrize("female", [0, 1])
def test_de_leva_for_men_and_women(tmp_path: Path, female: int) -> None:
    sizes = f"_deleva1996, height: 1.7 m, mass: 60 kg, female: {female}}}"
    body = body_of(Simulator(model_of(BODY.replace("_MASK}", sizes), tmp_path)))
    legs = 0.0
    for name, (mass, center, gyration) in DE_LEVA[female].items():
        length = LENGTHS[name]
        found = body.model.body(f"{name}.{'body' if name == 'foot' else 'rod'}")
        assert found.mass[0] == pytest.approx(60 * mass, rel=1e-9)
        assert found.inertia.max() == pytest.approx(60 * mass * (gyration * length) ** 2, rel=1e-9)
        place = found.ipos[0] + 0.2 * length if name == "foot" else -found.ipos[2]
        assert place == pytest.approx(center * length, rel=1e-9)
        legs += 2 * found.mass[0]
    assert body.model.body("trunk.rod").mass[0] + legs == pytest.approx(60, rel=1e-9)
    ball, heel = (body.data.site(f"{name}.place").xpos for name in ("ball", "heel"))
    assert ball - heel == pytest.approx([0.75 * LENGTHS["foot"], 0, 0], abs=1e-12)
    # The sole is below the ankle by the ankle's height, so that the hip stands at 0.530 of the body's.
    assert heel[2] == pytest.approx(-0.530 * 1.7, abs=1e-9)


def test_a_rigid_segment_points_where_it_is_told(tmp_path: Path) -> None:
    text = """
gaitsim: 1
parts:
  arm: {use: segment/rigid, mass: 2 kg, length: 50 cm, center_of_mass: 10 cm, inertia: 0.1 kg m^2, direction: WAY}
  tip: {use: segment/point_mass, mass: 1 kg}
  root: {use: joint/hinge, parent: world, child: arm.proximal}
  wrist: {use: joint/hinge, parent: arm.distal, child: tip.center}
simulate: {duration: 1 s, step: 1 ms}
"""
    for way, axis in {"down": (0, 0, -1), "up": (0, 0, 1), "forward": (1, 0, 0)}.items():
        body = body_of(Simulator(model_of(text, tmp_path, WAY=way)))
        assert body.model.body("arm").ipos == pytest.approx(0.1 * np.array(axis), abs=1e-12)
        assert body.model.body("tip").pos == pytest.approx(0.5 * np.array(axis), abs=1e-12)
