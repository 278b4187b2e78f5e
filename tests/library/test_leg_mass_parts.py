"""The parts of a leg with mass: segments, stops, restrictor, wrapped path, contacts, muscle, score."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import Tables, computed, metrics, primitive

from gaitsim.components.find import Library, library_folders
from gaitsim.errors import GaitsimError
from gaitsim.model import Model
from gaitsim.simulation.moment_arms import moment_arms
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
LEG = """
gaitsim: 1
parts:
  trunk: {use: segment/hat}
  thigh: {use: segment/thigh}
  shank: {use: segment/shank}
  foot: {use: segment/foot}
  guide: {use: joint/vertical, parent: world, child: trunk.hip}
  hip: {use: joint/hinge, parent: trunk.hip, child: thigh.proximal}
  knee:
    use: joint/limited_hinge
    parent: thigh.distal
    child: shank.proximal
    lower: 5 deg
    upper: 140 deg
    stiffness: 2000 N m/rad
  ankle: {use: joint/hinge, parent: shank.distal, child: foot.proximal}
simulate: {duration: 1 s, step: 1 ms}
"""


def made(text: str, folder: Path) -> Model:
    path = folder / "spec.yaml"
    path.write_text(text, encoding="utf-8")
    return resolve(read_spec(path), Library(library_folders(path)), "spec")


def body_of(simulator: Simulator) -> Any:
    return simulator._loop.physics


# Winter's table at 80 kg and 1.8 m: mass, length, center of mass from the proximal end, gyration.
WINTER = {
    "trunk": (0.678, 0.288, 0.626, 0.496, (0, 0, 1)),
    "thigh": (0.100, 0.245, 0.433, 0.323, (0, 0, -1)),
    "shank": (0.0465, 0.246, 0.433, 0.302, (0, 0, -1)),
    "foot": (0.0145, 0.152, 0.500, 0.475, (1, 0, 0)),
}


def test_segments_have_the_masses_of_the_table(tmp_path: Path) -> None:
    mechanics = body_of(Simulator(made(LEG, tmp_path))).model
    for name, (mass, length, center, gyration, direction) in WINTER.items():
        body = mechanics.body(f"{name}.rod")
        assert body.mass[0] == pytest.approx(mass * 80, rel=1e-12)
        assert body.ipos == pytest.approx(np.array(direction) * center * length * 1.8, abs=1e-12)
        assert body.inertia.max() == pytest.approx(mass * 80 * (gyration * length * 1.8) ** 2, rel=1e-9)
    # One leg and all above it; both legs would make the whole body.
    total = mechanics.body_subtreemass[0]
    assert 2 * total - 0.678 * 80 == pytest.approx(80, rel=1e-12)
    assert mechanics.body("shank.rod").pos == pytest.approx([0, 0, -0.245 * 1.8])
    assert mechanics.body("foot.rod").pos == pytest.approx([0, 0, -0.246 * 1.8])


def test_lengths_add_up_to_the_height_of_the_hip() -> None:
    trunk, thigh, shank = (WINTER[name][1] for name in ("trunk", "thigh", "shank"))
    assert 0.039 + shank + thigh == pytest.approx(0.530)
    assert 0.530 + trunk == pytest.approx(0.818)


STOP = {"lower": 0.1, "upper": 2.0, "stiffness": 1000.0, "stop_damping": 10.0}


@modes
@pytest.mark.parametrize(
    ("angle", "velocity", "stop"),
    [
        (1.0, 5.0, 0.0),
        (0.05, 0.0, 50.0),
        (0.05, -2.0, 70.0),  # going in: the damper helps
        (0.05, 4.0, 10.0),
        (0.05, 9.0, 0.0),  # going out fast: it never holds back
        (2.1, 0.0, -100.0),
        (2.1, 3.0, -130.0),
        (2.1, -30.0, 0.0),
    ],
)
def test_stops_push_and_never_pull(angle: float, velocity: float, stop: float, mode: str) -> None:
    now = computed("joint/limited_hinge", mode, **STOP, angle=angle, velocity=velocity, torque=3.0)
    assert now.stop == pytest.approx(stop, abs=1e-9)
    assert now.total == pytest.approx(stop + 3, abs=1e-9)
    depth = max(0.1 - angle, angle - 2.0, 0)
    assert now.stop_energy == pytest.approx(500 * depth**2, abs=1e-12)


def test_stops_take_energy_and_give_none() -> None:
    angles = np.linspace(-0.2, 0.1, 41)
    for angle in angles:
        for velocity in (-5.0, -0.1, 0.1, 5.0):
            now = computed("joint/limited_hinge", **STOP, angle=angle, velocity=velocity)
            released = -1000 * min(0.0, angle - 0.1) * velocity  # power of the spring alone
            assert now.stop * velocity <= released + 1e-12


RESTRICTED = LEG.replace(
    "simulate:",
    """  restrictor: {use: constraint/vertical, line: trunk.hip, point: foot.proximal}
