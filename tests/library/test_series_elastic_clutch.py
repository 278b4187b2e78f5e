"""The clutch in series with a spring, and the gates of a leg of the Endo-Herr type."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from components.calls import FOLDER, computed
from simulation.models import ROOT

from gaitsim.components.find import Library
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.study.opening import Opening
from gaitsim.text.document import parse

from .play import played

CLUTCH, GATES = "muscle/series_elastic_clutch", "controller/clutch_gates"
K = 50_000.0  # N/m
SIZES = {
    "max_isometric_force": 1500.0,
    "optimal_fiber_length": 0.05,
    "tendon_slack_length": 0.35,
    "max_contraction_velocity": 12.0,
    "stiffness": K,
}
WALKER = ROOT / "specs" / "walking_endo_herr.yaml"
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def pulled(lengths: Sequence[float], gate: Sequence[float], mode: Mode = "rapid") -> dict[str, np.ndarray]:
    """Outputs while the path has these lengths, in m, and the gate these values."""
    found = played(CLUTCH, {"path_length": lengths, "excitation": gate}, mode, **SIZES)
    return {name: np.array(values) for name, values in found.items()}


def work_on(force: np.ndarray, length: Sequence[float]) -> float:
    """What was put into a spring, exactly where force is straight over length."""
    return float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(length)))


@modes
def test_slack_is_taken_up_without_force_and_stretch_is_held(mode: Mode) -> None:
    found = pulled([0.40, 0.41, 0.41, 0.39, 0.40, 0.42], [0, 0, 1, 1, 1, 1], mode)
    # Engaged at 41 cm, slack down to 39 cm, then held.
    assert found["force"] == pytest.approx([0, 0, 0, 0, 0.01 * K, 0.03 * K])
    assert found["stretch"] == pytest.approx([0, 0, 0, 0, 0.01, 0.03])
    assert found["elastic_energy"] == pytest.approx([0, 0, 0, 0, 0.5 * K * 0.01**2, 0.5 * K * 0.03**2])
    assert found["fiber_length"] == pytest.approx([0.05, 0.06, 0.06, 0.04, 0.04, 0.04])
    assert found["normalized_path_length"] == pytest.approx([1, 1.2, 1.2, 0.8, 1, 1.4])


@modes
def test_a_closed_cycle_returns_its_energy(mode: Mode) -> None:
    lengths = [0.40, 0.405, 0.41, 0.425, 0.41, 0.40, 0.395, 0.38, 0.39, 0.43, 0.39, 0.38, 0.40, 0.38]
    found = pulled(lengths, [1] * len(lengths), mode)
    turnover = float(np.sum(np.abs(np.diff(found["elastic_energy"]))))
    assert turnover > 100
    assert work_on(found["force"], lengths) == pytest.approx(0, abs=1e-12 * turnover)
    assert found["dissipated_energy"][-1] == 0


@modes
def test_a_clutch_that_is_released_under_load_books_exactly_what_it_held(mode: Mode) -> None:
    lengths, gate = [0.40, 0.40, 0.42, 0.43, 0.43, 0.43, 0.44], [1, 1, 1, 1, 0, 1, 1]
    found = pulled(lengths, gate, mode)
    held = 0.5 * K * 0.03**2
    assert found["elastic_energy"][3] == pytest.approx(held, rel=1e-12)
    assert found["dissipated_energy"] == pytest.approx([0] * 5 + [held] * 2, rel=1e-12)
    assert found["force"][4:] == pytest.approx([0, 0, 0.01 * K])  # engaged anew, it holds from there
    put_in = work_on(found["force"][:4], lengths[:4])
    assert put_in == pytest.approx(found["dissipated_energy"][-1], rel=1e-12)


def test_for_metabolics_it_is_an_isometric_source_whose_part_in_use_is_active() -> None:
    found = pulled([0.40, 0.40, 0.41, 0.45], [1, 1, 1, 1])
    assert found["normalized_force"] == pytest.approx([0, 0, 1 / 3, 5 / 3])
    assert found["activation"] == pytest.approx([0, 0, 1 / 3, 1])
    assert not np.any(found["fiber_velocity"])
    assert np.all(found["normalized_isometric_force"] == 1)
    model = Opening(WALKER, tuned=False).open().model()
    sent = {c.target: c.sender for c in model.connections}
    assert sent["leg_r.vastus.metabolics.excitation"] == "leg_r.vastus.activation"


def test_moment_times_angle_is_force_times_length_along_every_path_of_a_clutch() -> None:
    model = Opening(WALKER, tuned=False).open().model()
    values = model.values()
    clutches = [part.address for part in model.parts if part.type.reference == CLUTCH]
    assert len(clutches) == 10
    paths = [p for p in model.parts if p.type.kind == "path" and p.address.startswith(tuple(clutches))]
    around = [p for p in paths if "angle" in p.type.inputs]
    assert len(around) == 16
    for path in around:
        given = {name: values[index] for name, index in path.numbers.items()}
        for angle in np.linspace(1.2, 3.5, 8):
            now = computed(path.type.reference, **given, angle=angle, angular_velocity=3.0, tension=700.0)
            assert now.moment * 3.0 == pytest.approx(-700.0 * now.velocity, rel=1e-12)


SPEC = """
gaitsim: 1
parts:
  unit:
    use: muscle/series_elastic_clutch
    max_isometric_force: 1500 N
    optimal_fiber_length: 5 cm
    tendon_slack_length: 35 cm
    stiffness: 5 kN/m
    metabolics: {use: metabolics/uchida2016}
    path: {use: path/sites, points: [{on: world, at: [0 m, 0 m, 1 m]}, {on: load.center, at: [0 m, 0 m, 0 m]}]}
  gate: {use: controller/phase_window, begins: 6 %, ends: 53 %, phase: {from: cycle.phase}, to: unit.excitation}
  cycle: {use: controller/clock, period: 1 s}
  load: {use: segment/point_mass, mass: 10 kg}
  guide: {use: joint/vertical, parent: world, child: load.center}
  energy: {use: sensor/mechanical_energy}
