"""What a part owes to a picture: joints tell all their coordinates, contacts draw their force."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.animation import CannotAnimate
from gaitsim.animation.stage import Stage, stage_of
from gaitsim.component import Attachment
from gaitsim.components.find import Library, library_folders
from gaitsim.spec.resolve import read_spec, resolve
from tests.components.calls import FOLDER, primitive
from tests.simulation.models import written

JOINTS = sorted(path.stem for path in (FOLDER / "joint").glob("[!_]*.py"))
CONTACTS = sorted(path.stem for path in (FOLDER / "contact").glob("[!_]*.py"))

RAIL = '''
from gaitsim.component import Attachment, Component, Output


class Rail(Component):
    """A rail that keeps its place to itself."""

    parent = Attachment("Where it lies.")
    child = Attachment("What slides.")
    velocity = Output("m/s", "Rate.")

    @staticmethod
    def build(p, mj):
        joint = mj.slide(axis=(1, 0, 0), suffix="along")
        mj.read("velocity", joint, "qvel")
'''
TOGETHER = {"joint/spatial_hinge": ", axis_left: 1"}  # of several numbers, one is needed
ON_A_RAIL = """gaitsim: 1
parts:
  block: {use: segment/point_mass, mass: 1 kg}
  rail: {use: joint/rail, parent: world, child: block.center}
simulate: {duration: 1 s, step: 1 ms}
"""


def required(reference: str) -> str:
    """Values where there is no default.

    Numbers are within the bounds, one larger than the other; words are the first choice; curves close.
    """
    part = primitive(reference)
    bare = {name: one for name, one in part.parameters.items() if one.default is None}
    values = [f", {name}: {one.choices[0]}" for name, one in part.options.items() if one.default is None]
    values += [f", {name}: [0 {one.unit}, 10 {one.unit}, 0 {one.unit}]" for name, one in part.series.items()]
    for number, (name, one) in enumerate(bare.items(), start=1):
        low, high = one.bounds or (0.0, 1.0)
        value = low + (high - low) * number / (len(bare) + 1)
        values.append(f", {name}: {value:g} {one.unit if one.unit != '1' else ''}")
    return "".join(values) + TOGETHER.get(reference, "")


def staged(parts: dict[str, str]) -> Stage:
    lines = "\n".join(f"  {name}: {{{entry}}}" for name, entry in parts.items())
    return stage_of(written(f"gaitsim: 1\nparts:\n{lines}\nsimulate: {{duration: 1 s, step: 1 ms}}\n"))


@pytest.mark.parametrize("name", JOINTS)
def test_every_joint_tells_all_its_coordinates(name: str) -> None:
    stage = staged(
        {
            "block": "use: segment/point_mass, mass: 1 kg",
            "joint": f"use: joint/{name}, parent: world, child: block.center{required(f'joint/{name}')}",
        }
    )
    assert {place for place, _ in stage.coordinates} == set(range(stage.mechanics.nq))
    assert (stage.mechanics.nq > 0) == (name != "fixed")  # the one that leaves no freedom


@pytest.mark.parametrize("name", CONTACTS)
def test_every_contact_draws_its_force(name: str) -> None:
    reference = f"contact/{name}"
    frames = [n for n, d in primitive(reference).cls.declarations.items() if isinstance(d, Attachment)]
    attached = "".join(f", {frame}: block.center" for frame in frames)
    stage = staged(
        {
            "block": "use: segment/point_mass, mass: 1 kg",
            "guide": "use: joint/planar, parent: world, child: block.center",
            "ground": f"use: {reference}{attached}{required(reference)}",
        }
    )
    assert [force.part for force in stage.forces] == ["ground"]
    assert stage.forces[0].up == "ground.force"


def test_a_joint_that_keeps_its_coordinate_to_itself_is_named(tmp_path: Path) -> None:
    (tmp_path / "components" / "joint").mkdir(parents=True)
    (tmp_path / "components" / "joint" / "rail.py").write_text(RAIL, encoding="utf-8")
    spec = tmp_path / "rail.yaml"
    spec.write_text(ON_A_RAIL, encoding="utf-8")
    model = resolve(read_spec(spec), Library(library_folders(spec)), "rail")
    with pytest.raises(CannotAnimate) as raised:
        stage_of(model)
    (fault,) = raised.value.faults
    assert fault.mark is not None and fault.mark.line == 4
    assert fault.address == "rail.along"
    assert fault.message == (
        "no output reports this joint's coordinate, so its motion was not recorded; "
        'declare an output and mj.read("angle", joint, "qpos") in its component\'s build.'
    )
