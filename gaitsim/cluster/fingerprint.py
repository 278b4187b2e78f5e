"""What must be the same on every worker: gaitsim's own source and the libraries below it."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import version
from pathlib import Path


@cache
def fingerprint() -> dict[str, str]:
    """Versions, and a digest of all of gaitsim's source."""
    import gaitsim

    whole = hashlib.sha256()
    folder = Path(gaitsim.__file__).parent
    for path in sorted(folder.rglob("*.py")):
        whole.update(f"{path.relative_to(folder)}\0".encode() + path.read_bytes())
    libraries = {name: version(name) for name in ("mujoco", "numba", "numpy")}
    return {
        "gaitsim": f"{gaitsim.__version__} ({whole.hexdigest()[:12]})",
        "python": platform.python_version(),
        **libraries,
    }


def differences(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """What differs, in words; empty if nothing does."""
    return ", ".join(
        f"{name} {theirs.get(name, 'absent')} instead of {value}"
        for name, value in ours.items()
        if theirs.get(name) != value
    )
