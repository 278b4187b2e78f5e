"""Ground contacts: their laws by hand, drops, restitution, slopes, and that none adds energy."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import computed, primitive

from gaitsim.simulation.run import Mode
from gaitsim.simulation.trial import Trial

from .plane import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
WEIGHT = 80 * 9.81

BALL = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: MASS, radius: 5 cm}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/CONTACT, frame: ball.center}
initial: {guide.position: HEIGHT, guide.velocity: SPEED}
simulate: {duration: DURATION, step: STEP, gravity: GRAVITY}
"""
USUAL = {"MASS": "80 kg", "SPEED": "0 m/s", "GRAVITY": "9.81 m/s^2", "STEP": "0.1 ms", "DURATION": "1 s"}
# Each contact with the height of its frame above the ground where it begins to touch.
CONTACTS = {
    "geyer2010": ("geyer2010", 0.0),
    "spatial_geyer2010": ("spatial_geyer2010", 0.0),
    "hunt_crossley": ("hunt_crossley, radius: 3 cm", 0.03),
    "spatial_hunt_crossley": ("spatial_hunt_crossley, radius: 3 cm", 0.03),
    "smooth": ("hunt_crossley, radius: 3 cm, smooth: 1", 0.03),
    "mujoco": ("mujoco, radius: 1 cm", 0.01),
    "yielding_sole": ("yielding_sole, radius: 1 cm", 0.01),
    "spring_damper": ("spring_damper, stiffness: 78480 N/m, damping: 500 N s/m", 0.0),
}


def drop(folder: Path, contact: str, height: float, **words: str) -> Any:
    found = played(BALL, folder, **{**USUAL, **words, "CONTACT": contact, "HEIGHT": f"{height} m"})
    return found if "ground.force" in found.signals else _Sole(found)


class _Sole:
    """A trajectory in which the mask's signals bear its own names."""

    def __init__(self, found: Any) -> None:
        self.found = found

    def __getitem__(self, signal: str) -> Any:
        renamed = signal.replace("ground.", "ground.sphere.")
        return self.found[renamed if renamed in self.found.signals else signal]


# Computed independently: drop height, peak force and depth within 1 s of an 80 kg point on BW / 1 cm.
@pytest.mark.parametrize(
    ("height", "peak", "depth"), [(0.01, 3.98, 0.00984), (0.05, 10.95, None), (0.10, 17.73, 0.00996)]
)
def test_drops_on_the_ground_of_geyer2010(tmp_path: Path, height: float, peak: float, depth: float | None) -> None:
    found = drop(tmp_path, "geyer2010", height)
    assert found["ground.load"].max() == pytest.approx(peak, rel=0.03)
    assert found["guide.velocity"].max() <= 0  # no rebound: it creeps
    if depth:
        assert -found["ground.height"].min() == pytest.approx(depth, abs=2e-5)


@pytest.mark.parametrize(("height", "peak"), [(0.01, 3.10), (0.05, 7.98), (0.10, 12.76)])
def test_drops_on_half_the_stiffness(tmp_path: Path, height: float, peak: float) -> None:
    found = drop(tmp_path, "geyer2010, sinking: 2 cm", height)
    assert found["ground.load"].max() == pytest.approx(peak, rel=0.03)


@pytest.mark.parametrize(
    ("contact", "depth"),
    [
        ("geyer2010", 0.01),
        ("spring_damper", 0.01),
        ("yielding_sole", 0.01),
        ("hunt_crossley", 2 * (WEIGHT / (4 / 3 * 2e6 * math.sqrt(0.03))) ** (2 / 3)),
        ("spatial_hunt_crossley", WEIGHT ** (2 / 3) / 5503.2),
    ],
)
def test_static_depth_and_load(tmp_path: Path, contact: str, depth: float) -> None:
    law, touch = CONTACTS[contact]
    found = drop(tmp_path, law, touch, STEP="1 ms" if contact != "spring_damper" else "0.5 ms", DURATION="4 s")
    assert touch - found["guide.position"][-1] == pytest.approx(depth, rel=0.01)
    assert found["ground.load"][-1] == pytest.approx(1, rel=1e-3)
    assert found["ground.in_contact"][-1] == 1


