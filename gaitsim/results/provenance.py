"""The origin of a result: versions, machine, commit, command."""

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

_LARGEST = 2**20  # bytes of a patch
_LIBRARIES = ("mujoco", "numba", "numpy", "pydantic", "pyyaml", "cma")


def provenance(place: Path) -> dict[str, Any]:
    """The origin of a result that is made now.

    Args:
        place: The folder of its spec.
    """
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "gaitsim": __version__,
        "versions": versions(),
        "machine": machine(),
        "commit": _commit(place),
    }


def versions() -> dict[str, str]:
    """The version of Python and of each library that numbers depend on."""
    return {"python": platform.python_version()} | {name: version(name) for name in _LIBRARIES}


def machine() -> dict[str, str]:
    """The system and the processor, for which native code is compiled."""
    return {"system": platform.platform(), "cpu": _processor()}


def changes(place: Path) -> str:
    """The uncommitted changes in the repository of a folder: a list of the changed files, and a patch.

    Returns:
        The text; empty without changes or outside a checkout. A patch of more than 1 MiB is left out, and the text says
            so.
    """
    try:
        status = _status(place)
        if not status:
            return ""
        patch = _git("diff", "--no-color", "--no-ext-diff", "--no-textconv", "HEAD", folder=place)
    except (OSError, subprocess.SubprocessError):
        return ""
    size = len(patch.encode())
    if size > _LARGEST:
        patch = f"# a patch of {size / 2**20:.1f} MiB is left out; the most that is kept is {_LARGEST / 2**20:g} MiB"
    return "\n".join([*(f"# {line}" for line in status.splitlines()), patch, ""])


def changes_file(place: Path) -> dict[str, str]:
    """The file with `changes` of a result, by name; empty without changes."""
    found = changes(place)
    return {"changes.diff": found} if found else {}


def _processor() -> str:
    import llvmlite.binding

    return str(llvmlite.binding.get_host_cpu_name())


def _commit(folder: Path) -> dict[str, Any] | None:
    """The git commit of a folder's repository, and whether it has changes; None outside a checkout."""
    try:
        head = _git("rev-parse", "HEAD", folder=folder)
        return {"hash": head, "dirty": bool(_status(folder))}
    except (OSError, subprocess.SubprocessError):
        return None


def _status(folder: Path) -> str:
    # A checkout can configure a file monitor, which git would start.
    return _git("-c", "core.fsmonitor=false", "status", "--porcelain", folder=folder)


def author() -> str:
    """The name and address that git knows, or else the name of the user."""
    name, address = (_setting(key) for key in ("user.name", "user.email"))
    if name:
        return f"{name} <{address}>" if address else name
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return "unknown"


def _setting(key: str) -> str:
    """A setting of git; empty if it is not set."""
    try:
        return _git("config", key, folder=Path.cwd())
    except (OSError, subprocess.SubprocessError):
        return ""


def _git(*arguments: str, folder: Path) -> str:
    ran = subprocess.run(["git", *arguments], cwd=folder, capture_output=True, check=True, timeout=10)
    return ran.stdout.decode("utf-8", "replace").rstrip()
