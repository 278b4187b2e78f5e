"""Result folders: open files, complete or absent."""

from __future__ import annotations

import json
import math
import secrets
from collections.abc import Mapping as Map
from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Any

from gaitsim.errors import GaitsimError
from gaitsim.model import Model
from gaitsim.parts.find import Library
from gaitsim.results.listing import model_data
from gaitsim.results.provenance import provenance
from gaitsim.simulation.outcome import Outcome
from gaitsim.spec.document import Mapping, dump, plain


class CannotSave(GaitsimError):
    """A result or a trajectory cannot be written."""


Row = tuple[Map[str, str], Outcome]


def save_run(
    folder: Path, document: Mapping, model: Model, library: Library, xml: str, mode: str, rows: Sequence[Row]
) -> Path:
    """Write the folder of a run, or of a study with one row per variant; its path.

    Errors: CannotSave.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        target = _free_name(folder, model.name)
        draft = target.with_name(f"{target.name}.partial")
        draft.mkdir()
        _write(draft, document, model, library, xml, mode, rows)
        draft.replace(target)
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{folder}: the result cannot be saved ({reason}); free it, or use --no-save.") from error
    return target


def _free_name(folder: Path, name: str) -> Path:
    while True:
        target = folder / f"{date.today().isoformat()}-{name}-{secrets.token_hex(2)}"
        if not target.exists() and not target.with_name(f"{target.name}.partial").exists():
            return target


def _write(
    folder: Path, document: Mapping, model: Model, library: Library, xml: str, mode: str, rows: Sequence[Row]
) -> None:
    components = {reference: part.digest for reference, part in library.used().items()}
    manifest = {
        "kind": "run",
        "status": "complete",
        "name": model.name,
        "mode": mode,
        **provenance(),
        "components": components,
        "notices": list(model.notices),
    }
    (folder / "spec.yaml").write_text(dump(plain(document)), encoding="utf-8")
    (folder / "model.yaml").write_text(dump(model_data(model)), encoding="utf-8")
    (folder / "model.xml").write_text(xml, encoding="utf-8")
    for reference, component in library.used().items():
        copy = folder / "components" / f"{reference}{component.path.suffix}"
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(component.source, encoding="utf-8")
    lines = [json.dumps(evaluation(settings, outcome), allow_nan=False) for settings, outcome in rows]
    (folder / "evaluations.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "README.md").write_text(_readme(model, manifest, rows), encoding="utf-8")
    (folder / "manifest.json").write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")


def evaluation(settings: Map[str, str], outcome: Outcome) -> dict[str, Any]:
    """One evaluation as data; numbers that are not finite are null."""
    return {
        "settings": dict(settings),
        "status": outcome.status,
        "reason": outcome.reason,
        "score": outcome.score,
        "metrics": {n: v if math.isfinite(v) else None for n, v in outcome.metrics.items()},
        "simulated_seconds": outcome.simulated_seconds,
        "steps": outcome.steps,
    }


def _readme(model: Model, manifest: dict[str, Any], rows: Sequence[Row]) -> str:
    commit = manifest["commit"]
    origin = f"commit {commit['hash'][:12]}{' with changes' if commit['dirty'] else ''}" if commit else "no commit"
    lines = [f"# {model.name}", "", f"gaitsim {manifest['gaitsim']}, {manifest['created']}, {origin}.", ""]
    for settings, outcome in rows[:20]:
        said = ", ".join(f"{a} = {v}" for a, v in settings.items())
        numbers = ", ".join(f"{n} {v:.5g}" for n, v in outcome.metrics.items())
        lines.append(f"- {said + ': ' if said else ''}{outcome.status}{': ' + numbers if numbers else ''}")
    return "\n".join([*lines, "", "## Notes", "", ""])


def save_trajectory(path: Path, outcome: Outcome) -> None:
    """Write a recorded run as CSV: time and every signal, each with its unit.

    Errors: CannotSave.
    """
    trajectory = outcome.trajectory
    assert trajectory is not None
    header = ["time [s]", *(f"{s} [{u}]" for s, u in zip(trajectory.signals, trajectory.units, strict=True))]
    draft = path.with_name(f"{path.name}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with draft.open("w", encoding="utf-8") as file:
            file.write(",".join(header) + "\n")
            for time, row in zip(trajectory.times, trajectory.values, strict=True):
                file.write(",".join([f"{time:.9g}", *(repr(float(v)) for v in row)]) + "\n")
        draft.replace(path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{path}: the trajectory cannot be written ({reason}); choose another --out.") from error