initial: {guide.position: 2 m, knee.angle: 60 deg}
simulate:""",
)


def test_a_restrictor_keeps_the_ankle_below_the_hip_and_weighs_nothing(tmp_path: Path) -> None:
    simulator, without = Simulator(made(RESTRICTED, tmp_path)), Simulator(made(LEG, tmp_path))
    assert body_of(simulator).model.nbody == body_of(without).model.nbody
    assert body_of(simulator).model.body_subtreemass[0] == body_of(without).model.body_subtreemass[0]
    assert body_of(simulator).data.ne == 1
    trajectory = simulator.run(recorded=True).trajectory
    assert trajectory is not None
    # A free fall of the knee from 60 deg through a full bend.
    assert np.ptp(trajectory["knee.angle"]) >= 0
    assert np.abs(trajectory["restrictor.deviation"]).max() < 1e-6
    assert trajectory["restrictor.deviation"][0] == pytest.approx(0, abs=1e-12)
    assert trajectory["restrictor.energy"][0] == pytest.approx(0, abs=1e-12)


EXTENSOR = """  extensor:
    use: muscle/geyer2010
    max_isometric_force: 1 kN
    optimal_fiber_length: 10 cm
    tendon_slack_length: 40 cm
    path: PATH
"""
WRAPPED = """
      use: path/wrapped
      origin: [{on: thigh.distal, at: [4.5 cm, 0 m, 38 cm]}]
      center: [{on: thigh.distal, at: [0 m, 0 m, 0 m]}]
      side: [{on: thigh.distal, at: [SIDE]}]
      radius: 4 cm
      insertion: [{on: shank, at: [4.5 cm, 0 m, -8 cm]}]"""
# Two points, 4 cm in front, 30 cm above and 7 cm below: the arm is gone 38 deg from straight.
STRAIGHT = """
      use: path/sites
      points: [{on: thigh.distal, at: [4 cm, 0 m, 30 cm]}, {on: shank, at: [4 cm, 0 m, -7 cm]}]"""


def with_path(path: str, **words: str) -> str:
    for word, text in words.items():
        path = path.replace(word, text)
    return LEG.replace("simulate:", EXTENSOR.replace("PATH", path) + "simulate:")


def test_a_wrapped_path_has_the_radius_as_its_arm(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(WRAPPED, SIDE="7 cm, 0 m, -7 cm"), tmp_path))
    assert (arm.path.address, arm.hinge.address, arm.limited) == ("extensor.path", "knee", True)
    assert np.degrees(arm.angles[[0, -1]]) == pytest.approx([5, 140])
    bent = arm.angles > math.radians(15)
    assert arm.arms[bent] == pytest.approx(-0.04, abs=1e-6)
    assert arm.turns == () and arm.jumps == ()


def test_a_path_slips_off_if_its_side_is_too_far_up(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(WRAPPED, SIDE="7 cm, 0 m, 0 m"), tmp_path))
    assert np.degrees(arm.turns) == pytest.approx([119], abs=1)
    assert np.degrees(arm.jumps) == pytest.approx([119], abs=1)


def test_a_straight_extensor_turns_into_a_flexor(tmp_path: Path) -> None:
    (arm,) = moment_arms(made(with_path(STRAIGHT), tmp_path))
    assert np.degrees(arm.turns) == pytest.approx([180 - 142], abs=1)
    assert arm.jumps == ()


def test_a_wrap_has_one_center(tmp_path: Path) -> None:
    two = "{on: thigh.distal, at: [7 cm, 0 m, -7 cm]}"
    text = with_path(WRAPPED, SIDE="7 cm, 0 m, -7 cm").replace(f"side: [{two}]", f"side: [{two}, {two}]")
    with pytest.raises(GaitsimError, match="center and side are lists of one point each"):
        Simulator(made(text, tmp_path))


BALL = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: MASS}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/CONTACT, frame: ball.center}
  elastic: {use: sensor/elastic_energy}
initial: {guide.position: HEIGHT, guide.velocity: SPEED}
simulate: {duration: DURATION, step: STEP, gravity: GRAVITY}
"""


