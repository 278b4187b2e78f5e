"""Where the library and the specs that come with gaitsim are."""

from __future__ import annotations

from pathlib import Path


def shipped_folder() -> Path:
    """The library in the wheel or in the checkout."""
    package = Path(__file__).resolve().parent
    inside = package / "shipped" / "library"
    return inside if inside.is_dir() else package.parent / "library"


def shipped_specs() -> dict[str, Path]:
    """The specs in the wheel or in the checkout, by name, without tuned values."""
    folder = shipped_folder().parent / "specs"
    return {path.stem: path for path in sorted(folder.glob("*.yaml")) if not path.stem.endswith(".tuned")}