@pytest.mark.parametrize(
    ("dissipation", "speed", "restitution"),
    [
        (0.1, 0.05, 0.99502),
        (0.1, 0.2, 0.98039),
        (0.1, 1.0, 0.90902),
        (0.5, 0.1, 0.95237),
        (0.5, 1.0, 0.66296),
        (1, 0.05, 0.95237),
        (1, 0.2, 0.83287),
        (1, 1.0, 0.48774),
    ],
)
def test_restitution_of_hunt_and_crossley(tmp_path: Path, dissipation: float, speed: float, restitution: float) -> None:
    law = f"hunt_crossley, radius: 3 cm, dissipation: {dissipation} s/m"
    step = {"STEP": "0.01 ms", "GRAVITY": "0 m/s^2", "MASS": "1 kg", "SPEED": f"{-speed} m/s", "DURATION": "0.1 s"}
    found = drop(tmp_path, law, 0.03, **step)
    assert found["guide.velocity"][-1] / speed == pytest.approx(restitution, abs=1e-3)
    # The exact relation between the two velocities, whatever the stiffness.
    rate, e = 1.5 * dissipation * speed, found["guide.velocity"][-1] / speed
    assert math.log((1 + rate) / (1 - rate * e)) == pytest.approx(rate * (1 + e), rel=2e-3)


@modes
@pytest.mark.parametrize("depth", [0.001, 0.01, 0.02])
def test_the_force_of_hertz(depth: float, mode: Mode) -> None:
    height = {"center_height": 0.04 - depth, "radius": 0.04, "stiffness": 2e6, "weight": 800.0}
    half = 0.5 * 2e6 ** (2 / 3)
    hertz = 4 / 3 * half * depth * math.sqrt(0.04 * half * depth)
    assert computed("contact/hunt_crossley", mode, **height).force == pytest.approx(hertz, rel=1e-12)
    going = computed("contact/hunt_crossley", mode, **height, velocity=-0.3, dissipation=2.0)
    assert going.force == pytest.approx(hertz * 1.9, rel=1e-12)
    assert going.load == pytest.approx(hertz * 1.9 / 800, rel=1e-12)
    assert computed("contact/hunt_crossley", mode, **height, velocity=0.4, dissipation=2.0).force == 0
    blend = 0.5 + 0.5 * math.tanh(300 * depth)
    rounded = 4 / 3 * half * math.sqrt(depth**2 + 1e-5) * math.sqrt(0.04 * half * math.sqrt(depth**2 + 1e-5))
    assert computed("contact/hunt_crossley", mode, **height, smooth=1.0).force == pytest.approx(
        rounded * blend * (0.5 + 0.5 * math.tanh(50 * 2 / 3)), rel=1e-9
    )


@modes
@pytest.mark.parametrize("slip", [0.001, 0.05, 0.1, 0.3, -2.0])
def test_friction_of_hunt_crossley(slip: float, mode: Mode) -> None:
    tables = Trial(primitive("contact/hunt_crossley"))
    tables.put({"center_height": 0.02, "weight": 800.0, "slip_velocity": slip})
    assert not tables.call("output", mode)
    ratio = abs(slip) / 0.1
    law = tables.y.force * (min(ratio, 1) * (0.8 + 0.2 / (1 + ratio**2)) + 0.6 * abs(slip))
    assert tables.y.friction_force == pytest.approx(-math.copysign(law, slip), rel=1e-12)


@modes
def test_what_hunt_crossley_reports_and_what_acted(mode: Mode) -> None:
    """The force of this instant, its velocity half a step further; what acted had the velocity of the step's end."""
    tables = Trial(primitive("contact/hunt_crossley"))

    def step(height: float, velocity: float, slip: float) -> Any:
        tables.put({"center_height": height, "velocity": velocity, "slip_velocity": slip, "weight": 800.0})
        assert not tables.call("output", mode)
        found = {name: getattr(tables.y, name) for name in ("spring", "drag", "force", "load", "friction_force")}
        acted = tables.y.applied_force, tables.y.applied_friction_force
        assert not tables.call("update", mode)
        return found, acted

    first, nothing = step(0.024, -0.4, 0.2)
    assert nothing == (0, 0)
    assert first["force"] == pytest.approx(first["spring"] * 1.6, rel=1e-12)
    second, acted = step(0.0232, -0.2, 0.1)
    assert acted == (pytest.approx(first["spring"] * 1.3), pytest.approx(-first["drag"] * 0.1))
    assert second["force"] == pytest.approx(second["spring"] * (1 + 1.5 * 0.1), rel=1e-12)  # 0.1 m/s, half a step later
    assert second["load"] == pytest.approx(second["force"] / 800, rel=1e-12)
    assert second["friction_force"] == pytest.approx(-second["drag"] * 0.1, rel=1e-12)


