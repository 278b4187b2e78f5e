"""Results run again for ever: candidates, verify, adopted values, trust, and a debugger."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from optimization.searches import Ended, Study, signed

from gaitsim.cli.main import main
from gaitsim.results import store

ROOT = Path(__file__).parents[2]
SMALL = ("--workers", "0", "--set", "simulate.duration=500ms", "--generations", "2", "--seed", "3")


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    return Study(tmp_path)


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Any:
    def run(*words: str) -> Ended:
        with pytest.raises(SystemExit) as ended:
            main(list(words))
        out, err = capsys.readouterr()
        assert "Traceback" not in err, err
        return Ended(int(ended.value.code or 0), out, err)

    return run


@pytest.fixture
def begun(command: Any, study: Study) -> Path:
    assert command("optimize", "spec.yaml", *SMALL).code == 0
    return study.result.relative_to(study.folder)


def journal(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / "evaluations.jsonl").read_text().splitlines()]


def test_a_candidate_gives_its_score_again(begun: Path, command: Any) -> None:
    lines = journal(begun)
    ranked = sorted(lines, key=lambda line: line["score"])
    assert len({line["score"] for line in lines}) > 5
    for which, line in (("best", ranked[0]), ("1", ranked[0]), ("2", ranked[1]), ("1:0", lines[1]), ("0:0", lines[0])):
        ended = command("run", str(begun), "--candidate", which, "--no-save", "--json")
        assert ended.data["score"] == line["score"]
        assert ended.data["metrics"] == line["metrics"]
        assert f"candidate {line['generation']}:{line['index']} of {begun}" in ended.err
    assert command("run", str(begun), "--no-save", "--json").data["score"] == ranked[0]["score"]


def test_a_run_of_a_candidate_is_a_result_that_verifies(begun: Path, command: Any) -> None:
    ended = command("run", str(begun), "--candidate", "2", "--json")
    again = command("run", ended.data["result"], "--no-save", "--json")
    assert again.data["score"] == ended.data["score"]
    assert command("results", "verify", ended.data["result"]).code == 0


def test_verify_notices_a_changed_number(begun: Path, command: Any) -> None:
    assert command("results", "verify", str(begun), "--all", "--json").data["status"] == "reproduced"
    path = begun / "evaluations.jsonl"
    lines = path.read_text().splitlines(keepends=True)
    lines[3] = signed(lines[3], metrics={"angle": json.loads(lines[3])["metrics"]["angle"] + 1e-16 * 2})
    lines[5] = signed(lines[5], score=0.0)
    path.write_text("".join(lines))
    ended = command("results", "verify", str(begun), "--all", "--json")
    assert (ended.code, ended.data["status"]) == (4, "differs")
    differing = {check["candidate"]: check["differs"] for check in ended.data["checked"] if check["differs"]}
    assert list(differing) == ["1:2", "1:4"]
    assert differing["1:2"][0].startswith("angle: ")
    assert "11 of 13 runs reproduced bit for bit" in command("results", "verify", str(begun), "--all").out


def test_list_and_show(begun: Path, command: Any) -> None:
    best = min(line["score"] for line in journal(begun))
    (row,) = command("results", "list", "--json").data["results"]
    assert (row["result"], row["kind"], row["status"]) == (str(begun), "optimize", "complete")
    assert (row["best_score"], row["evaluations"]) == (best, 13)
    shown = command("results", "show", str(begun))
    assert "balance.proportional" in shown.out and "2 generations done" in shown.out
    data = command("results", "show", str(begun), "--json").data
    assert data["search"] == {"algorithm": "cma", "population": 6, "generations": 2, "seed": 3, "spread_factor": 1.0}


def test_the_default_population_is_written_down(study: Study, command: Any) -> None:
    (study.folder / "spec.yaml").write_text((study.folder / "spec.yaml").read_text().replace("population: 6, ", ""))
    assert command("optimize", "spec.yaml", *SMALL).code == 0
    assert study.manifest()["search"]["population"] == 7  # 4 + 3 log(3 parameters)


def test_adopted_values_are_used_and_named(study: Study, command: Any) -> None:
    ended = command("optimize", "spec.yaml", *SMALL, "--adopt", "--json")
    assert "wrote spec.tuned.yaml" in ended.err
    best, settings = ended.data["best_score"], ("--set", "simulate.duration=500ms", "--no-save", "--json")
    tuned = command("run", "spec.yaml", *settings)
    assert tuned.data["score"] == best
    assert f"tuned values from spec.tuned.yaml (results/{study.result.name}); --start ignores them" in tuned.err
    start = command("run", "spec.yaml", *settings, "--start")
    assert start.data["score"] == journal(study.result)[0]["score"] != best
    assert "tuned" not in start.err


def test_a_search_starts_where_another_ended(begun: Path, study: Study, command: Any) -> None:
    best = min(journal(begun), key=lambda line: line["score"])
    second = command("optimize", "spec.yaml", *SMALL, "--from", str(begun), "--json")
    addresses = "balance.proportional, balance.derivative, trap.level"
    assert f"start from {begun}: {addresses}\n" in second.err
    folder = Path(second.data["result"])
    assert journal(folder)[0]["x"] == best["x"]
    assert journal(folder)[0]["score"] == best["score"]
    assert command("results", "verify", str(folder), "--all").code == 0
    assert command("optimize", "spec.yaml", *SMALL, "--adopt").code == 0
    third = command("optimize", "spec.yaml", *SMALL, "--from", "tuned", "--json")
    assert journal(Path(third.data["result"]))[0]["score"] == best["score"]


def test_a_search_from_the_middle_of_all_bounds(study: Study, command: Any) -> None:
    ended = command("optimize", "spec.yaml", *SMALL, "--from", "middle", "--json")
    assert "start from the middle of all bounds: balance.proportional," in ended.err
    folder = Path(ended.data["result"])
    rows = [line.split(",") for line in (folder / "parameters.csv").read_text().splitlines()]
    middles = [(float(row[2]) + float(row[3])) / 2 for row in rows[1:]]
    assert len(middles) == 3 and journal(folder)[0]["x"] == pytest.approx(middles)


def test_a_start_from_elsewhere_says_what_was_not_found(begun: Path, study: Study, command: Any) -> None:
    text = (study.folder / "spec.yaml").read_text().replace("trap: {use", "snare: {use")
    (study.folder / "other.yaml").write_text(text)
    ended = command("optimize", "other.yaml", *SMALL, "--from", str(begun))
    assert ended.code == 0
    assert "balance.proportional, balance.derivative; not found there: snare.level\n" in ended.err


def test_strange_code_is_not_run_unasked(begun: Path, study: Study, command: Any, monkeypatch: Any) -> None:
    other = study.folder / "other machine"
    shutil.copytree(begun, other / begun)
    monkeypatch.chdir(other)
    monkeypatch.setenv("GAITSIM_STATE", str(other / "state"))
    file = begun / "components" / "trap" / "none.py"
    said = f"{begun}: running it would run code that this machine does not know: {file}; read these files, then use"
    for words in (
        ["run", str(begun)],
        ["results", "verify", str(begun)],
        ["optimize", str(begun), "--resume", "--generations", "3", "--workers", "0"],
        ["optimize", "../spec.yaml", "--from", str(begun)],
    ):
        ended = command(*words)
        assert (ended.code, said in ended.err) == (3, True), ended.err
    assert command("results", "verify", str(begun), "--trust").code == 0
    assert command("run", str(begun), "--no-save", "--trust").code == 0


def test_an_edited_muscle_in_the_library_changes_no_result(tmp_path: Path, command: Any, monkeypatch: Any) -> None:
    """With a copy of the library, as a researcher's lab has it."""
    monkeypatch.chdir(tmp_path)
    Path("lab.yaml").write_text("gaitsim: 1\n")
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    shutil.copytree(ROOT / "library", tmp_path / "library", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "specs", tmp_path / "specs")
    spec = "specs/hopping_geyer2003.yaml"
    words = ("--set", "simulate.duration=1s", "--json")
    searched = command("optimize", spec, *words, "--workers", "0", "--population", "3", "--generations", "1")
    folder = searched.data["result"]
    single = command("run", spec, *words)
    muscle = tmp_path / "library" / "muscle" / "geyer2003.py"
    old = muscle.read_text()
    line = next(text for text in old.splitlines() if "y.tendon_force =" in text or "y.force =" in text)
    muscle.write_text(old.replace(line, f"{line} * 0.9"))
    assert command("run", spec, *words, "--no-save").data["metrics"] != single.data["metrics"]
    for result in (folder, single.data["result"]):
        ended = command("results", "verify", result, "--all", "--json")
        assert (ended.code, ended.data["status"]) == (0, "reproduced"), ended.err
    best = command("run", folder, "--candidate", "best", "--no-save", "--json")
    assert best.data["score"] == searched.data["best_score"]
    assert command("optimize", folder, "--resume", "--generations", "2", "--workers", "0").code == 0
    assert "library/muscle/geyer2003" not in command("results", "verify", folder, "--all").err


