"""A pendulum that swings out, in well under a second of work: every test about signals looks at it."""

from __future__ import annotations

from pathlib import Path

from gaitsim.analysis.replays.replay import Replay, replayed
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.model import Model
from gaitsim.spec.inheritance import override
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

COMPONENTS = Path(__file__).parent / "components"
SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
  brake:
    use: controller/pid
    proportional: 0 N m/rad
    derivative: {value: 0.2 N m s/rad, tune: [0 N m s/rad, 5 N m s/rad]}
    angle: {from: pivot.angle}
    angular_velocity: {from: pivot.velocity, delay: 10 ms}
    to: pivot.torque
  watch: {use: controller/side, angle: {from: pivot.angle}}
initial: {pivot.angle: 30 deg}
measures:
  swing: {use: measure/range, signal: {from: pivot.angle}}
objective: {use: objective/minimize, value: {from: swing}}
simulate: {duration: 8 s, step: 1 ms}
"""


def model(*settings: tuple[str, str]) -> Model:
    """The pendulum's model with some of its values replaced."""
    document = parse(SPEC, "spec.yaml")
    for address, value in settings:
        document = override(document, address, value)
    return resolve(document, Library((COMPONENTS, shipped_folder())), "swinging")


def replay(*settings: tuple[str, str], label: str = "") -> Replay:
    """The pendulum's run."""
    return replayed(model(*settings), Path("spec.yaml"), label)