initial: {guide.position: 60 cm}
simulate: {duration: 0.6 s, step: 0.05 ms}
"""


def test_a_weight_that_bounces_on_it_keeps_its_energy_until_the_clutch_is_released() -> None:
    outcome = Simulator(resolve(parse(SPEC, "spec.yaml"), Library((FOLDER,)), "spec")).run(recorded=True)
    made = outcome.trajectory
    assert outcome.status == "completed" and made is not None
    held, energy = made["unit.force"] > 0, made["energy.total"] + made["unit.elastic_energy"]
    first, last = np.flatnonzero(held)[[0, -1]]
    assert made.times[[first, last]] == pytest.approx([0.06, 0.53], abs=1e-4)
    lost = made["unit.dissipated_energy"][-1]
    turnover = np.ptp(made["unit.elastic_energy"])
    assert turnover > 5 and lost > 0.5
    assert np.ptp(energy[: last + 1]) < 1e-3 * turnover
    assert energy[0] - energy[-1] == pytest.approx(lost, abs=1e-3 * turnover)


THRESHOLDS = {
    "gastrocnemius_direction": math.radians(85),
    "rectus_femoris_direction": math.radians(86),
    "hamstrings_release": math.radians(88),
    "hamstrings_knee": math.radians(140),
    "biceps_femoris_knee": math.radians(172),
}
# in stance, trailing, hip, knee in deg, knee extends: VAS GAS RF HAM BFSH in the instant after
STRIDE = (
    ((0, 0, 160, 110, -1), (0, 0, 1, 0, 0)),  # swing, the knee bends
    ((0, 0, 150, 130, 1), (0, 0, 1, 0, 0)),  # it extends
    ((0, 0, 145, 150, 1), (0, 0, 0, 1, 0)),  # beyond k_HAM
    ((0, 0, 145, 173, 1), (0, 0, 0, 1, 1)),  # beyond k_BFSH
    ((0, 0, 145, 170, -1), (0, 0, 0, 1, 1)),  # held
    ((1, 0, 150, 165, -1), (1, 0, 0, 1, 1)),  # stance, the leg in front
    ((1, 0, 169, 166, -1), (1, 1, 0, 1, 1)),  # a = 86: beyond a_GAS
    ((1, 0, 171, 167, 1), (1, 1, 1, 1, 1)),  # a = 87.5: beyond a_RF
    ((1, 0, 175, 170, 1), (1, 1, 1, 0, 0)),  # a = 90: beyond a_HAM
    ((1, 1, 190, 160, -1), (0, 1, 1, 0, 0)),  # the other leg has landed
    ((0, 0, 190, 140, -1), (0, 0, 1, 0, 0)),  # swing
)


@modes
def test_gates_over_a_stride(mode: Mode) -> None:
    rows = [row for row, _ in STRIDE for _ in range(2)]
    signals = {
        "in_stance": [float(r[0]) for r in rows],
        "in_double_support": [float(r[1]) for r in rows],
        "hip_angle": [math.radians(r[2]) for r in rows],
        "knee_angle": [math.radians(r[3]) for r in rows],
        "knee_angular_velocity": [float(r[4]) for r in rows],
    }
    found = played(GATES, signals, mode, **THRESHOLDS)
    names = ("vastus", "gastrocnemius", "rectus_femoris", "hamstrings", "biceps_femoris")
    told = [tuple(found[name][i] for name in names) for i in range(1, len(rows), 2)]
    assert told == [gates for _, gates in STRIDE]
    assert found["direction"][-1] == pytest.approx(math.radians(120))
