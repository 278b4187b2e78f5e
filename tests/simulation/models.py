"""Models and simulators from spec files, as a researcher would make them."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path

from gaitsim.components.find import Library, library_folders
from gaitsim.distribution import shipped_folder
from gaitsim.model import Model
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.inheritance import override
from gaitsim.spec.resolve import read_spec, resolve
from gaitsim.text.document import parse

ROOT = Path(__file__).resolve().parents[2]
SPECS = sorted(p for p in (ROOT / "specs").glob("*.yaml") if not p.stem.endswith(".tuned"))
OWN = Path(__file__).parent / "specs"
HOPPER = ROOT / "specs" / "hopping_geyer2003.yaml"

Settings = Iterable[tuple[str, str]]


def model(path: Path, settings: Settings = ()) -> Model:
    """The model of a spec. Those of the checkout do not change while tests run, and are resolved once."""
    return (_resolved_once if path.is_relative_to(ROOT) else _resolved)(path, tuple(settings))


def _resolved(path: Path, settings: tuple[tuple[str, str], ...]) -> Model:
    return resolve(read_spec(path, settings), Library(library_folders(path)), path.stem)


_resolved_once = cache(_resolved)


def simulator(path: Path, settings: Settings = (), mode: Mode = "rapid") -> Simulator:
    return Simulator(model(path, settings), mode)


def written(text: str, settings: Settings = ()) -> Model:
    """The model of a spec written in a test; it may use the components beside the test specs."""
    document = parse(text, "spec.yaml")
    for address, value in settings:
        document = override(document, address, value)
    return resolve(document, Library((OWN / "components", shipped_folder())), "spec")