def ball(folder: Path, contact: str, **words: str) -> Any:
    text = BALL.replace("CONTACT", contact)
    usual = {"MASS": "1 kg", "SPEED": "0 m/s", "GRAVITY": "9.81 m/s^2", "STEP": "0.1 ms", "DURATION": "1 s"}
    for word, value in {**usual, **words}.items():
        text = text.replace(word, value)
    outcome = Simulator(made(text, folder)).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    return outcome.trajectory


@pytest.mark.parametrize(("zeta", "restitution"), [(0.1, 0.74408), (0.2, 0.57174), (0.5, 0.29844), (0.7, 0.21028)])
def test_restitution_of_spring_and_damper(tmp_path: Path, zeta: float, restitution: float) -> None:
    # Without gravity and without adhesion: contact ends where the force does.
    damping = 2 * zeta * math.sqrt(1e4)
    found = ball(
        tmp_path,
        f"spring_damper, stiffness: 10 kN/m, damping: {damping:.12g} N s/m",
        HEIGHT="1 cm",
        SPEED="-1 m/s",
        GRAVITY="0 m/s^2",
        STEP="0.005 ms",
        DURATION="0.1 s",
    )
    assert found["guide.velocity"][-1] == pytest.approx(restitution, abs=2e-4)
    assert found["ground.force"].min() >= 0
    assert found["ground.load"].max() == 0


def test_static_load_of_spring_and_damper(tmp_path: Path) -> None:
    law = "spring_damper, stiffness: 78480 N/m, damping: 4 kN s/m, to: {energy: elastic.energy}"
    found = ball(tmp_path, law, MASS="80 kg", HEIGHT="0 m")
    assert found["ground.height"][-1] == pytest.approx(-0.01, rel=1e-6)
    assert found["ground.force"][-1] == pytest.approx(80 * 9.81, rel=1e-6)
    assert found["ground.load"][-1] == pytest.approx(1, rel=1e-6)
    assert found["ground.in_contact"][-1] == 1
    assert found["elastic.total"][-1] == pytest.approx(0.5 * 78480 * 0.01**2, rel=1e-5)


SOLREF = {
    "default": "",
    ".01 1": ", time_constant: 10 ms",
    ".005 1": ", time_constant: 5 ms",
    ".02 .5": ", damping_ratio: 0.5",
    ".02 .1": ", damping_ratio: 0.1",
    "-100000 -1000": ", law: stiffness, reference_stiffness: 1e5 1/s^2, reference_damping: 1000 1/s",
    "-10000 -200": ", law: stiffness, reference_stiffness: 1e4 1/s^2, reference_damping: 200 1/s",
    "-10000 -20": ", law: stiffness, reference_stiffness: 1e4 1/s^2, reference_damping: 20 1/s",
}