DEBUG = ("--workers", "0", "--mode", "normal", "--set", "simulate.duration=3ms", "--generations", "1")


def test_a_debugger_stops_in_a_component(study: Study) -> None:
    words = ("optimize", "spec.yaml", *DEBUG, "--set", "parts.trap.use=trap/stops")
    start = ("--set", "trap.level={value: 0.9, tune: [0.8, 1], spread: 0.01}")
    typed = ["p 'level', float(p.level)", "w", "import sys", "sys.breakpointhook = int", "continue"]
    ended = study.run_apart(*words, *start, said="\n".join([*typed, ""]))
    assert "components/trap/stops.py(27)update()" in ended.out
    assert "('level', 0.9)" in ended.out
    assert ended.code == 0, ended.err
    assert study.manifest()["mode"] == "normal"


def test_normal_mode_warns(study: Study) -> None:
    start = ("--set", "trap.level={value: 0.9, tune: [0.8, 1], spread: 0.01}")
    ended = study.run_apart("optimize", "spec.yaml", *DEBUG, "--set", "parts.trap.use=trap/warns", *start)
    assert "components/trap/warns.py:27: RuntimeWarning: divide by zero" in ended.err


def test_normal_mode_gives_the_same_search(study: Study, command: Any) -> None:
    small = ("--workers", "0", "--set", "simulate.duration=50ms", "--generations", "1")
    for mode in ("rapid", "normal"):
        assert command("optimize", "spec.yaml", *small, "--mode", mode).code == 0
    rapid, normal = ([(line["x"], line["score"]) for line in journal(folder)] for folder in study.results)
    assert [x for x, _ in rapid] == [x for x, _ in normal]
    assert [score for _, score in rapid] == pytest.approx([score for _, score in normal], rel=1e-9)


def test_notes_that_are_no_longer_utf8_stay_readable(tmp_path: Path) -> None:
    (tmp_path / "README.md").write_bytes(b"# A result\n\n## Notes\n\ngood \xa0 gait\n")
    store.finish(tmp_path, {"name": "a", "gaitsim": "1", "created": "2026", "status": "completed"}, [])
    assert "good \\xa0 gait" in (tmp_path / "README.md").read_text(encoding="utf-8")
