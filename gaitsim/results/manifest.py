"""manifest.json: what a result is, where it comes from, and whether it is whole."""

from __future__ import annotations

import json
from collections.abc import Mapping as Map
from pathlib import Path
from typing import Any

from gaitsim.errors import Fault, GaitsimError, Mark
from gaitsim.results.bundle import Bundle, read_bundle
from gaitsim.results.lock import state_of
from gaitsim.results.provenance import provenance

_NAME = "manifest.json"
FORMAT = 2  # of what a result's files say; in 1, parameters.csv and model.yaml have SI numbers beside other units


class BadResult(GaitsimError):
    """A folder that is no result, or that is damaged."""


def is_result(path: Path) -> bool:
    """Whether a path is meant as a result: a folder with a manifest, or below one named results."""
    return (path / _NAME).is_file() or (path.suffix != ".yaml" and path.absolute().parent.name == "results")


def new_manifest(kind: str, bundle: Bundle, mode: str, **more: Any) -> dict[str, Any]:
    """The manifest of a result that is about to be made."""
    return {
        "kind": kind,
        "status": "running",
        "format": FORMAT,
        "name": bundle.name,
        "mode": mode,
        **provenance(),
        "digest": bundle.digest,
        **more,
    }


def format_of(manifest: Map[str, Any]) -> int:
    """The format of a result's files; those that do not say it have the first."""
    return int(manifest.get("format", 1))


def write_manifest(folder: Path, manifest: dict[str, Any]) -> None:
    """Replace the manifest as a whole. Errors: OSError."""
    draft = folder / f"{_NAME}.partial"
    try:
        draft.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")
        draft.replace(folder / _NAME)
    except OSError:
        draft.unlink(missing_ok=True)
        raise


def read_manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a result, with its files checked against their digest.

    Errors: BadResult.
    """
    path = folder / _NAME
    if not folder.is_dir():
        near = sorted(p.name for p in folder.absolute().parent.glob("*") if (p / _NAME).is_file())
        known = f"; the last are: {', '.join(near[-5:])}" if near else ""
        raise BadResult(f"{folder}: there is no such result{known}. See: gaitsim results list")
    if not path.is_file():
        rule = "there is no manifest.json, so this is no result, or one that was never finished being made"
        raise BadResult(f"{folder}: {rule}; name another, or see: gaitsim results list")
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
        name, digest = str(manifest["name"]), str(manifest["digest"])
        manifest["kind"]
        manifest["status"] = state_of(folder, manifest["status"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        rule = f"this manifest cannot be read ({error}); restore it from a copy."
        raise BadResult(Fault(rule, Mark(str(path)))) from error
    try:
        found = read_bundle(folder, name).digest
    except OSError as error:
        raise BadResult(f"{error.filename}: this is missing or cannot be read; restore it from a copy.") from error
    except UnicodeDecodeError as error:
        raise BadResult(f"{folder}: its spec or a component is no text any more; restore them from a copy.") from error
    if found != digest:
        rule = "its spec or components were edited after it was made, so it would not re-run as it was"
        raise BadResult(f"{folder}: {rule}; restore them, or copy the folder's spec.yaml and run that.")
    return dict(manifest)


def changed_versions(manifest: dict[str, Any]) -> list[str]:
    """What differs between the result's versions and this machine's: in words."""
    now = provenance()
    before = {"gaitsim": manifest.get("gaitsim"), **manifest.get("versions", {})}
    after = {"gaitsim": now["gaitsim"], **now["versions"]}
    return [
        f"{name} {before.get(name, 'absent')} -> {version}"
        for name, version in after.items()
        if before.get(name) != version
    ]