@pytest.mark.parametrize("mass", ["1 kg", "40 kg"])
@pytest.mark.parametrize(
    ("solref", "depth"),
    [("default", 3.6718e-4), (".01 1", 1.0776e-4), (".005 1", 2.7301e-5), ("-100000 -1000", 1.0929e-5)],
)
def test_static_depth_of_mujocos_contact(tmp_path: Path, solref: str, depth: float, mass: str) -> None:
    law = f"mujoco, radius: 5 cm{SOLREF[solref]}"
    found = ball(tmp_path, law, MASS=mass, HEIGHT="5 cm", STEP="1 ms", DURATION="2 s")
    assert found["ground.height"][-1] == pytest.approx(-depth, rel=2e-4)
    assert found["ground.load"][-1] == pytest.approx(1, rel=1e-4)
    assert found["ground.in_contact"][-1] == 1


@pytest.mark.parametrize(
    ("solref", "depth", "restitution", "peak"),
    [
        ("default", 0.01035, 0.0, 14.67),
        (".005 1", 0.00257, 0.026, 55.4),
        (".02 .5", 0.00767, 0.2276, 15.31),
        (".02 .1", 0.00242, 0.744, 64.3),
        ("-10000 -200", 0.00516, 0.0, 28.07),
        ("-10000 -20", 0.01213, 0.7331, 13.58),
    ],
)
def test_a_drop_on_mujocos_contact(tmp_path: Path, solref: str, depth: float, restitution: float, peak: float) -> None:
    found = ball(tmp_path, f"mujoco, radius: 5 cm{SOLREF[solref]}", HEIGHT="15 cm", DURATION="0.3 s")
    assert -found["ground.height"].min() == pytest.approx(depth, abs=2e-5)
    assert found["ground.load"].max() == pytest.approx(peak, rel=0.01)
    lowest = int(np.argmin(found["ground.height"]))
    left = lowest + np.flatnonzero(found["ground.height"][lowest:] >= 0)
    speed = found["guide.velocity"][left[0]] if left.size else 0.0
    assert speed / math.sqrt(2 * 9.81 * 0.1) == pytest.approx(restitution, abs=0.003)


MUSCLE = {
    "max_isometric_force": 2000.0,
    "optimal_fiber_length": 0.1,
    "tendon_slack_length": 0.4,
    "tendon_strain": 0.04,
}
# muscles.md: force-length at w .56, and the force-velocity relation.
FORCE_LENGTH = {0.44: 0.05, 0.5: 0.118564, 0.6: 0.335632, 0.7: 0.630919, 0.8: 0.872435, 0.9: 0.983086, 1.0: 1.0}
FORCE_VELOCITY = {-0.9: 0.018182, -0.5: 0.142857, -0.25: 0.333333, -0.1: 0.6, -0.01: 0.942857, 0.0: 1.0}
FORCE_VELOCITY |= {0.01: 1.140784, 0.05: 1.33564, 0.1: 1.405858, 0.25: 1.464115, 0.5: 1.487437, 1.0: 1.5}


def strained(force: float, length: float) -> float:
    """Length of the unit whose tendon has a force (in F_max) at a fiber length (in optimal ones)."""
    return 0.1 * length + 0.4 * (1 + 0.04 * math.sqrt(force))


@modes
def test_the_curves_of_geyer2010(mode: str) -> None:
    for length, velocity in itertools.product([*FORCE_LENGTH, 1.2, 1.4], FORCE_VELOCITY):
        if length > 1:
            isometric = FORCE_LENGTH[round(2 - length, 1)] * 0.3 + ((length - 1) / 0.56) ** 2
        else:
            isometric = FORCE_LENGTH[length] * 0.3
        force = isometric * FORCE_VELOCITY[velocity]
        state = {"activation_level": 0.3, "length": 0.1 * length, "path_length": strained(force, length)}
        now = computed("muscle/geyer2010", mode, **MUSCLE, **state)
        place = f"length {length}, velocity {velocity}"
        assert now.normalized_force == pytest.approx(force, rel=1e-9), place
        # Near +-1 the relation is flat and the printed six digits say little about the velocity.
        near = 0.02 if velocity > 0.4 else 1e-4
        assert now.normalized_fiber_velocity == pytest.approx(velocity, abs=near), place
        assert now.fiber_velocity == pytest.approx(1.2 * now.normalized_fiber_velocity), place


