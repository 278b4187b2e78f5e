"""A researcher's own model: two legs from one composite, three composites deep, four muscles, and
a component of their own beside the spec."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from gaitsim.simulation.run import Simulator

from .models import OWN, model

SPEC = OWN / "two_legs.yaml"
MUSCLES = [f"leg_{side}.muscles.{name}" for side in "lr" for name in ("extensor", "flexor")]
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def test_three_composites_deep() -> None:
    made = model(SPEC)
    groups = {group.address: group.reference for group in made.groups}
    assert groups["leg_l"] == "leg/hanging"
    assert groups["leg_l.muscles"] == "antagonists/pair"
    assert groups["leg_l.thigh"] == "segment/scaled"
    muscles = [part.address for part in made.parts if part.type.reference == "muscle/geyer2003"]
    assert muscles == MUSCLES
    pelvis = next(part for part in made.parts if part.address == "pelvis")
    assert pelvis.type.path == OWN / "components" / "segment" / "pelvis.py"
    # The user's own unit is converted like any other: 20 cm apart.
    assert made.numbers[pelvis.numbers["width"]].value == pytest.approx(0.2)


def test_left_is_right_mirrored_in_y() -> None:
    mechanics = Simulator(model(SPEC))._loop.physics.model
    for name in MUSCLES[:2]:
        for i in (0, 1):
            left = mechanics.site(f"{name}.path.points.{i}").pos
            right = mechanics.site(f"{name}.path.points.{i}".replace("leg_l", "leg_r")).pos
            np.testing.assert_array_equal(left, right * [1, -1, 1])
            assert left[1] != 0
    # Half of the thigh's length below the hip: 0.5 * 0.245 * 1.7 m.
    right = mechanics.site("leg_r.muscles.extensor.path.points.0").pos
    np.testing.assert_allclose(right, [0.04, 0.03, -0.5 * 0.245 * 1.7], rtol=1e-12)
    hips = [mechanics.body(f"leg_{side}.thigh.rod").pos for side in "lr"]
    np.testing.assert_allclose(hips, [[0, 0.1, 0], [0, -0.1, 0]])
    assert mechanics.body("leg_l.thigh.rod").mass[0] == pytest.approx(8)
    assert mechanics.body("leg_r.shank.rod").mass[0] == pytest.approx(4.8)
    lengths = {}
    for side in "lr":
        data = mujoco.MjData(mechanics)
        data.joint(f"leg_{side}.knee").qpos[0] = 0.6
        mujoco.mj_forward(mechanics, data)
        names = ("extensor", "flexor")
        ids = [mechanics.tendon(f"leg_{side}.muscles.{n}.path").id for n in names]
        lengths[side] = data.ten_length[ids]
    np.testing.assert_allclose(lengths["l"], lengths["r"], rtol=1e-12)


@modes
def test_equal_legs_move_alike(mode: str) -> None:
    trajectory = Simulator(model(SPEC), mode).run(recorded=True).trajectory
    assert trajectory is not None
    left = [signal for signal in trajectory.signals if signal.startswith("leg_l.")]
    assert len(left) > 20
    for signal in left:
        other = trajectory[signal.replace("leg_l.", "leg_r.")]
        scale = max(1e-9, np.abs(other).max())
        np.testing.assert_allclose(trajectory[signal] / scale, other / scale, atol=1e-9)
    assert trajectory["leg_l.muscles.extensor.force"].max() > 30
    assert np.ptp(trajectory["leg_l.knee.angle"]) > 0.3


def test_a_number_tuned_for_both_sides_is_one_number() -> None:
    made = model(SPEC)
    free = {each.address: each for each in made.free}
    assert list(free) == ["leg.strength", "leg.muscles.gain", "leg.muscles.delay"]
    assert free["leg.strength"].drives == ("leg_l.strength", "leg_r.strength")
    assert (free["leg.strength"].low, free["leg.strength"].high) == (1000, 4000)
    values = made.values([3000.0, 1.0, 0.02])
    strengths = {
        part.address: values[part.numbers["max_isometric_force"]] for part in made.parts if part.address in MUSCLES
    }
    assert strengths == dict(zip(MUSCLES, [3000, 1500, 3000, 1500], strict=True))


@modes
def test_one_side_can_differ(mode: str) -> None:
    settings = [
        ("leg_r.strength", "3 kN"),
        ("leg_r.shank.part_of_mass", "0.03"),
        ("leg_l.muscles.gain", "{value: 0.5, tune: [0, 1]}"),
    ]
    made = model(SPEC, settings)
    free = {each.address: each.drives for each in made.free}
    assert free["leg_l.strength"] == ("leg_l.strength",)
    assert free["leg_l.muscles.gain"] == ("leg_l.muscles.gain",)
    assert free["leg_r.muscles.gain"] == ("leg_r.muscles.gain",)
    assert free["leg.muscles.delay"] == ("leg_l.muscles.delay", "leg_r.muscles.delay")
    simulator = Simulator(made, mode)
    mechanics = simulator._loop.physics.model
    assert mechanics.body("leg_l.shank.rod").mass[0] == pytest.approx(4.8)
    assert mechanics.body("leg_r.shank.rod").mass[0] == pytest.approx(2.4)
    outcome = simulator.run(recorded=True)
    assert outcome.status == "completed" and outcome.trajectory is not None
    left, right = (outcome.trajectory[f"leg_{side}.knee.angle"] for side in "lr")
    assert np.abs(left - right).max() > 0.01


def test_candidates_reach_the_run_through_every_mask() -> None:
    simulator = Simulator(model(SPEC))
    weak, strong, late = (
        simulator.run(candidate, recorded=True)
        for candidate in ([1000.0, 1.5, 0.01], [4000.0, 1.5, 0.01], [1000.0, 1.5, 0.04])
    )
    metrics = [outcome.metrics["swing"] for outcome in (weak, strong, late)]
    assert len(set(metrics)) == 3