@modes
def test_stiction_and_sliding_of_geyer2010(mode: Mode) -> None:
    tables = Trial(primitive("contact/geyer2010"))

    def step(position: float, slip: float, height: float = -0.01) -> Any:
        tables.put({"position": position, "slip_velocity": slip, "place_height": height, "weight": WEIGHT})
        assert not tables.call("output", mode)
        assert not tables.call("update", mode)
        return tables.y

    assert step(2.0, 0.1, height=0.001).in_contact == 0
    now = step(2.0, 0.1)  # touchdown: it sticks to where it is
    assert (now.sticks, now.anchor, now.shear_spring, now.spring) == (1, 2.0, 0, pytest.approx(WEIGHT))
    now = step(2.01, 0.06)
    assert now.shear_spring == pytest.approx(-WEIGHT / 0.1 * 0.01)
    now = step(2.01, 0.06)  # the law: -k_x dx (1 + sgn(dx) x' / v_x)
    assert now.friction_force == pytest.approx(-WEIGHT * 0.1 * 3)
    assert now.sticks == 1
    now = step(2.01, -0.06)
    assert now.friction_force == pytest.approx(-WEIGHT * 0.1 * (1 - 2))
    now = step(2.01, 0.3)  # 1.1 body weights are more than 0.9
    assert (now.sticks, now.shear_spring) == (0, 0)
    now = step(2.02, 0.3)
    assert now.friction_force == pytest.approx(-0.8 * WEIGHT)
    now = step(2.02, -0.3)
    assert now.friction_force == pytest.approx(0.8 * WEIGHT)
    now = step(2.05, 0.009)  # slow enough: it sticks where it is now
    assert (now.sticks, now.anchor, now.shear_spring) == (1, 2.05, 0)
    assert step(2.05, 0.0, height=0.001).in_contact == 0
    assert step(2.2, 5.0).anchor == 2.2


BLOCK = """
gaitsim: 1
use_for: {terrain: {use: terrain/slope, angle: ANGLE}}
parts:
  block: {use: segment/rod, mass: 80 kg, length: 10 m, center_of_mass: 0, radius_of_gyration: 1}
  root: {use: joint/planar, parent: world, child: block.center}
  ground: {use: contact/CONTACT, frame: block.center}
initial: {root.forward_velocity: 0 m/s}
simulate: {duration: 1.5 s, step: 1 ms}
"""


def block(folder: Path, contact: str, angle: float) -> dict[str, Any]:
    """Signals on a slope, and the velocity up the slope."""
    found = played(BLOCK, folder, CONTACT=CONTACTS[contact][0], ANGLE=f"{angle} deg")
    inner = "ground.sphere" if contact == "yielding_sole" else "ground"
    along = found["root.forward_velocity"] * math.cos(math.radians(angle))
    along = along + found["root.upward_velocity"] * math.sin(math.radians(angle))
    signals = {name: found[f"{inner}.{name}"] for name in ("force", "friction_force", "position", "in_contact")}
    return {**signals, "along": along}


@pytest.mark.parametrize("contact", [name for name in CONTACTS if name != "spring_damper"])
@pytest.mark.parametrize("angle", [5, -10])
def test_a_block_rests_on_a_slope(tmp_path: Path, contact: str, angle: float) -> None:
    found = block(tmp_path, contact, angle)
    assert found["force"][-200:].mean() == pytest.approx(WEIGHT * math.cos(math.radians(angle)), rel=2e-3)
    assert found["friction_force"][-200:].mean() == pytest.approx(WEIGHT * math.sin(math.radians(angle)), rel=5e-3)


def test_stiction_holds_up_to_its_friction_and_not_beyond(tmp_path: Path) -> None:
    held, sliding = block(tmp_path, "geyer2010", 30), block(tmp_path, "geyer2010", 46)
    assert math.tan(math.radians(30)) < 0.8 and math.tan(math.radians(46)) > 0.9
    # Shear alone, 10 cm for a weight, and what it slid while the ground was taking its weight.
    assert abs(held["along"][-1]) < 0.01 and held["position"][-1] > -0.07
    angle = math.radians(46)
    gained = (sliding["along"][-1] - sliding["along"][-501]) / 0.5
    assert gained == pytest.approx(-9.81 * (math.sin(angle) - 0.8 * math.cos(angle)), rel=0.02)


@pytest.mark.parametrize("angle", [5, 20])
def test_regularised_friction_creeps(tmp_path: Path, angle: float) -> None:
    def friction(speed: float) -> float:
        return min(speed / 0.1, 1) * (0.8 + 0.2 / (1 + (speed / 0.1) ** 2)) + 0.6 * speed

    low, high = 0.0, 0.1
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if friction(middle) < math.tan(math.radians(angle)) else (low, middle)
    assert -block(tmp_path, "hunt_crossley", angle)["along"][-1] == pytest.approx(low, rel=0.01)


