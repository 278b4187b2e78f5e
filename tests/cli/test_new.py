"""gaitsim new: a folder in which everything works."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from gaitsim.distribution import shipped_specs

from .commands import gaitsim

FILES = [
    "hopping_leg_mass.yaml",
    "hopping_leg_mass.tuned.yaml",
    "my_hopping_leg_mass.yaml",
    "components/controller/my_reflex.py",
    "tests/test_my_reflex.py",
    "README.md",
]


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_the_files(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "new", "demo", "--json")
    assert json.loads(said.out) == {"folder": "demo", "files": FILES}
    assert sorted(str(p.relative_to("demo")) for p in Path("demo").rglob("*") if p.is_file()) == sorted(FILES)
    assert Path("demo/hopping_leg_mass.yaml").read_text() == shipped_specs()["hopping_leg_mass"].read_text()


def test_everything_in_it_works(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert gaitsim(capsys, "new", "demo").code == 0
    monkeypatch.chdir("demo")
    assert gaitsim(capsys, "library", "check", "components").code == 0
    ran = json.loads(gaitsim(capsys, "run", "my_hopping_leg_mass.yaml", "--json").out)
    assert ran["status"] == "completed"
    assert ran["metrics"]["hop"] > 0.1
    parts = json.loads(gaitsim(capsys, "show", "my_hopping_leg_mass.yaml", "--json").out)["tree"]
    assert {"address": "feedback", "use": "controller/my_reflex"}.items() <= next(
        part for part in parts if part["address"] == "feedback"
    ).items()
    searched = gaitsim(capsys, "optimize", "my_hopping_leg_mass.yaml", "--smoke", "--workers", "0", "--json")
    assert searched.code == 0
    tested = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"], capture_output=True)
    assert tested.returncode == 0, tested.stdout


def test_every_command_of_its_readme_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    gaitsim(capsys, "new", "demo")
    lines = [line.strip() for line in Path("demo/README.md").read_text().splitlines() if line.startswith("    ")]
    assert len(lines) >= 8
    for line in lines:
        words = line.split("#")[0].split()
        assert words[0] == "gaitsim"
        command = words[1:3] if words[1] in ("library", "results") else words[1:2]
        helped = gaitsim(capsys, *command, "--help")
        assert helped.code == 0, line
        assert all(word in helped.out for word in words if word.startswith("--")), line


def test_a_model_without_muscle_feedback_promises_no_file_that_is_not_there(
    capsys: pytest.CaptureFixture[str],
) -> None:
    said = gaitsim(capsys, "new", "demo", "--from", "pendulum_pid")
    assert "cd demo && gaitsim run pendulum_pid.yaml" in said.err
    readme = Path("demo/README.md").read_text(encoding="utf-8")
    assert "my_pendulum_pid" not in readme and "| `components" not in readme
    assert "gaitsim library new controller my_reflex" in readme


def test_a_variant_comes_with_its_parents_and_tuned_values(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert gaitsim(capsys, "new", "demo", "--from", "hopping_leg_mass_free").code == 0
    assert Path("demo/hopping_leg_mass.yaml").is_file() and Path("demo/hopping_leg_mass.tuned.yaml").is_file()
    for name in ("hopping_leg_mass_free", "my_hopping_leg_mass_free"):
        said = gaitsim(capsys, "check", f"demo/{name}.yaml")
        assert said.code == 0, said.err


every_origin = pytest.mark.parametrize(
    "origin", [name for name, path in shipped_specs().items() if "\nextends:" not in path.read_text()]
)


def made_from(origin: str, capsys: pytest.CaptureFixture[str]) -> list[Path]:
    """The specs of a new folder."""
    assert gaitsim(capsys, "new", "demo", "--from", origin).code == 0
    return [spec for spec in Path("demo").glob("*.yaml") if not spec.stem.endswith(".tuned")]


@every_origin
def test_every_shipped_spec_can_be_the_beginning(origin: str, capsys: pytest.CaptureFixture[str]) -> None:
    for spec in made_from(origin, capsys):
        said = gaitsim(capsys, "show", str(spec))
        assert said.code == 0, said.err


@pytest.mark.slow
@every_origin
def test_every_shipped_spec_of_a_new_folder_starts_well(origin: str, capsys: pytest.CaptureFixture[str]) -> None:
    for spec in made_from(origin, capsys):
        said = gaitsim(capsys, "check", str(spec))
        assert (said.code, "at the start" in said.err) == (0, False), said.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["taken"], "taken exists already; gaitsim new makes a folder of its own, so choose another name."),
        (["demo", "--from", "hoping_leg_mass"], "--from hoping_leg_mass: no such spec is shipped. Did you mean"),
    ],
)
def test_what_cannot_be_made_is_told(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("taken").mkdir()
    found = gaitsim(capsys, "new", *words)
    assert found.code == 2
    assert found.err.startswith(said)
    assert not Path("demo").exists()
