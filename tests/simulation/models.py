"""Models and simulators from spec files, as a researcher would make them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from gaitsim.model import Model
from gaitsim.parts.find import Library, library_folders
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import read_spec, resolve

ROOT = Path(__file__).resolve().parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))
OWN = Path(__file__).parent / "specs"
HOPPER = ROOT / "specs" / "hopping_geyer2003.yaml"

Settings = Iterable[tuple[str, str]]


def model(path: Path, settings: Settings = ()) -> Model:
    library = Library(library_folders(path))
    return resolve(read_spec(path, tuple(settings)), library, path.stem)


def simulator(path: Path, settings: Settings = (), mode: Mode = "rapid") -> Simulator:
    return Simulator(model(path, settings), mode)
