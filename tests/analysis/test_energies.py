from __future__ import annotations

import numpy as np
import pytest

from gaitsim.analysis.energies import Balance, balance, energy_figures
from tests.analysis.replays import cut, of_spec, of_text

BALL = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: 2 kg}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/spring_damper, frame: ball.center, stiffness: 20 kN/m, damping: 0 N s/m}
  energy: {use: sensor/mechanical_energy}
initial: {guide.position: 0.5 m}
simulate: {duration: 2 s, step: 0.02 ms}
"""
PUSHED = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: rod.proximal, damping: 0.5 N m s/rad}
  push:
    use: controller/pid
    proportional: 60 N m/rad
    setpoint: 90 deg
    angle: {from: pivot.angle}
    angular_velocity: {from: pivot.velocity}
    to: pivot.torque
  energy: {use: sensor/mechanical_energy}
simulate: {duration: 2 s, step: 0.02 ms}
"""


def test_a_bounce_without_friction_keeps_its_energy() -> None:
    found = balance(of_text(BALL))
    assert found is not None
    assert set(found.stored) == {"kinetic", "potential", "elastic, ground"}
    assert found.total[0] == pytest.approx(2 * 9.81 * 0.5)
    assert found.total == pytest.approx(found.total[0], abs=0.02)
    assert found.stored["elastic, ground"].max() > 9.81
    assert np.abs(found.residual).max() < 0.02


def test_a_damped_bounce_gives_its_energy_to_the_ground() -> None:
    found = balance(of_text(BALL, [("ground.damping", "40 N s/m")]))
    assert found is not None
    assert set(found.exchanged) == {"ground, damping"}
    lost = found.exchanged["ground, damping"]
    assert np.diff(lost).max() < 1e-3  # it takes and never gives
    assert lost[-1] == pytest.approx(found.change[-1], abs=0.02)
    assert lost[-1] < -4


def test_a_drive_and_a_damper_explain_a_swing() -> None:
    found = balance(of_text(PUSHED))
    assert found is not None
    assert set(found.exchanged) == {"pivot, torque", "pivot, damping"}
    assert found.exchanged["pivot, torque"][-1] > 1
    assert found.exchanged["pivot, damping"][-1] < -1
    assert np.abs(found.residual).max() < 1e-3 * found.turned_over


@pytest.mark.parametrize(("spec", "duration"), [("hopping_geyer2003", "2 s"), ("hopping_leg_mass", "0.5 s")])
def test_the_residual_is_an_error_of_the_step(spec: str, duration: str) -> None:
    coarse, fine = (
        balance(of_spec(spec, [("simulate.duration", duration), ("simulate.step", step)]))
        for step in ("0.2 ms", "0.02 ms")
    )
    assert coarse is not None and fine is not None
    # Semi-implicit Euler is of first order: a tenth of the step, a tenth of the residual.
    assert np.abs(fine.residual).max() < 0.2 * np.abs(coarse.residual).max()
    assert np.abs(fine.residual).max() < 2e-3 * fine.turned_over


def test_a_balance_by_hand() -> None:
    stored = {"kinetic": np.array([0.0, 3.0, 1.0]), "potential": np.array([5.0, 1.0, 2.0])}
    found = Balance(stored, {"muscle": np.array([0.0, 1.0, 1.0]), "ground": np.array([0.0, -2.0, -2.5])})
    assert found.total.tolist() == [5, 4, 3]
    assert found.residual.tolist() == pytest.approx([0, 0, -0.5])
    assert found.turned_over == 4


def test_the_figures_name_every_layer_and_say_the_residual() -> None:
    stacked, exchanged = energy_figures(of_spec("hopping_leg_mass", [("simulate.duration", "2 s")]))
    (axes,) = stacked.figure.axes
    labels = axes.get_legend_handles_labels()[1]
    assert {"kinetic", "potential", "elastic, extensor", "elastic, ground", "elastic, knee's stops"} < set(labels)
    assert "total" in labels
    assert axes.get_ylabel() == "energy (J)"
    assert "Residual" in exchanged.caption and "J at the end" in exchanged.caption


def test_without_a_sensor_there_is_no_balance() -> None:
    replay = of_spec("pendulum_pid")
    assert balance(replay) is None
    assert energy_figures(replay) == []


@pytest.mark.parametrize("count", [0, 1, 2])
def test_a_run_of_a_few_instants(count: int) -> None:
    replay = cut(of_spec("hopping_leg_mass", [("simulate.duration", "0.1 s")]), count)
    assert len(energy_figures(replay)) == (0 if count < 2 else 2)
