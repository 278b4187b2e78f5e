"""A posture is the recorded one: what MuJoCo measures on it is what was measured in the run."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from gaitsim.animation import CannotAnimate
from gaitsim.animation.posture import Posture, rows_at
from gaitsim.animation.stage import stage_of
from gaitsim.simulation.outcome import Trajectory
from tests.animation.runs import run_of, run_of_text

SLOPE = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: 30 kg}
  root: {use: joint/planar, parent: world, child: ball.center}
  foot: {use: contact/spring_damper, frame: ball.center, stiffness: 50 kN/m, damping: 1 kN s/m,
         terrain: {use: terrain/slope, angle: 30 deg}}
simulate: {duration: 0.2 s, step: 0.5 ms}
"""


@pytest.fixture
def leg() -> Posture:
    replay = run_of("hopping_leg_mass")
    return Posture(stage_of(replay.model), replay.trajectory)


def test_paths_and_places_are_as_long_and_high_as_they_were(leg: Posture) -> None:
    mechanics, trajectory = leg.stage.mechanics, leg.trajectory
    tendon = mechanics.tendon("extensor.path").id
    (foot,) = leg.stage.forces
    for row in range(0, len(trajectory.times), 97):
        leg.take(row)
        assert leg.data.ten_length[tendon] == pytest.approx(trajectory["extensor.path.length"][row], abs=1e-12)
        assert leg.place(foot.spot)[2] == pytest.approx(trajectory["ground.height"][row], abs=1e-12)
        assert leg.force(foot) == pytest.approx([0, 0, trajectory["ground.force"][row]], abs=1e-9)


def test_a_massless_leg_is_drawn_from_the_hip_to_the_ground() -> None:
    replay = run_of("hopping_geyer2003")
    posture = Posture(stage_of(replay.model), replay.trajectory)
    (line,) = posture.stage.lines
    for row in (0, int(np.argmax(replay.trajectory["leg.force"]))):
        posture.take(row)
        hip, knee, foot = (posture.place(spot) for spot in line.spots)
        height = replay.trajectory["guide.position"][row]
        standing = replay.trajectory["leg.in_stance"][row] == 1
        assert hip == pytest.approx([0, 0, height])
        assert foot == pytest.approx([0, 0, 0 if standing else height - 0.99], abs=1e-9)
        assert np.linalg.norm(hip - knee) == pytest.approx(0.5)
        assert np.linalg.norm(knee - foot) == pytest.approx(0.5)
        assert knee[0] > 0


def test_a_path_without_places_is_no_line_and_measuring_tendons_are_not_seen(leg: Posture) -> None:
    assert [signal for _, signal in leg.stage.muscles] == ["extensor.activation"]
    mechanics = leg.stage.mechanics
    seen = [mechanics.tendon(i).name for i in range(mechanics.ntendon) if mechanics.tendon_rgba[i, 3] > 0]
    assert seen == ["extensor.path"]
    assert stage_of(run_of("hopping_geyer2003").model).muscles == ()


def test_forces_on_a_slope_point_along_its_normal() -> None:
    replay = run_of_text(SLOPE)
    posture = Posture(stage_of(replay.model), replay.trajectory)
    row = int(np.argmax(replay.trajectory["foot.force"]))
    posture.take(row)
    (force,) = posture.stage.forces
    size = replay.trajectory["foot.force"][row]
    assert size > 100
    assert posture.force(force) == pytest.approx([-0.5 * size, 0, np.sqrt(0.75) * size])


def test_the_nearest_recorded_instant_is_taken() -> None:
    trajectory = Trajectory(np.array([0.0, 0.1, 0.2]), (), (), np.zeros((3, 0)))
    assert list(rows_at(trajectory, [0.0, 0.04, 0.06, 0.19, 5.0])) == [0, 0, 1, 2, 2]
    assert list(rows_at(Trajectory(np.zeros(1), (), (), np.zeros((1, 0))), [0.0, 1.0])) == [0, 0]


def test_without_an_instant_there_is_no_posture(leg: Posture) -> None:
    with pytest.raises(CannotAnimate, match="no motion was recorded"):
        Posture(leg.stage, Trajectory(np.zeros(0), (), (), np.zeros((0, 0))))


def test_uneven_ground_is_drawn_as_high_as_it_is() -> None:
    rough = "{use: terrain/rough, amplitude: 5 cm, cell: 40 cm, first: -9 m}"
    replay = run_of_text(SLOPE.replace("{use: terrain/slope, angle: 30 deg}", rough))
    stage = stage_of(replay.model)
    posture = Posture(stage, replay.trajectory)
    posture.take(0)
    mechanics, drawn = stage.mechanics, stage.mechanics.geom("gaitsim.relief").id
    (plane,) = (g for g in range(mechanics.ngeom) if mechanics.geom(g).name == "world.ground")
    above, down, none = np.array([replay.trajectory["root.x"][0], 0.0, 9.0]), np.array([0, 0, -1.0]), np.zeros(3)
    depth = mujoco.mj_rayHfield(mechanics, posture.data, drawn, above, down, none)
    assert 9 - depth == pytest.approx(replay.trajectory["foot.terrain.height"][0], abs=5e-4)
    assert abs(9 - depth) > 1e-3
    assert posture.data.geom_xpos[plane][2] < -0.03
