"""A result of a spec in which parts were swapped re-runs from its own files alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.study.opening import Opening
from gaitsim.results.bundle import read_bundle
from gaitsim.simulation.run import Simulator

SPEC = Path(__file__).parents[2] / "specs" / "hopping_leg_mass.yaml"
PATH = (
    "{use: path/constant_arm, moment_arm: -4 cm, reference_length: 0.5 m, reference_angle: 70 deg,"
    " angle: {from: knee.angle}, angular_velocity: {from: knee.velocity}, to: {moment: knee.torque}}"
)


@pytest.mark.parametrize(
    "swap", ["ground.use=contact/mujoco", f"extensor.path={PATH}", "use_for.muscle=muscle/geyer2003"]
)
def test_a_swapped_model_is_the_same_from_its_bundle(swap: str, tmp_path: Path) -> None:
    opened = Opening(SPEC, (swap, "simulate.duration=1 s",), tuned=False).open()
    model = opened.model()
    opened.bundle([model]).write(tmp_path)
    again = read_bundle(tmp_path, opened.name).model()
    assert [part.type.reference for part in again.parts] == [part.type.reference for part in model.parts]
    assert again.values() == model.values()
    assert Simulator(again).run().metrics == Simulator(model).run().metrics
