"""What must be equal on every worker: gaitsim's source, Python, and the libraries that results depend on."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


@cache
def fingerprint() -> dict[str, str]:
    """The versions of Python and libraries, and a digest of gaitsim's source, by name."""
    import gaitsim

    whole = hashlib.sha256()
    folder = Path(gaitsim.__file__).parent
    for path in sorted(folder.rglob("*.py")):
        whole.update(f"{path.relative_to(folder)}\0".encode() + path.read_bytes())
    return {
        "gaitsim": f"{gaitsim.__version__} ({whole.hexdigest()[:12]})",
        "python": platform.python_version(),
        **{name: found for name in ("mujoco", "numba", "numpy") if (found := _version(name))},
    }


def differences(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """The differences of two fingerprints in words; empty if they are equal."""
    if not theirs:
        return f"no gaitsim, and this process has {ours['gaitsim']}"
    return ", ".join(
        f"{name} {theirs[name]} instead of {value}" if name in theirs else f"no {name} instead of {value}"
        for name, value in ours.items()
        if theirs.get(name) != value
    )


def _version(library: str) -> str | None:
    try:
        return version(library)
    except PackageNotFoundError:
        return None
