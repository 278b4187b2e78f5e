"""What gaitsim costs on this machine: `make bench`, or `python bench/bench.py --help`.

Every row is printed as it is ready. What is compared with each other runs in alternating pairs within one run, and
medians are given: ratios hold on a busy machine, times only roughly.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import rows
from growth import growth
from rows import Report
from searches import searches
from starts import starts
from steps import steps

SECONDS = 180.0
PARTS = {"steps": steps, "starts": starts, "searches": searches, "growth": growth}
SHARES = {"steps": 3, "starts": 2, "searches": 2, "growth": 3}  # of the time, so that every table has rows


def arguments() -> argparse.Namespace:
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description="Measure gaitsim on this machine.")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write all numbers to a file")
    parser.add_argument("--against", metavar="FILE", type=Path, help="compare with numbers that --json wrote before")
    parser.add_argument("--page", metavar="FILE", type=Path, help="write the tables as a page in Markdown")
    parser.add_argument("--only", choices=PARTS, action="append", help="only this table; repeatable")
    parser.add_argument(
        "--seconds", type=float, default=SECONDS, help=f"no row begins after so many seconds ({SECONDS:g})"
    )
    asked = parser.parse_args()
    asked.before = None
    if asked.against:
        try:
            asked.before = rows.read(asked.against)
        except (OSError, ValueError) as error:
            parser.error(f"--against {asked.against}: {error}; name a file that --json wrote")
    return asked


def main() -> None:
    """Measure, print, and write what was asked for."""
    asked = arguments()
    report = Report(asked.seconds, asked.before)
    print(", ".join(f"{name} {value}" for name, value in rows.machine().items()), f"commit {rows.commit()}", sep=", ")
    if asked.before:
        print(f"compared with commit {asked.before.get('commit')}")
        if asked.before.get("machine") != rows.machine():
            print("That was another machine or Python, so only ratios within a row can be compared.")
    told = _measured(report, asked.only or list(PARTS))
    if report.skipped:
        told.append(f"No time was left for: {', '.join(report.skipped)}; give more with --seconds.")
    print("\n" + "\n\n".join([*(f"{section.title}: {section.about}" for section in report.sections), *told]))
    if asked.json:
        asked.json.write_text(json.dumps(report.data(), indent=2) + "\n", encoding="utf-8")
    if asked.page:
        asked.page.write_text(report.page(), encoding="utf-8")


def _measured(report: Report, parts: Sequence[str]) -> list[str]:
    """Add the rows of some tables; what is said of them at the end."""
    told: list[str] = []
    for part in parts:
        report.allow(SHARES[part] / sum(SHARES[each] for each in parts))
        told += PARTS[part](report)
    return told


if __name__ == "__main__":
    main()
