"""Where a result comes from: versions, machine, commit, command."""

from __future__ import annotations

import getpass
import platform
import subprocess
import sys
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from gaitsim import __version__

_LIBRARIES = ("mujoco", "numba", "numpy", "pydantic", "pyyaml", "cma")


def provenance() -> dict[str, Any]:
    """What a result must remember of its making."""
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "gaitsim": __version__,
        "versions": versions(),
        "machine": {"system": platform.platform(), "cpu": _processor()},
        "commit": _commit(Path.cwd()),
    }


def versions() -> dict[str, str]:
    """The version of Python and of each library that numbers depend on."""
    return {"python": platform.python_version()} | {name: version(name) for name in _LIBRARIES}


def _processor() -> str:
    import llvmlite.binding

    return str(llvmlite.binding.get_host_cpu_name())


def _commit(folder: Path) -> dict[str, Any] | None:
    """The git commit of the working folder and whether it has changes; None outside a checkout."""
    try:
        head = _git("rev-parse", "HEAD", folder=folder)
        # A checkout may name a program that watches its files, which this would start.
        status = _git("-c", "core.fsmonitor=false", "status", "--porcelain", folder=folder)
        return {"hash": head, "dirty": bool(status)}
    except (OSError, subprocess.SubprocessError):
        return None


def author() -> str:
    """Who works here: the name and address that git knows, or else the name of the user."""
    name, address = (_setting(key) for key in ("user.name", "user.email"))
    if name:
        return f"{name} <{address}>" if address else name
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return "unknown"


def _setting(key: str) -> str:
    """A setting of git; nothing where there is none."""
    try:
        return _git("config", key, folder=Path.cwd())
    except (OSError, subprocess.SubprocessError):
        return ""


def _git(*words: str, folder: Path) -> str:
    ran = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=True, timeout=10)
    return ran.stdout.strip()
