"""Paths around joints: the muscles of Geyer & Herr (2010) with the published reference angles and arms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import computed

from gaitsim.components.find import Library, library_folders
from gaitsim.errors import InvalidSpec
from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

from .muscle_rig import MUSCLES

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
COSINE, CONSTANT = "path/cosine_arm", "path/constant_arm"
# Muscle, joint: kind of arm, r_0 in m (positive opens the joint), phi_max, phi_ref in deg, rho.
ARMS: dict[tuple[str, str], tuple[str, float, float, float, float]] = {
    ("SOL", "ankle"): (COSINE, 0.05, 110, 80, 0.5),
    ("TA", "ankle"): (COSINE, -0.04, 80, 110, 0.7),
    ("GAS", "ankle"): (COSINE, 0.05, 110, 80, 0.7),
    ("GAS", "knee"): (COSINE, -0.05, 140, 165, 0.7),
    ("VAS", "knee"): (COSINE, 0.06, 165, 125, 0.7),
    ("HAM", "knee"): (COSINE, -0.05, 180, 180, 0.7),
    ("HAM", "hip"): (CONSTANT, 0.08, 0, 155, 0.7),
    ("GLU", "hip"): (CONSTANT, 0.10, 0, 150, 0.5),
    ("HFL", "hip"): (CONSTANT, -0.10, 0, 180, 0.5),
}
REST = 0.3


def published(muscle: str, joint: str, angle: float) -> float:
    """The change of length by the published formulas: S(ref, phi, max) = sin(ref - max) - sin(phi - max)."""
    kind, arm, most, reference, rho = ARMS[muscle, joint]
    if kind == CONSTANT:
        sign = {"HAM": -1, "GLU": -1, "HFL": 1}[muscle]
        return sign * rho * abs(arm) * math.radians(angle - reference)
    if muscle == "TA":  # L - rho r S(110, phi_a, 80)
        change = -(math.sin(math.radians(110 - 80)) - math.sin(math.radians(angle - 80)))
    elif joint == "knee" and muscle in ("GAS", "HAM"):
        change = -(math.sin(math.radians(reference - most)) - math.sin(math.radians(angle - most)))
    else:
        change = math.sin(math.radians(reference - most)) - math.sin(math.radians(angle - most))
    return rho * abs(arm) * change


def path(muscle: str, joint: str, angle: float, mode: str = "rapid", **more: float) -> Any:
    kind, arm, most, reference, rho = ARMS[muscle, joint]
    values = {"moment_arm": arm, "reference_angle": math.radians(reference), "pennation": rho, "reference_length": REST}
    if kind == COSINE:
        values["max_angle"] = math.radians(most)
    return computed(kind, mode, **values, angle=math.radians(angle), **more)


@modes
@pytest.mark.parametrize(("muscle", "joint"), ARMS)
def test_lengths_are_the_published_ones(muscle: str, joint: str, mode: str) -> None:
    for angle in np.linspace(70, 230, 9):
        now = path(muscle, joint, angle, mode)
        assert now.length - REST == pytest.approx(published(muscle, joint, angle), abs=1e-12)


@modes
@pytest.mark.parametrize(("muscle", "joint"), ARMS)
def test_the_moment_is_that_of_the_arm_without_the_pennation_factor(muscle: str, joint: str, mode: str) -> None:
    rho, turn = ARMS[muscle, joint][4], 1e-5
    for angle in (80.0, 110.0, 150.0, 175.0):
        now = path(muscle, joint, angle, mode, tension=1000.0, angular_velocity=2.0)
        before, after = (path(muscle, joint, angle + math.degrees(d)).length for d in (-turn, turn))
        slope = (after - before) / (2 * turn)
        assert now.moment == pytest.approx(-1000 * slope / rho, abs=1e-6)
        assert now.velocity == pytest.approx(2 * slope, abs=1e-9)


POLYNOMIAL = {"moment_arm": 0.04, "arm_slope": -0.013, "arm_curvature": 0.006, "arm_cubic": -0.0021}


@modes
@pytest.mark.parametrize("kind", ["path/polynomial_arm", COSINE, CONSTANT])
def test_force_times_shortening_is_moment_times_turning(kind: str, mode: str) -> None:
    """Work over an arc and power at its ends; the arms of the paper agree without their pennation factor."""
    values = {"moment_arm": 0.04, "reference_length": REST, "reference_angle": 1.1}
    values |= {"path/polynomial_arm": POLYNOMIAL, COSINE: {"max_angle": 1.4}, CONSTANT: {}}[kind]

    def at(angle: float) -> Any:
        return computed(kind, mode, **values, angle=angle, angular_velocity=2.5, tension=700.0)

    begin, end = 0.3, 1.9
    nodes, weights = np.polynomial.legendre.leggauss(20)
    moments = [at(0.5 * (begin + end) + 0.5 * (end - begin) * node).moment for node in nodes]
    turning = 0.5 * (end - begin) * float(weights @ moments)
    assert 700 * (at(begin).length - at(end).length) == pytest.approx(turning, abs=1e-12)
    assert 700 * at(0.7).velocity + 2.5 * at(0.7).moment == pytest.approx(0, abs=1e-12)


@modes
def test_a_polynomial_arm_by_its_equation(mode: str) -> None:
    values = {**POLYNOMIAL, "reference_length": REST, "reference_angle": 1.1}
    now = computed("path/polynomial_arm", mode, **values, angle=1.6, tension=700.0)
    assert now.moment == pytest.approx(700 * (0.04 - 0.013 * 0.5 + 0.006 * 0.25 - 0.0021 * 0.125), abs=1e-12)
    change = 0.04 * 0.5 - 0.013 * 0.125 + 0.002 * 0.125 - 0.0021 * 0.0625 / 4
    assert now.length == pytest.approx(REST - change, abs=1e-12)


@pytest.mark.parametrize(
    ("muscle", "joint", "longer"),
    [
        ("HFL", "hip", True),
        ("GLU", "hip", False),
        ("HAM", "hip", False),
        ("SOL", "ankle", False),
        ("GAS", "ankle", False),
        ("TA", "ankle", True),
        ("VAS", "knee", False),
        ("GAS", "knee", True),
        ("HAM", "knee", True),
    ],
)
def test_extending_a_joint_lengthens_its_flexors_and_shortens_its_extensors(
    muscle: str, joint: str, longer: bool
) -> None:
    low, high = {"ankle": (75, 110), "knee": (130, 175), "hip": (150, 190)}[joint]
    change = path(muscle, joint, high).length - path(muscle, joint, low).length
    assert (change > 0) == longer
    moment = path(muscle, joint, 0.5 * (low + high), tension=1000.0).moment
    assert (moment < 0) == longer


HINGES = """
gaitsim: 1
parts:
  thigh: {use: segment/rod, mass: 8 kg, length: 0.5 m}
  shank: {use: segment/rod, mass: 4 kg, length: 0.5 m}
  hip: {use: joint/geyer2010, parent: world, child: thigh.proximal, grows: backwards, neutral: 180 deg}
  knee: {use: joint/geyer2010, parent: thigh.distal, child: shank.proximal, grows: forwards, neutral: 180 deg}
  hamstrings:
    use: muscle/MUSCLE
    max_isometric_force: 3 kN
    optimal_fiber_length: {value: 10 cm, tune: [8 cm, 12 cm]}
    tendon_slack_length: 31 cm
    excitation: 0.2
    path:
      use: path/two_joints
      first: {use: path/constant_arm, joint: hip, moment_arm: 8 cm, reference_angle: 155 deg, pennation: 0.7}
      second: {joint: knee, moment_arm: -5 cm, max_angle: 180 deg, reference_angle: 180 deg, pennation: 0.7}
