"""Where nothing can be written: said in words, early, with nothing half-written left behind."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.cli.main import main

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
    assert refusal(capsys, "--out", "a.csv") == (
        "a.csv: the trajectory cannot be written (Permission denied); choose another --out.\n"
    )


def test_a_file_named_results_is_in_the_way(capsys: pytest.CaptureFixture[str]) -> None:
    Path("results").write_text("mine")
    assert refusal(capsys) == (
        "results: this is a file, and results go into a folder of that name; rename the file, or use --no-save.\n"
    )
    with pytest.raises(SystemExit) as ended:
        main(["run", "spec.yaml", "--no-save"])
    assert ended.value.code == 0
    assert Path("results").read_text() == "mine"


def test_results_cannot_be_written(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    plain = Path.write_text

    def full(self: Path, data: str, **options: object) -> int:
        if self.name == "model.xml":
            raise OSError(28, "No space left on device")
        return plain(self, data, **options)  # type: ignore[arg-type]

    Path("results").mkdir()
    monkeypatch.setattr(Path, "write_text", full)
    assert refusal(capsys).startswith("results: the result cannot be saved (No space left on device); ")


def test_a_failed_run_has_no_trajectory(capsys: pytest.CaptureFixture[str]) -> None:
    Path("spec.yaml").write_text(SPEC.replace("simulate", "initial: {pivot.velocity: 1e160 rad/s}\nsimulate"))
    with pytest.raises(SystemExit) as ended:
        main(["run", "spec.yaml", "--no-save"])
    assert ended.value.code == 4
    assert capsys.readouterr().err.startswith("failed: the mechanics diverged in pivot.angle")
