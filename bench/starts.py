"""How long `gaitsim run` takes as a whole: the first time after an installation, and from then on."""

from __future__ import annotations

import compileall
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from rows import Report, Section

SPECS = ("hopping_geyer2003", "walking_geyer2010")
REPEATS = 3
STARTS = Section(
    "Whole commands",
    {"first run": "s", "later runs": "s", "version": "s"},
    "Wall time of `gaitsim run SPEC --no-save` in a process of its own: with an empty cache, so that all native code "
    f"is compiled, and the median of {REPEATS} runs after that. `gaitsim --version` is what no command can be below. "
    "gaitsim's own files are compiled to bytecode before, as pip does when it installs.",
)
# As the installed command: with python -m, MuJoCo would be imported with OpenGL.
COMMAND = "from gaitsim.cli.main import main; main()"


def starts(report: Report) -> Iterator[str]:
    """Rows of the specs that a newcomer runs first."""
    report.begin(STARTS)
    root = Path(__file__).resolve().parents[1]
    compileall.compile_dir(root / "gaitsim", quiet=1)
    folder = root / "specs"
    with tempfile.TemporaryDirectory() as place:
        least = statistics.median(_seconds(place, "--version") for _ in range(REPEATS))
        for name in SPECS:
            if report.has_time(f"first run of {name}"):
                arguments = ("run", str(folder / f"{name}.yaml"), "--no-save")
                with tempfile.TemporaryDirectory() as empty:
                    first = _seconds(empty, *arguments)
                    later = statistics.median(_seconds(empty, *arguments) for _ in range(REPEATS))
                report.add(name, {"first run": first, "later runs": later, "version": least})
    yield from ()


def _seconds(cache: str, *arguments: str) -> float:
    environment = os.environ | {"GAITSIM_CACHE": cache, "NUMBA_CACHE_DIR": f"{cache}/numba"}
    began = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", COMMAND, *arguments], env=environment, check=True, capture_output=True, cwd=cache
    )
    return time.perf_counter() - began
