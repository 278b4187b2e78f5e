"""Known values to compare a model with: specs/reference/<model>.yaml, each with its source."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.replays.replay import Replay
from gaitsim.distribution import shipped_folder
from gaitsim.errors import Fault, InvalidSpec, Mark
from gaitsim.text.document import plain, read

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Reference:
    """Points for a figure in SI, and their source."""

    points: tuple[Floats, Floats]
    source: str


def return_map_of(replay: Replay) -> Reference | None:
    """Known apex heights in m, and the next ones."""
    table = _table(replay)
    rows = table.get("return_map")
    if not rows or not _fits(replay, table):
        return None
    before, after = np.array(rows, dtype=np.float64).T
    return Reference((before, after), str(table["source"]))


def metric_over(replay: Replay, varied: str, metric: str) -> Reference | None:
    """Known values of a metric over a varied number; rows without a value are left out."""
    table = _table(replay)
    rows = [r for r in table.get("sweep", {}).get(varied, []) if r.get(metric) is not None]
    if not rows:
        return None
    points = np.array([(row["at"], row[metric]) for row in rows], dtype=np.float64).T
    return Reference((points[0], points[1]), str(table["source"]))


def _fits(replay: Replay, table: dict[str, Any]) -> bool:
    """Whether the model has the numbers for which the table was made."""
    values = dict(zip((number.address for number in replay.model.numbers), replay.model.values(), strict=True))
    wanted = table.get("with", {})
    return all(address in values and np.isclose(values[address], value) for address, value in wanted.items())


def _table(replay: Replay) -> dict[str, Any]:
    """The table of a model; empty if there is none."""
    folders = [replay.path.parent / "reference", Path("specs/reference"), shipped_folder().parent / "specs/reference"]
    path = next((f / f"{replay.name}.yaml" for f in folders if (f / f"{replay.name}.yaml").is_file()), None)
    if path is None:
        return {}
    table = plain(read(path))
    if not isinstance(table, dict) or "source" not in table:
        raise InvalidSpec(Fault("a table of reference values says its source: and has a sweep:.", Mark(str(path))))
    return table
