"""Make h1922_arms.csv: lengths and moment arms of the muscles of H1922 at 200 postures, computed by OpenSim.

The geometry is typed here a second time, from SCONE's H1922v2n.hfd (https://github.com/tgeijten/scone-core,
commit 6a315db7, Apache-2.0), in its axes: x forwards, y up, z to the right. Run it where OpenSim is installed:

    pip install opensim==4.6 && python tests/library/reference/make_h1922_arms.py
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import opensim

POSES = 200
FILE = Path(__file__).with_name("h1922_arms.csv")
COORDINATES = {
    "hip_flexion": (-30, 120),
    "hip_adduction": (-45, 20),
    "hip_rotation": (-45, 45),
    "knee": (-120, 0),
    "ankle": (-60, 25),
}
CROSSED = {
    "hip": ("hip_flexion", "hip_adduction", "hip_rotation"),
    "knee": ("knee",),
    "ankle": ("ankle",),
}
MUSCLES: dict[str, list[tuple[str, tuple[float, float, float]]]] = {
    "gluteus_medius": [("pelvis", (-0.0148, 0.0445, 0.0766)), ("femur", (-0.0258, 0.1642, 0.0527))],
    "adductor_magnus": [("pelvis", (-0.0025, -0.1174, 0.0255)), ("femur", (-0.0045, 0.0489, 0.0339))],
    "hamstrings": [
        ("pelvis", (-0.05526, -0.10257, 0.06944)),
        ("tibia", (-0.028, 0.1667, 0.02943)),
        ("tibia", (-0.021, 0.1467, 0.0343)),
    ],
    "biceps_femoris_short_head": [
        ("femur", (0.005, -0.0411, 0.0234)),
        ("tibia", (-0.028, 0.1667, 0.02943)),
        ("tibia", (-0.021, 0.1467, 0.0343)),
    ],
    "gluteus_maximus": [
        ("pelvis", (-0.0642, 0.0176, 0.0563)),
        ("pelvis", (-0.0669, -0.052, 0.0914)),
        ("femur", (-0.0426, 0.117, 0.0293)),
        ("femur", (-0.0156, 0.0684, 0.0419)),
    ],
    "iliopsoas": [
        ("pelvis", (0.006, 0.0887, 0.0289)),
        ("pelvis", (0.0407, -0.01, 0.076)),
        ("femur", (0.033, 0.135, 0.0038)),
        ("femur", (-0.0188, 0.1103, 0.0104)),
    ],
    "rectus_femoris": [
        ("pelvis", (0.0412, -0.0311, 0.0968)),
        ("femur", (0.038, -0.17, 0.004)),
        ("tibia", (0.038, 0.2117, 0.0018)),
    ],
    "vasti": [
        ("femur", (0.029, -0.0224, 0.031)),
        ("femur", (0.038, -0.17, 0.007)),
        ("tibia", (0.038, 0.2117, 0.0018)),
    ],
    "gastrocnemius": [("femur", (-0.02, -0.218, -0.024)), ("calcn", (-0.095, 0.001, -0.0053))],
    "soleus": [("tibia", (-0.0024, 0.0334, 0.0071)), ("calcn", (-0.095, 0.001, -0.0053))],
    "tibialis_anterior": [
        ("tibia", (0.0179, 0.0243, 0.0115)),
        ("tibia", (0.0329, -0.2084, -0.0177)),
        ("calcn", (0.0166, -0.0122, -0.0305)),
    ],
}
PLACES = {"pelvis": 0, "femur": 1, "tibia": 2, "calcn": 3}
JOINTS = ("hip", "knee", "ankle")


def crossed(muscle: str) -> list[str]:
    """The coordinates that a muscle crosses."""
    bodies = [PLACES[body] for body, _ in MUSCLES[muscle]]
    return [name for joint in JOINTS[min(bodies) : max(bodies)] for name in CROSSED[joint]]


def leg(model: Any, side: str) -> None:
    """One leg below the pelvis; the left one is the mirror of the right one, in places and axes."""
    turn = 1 if side == "r" else -1

    def place(x: float, y: float, z: float) -> Any:
        return opensim.Vec3(x, y, turn * z)

    bodies = {"pelvis": model.getBodySet().get("pelvis")}
    for name, mass in (("femur", 9.3), ("tibia", 3.7), ("calcn", 1.25)):
        bodies[name] = opensim.Body(f"{name}_{side}", mass, opensim.Vec3(0), opensim.Inertia(0.1, 0.1, 0.1))
        model.addBody(bodies[name])
    still = opensim.Vec3(0)
    transform = opensim.SpatialTransform()
    axes = {"hip_flexion": (0, 0, 1), "hip_adduction": (turn, 0, 0), "hip_rotation": (0, turn, 0)}
    for i, (name, axis) in enumerate(axes.items()):
        transform.updTransformAxis(i).setCoordinateNames(opensim.ArrayStr(f"{name}_{side}", 1))
        transform.updTransformAxis(i).setAxis(opensim.Vec3(*axis))
        transform.updTransformAxis(i).set_function(opensim.LinearFunction(1, 0))
    hip = opensim.CustomJoint(
        f"hip_{side}",
        bodies["pelvis"],
        place(0, -0.0661, 0.0835),
        still,
        bodies["femur"],
        place(0, 0.17, 0),
        still,
        transform,
    )
    knee = opensim.PinJoint(
        f"knee_{side}", bodies["femur"], place(0, -0.226, 0), still, bodies["tibia"], place(0, 0.1867, 0), still
    )
    toes = place(-0.05123, 0.01195, -0.00792)
    ankle = opensim.PinJoint(
        f"ankle_{side}", bodies["tibia"], place(0, -0.2433, 0), still, bodies["calcn"], toes, still
    )
    for name, joint in (("knee", knee), ("ankle", ankle)):
        joint.updCoordinate().setName(f"{name}_{side}")
    for joint in (hip, knee, ankle):
        model.addJoint(joint)
    for name, points in MUSCLES.items():
        path = opensim.PathActuator()
        path.setName(f"{name}_{side}")
        for i, (body, at) in enumerate(points):
            path.addNewPathPoint(f"{name}_{side}_{i}", bodies[body], place(*at))
        model.addForce(path)


def model_of_h1922() -> Any:
    """Pelvis, two legs and the paths of their muscles."""
    model = opensim.Model()
    pelvis = opensim.Body("pelvis", 11.777, opensim.Vec3(0), opensim.Inertia(0.1, 0.1, 0.1))
    model.addBody(pelvis)
    model.addJoint(opensim.WeldJoint("root", model.getGround(), pelvis))
    for side in ("r", "l"):
        leg(model, side)
    model.finalizeConnections()
    return model


def row_of(model: Any, state: Any, side: str, pose: dict[str, float]) -> list[float]:
    """Lengths of all muscles of a side, and their moment arms in the order of `crossed`."""
    coordinates = {name: model.getCoordinateSet().get(f"{name}_{side}") for name in pose}
    for name, angle in pose.items():
        coordinates[name].setValue(state, angle, False)
    model.realizePosition(state)
    found = []
    for muscle in MUSCLES:
        path = opensim.PathActuator.safeDownCast(model.getForceSet().get(f"{muscle}_{side}")).getGeometryPath()
        found.append(path.getLength(state))
        found += [path.computeMomentArm(state, coordinates[name]) for name in crossed(muscle)]
    return found


def main() -> None:
    """Write the table."""
    model = model_of_h1922()
    state = model.initSystem()
    generator = np.random.default_rng(1922)
    rows = []
    for _ in range(POSES):
        pose = {name: float(np.round(np.radians(generator.uniform(*ends)), 6)) for name, ends in COORDINATES.items()}
        right, left = (row_of(model, state, side, pose) for side in ("r", "l"))
        assert np.allclose(right, left, rtol=0, atol=1e-12), "the left leg is not the mirror of the right one"
        rows.append([*pose.values(), *right])
    heads = [*COORDINATES]
    for muscle in MUSCLES:
        heads += [f"{muscle}.length", *(f"{muscle}.{name}" for name in crossed(muscle))]
    with FILE.open("w", encoding="utf-8", newline="") as stream:
        stream.write(
            f"# OpenSim {opensim.GetVersion()}, by make_h1922_arms.py; angles in rad, lengths and arms in m.\n"
        )
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(heads)
        writer.writerows([f"{value:.12g}" for value in row] for row in rows)


if __name__ == "__main__":
    main()
