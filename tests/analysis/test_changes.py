"""Gaits of several walkers beside each other, and what changes from the first one."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from gaitsim.analysis.gait.changes import changes_table, gait_changes
from gaitsim.analysis.report.report import write
from tests.analysis.replays import cut
from tests.analysis.walking import bent, walk


def test_each_quantity_of_each_run_beside_the_first() -> None:
    found = gait_changes([bent("healthy", 60), bent("stiff knee", 40)])
    knee = found["knee_flexion_highest"]
    assert knee["unit"] == "deg"
    assert knee["values"] == pytest.approx({"healthy": 60, "stiff knee": 40}, abs=0.1)
    assert found["knee_flexion_at_touchdown"]["values"]["healthy"] == pytest.approx(0, abs=0.1)
    assert found["stance"]["values"] == pytest.approx({"healthy": 60, "stiff knee": 60}, abs=0.5)
    table = changes_table([bent("healthy", 60), bent("stiff knee", 40)])
    assert table is not None and table.columns == ("gait", "unit", "healthy", "stiff knee")
    rows = {row[0]: row[1:] for row in table.rows}
    assert rows["knee_flexion_highest"] == ("deg", "60", "40 (\N{MINUS SIGN}20)")
    assert rows["cadence"][2].endswith(" (0)")


def test_a_run_that_does_not_walk_has_no_column() -> None:
    fallen = replace(cut(walk({}), 400), label="fallen")
    assert gait_changes([bent("healthy", 60), fallen]) == {}
    assert changes_table([bent("healthy", 60), fallen]) is None
    table = changes_table([bent("healthy", 60), fallen, bent("stiff knee", 40)])
    assert table is not None and table.columns[2:] == ("healthy", "stiff knee")


def test_the_report_has_the_changes(tmp_path: Path) -> None:
    page = write(tmp_path / "report.html", [bent("healthy", 60), bent("stiff knee", 40)], []).read_text("utf-8")
    assert "What differs from healthy" in page and "40 (\N{MINUS SIGN}20)" in page
    assert "What differs from" not in write(tmp_path / "report.html", [bent("healthy", 60)], []).read_text("utf-8")


def test_changes_are_data() -> None:
    found = gait_changes([bent("healthy", 60), bent("stiff knee", 40)])
    assert json.loads(json.dumps(found)) == found
