"""Rows of numbers: printed as they are ready, kept as JSON, compared with those of another commit, made a page."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import llvmlite.binding

from gaitsim import __version__

WIDTH = 13


@dataclass(frozen=True)
class Section:
    """A table: what it shows, the unit of each column, and how its numbers were measured."""

    title: str
    columns: Mapping[str, str]
    about: str


@dataclass
class Report:
    """All rows of one run of the benchmarks; `before` are those of another run, to be compared with."""

    seconds: float
    before: Mapping[str, Any] | None = None
    sections: list[Section] = field(default_factory=list)
    rows: dict[str, dict[str, dict[str, float]]] = field(default_factory=dict)
    skipped: list[str] = field(default_factory=list)
    began: float = field(default_factory=time.monotonic)
    share: float = 0.0

    def allow(self, share: float) -> None:
        """Give the next table a share of all seconds. What a table leaves is there for those after it."""
        self.share += share

    def begin(self, section: Section) -> None:
        """Print a table's title and the names of its columns."""
        self.sections.append(section)
        self.rows[section.title] = {}
        print(f"\n{section.title}\n{_line('', [f'{name} ({unit})' for name, unit in section.columns.items()])}")
        sys.stdout.flush()

    def has_time(self, name: str) -> bool:
        """Whether a row of this table may begin; its first always may. One that may not is told at the end."""
        first = not self.rows[self.sections[-1].title]
        left = time.monotonic() - self.began < self.seconds * (1.0 if first else self.share)
        if not left:
            self.skipped.append(name)
        return left

    def add(self, name: str, values: Mapping[str, float]) -> None:
        """Print a row; below it how many times as much each number is as in the run that it is compared with."""
        section = self.sections[-1]
        self.rows[section.title][name] = dict(values)
        print(_line(name, [shown(values.get(column)) for column in section.columns]))
        old = ((self.before or {}).get("rows", {}).get(section.title) or {}).get(name)
        if old:
            print(_line("  times before", [_ratio(values.get(c), old.get(c)) for c in section.columns]))
        sys.stdout.flush()

    def data(self) -> dict[str, Any]:
        """Everything as plain data."""
        return {"machine": machine(), "gaitsim": __version__, "commit": commit(), "rows": self.rows}

    def page(self) -> str:
        """The tables as a page of documentation."""
        made = ", ".join(f"{name} {value}" for name, value in machine().items())
        origin = f"Made by `make bench-page` with gaitsim {__version__}, commit {commit()}, on this machine: {made}."
        lines = ["# Benchmarks", "", origin]
        for section in self.sections:
            heads = ["", *(_head(name, unit) for name, unit in section.columns.items())]
            lines += ["", f"## {section.title}", "", section.about, "", _cells(heads), _cells(["---"] * len(heads))]
            for name, values in self.rows[section.title].items():
                lines.append(_cells([name, *(shown(values.get(column)) for column in section.columns)]))
        if self.skipped:
            lines += ["", f"Left out, because there was no time left: {', '.join(self.skipped)}."]
        return "\n".join([*lines, ""])


def machine() -> dict[str, str]:
    """What times depend on besides the code."""
    cores = str(os.cpu_count())
    return {"processor": llvmlite.binding.get_host_cpu_name(), "cores": cores, "python": platform.python_version()}


def commit() -> str:
    """The commit of this checkout, with a plus if it has changes; unknown outside a checkout."""
    try:
        found = [_git("rev-parse", "--short", "HEAD"), _git("status", "--porcelain", "--untracked-files=no")]
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return found[0] + ("+" if found[1] else "")


def read(path: Path) -> dict[str, Any]:
    """The data that `--json` wrote. Errors: OSError, ValueError."""
    data = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(data, dict) or "rows" not in data:
        raise ValueError("it holds no rows")
    return data


def shown(value: float | None) -> str:
    """A number with three digits, or a dash."""
    if value is None:
        return "-"
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:.3g}"


def _head(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name} ({unit})"


def _ratio(now: float | None, before: float | None) -> str:
    return "-" if now is None or not before else f"{now / before:.2f}"


def _line(name: str, cells: Sequence[str]) -> str:
    return f"{name:<30}" + "".join(f"{cell:>{max(WIDTH, len(cell) + 2)}}" for cell in cells)


def _cells(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _git(*arguments: str) -> str:
    folder = Path(__file__).parent
    return subprocess.run(["git", *arguments], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()