initial: {hip.angle: 160 deg, knee.angle: 150 deg}
simulate: {duration: 20 ms, step: 0.5 ms}
"""


def made(folder: Path, text: str) -> Model:
    spec = folder / "spec.yaml"
    spec.write_text(text, encoding="utf-8")
    return resolve(read_spec(spec), Library(library_folders(spec)), "spec")


@modes
@pytest.mark.parametrize("muscle", [muscle for muscle in MUSCLES if muscle != "geyer2003"])
def test_a_muscle_across_two_joints(muscle: str, mode: Any, tmp_path: Path) -> None:
    found = Simulator(made(tmp_path, HINGES.replace("MUSCLE", muscle)), mode).run(recorded=True).trajectory
    assert found is not None
    change = published("HAM", "hip", 160) + published("HAM", "knee", 150)
    assert found["hamstrings.path.length"][0] == pytest.approx(0.41 + change, abs=1e-12)
    rates = found["hamstrings.path.first.velocity"] + found["hamstrings.path.second.velocity"]
    assert found["hamstrings.path.velocity"] == pytest.approx(rates)
    assert found["hamstrings.path.first.moment"] == pytest.approx(0.08 * found["hamstrings.force"])
    bent = np.cos(found["knee.angle"] - math.pi)
    assert found["hamstrings.path.second.moment"] == pytest.approx(-0.05 * bent * found["hamstrings.force"])


def test_the_rest_length_follows_the_tuned_fiber(tmp_path: Path) -> None:
    model = made(tmp_path, HINGES.replace("MUSCLE", "geyer2010"))
    index = {number.address: i for i, number in enumerate(model.numbers)}
    for fiber in (0.08, 0.1, 0.12):
        values = model.values([fiber])
        for inner in ("", "first.", "second."):
            assert values[index[f"hamstrings.path.{inner}reference_length"]] == pytest.approx(fiber + 0.31)


def test_pennate_fibers_are_shorter_along_the_path(tmp_path: Path) -> None:
    text = HINGES.replace("MUSCLE", "millard2012\n    pennation_angle: 60 deg")
    model = made(tmp_path, text)
    index = {number.address: i for i, number in enumerate(model.numbers)}
    assert model.values()[index["hamstrings.path.reference_length"]] == pytest.approx(0.05 + 0.31)


def test_a_length_that_the_spec_sets_stays(tmp_path: Path) -> None:
    text = HINGES.replace("MUSCLE", "geyer2010")
    text = text.replace("use: path/two_joints", "use: path/two_joints\n      reference_length: 0.4 m")
    model = made(tmp_path, text)
    index = {number.address: i for i, number in enumerate(model.numbers)}
    assert model.values()[index["hamstrings.path.reference_length"]] == 0.4
    assert model.values()[index["hamstrings.path.first.reference_length"]] == 0.4


def test_moments_reach_the_joints(tmp_path: Path) -> None:
    model = made(tmp_path, HINGES.replace("MUSCLE", "geyer2010"))
    wires = {(c.sender, c.target, c.made_by) for c in model.connections}
    for inner, joint in (("first", "hip"), ("second", "knee")):
        part = f"hamstrings.path.{inner}"
        assert (f"{part}.moment", f"{joint}.moment", part) in wires
        assert (f"{joint}.angle", f"{part}.angle", part) in wires
        assert (f"{joint}.angular_velocity", f"{part}.angular_velocity", part) in wires


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        ("ankel", "there is no part ankel here. "),
        ("thigh", "there is no output thigh.angle. "),
        ("3", "joint names a part; write such as joint: ankle."),
    ],
)
def test_a_joint_that_is_none(joint: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidSpec) as error:
        made(tmp_path, HINGES.replace("MUSCLE", "geyer2010").replace("joint: hip", f"joint: {joint}"))
    assert any(said in fault.message for fault in error.value.faults)


def test_a_joint_that_is_wired_twice(tmp_path: Path) -> None:
    text = HINGES.replace("MUSCLE", "geyer2010").replace("joint: hip,", "joint: hip, angle: {from: knee.angle},")
    with pytest.raises(InvalidSpec, match="takes one sender and has 2"):
        made(tmp_path, text)
