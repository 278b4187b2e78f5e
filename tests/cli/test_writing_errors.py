"""Where nothing can be written: said in words, early, with nothing half-written left behind."""

from __future__ import annotations

import json
import resource
from pathlib import Path
from typing import Any

import pytest

from gaitsim.cli.main import main
from gaitsim.results.manifest import read_manifest
from gaitsim.results.record import Record
from gaitsim.results.rows import read_rows

SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
simulate: {duration: 2 ms, step: 1 ms}
"""


@pytest.fixture(autouse=True)
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "spec.yaml").write_text(SPEC)
    return tmp_path


def refusal(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    before = sorted(Path().rglob("*"))
    with pytest.raises(SystemExit) as ended:
        main(["run", "spec.yaml", *words])
    out, err = capsys.readouterr()
    assert (ended.value.code, out) == (3, "")
    assert sorted(Path().rglob("*")) == before
    return err


def test_out_is_a_folder(capsys: pytest.CaptureFixture[str]) -> None:
    Path("plots").mkdir()
    assert refusal(capsys, "--out", "plots") == (
        "plots: this is a folder; name a file in it, such as --out plots/trajectory.csv.\n"
    )


def test_out_lies_below_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert refusal(capsys, "--out", "spec.yaml/a.csv") == (
        "spec.yaml/a.csv: spec.yaml is a file, so nothing can be written below it; choose another --out.\n"
    )


def test_out_without_permission(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    plain = Path.open

    def denied(self: Path, mode: str = "r", **options: object) -> object:
        if "w" in mode and self.name.startswith("a.csv"):
            raise PermissionError(13, "Permission denied")
        return plain(self, mode, **options)  # type: ignore[call-overload]

    monkeypatch.setattr(Path, "open", denied)
    code, out, err = gaitsim(capsys, "run", "spec.yaml", "--out", "a.csv")
    assert (code, "completed: 0.002 s in 2 steps" in out) == (3, True)
    assert err.splitlines()[-1] == "a.csv: the trajectory cannot be written (Permission denied); choose another --out."
    assert not Path("a.csv").exists()


def test_a_file_named_results_is_in_the_way(capsys: pytest.CaptureFixture[str]) -> None:
    Path("results").write_text("mine")
    assert refusal(capsys) == (
        "results: this is a file, and results go into a folder of that name; "
        "rename the file, name another folder with --results, or use --no-save.\n"
    )
    with pytest.raises(SystemExit) as ended:
        main(["run", "spec.yaml", "--no-save"])
    assert ended.value.code == 0
    assert Path("results").read_text() == "mine"


def gaitsim(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    code = ended.value.code
    assert isinstance(code, int)
    return code, *capsys.readouterr()


def test_what_was_computed_is_printed_if_it_cannot_be_saved(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = Path.write_text

    def full(self: Path, data: str, **options: object) -> int:
        if self.name == "model.xml":
            raise OSError(28, "No space left on device")
        return plain(self, data, **options)  # type: ignore[arg-type]

    Path("results").mkdir()
    monkeypatch.setattr(Path, "write_text", full)
    code, out, err = gaitsim(capsys, "run", "spec.yaml", "--json")
    assert (code, json.loads(out)["result"]) == (3, None)
    assert err.splitlines()[-1] == (
        "results: the result cannot be saved (No space left on device); "
        "make room or rights there, name another folder with --results, or use --no-save."
    )
    code, out, err = gaitsim(capsys, "run", "spec.yaml")
    assert (code, "completed: 0.002 s in 2 steps" in out) == (3, True)
    assert list(Path("results").iterdir()) == []


def test_a_study_is_kept_row_by_row(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """The disk is full at its third row: two are whole, and all are printed."""
    append = Record._append
    rows: list[str] = []

    def full(self: Record, line: str) -> None:
        rows.append(line)
        limit = resource.getrlimit(resource.RLIMIT_FSIZE)
        if len(rows) == 2:
            size = (Path(str(self.folder)) / "evaluations.jsonl").stat().st_size
            resource.setrlimit(resource.RLIMIT_FSIZE, (size + 10, limit[1]))
        try:
            append(self, line)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limit)

    monkeypatch.setattr(Record, "_append", full)
    code, out, err = gaitsim(capsys, "run", "spec.yaml", "--vary", "pendulum.mass=1 kg:4 kg:4", "--json")
    (folder,) = Path("results").iterdir()
    assert (code, len(json.loads(out)["rows"])) == (3, 4)
    assert err.splitlines()[-1] == f"{folder}: the result cannot be saved (File too large); the first 2 runs are in it."
    assert [row["settings"] for row in read_rows(folder)] == [{"pendulum.mass": f"{n}.0 kg"} for n in (1, 2)]
    assert read_manifest(folder)["status"] == "interrupted"
    assert gaitsim(capsys, "results", "verify", str(folder))[0] == 0


def test_an_interrupted_study_prints_and_keeps_what_it_has(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    add, kept = Record.add, []

    def stopped(self: Record, *row: Any) -> None:
        add(self, *row)
        kept.append(row)
        if len(kept) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Record, "add", stopped)
    code, out, err = gaitsim(capsys, "run", "spec.yaml", "--vary", "pendulum.mass=1 kg:4 kg:4")
    (folder,) = Path("results").iterdir()
    assert (code, err.splitlines()[-1]) == (130, f"saved in {folder}")
    assert out.count("completed") == len(read_rows(folder)) == 2
    assert read_manifest(folder)["status"] == "interrupted"


def test_a_failed_run_has_no_trajectory(capsys: pytest.CaptureFixture[str]) -> None:
    Path("spec.yaml").write_text(SPEC.replace("simulate", "initial: {pivot.velocity: 1e160 rad/s}\nsimulate"))
    with pytest.raises(SystemExit) as ended:
        main(["run", "spec.yaml", "--no-save"])
    assert ended.value.code == 4
    assert capsys.readouterr().err.startswith("failed: the mechanics diverged in pivot.angle")
