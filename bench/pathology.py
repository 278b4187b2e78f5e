"""Impaired walkers: `python bench/pathology.py` tunes each again from the healthy walker and compares the gaits.

Every spec that extends `walking_impaired.yaml` is searched from the values of the healthy walker for `--generations`
generations of 20, on `--workers` cores, and its best values are written beside it. Then all of them are analyzed with
the healthy one first: figures with all gaits over one another, and a table of what differs, in `analysis/pathology/`.
`--compare` leaves out the searches.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

SPECS = Path(__file__).resolve().parents[1] / "specs"
HEALTHY = SPECS / "walking_impaired.yaml"
GAITSIM = [sys.executable, "-m", "gaitsim.cli.main"]


def impaired() -> list[Path]:
    """The specs that extend the healthy one, in the order of their names."""
    extends = f"extends: {HEALTHY.name}\n"
    return sorted(path for path in SPECS.glob("*.yaml") if extends in path.read_text(encoding="utf-8"))


def tune(spec: Path, options: argparse.Namespace) -> None:
    """Search from the healthy walker, or from what an earlier search found, and keep the best values."""
    command = [*GAITSIM, "optimize", str(spec), "--from", "tuned", "--adopt", "--results", options.results]
    command += ["--generations", str(options.generations), "--seed", str(options.seed)]
    command += ["--set", f"optimize.spread_factor={options.spread_factor}"]
    subprocess.run(
        [*command, *(["--workers", str(options.workers)] if options.workers is not None else [])], check=False
    )


def main() -> None:
    """Tune, then compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("specs", nargs="*", type=Path, default=impaired(), help="impaired walkers; all by default")
    parser.add_argument("--generations", type=int, default=30, help="of each search")
    parser.add_argument("--seed", type=int, default=1, help="of each search")
    parser.add_argument("--spread-factor", type=float, default=1.0, help="on the spreads of the spec")
    parser.add_argument("--workers", type=int, help="processes; all cores by default")
    parser.add_argument("--results", default="results", help="folder of the searches")
    parser.add_argument("--folder", default="analysis/pathology", help="where figures and table go")
    parser.add_argument("--compare", action="store_true", help="no searches")
    options = parser.parse_args()
    for spec in () if options.compare else options.specs:
        tune(spec, options)
    command = [*GAITSIM, "analyze", str(HEALTHY), *map(str, options.specs), "--from-time", "4 s", "--no-video"]
    sys.exit(subprocess.run([*command, "--folder", options.folder], check=False).returncode)


if __name__ == "__main__":
    main()
