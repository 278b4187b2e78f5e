"""Result folders. Their files are complete or absent, and the manifest describes them."""

from __future__ import annotations

import json
import math
import secrets
import shutil
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import asdict
from datetime import date
from pathlib import Path
from typing import Any

from gaitsim.errors import GaitsimError
from gaitsim.exchange.csv import write_csv
from gaitsim.model import Model
from gaitsim.optimization.draws import Draws
from gaitsim.results.bundle import Bundle
from gaitsim.results.listing import model_data
from gaitsim.results.manifest import new_manifest, write_manifest
from gaitsim.results.readme import readme
from gaitsim.results.rows import row_words
from gaitsim.results.trust import remember
from gaitsim.results.tuned import problem_of
from gaitsim.simulation.outcome import Outcome
from gaitsim.text.document import dump
from gaitsim.units import with_unit
from gaitsim.whole import draft_of


class CannotSave(GaitsimError):
    """A result or a trajectory cannot be written."""


def create_result(
    root: Path, bundle: Bundle, model: Model, xml: str, manifest: dict[str, Any], more: Mapping[str, str], move: str
) -> Path:
    """Make a result folder with spec, model, MJCF, components and manifest.

    Args:
        root: The folder of results.
        bundle: The bundle.
        model: The model.
        xml: Its MJCF.
        manifest: The manifest.
        more: Further files by name.
        move: What the message suggests if the folder cannot be written.

    Returns:
        The path of the result.

    Raises:
        CannotSave: The folder cannot be written. Nothing is left behind.
    """
    draft = None
    try:
        root.mkdir(parents=True, exist_ok=True)
        target = _free_name(root, bundle.name)
        draft = draft_of(target)
        draft.mkdir()
        bundle.write(draft)
        files = {"model.yaml": dump(model_data(model)), "model.xml": xml, **more}
        for name, text in files.items():
            (draft / name).write_text(text, encoding="utf-8")
        write_manifest(draft, manifest)
        draft.replace(target)
    except OSError as error:
        if draft is not None:
            shutil.rmtree(draft, ignore_errors=True)
        reason = error.strerror or str(error)
        raise CannotSave(f"{root}: the result cannot be saved ({reason}); {move}.") from error
    remember(bundle)
    return target


def finish(folder: Path, manifest: dict[str, Any], headline: Sequence[str]) -> None:
    """Write the final manifest and the README, whose notes are kept.

    Raises:
        OSError: A file cannot be written.
    """
    path = folder / "README.md"
    before = path.read_text(encoding="utf-8", errors="backslashreplace") if path.is_file() else ""
    path.write_text(readme(manifest, headline, before), encoding="utf-8")
    write_manifest(folder, manifest)


def row_data(settings: Mapping[str, str], outcome: Outcome) -> dict[str, Any]:
    """One run as plain data.

    Args:
        settings: The settings of the run, as text by address.
        outcome: Its outcome. Numbers that are not finite become null.
    """
    return {
        "settings": dict(settings),
        "status": outcome.status,
        "reason": outcome.reason,
        "score": outcome.score,
        "metrics": {n: v if math.isfinite(v) else None for n, v in outcome.metrics.items()},
        "simulated_seconds": outcome.simulated_seconds,
        "steps": outcome.steps,
    }


def _free_name(root: Path, name: str) -> Path:
    while True:
        target = root / f"{date.today().isoformat()}-{name}-{secrets.token_hex(2)}"
        if not target.exists() and not draft_of(target).exists():
            return target


def save_trajectory(path: Path, outcome: Outcome) -> None:
    """Write the trajectory of a run as CSV.

    Raises:
        CannotSave: The file cannot be written.
    """
    trajectory = outcome.trajectory
    assert trajectory is not None
    try:
        write_csv(path, trajectory)
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{path}: the trajectory cannot be written ({reason}); choose another --out.") from error
