"""Labs and projects, which are marked by the files lab.yaml and project.yaml."""

from __future__ import annotations

from pathlib import Path

LAB = "lab.yaml"  # marks the folder that holds library/ and projects/
PROJECT = "project.yaml"  # marks the folder of one project
_RESULT = "manifest.json"


def lab_of(place: Path) -> Path | None:
    """The lab of a file or folder: the nearest marked folder above it; None if there is none."""
    return _marked(place, LAB)


def project_of(place: Path) -> Path | None:
    """The project of a file or folder, within its lab; None if there is none."""
    return _marked(place, PROJECT, LAB)


def _marked(place: Path, marker: str, end: str = "") -> Path | None:
    """The nearest folder above a place that holds a marker. The search ends at the folder that holds `end`."""
    whole = place.absolute()
    for folder in (whole, *whole.parents):
        if (folder / marker).is_file():
            return folder
        if end and (folder / end).is_file():
            return None
    return None


def serves(folder: Path, shipped: Path) -> str:
    """The name of a component folder: shipped, lab, project, result, or its path.

    Args:
        folder: One of the folders of a library.
        shipped: The folder that comes with gaitsim.
    """
    if folder.resolve() == shipped.resolve():
        return "shipped"
    markers = {("library", LAB): "lab", ("components", PROJECT): "project", ("components", _RESULT): "result"}
    for (name, marker), word in markers.items():
        if folder.name == name and (folder.parent / marker).is_file():
            return word
    return str(folder)