@modes
def test_the_buffer_keeps_the_fiber_from_collapsing(mode: str) -> None:
    def velocity(length: float) -> float:
        now = computed("muscle/geyer2010", mode, **MUSCLE, activation_level=0.5, length=0.1 * length, path_length=0.1)
        assert now.force == 0
        return float(now.normalized_fiber_velocity)

    assert velocity(0.5) == pytest.approx(-1)  # slack: it shortens at v_max
    buffer = ((0.42 - 0.44) / 0.28) ** 2
    ratio = buffer / (0.5 * math.exp(math.log(0.05) * (0.58 / 0.56) ** 3))
    assert velocity(0.42) == pytest.approx((ratio - 1) / (1 + 5 * ratio), rel=1e-9)
    assert -1 < velocity(0.42) < 0 < velocity(0.4)


@modes
@pytest.mark.parametrize("path", [0.42, 0.46, 0.5, 0.52, 0.55, 0.6])
@pytest.mark.parametrize("activation", [0.01, 0.2, 1.0])
def test_geyer2010_starts_at_rest(path: float, activation: float, mode: str) -> None:
    tables = Tables(primitive("muscle/geyer2010")).put({**MUSCLE, "activation_level": activation})
    tables.put({"path_length": path})
    for stage in ("start", "output"):
        assert not tables.call(stage, mode)
    assert abs(tables.y.normalized_fiber_velocity) < 1e-6
    stretch = max(0.0, tables.y.normalized_fiber_length - 1) / 0.56
    squeeze = max(0.0, 0.44 - tables.y.normalized_fiber_length) / 0.28
    offset = abs(tables.y.normalized_fiber_length - 1) / 0.56
    active = activation * math.exp(math.log(0.05) * offset**3)
    assert tables.y.normalized_force == pytest.approx(active + stretch**2 - squeeze**2, abs=1e-9)


def test_geyer2010_is_geyer2003_where_neither_spring_acts() -> None:
    for length in (0.065, 0.08, 0.1):
        for strain in (0.0, 0.01, 0.03, 0.05):
            values = {
                **MUSCLE,
                "width": 0.4,
                "activation_level": 0.4,
                "length": length,
                "path_length": length + 0.4 * (1 + strain),
            }
            new, old = (computed(f"muscle/geyer{year}", **values) for year in (2010, 2003))
            for name in primitive("muscle/geyer2003").outputs:
                assert getattr(new, name) == pytest.approx(getattr(old, name), rel=1e-12), name


def test_elastic_energy_of_geyer2010_is_the_work_of_its_springs() -> None:
    def springs(length: float, strain: float) -> tuple[float, float]:
        now = computed(
            "muscle/geyer2010",
            **MUSCLE,
            activation_level=0.1,
            length=0.1 * length,
            path_length=0.1 * length + 0.4 * (1 + strain),
        )
        return float(now.tendon_energy), float(now.elastic_energy)

    strains = np.linspace(0, 0.05, 2001)
    work = np.trapezoid(2000 * (strains / 0.04) ** 2, 0.4 * strains)
    assert springs(0.9, 0.05) == pytest.approx((work, work), rel=1e-5)
    stretched = np.linspace(1, 1.5, 2001)
    parallel = np.trapezoid(2000 * ((stretched - 1) / 0.56) ** 2, 0.1 * stretched)
    assert springs(1.5, 0) == pytest.approx((0, parallel), rel=1e-5, abs=1e-9)
    squeezed = np.linspace(0.3, 0.44, 2001)
    buffer = np.trapezoid(2000 * ((0.44 - squeezed) / 0.28) ** 2, 0.1 * squeezed)
    assert springs(0.3, 0) == pytest.approx((0, buffer), rel=1e-5, abs=1e-9)


