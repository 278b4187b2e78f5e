from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.muscles.energies import Balance, balance, energy_figures
from gaitsim.analysis.replays.replay import replayed
from tests.analysis.replays import cut, of_spec, of_text
from tests.simulation.models import ROOT, model

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
PENNATE = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 4 kg, length: 40 cm}
  pivot: {use: joint/geyer2010, parent: world, child: rod.proximal, grows: backwards, neutral: 90 deg, lower: 70 deg}
  muscle:
    use: muscle/geyer2010
    max_isometric_force: 1500 N
    optimal_fiber_length: 8 cm
    tendon_slack_length: 20 cm
    excitation: 0.2
    path: {use: path/constant_arm, joint: pivot, moment_arm: -4 cm, reference_angle: 90 deg, pennation: 0.5}
  energy: {use: sensor/mechanical_energy}
simulate: {duration: 1 s, step: 0.02 ms}
"""


EXO = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: rod.proximal}
  exo:
    use: device/ankle_spring
    stiffness: 30 N m/rad
    slack_angle: 60 deg
    angle: {from: pivot.angle}
    to: {moment: pivot.torque}
  push:
    use: controller/pid
    proportional: 5 N m/rad
    angle: {from: pivot.angle}
    angular_velocity: {from: pivot.velocity}
    to: pivot.torque
  energy: {use: sensor/mechanical_energy}
simulate: {duration: 2 s, step: 0.02 ms}
"""


def test_a_device_is_in_the_books_beside_another_drive() -> None:
    found = balance(of_text(EXO))
    assert found is not None
    assert found.stored["elastic, exo"].max() > 1
    assert np.abs(found.exchanged.get("exo", np.zeros(1))).max() < 0.01  # a spring gives back what it takes
    assert np.ptp(found.exchanged["pivot, torque"]) > 0.1
    assert np.abs(found.residual).max() < 0.01 * found.turned_over


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


def test_what_a_path_makes_of_nothing_has_a_line_of_its_own() -> None:
    """Half of the arm pulls on the muscle, all of it on the joint: joints get twice what the muscle gives."""
    replay = of_text(PENNATE)
    found = balance(replay)
    assert found is not None
    created, signals = found.exchanged["created at paths"], replay.trajectory
    angle, moment = signals["pivot.angle"], signals["muscle.path.moment"]
    at_joint = np.concatenate([[0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(angle))])
    assert np.ptp(created) > 1
    assert created == pytest.approx(0.5 * at_joint, abs=1e-3 * np.ptp(created))
    assert np.abs(found.residual).max() < 2e-3 * found.turned_over
    assert "Created at paths" in energy_figures(replay)[1].caption


def test_a_path_that_agrees_with_itself_has_no_such_line() -> None:
    replay = of_text(PENNATE, [("muscle.path.pennation", "1")])
    found = balance(replay)
    assert found is not None
    assert set(found.exchanged) == {"muscle, contractile", "pivot, damping"}
    assert np.abs(found.residual).max() < 2e-3 * found.turned_over
    assert "Created at paths" not in energy_figures(replay)[1].caption


@pytest.mark.parametrize("contact", ["hunt_crossley", "geyer2010"])
def test_friction_takes_what_a_sliding_foot_loses(contact: str) -> None:
    """A point that lands with 1 m/s forwards and is braked by the ground."""
    text = BALL.replace("joint/vertical", "joint/planar").replace("guide.position: 0.5 m", "guide.z: 3.5 cm")
    ground = f"ground: {{use: contact/{contact}, frame: ball.center}}"
    text = "\n".join(f"  {ground}" if "ground:" in line else line for line in text.splitlines())
    text = text.replace("guide.z: 3.5 cm", "guide.z: 3.5 cm, guide.forward_velocity: 1 m/s").replace("2 s", "0.3 s")
    found = balance(of_text(text))
    assert found is not None
    assert found.exchanged["ground, damping"][-1] < -0.9
    assert np.abs(found.residual).max() < 5e-3 * found.turned_over


def test_the_balance_closes_at_the_largest_step_of_the_contact() -> None:
    """The work is that of the forces that really acted, which at such a step differ from those that are told."""
    text = BALL.replace("joint/vertical", "joint/planar").replace("guide.position: 0.5 m", "guide.z: 5 cm")
    text = text.replace("guide.z: 5 cm", "guide.z: 5 cm, guide.forward_velocity: 1 m/s").replace("0.02 ms", "2 ms")
    text = text.replace("contact/spring_damper", "contact/hunt_crossley").replace(
        ", stiffness: 20 kN/m, damping: 0 N s/m", ""
    )
    found = balance(of_text(text.replace("mass: 2 kg", "mass: 80 kg")))
    assert found is not None
    assert found.exchanged["ground, damping"][-1] < -30
    assert np.abs(found.residual).max() < 0.02 * found.turned_over


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


def test_a_model_of_many_muscles_shows_the_largest_energies_and_sums_the_others(tmp_path: Path) -> None:
    walker = ROOT / "specs" / "walking_geyer2010.yaml"
    added = "parts: {energy: {use: sensor/mechanical_energy}}"
    spec = tmp_path / "walker.yaml"
    spec.write_text(f"gaitsim: 1\nextends: {walker}\n{added}\n", encoding="utf-8")
    replay = replayed(model(spec, [("simulate.duration", "2 s")]), spec)
    whole = balance(replay)
    assert whole is not None and len(whole.exchanged) > 20
    stacked, exchanged = energy_figures(replay)
    layers, lines = stacked.figure.axes[0], exchanged.figure.axes[0]
    names = lines.get_legend_handles_labels()[1]
    assert len(names) == 7 and "created at paths" in names and names[-2].endswith("others")
    ends = [line.get_ydata()[-1] for line in lines.lines[:-1]]
    assert np.sum(ends) == pytest.approx(lines.lines[-1].get_ydata()[-1] - whole.residual[-1], abs=1e-9)
    assert {"kinetic", "potential"} < set(layers.get_legend_handles_labels()[1])
    for axes in (layers, lines):
        assert axes.get_position().height > 0.2


def test_without_a_sensor_there_is_no_balance() -> None:
    replay = of_spec("pendulum_pid")
    assert balance(replay) is None
    assert energy_figures(replay) == []


@pytest.mark.parametrize("count", [0, 1, 2])
def test_a_run_of_a_few_instants(count: int) -> None:
    replay = cut(of_spec("hopping_leg_mass", [("simulate.duration", "0.1 s")]), count)
    assert len(energy_figures(replay)) == (0 if count < 2 else 2)
