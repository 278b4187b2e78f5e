"""manifest.json: what a result is, where it comes from, and whether it is complete."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from gaitsim import __version__
from gaitsim.errors import Fault, Mark, shortened
from gaitsim.folders import results_folder
from gaitsim.results.bundle import BadResult as BadResult
from gaitsim.results.bundle import Bundle, read_bundle
from gaitsim.results.lock import state_of
from gaitsim.results.provenance import machine, provenance, versions
from gaitsim.whole import write_whole

_NAME = "manifest.json"
FORMAT = 2  # of what a result's files say; in 1, parameters.csv and model.yaml have SI numbers beside other units


def is_result(path: Path) -> bool:
    """Whether a path refers to a result: a folder with a manifest, or one in a folder of results."""
    if (path / _NAME).is_file():
        return True
    parent = path.absolute().parent
    return path.suffix != ".yaml" and (parent.name == "results" or parent == results_folder().absolute())


def result_named(path: Path, results: Path | None = None) -> Path:
    """The path of a result that is given by name, such as 2026-11-22-hopping-3f9c; other paths are returned
    unchanged.

    Args:
        path: The name or path.
        results: The folder in which names are looked up, if not the usual one.
    """
    found = results_folder(results) / path
    return found if len(path.parts) == 1 and not path.exists() and (found / _NAME).is_file() else path


def new_manifest(kind: str, bundle: Bundle, mode: str, place: Path, **more: Any) -> dict[str, Any]:
    """The manifest of a new result.

    Args:
        kind: run, study, draws, optimize or limit.
        bundle: Its bundle.
        mode: "rapid" or "normal".
        place: The folder of its spec.
        more: Further entries.
    """
    return {
        "kind": kind,
        "status": "running",
        "format": FORMAT,
        "name": bundle.name,
        "mode": mode,
        **provenance(place),
        "digest": bundle.digest,
        "files": bundle.digests,
        **more,
    }


def format_of(manifest: Mapping[str, Any]) -> int:
    """The format of a result's files; 1 if the manifest does not say it."""
    return int(manifest.get("format", 1))


def write_manifest(folder: Path, manifest: dict[str, Any]) -> None:
    """Replace the manifest completely.

    Raises:
        OSError: The file cannot be written.
    """
    write_whole(folder / _NAME, json.dumps(manifest, indent=2) + "\n")


class _Known(BaseModel):
    """The entries of a manifest that its readers use. Others are not checked."""

    model_config = ConfigDict(extra="allow", strict=True)

    kind: Literal["run", "optimize"]
    status: str
    name: str
    mode: str
    digest: str
    format: int = 1
    created: str
    gaitsim: str
    versions: dict[str, str]
    files: dict[str, str] = {}
    notices: list[str] = []
    search: dict[str, Any] = {}
    best_score: float | None = None
    evaluations: int | None = None


def recorded_manifest(folder: Path) -> dict[str, Any]:
    """Read the manifest of a result, without checking the result's files.

    Raises:
        BadResult: There is no manifest, or it cannot be read.
    """
    path = folder / _NAME
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
        _Known.model_validate(manifest)
    except ValidationError as error:
        rule = f"{_rule(error.errors()[0])}, so this manifest was damaged or edited; restore it from a copy."
        raise BadResult(Fault(rule, Mark(str(path)))) from error
    except (OSError, ValueError, RecursionError) as error:
        rule = f"this manifest cannot be read ({getattr(error, 'strerror', None) or error}); restore it from a copy."
        raise BadResult(Fault(rule, Mark(str(path)))) from error
    return {**manifest, "status": state_of(folder, manifest["status"])}


def _rule(fault: ErrorDetails) -> str:
    """The message for a wrong entry of a manifest."""
    place = ".".join(map(str, fault["loc"]))
    if fault["type"] == "missing":
        return f"{place} is missing"
    found = shortened(json.dumps(fault["input"]))
    return f"{place} is {found}" if place else f"this is {found} and no mapping"


def read_result(folder: Path) -> tuple[dict[str, Any], Bundle]:
    """Read a result, and check its files against the digest in the manifest.

    Returns:
        The manifest and the bundle.

    Raises:
        BadResult: The folder is not a result, or its files were changed.
    """
    check_is_result(folder)
    manifest = recorded_manifest(folder)
    bundle = read_bundle(folder, manifest["name"])
    if bundle.digest != manifest["digest"]:
        rule = f"{_edited(manifest.get('files', {}), bundle)} after it was made, so it would not re-run as it was"
        raise BadResult(f"{folder}: {rule}; restore them, or copy the folder's spec.yaml and run that.")
    return manifest, bundle


def _edited(before: Mapping[str, str], bundle: Bundle) -> str:
    """How the files of a result were changed, in words.

    Args:
        before: Their digests when the result was made; old results have none.
        bundle: The files now.
    """
    now = bundle.digests
    same = [path for path in before if now.get(path) == before[path]]
    found = {
        "edited": [path for path in now if path in before and path not in same],
        "removed": [path for path in before if path not in now],
        "added": [path for path in now if path not in before],
    }
    changes = [f"{', '.join(paths)} {'was' if len(paths) == 1 else 'were'} {verb}" for verb, paths in found.items() if paths]
    return " and ".join(changes) if before and changes else "its spec or components were edited"


def check_is_result(folder: Path) -> None:
    """Check that a folder is a result.

    Raises:
        BadResult: It is not, or it was never completed.
    """
    if not folder.is_dir():
        near = sorted(p.name for p in folder.absolute().parent.glob("*") if (p / _NAME).is_file())
        known = f"; the last are: {', '.join(near[-5:])}" if near else ""
        raise BadResult(f"{folder}: there is no such result{known}. See: gaitsim results list")
    if not (folder / _NAME).is_file():
        rule = "there is no manifest.json, so this is not a result, or one that was never finished being made"
        raise BadResult(f"{folder}: {rule}; name another, or see: gaitsim results list")


def read_manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a result whose files are unchanged.

    Raises:
        BadResult: The folder is not a result, or its files were changed.
    """
    return read_result(folder)[0]


def changed_versions(manifest: dict[str, Any]) -> list[str]:
    """The differences between the result's versions and those of this machine, in words."""
    before = {"gaitsim": manifest.get("gaitsim"), **manifest.get("versions", {})}
    after = {"gaitsim": __version__, **versions()}
    return [
        f"{name} {before.get(name, 'absent')} -> {version}"
        for name, version in after.items()
        if before.get(name) != version
    ]


def changed_makers(manifest: dict[str, Any]) -> list[str]:
    """The differences in all that may change the last digits: versions and processor."""
    before, after = manifest.get("machine", {}).get("cpu"), machine()["cpu"]
    return [*changed_versions(manifest), *([f"processor {before} -> {after}"] if before not in (None, after) else [])]
