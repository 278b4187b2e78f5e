"""--adopt never replaces better values by worse ones unasked; which are better is simulated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Ended
from results.foreign import make

from gaitsim.cli.main import main
from gaitsim.units import parse_unit

SEARCH = ("--workers", "0", "--population", "4", "--generations", "2", "--seed", "1")
TUNED = Path("spec.tuned.yaml")


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Any:
    """Commands in a folder with the spec."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    make(tmp_path)

    def run(*words: str) -> Ended:
        with pytest.raises(SystemExit) as ended:
            main(list(words))
        out, err = capsys.readouterr()
        return Ended(int(ended.value.code or 0), out, err)

    return run


def write(angle: str, score: float) -> str:
    """Tuned values beside the spec, with a score that may be that of another objective."""
    TUNED.write_text(f"format: 2\nresult: results/before\nscore: {score}\nvalues: {{odd.angle: {angle}}}\n")
    return TUNED.read_text()


def test_better_values_stay_without_force(command: Any) -> None:
    before = write("5 deg", 99.0)
    ended = command("optimize", "spec.yaml", *SEARCH, "--set", "odd.rest=7 ms", "--adopt", "--json")
    (folder,) = Path("results").iterdir()
    best, there = ended.data["best_score"], parse_unit("deg").to_si(5)
    assert there < best
    rule = f"its values score {there:.6g} here, and the best of this search {best:.6g} (lower is better)"
    again = "gaitsim optimize spec.yaml --resume --set 'odd.rest=7 ms' --workers 0 --adopt --force"
    assert f"spec.tuned.yaml is kept: {rule}. To replace it: {again}\n" in ended.err
    assert (ended.code, ended.data["adopted"], TUNED.read_text()) == (2, False, before)
    forced = command(
        "optimize", "spec.yaml", "--resume", "--set", "odd.rest=7 ms", "--workers", "0", "--adopt", "--force"
    )
    assert forced.code == 0 and "wrote spec.tuned.yaml\n" in forced.err
    assert f"result: {folder}\n" in TUNED.read_text()


def test_worse_values_are_replaced_whatever_score_they_had(command: Any) -> None:
    write("39 deg", -99.0)
    ended = command("optimize", "spec.yaml", *SEARCH, "--adopt", "--json")
    assert (ended.code, ended.data["adopted"]) == (0, True)
    assert "result: results/before" not in TUNED.read_text()


def test_a_damaged_file_stays_without_force(command: Any) -> None:
    TUNED.write_text("gains: 3\n")
    ended = command("optimize", "spec.yaml", *SEARCH, "--adopt")
    rule = "its values cannot be compared, as this holds no tuned values; write it again with optimize --adopt"
    assert ended.code == 2
    assert f"spec.tuned.yaml is kept: {rule}. To replace it: gaitsim optimize spec.yaml --resume" in ended.err
    assert TUNED.read_text() == "gains: 3\n"


def test_force_belongs_to_adopt(command: Any) -> None:
    ended = command("optimize", "spec.yaml", *SEARCH, "--force")
    assert (ended.code, ended.err) == (
        2,
        "--force needs --adopt: it replaces better values; add --adopt, or leave it out.\n",
    )