@pytest.mark.parametrize("mass", ["0.3 kg", "1.25 kg", "80 kg"])
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("fall", [0.01, 0.1])
def test_no_contact_adds_energy_at_its_largest_step(tmp_path: Path, contact: str, mass: str, fall: float) -> None:
    law, touch = CONTACTS[contact]
    kind = primitive("contact/mujoco" if contact == "yielding_sole" else f"contact/{law.split(',')[0]}")
    step = 1e3 * kind.largest_step
    for part in (1.0, 0.5, 0.25):
        found = drop(tmp_path, law, touch + fall, MASS=mass, STEP=f"{part * step:g} ms")
        struck = int(np.argmin(found["guide.velocity"]))
        impact = -found["guide.velocity"][struck]
        assert impact > 0.1
        assert found["guide.velocity"][struck:].max() <= 1.002 * impact


LANDING = """
gaitsim: 1
parts:
  rest: {use: segment/point_mass, mass: 78.75 kg, radius: 0.3 m}
  root: {use: joint/planar, parent: world, child: rest.center}
  foot: {use: segment/foot_geyer2010}
  ankle:
    {use: joint/geyer2010, parent: rest.center, child: foot.ankle, neutral: 90 deg, grows: backwards, lower: 70 deg,
     upper: 130 deg}
  ball: {use: contact/CONTACT, frame: foot.ball}
  heel: {use: contact/CONTACT, frame: foot.heel}
  energy: {use: sensor/mechanical_energy}
initial: {root.z: HEIGHT, root.upward_velocity: SPEED, root.forward_velocity: FORWARD, ankle.angle: ANGLE}
simulate: {duration: DURATION, step: STEP}
"""
RIGHT = {
    "geyer2010": 0.04,
    "spatial_geyer2010": 0.04,
    "hunt_crossley": 0.01,
    "spatial_hunt_crossley": 0.01,
    "mujoco": 0.05,
    "spring_damper": 0.01,
}
STANDING = ["geyer2010", "spatial_geyer2010", "hunt_crossley", "spatial_hunt_crossley", "mujoco", "yielding_sole"]


def landing(folder: Path, contact: str, step: str) -> tuple[float, float]:
    """The peak force of a landing on the heel in weights, and the energy lost."""
    law, touch = CONTACTS[contact]
    words = {"SPEED": "-0.5 m/s", "FORWARD": "1 m/s", "ANGLE": "75 deg", "DURATION": "0.3 s"}
    found = played(LANDING, folder, **words, CONTACT=law, HEIGHT=f"{touch + 0.012} m", STEP=step)
    stored = found["heel.energy"] + found["ball.energy"] + found["energy.total"]
    return float((found["heel.force"] + found["ball.force"]).max() / WEIGHT), float(stored[0] - stored[-1])


@pytest.mark.parametrize("contact", RIGHT)
def test_a_landing_is_right_at_the_largest_step(tmp_path: Path, contact: str) -> None:
    exact, lost = landing(tmp_path, contact, "0.02 ms")
    largest = primitive(f"contact/{contact}").largest_step
    peak, loss = landing(tmp_path, contact, f"{1e3 * largest:g} ms")
    assert peak == pytest.approx(exact, rel=RIGHT[contact])
    assert loss == pytest.approx(lost, rel=1e-3)


@pytest.mark.parametrize("contact", STANDING)
@pytest.mark.parametrize("step", ["1 ms", "0.25 ms"])
def test_a_foot_stands_without_noise(tmp_path: Path, contact: str, step: str) -> None:
    law, touch = CONTACTS[contact]
    words = {"SPEED": "0 m/s", "FORWARD": "0 m/s", "ANGLE": "90 deg", "DURATION": "2 s"}
    found = played(LANDING, tmp_path, **words, CONTACT=law, HEIGHT=f"{touch} m", STEP=step)
    inner = ".sphere" if contact == "yielding_sole" else ""
    heel, ball = (found[f"{name}{inner}.load"][-500:] for name in ("heel", "ball"))
    assert (heel + ball).mean() == pytest.approx(1, abs=1e-3)
    # The ankle is a fifth of the sole from the heel, the foot's own weight a little in front of it.
    assert ball.mean() == pytest.approx((78.75 * 0.04 + 1.25 * 0.06) / 0.2 / 80, abs=2e-3)
    assert heel.std() < 1e-4 and ball.std() < 1e-4
