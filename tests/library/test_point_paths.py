"""Paths through points in space: lengths and moment arms of H1922's muscles against OpenSim's at 200 postures."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from gaitsim.components.find import Library, library_folders
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

from .plane import body_of

REFERENCE = Path(__file__).parent / "reference" / "h1922_arms.csv"
JOINTS = ("hip_flexion", "hip_adduction", "hip_rotation", "knee", "ankle")


def table() -> list[dict[str, float]]:
    with REFERENCE.open(encoding="utf-8") as stream:
        assert next(stream).startswith("# OpenSim 4.6")
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]


@pytest.fixture(scope="module")
def physics() -> Any:
    spec = shipped_folder().parent / "specs" / "walking_scone_h1922.yaml"
    simulator = Simulator(resolve(read_spec(spec), Library(library_folders(spec)), "h1922"))
    found = body_of(simulator)
    found.pose(simulator.model.values())
    return found


def jacobian(model: Any, data: Any) -> Any:
    """How each tendon's length changes with each coordinate: a full matrix, whatever MuJoCo keeps."""
    full = np.zeros((model.ntendon, model.nv))
    mujoco.mju_sparse2dense(full, data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind)
    return full


@pytest.mark.parametrize("side", ["l", "r"])
def test_lengths_and_moment_arms_are_those_of_opensim(physics: Any, side: str) -> None:
    model, data = physics.model, physics.data
    rows = table()
    assert len(rows) == 200
    worst = 0.0
    for row in rows:
        for name in JOINTS:
            data.qpos[model.joint(f"leg_{side}.{name}").qposadr] = row[name]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_tendon(model, data)
        arms = -jacobian(model, data)
        for name, value in row.items():
            muscle, _, what = name.partition(".")
            if not what:
                continue
            tendon = model.tendon(f"leg_{side}.{muscle}.path").id
            joint = None if what == "length" else model.joint(f"leg_{side}.{what}").dofadr[0]
            found = data.ten_length[tendon] if joint is None else arms[tendon, joint]
            worst = max(worst, abs(float(found) - value))
    assert worst < 1e-9


def test_a_muscle_moves_only_what_it_crosses(physics: Any) -> None:
    model, data = physics.model, physics.data
    arms = jacobian(model, data)
    crossed = {name.partition(".")[::2] for name in table()[0] if "." in name}
    for t in range(model.ntendon):
        leg, muscle, _ = model.tendon(t).name.split(".")
        moved = {model.joint(int(model.dof_jntid[d])).name for d in np.flatnonzero(np.abs(arms[t]) > 1e-12)}
        moved = {joint for joint in moved if joint.partition(".")[2] in JOINTS}  # knee and ankle also yield
        assert moved <= {f"{leg}.{joint}" for name, joint in crossed if name == muscle}


def test_the_body_has_the_published_mass(physics: Any) -> None:
    assert physics.model.body_subtreemass[0] == pytest.approx(74.5314, abs=1e-9)
    assert physics.model.nv == 19 + 8
