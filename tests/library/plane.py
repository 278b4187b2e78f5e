"""Small models in the sagittal plane for tests of parts: a spec as text, run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gaitsim.components.find import Library, library_folders
from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve


def model_of(text: str, folder: Path, **words: Any) -> Model:
    """The model of a spec in which words in capitals stand for values."""
    for word, value in words.items():
        text = text.replace(word, str(value))
    path = folder / "spec.yaml"
    path.write_text(text, encoding="utf-8")
    return resolve(read_spec(path), Library(library_folders(path)), "spec")


def body_of(simulator: Simulator) -> Any:
    """MuJoCo's model and data, posed."""
    return simulator._loop.physics


def played(text: str, folder: Path, **words: Any) -> Any:
    """The trajectory of a spec."""
    outcome = Simulator(model_of(text, folder, **words)).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    return outcome.trajectory