def test_stored_energy_is_that_of_the_start() -> None:
    signals = {"energy": [12.0, 50.0, 80.0], "weight": [600.0] * 3}
    assert metrics("measure/stored_energy", signals, 0.1) == {
        "value": pytest.approx(0.02),
        "energy_at_start": pytest.approx(12),
    }


def hops(apexes: list[float], touchdowns: list[float]) -> dict[str, list[float]]:
    """Down from 1.2 to a first touchdown at 0.9; then contact, apex, touchdown, each in turn."""
    height, contact = [1.2, 1.0, 0.9, 0.7], [0.0, 0.0, 1.0, 1.0]
    for apex, touchdown in zip(apexes, touchdowns, strict=True):
        height += [0.85, 0.95, apex, apex - 0.01, touchdown, 0.8, 0.75]
        contact += [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0]  # it chatters on landing
    return {"height": height, "contact": contact}


def test_hop_height_is_counted_from_each_touchdown() -> None:
    found = metrics("measure/hop_height", hops([1.1, 1.2, 1.3, 1.32], [0.9, 0.91, 0.92, 0.9]), 0.1)
    assert found["hops"] == 4
    assert found["value"] == pytest.approx((0.29 + 0.38 + 0.42) / 3)
    assert found["spread"] == pytest.approx(0.12)
    assert found["apex_height"] == pytest.approx((1.2 + 1.3 + 1.32) / 3)
    assert found["touchdown"] == pytest.approx(0.9)
    assert found["rebound"] == 1


def test_hop_height_without_a_hop() -> None:
    found = metrics("measure/hop_height", {"height": [1.2, 0.9, 0.7, 0.75], "contact": [0.0, 1.0, 1.0, 1.0]}, 0.1)
    assert found["hops"] == 0 and math.isnan(found["value"]) and math.isnan(found["spread"])
    assert found["rebound"] == pytest.approx(0.25)
    assert metrics("measure/hop_height", {"height": [1.2, 1.1], "contact": [0.0, 0.0]}, 0.1)["rebound"] == 0


def cost(**values: float) -> float:
    usual = {"height": 0.2, "spread": 0.002, "hops": 8.0, "rebound": 1.0, "upright": 8.0, "stored_height": 0.0}
    return float(computed("objective/hop", "normal", **(usual | values)).cost)


def test_the_score_of_a_hop() -> None:
    assert cost() == pytest.approx(-0.2)
    assert cost(stored_height=0.05) == pytest.approx(-0.15)
    assert cost(stored_height=0.05, correction=0.0) == pytest.approx(-0.2)
    assert cost(spread=0.02) == pytest.approx(0.5)


def test_a_failed_hop_costs_the_more_the_more_is_missing() -> None:
    nothing = {"height": math.nan, "spread": math.nan}
    ladder = [
        cost(hops=0.0, rebound=0.0, upright=0.3, **nothing),
        cost(hops=0.0, rebound=0.0, upright=0.5, **nothing),
        cost(hops=0.0, rebound=0.4, upright=0.5, **nothing),
        cost(hops=0.0, rebound=0.9, upright=8.0, **nothing),
        cost(hops=1.0, upright=2.0, spread=0.0),
        cost(hops=3.0, upright=4.0),
        cost(hops=4.0),
        cost(spread=0.3),
        cost(spread=0.03),
        cost(spread=0.0101),
        cost(),
    ]
    assert ladder == sorted(ladder, reverse=True) and len(set(ladder)) == len(ladder)
    assert all(math.isfinite(each) for each in ladder)
    assert min(ladder[:-1]) > 0 > ladder[-1]
