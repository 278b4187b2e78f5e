"""Results of strangers: nothing in them runs unasked, wherever they lie and whatever is a link in them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cli.commands import Said
from cli.commands import gaitsim as run_gaitsim

from gaitsim.components.load import digest_of
from gaitsim.results import bundle
from gaitsim.results.bundle import read_bundle
from gaitsim.results.trust import Untrusted, check_trust, remember

SPEC = """\
gaitsim: 1
simulate: {duration: 10 ms, step: 1 ms}
parts: {brake: {use: controller/brake, angle: 1 rad}}
"""
OURS = '''"""A brake."""

from gaitsim.component import Component, Input, Output


class Brake(Component):
    """A torque against an angle."""

    angle = Input("rad", "Angle.")
    torque = Output("1", "Share of a torque.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = -1.0 * u.angle
'''
PLANTED = f"{OURS}\n\nSTRANGE = [][1]\n"  # raises wherever it runs


@pytest.fixture(autouse=True)
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))


@pytest.fixture
def gaitsim(capsys: pytest.CaptureFixture[str]) -> Callable[..., Said]:
    return lambda *words: run_gaitsim(capsys, *words)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A stranger's result, of which one component is not known here."""
    made = tmp_path / "results" / "R"
    (made / "components" / "controller").mkdir(parents=True)
    (made / "components" / "controller" / "brake.py").write_text(PLANTED)
    (made / "spec.yaml").write_text(SPEC)
    signed(made)
    return made


def signed(folder: Path) -> None:
    """Write the manifest that a stranger would: everything in it is as it should be."""
    manifest = {
        "kind": "run",
        "status": "complete",
        "name": "spec",
        "mode": "rapid",
        "created": "2026-11-26T00:00:00+00:00",
        "gaitsim": "0",
        "versions": {},
        "digest": read_bundle(folder, "spec").digest,
    }
    row = {"settings": {}, "status": "completed", "reason": "", "score": None, "metrics": {}, "steps": 10}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    (folder / "evaluations.jsonl").write_text(json.dumps(row) + "\n")


def linked(path: Path, away: Path) -> None:
    """Move something aside, and put a link in its place."""
    path.rename(away)
    path.symlink_to(away)


LINKS: dict[str, Callable[[Path, Path], None]] = {
    "none": lambda folder, away: None,
    "result": linked,
    "components": lambda folder, away: linked(folder / "components", away),
    "kind": lambda folder, away: linked(folder / "components" / "controller", away),
    "file": lambda folder, away: linked(folder / "components" / "controller" / "brake.py", away),
    "hard link": lambda folder, away: (folder / "components" / "controller" / "brake.py").hardlink_to(away)
    if (folder / "components" / "controller" / "brake.py").replace(away)
    else None,
}
COMMANDS = (("check",), ("run",), ("analyze",), ("cite",), ("show",), ("limit", "--vary", "brake.angle=1 rad:2 rad"))


@pytest.mark.parametrize("link", LINKS)
def test_a_planted_component_is_seen_behind_every_link(
    link: str, folder: Path, tmp_path: Path, gaitsim: Any
) -> None:
    LINKS[link](folder, tmp_path / "away")
    signed(folder)
    for command in (*COMMANDS, ("results", "verify")):
        at = 2 if command[0] == "results" else 1
        ended = gaitsim(*command[:at], "results/R", *command[at:])
        rule = "running it would run code that this machine does not know"
        assert ended.err.splitlines()[:1] == [
            f"results/R: {rule}: results/R/components/controller/brake.py; read these files, then use --trust."
        ], command
        assert ended.code == 3


def test_what_a_link_shows_instead_is_an_edit(folder: Path, tmp_path: Path, gaitsim: Any) -> None:
    kind = folder / "components" / "controller"
    (kind / "brake.py").write_text(OURS)
    signed(folder)
    remember(read_bundle(folder, "spec"))
    assert gaitsim("check", "results/R").code == 0
    linked(kind, tmp_path / "away")
    assert gaitsim("check", "results/R").code == 0  # the same bytes
    (tmp_path / "away" / "brake.py").write_text(PLANTED)
    ended = gaitsim("check", "results/R")
    assert (ended.code, "its spec or components were edited after it was made" in ended.err) == (3, True)


@pytest.mark.parametrize("place", ["components", "library"])
@pytest.mark.parametrize("option", [(), ("--library", "components")])
def test_the_folder_of_a_command_vouches_for_nothing(
    place: str, option: tuple[str, ...], folder: Path, tmp_path: Path, gaitsim: Any
) -> None:
    """A project that was sent with its results has the same component in its own library."""
    shutil.copytree(folder / "components", tmp_path / "components")
    shutil.copytree(folder / "components", tmp_path / place, dirs_exist_ok=True)
    ended = gaitsim("check", "results/R", *option)
    assert (ended.code, "does not know" in ended.err) == (3, True), ended.err


def test_the_spec_inside_a_result_does_not_bring_its_components(folder: Path, gaitsim: Any) -> None:
    for command in (("check",), ("run",), ("optimize",)):
        ended = gaitsim(*command, "results/R/spec.yaml")
        assert (ended.code, ended.err) == (
            2,
            "results/R/spec.yaml: this is the spec of a result, and its components are run with that only; "
            "name the result, results/R, or copy the file to a folder of your own.\n",
        )


@pytest.mark.parametrize("variable", ["GAITSIM_STATE", "XDG_STATE_HOME", "HOME"])
def test_no_memory_is_looked_for_from_the_current_folder(
    variable: str, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("GAITSIM_STATE", "XDG_STATE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv(variable, "sent")
    for memory in ("sent/gaitsim", "sent/.local/state/gaitsim"):
        (tmp_path / memory).mkdir(parents=True)
        (tmp_path / memory / "known_components").write_text(digest_of(PLANTED))
    with pytest.raises(Untrusted):
        check_trust(read_bundle(folder, "spec"), False)


def test_a_result_is_read_once(folder: Path, monkeypatch: pytest.MonkeyPatch, gaitsim: Any) -> None:
    """What changes on the disk while a command runs changes nothing in it."""
    component = folder / "components" / "controller" / "brake.py"
    component.write_text(OURS)
    signed(folder)
    remember(read_bundle(folder, "spec"))
    read = bundle._text
    seen: list[Path] = []

    def swapped(path: Path) -> str:
        seen.append(path)
        text = read(path)
        if path.name == "brake.py":
            component.write_text(PLANTED)
        return text

    monkeypatch.setattr(bundle, "_text", swapped)
    for words in (("check", "results/R"), ("run", "results/R", "--no-save"), ("results", "verify", "results/R")):
        component.write_text(OURS)
        seen.clear()
        ended = gaitsim(*words)
        assert ended.code in (0, 4), ended.err  # verify: this record has no metrics
        assert "IndexError" not in ended.err
        assert sorted(path.name for path in seen) == ["brake.py", "spec.yaml"]


@pytest.mark.parametrize("start", ["[1]", '{"a": "x"}', "3", '{"a": null}', "[" * 5000, '{"a": 1' + "0" * 400 + "}"])
def test_starts_that_are_no_numbers(folder: Path, start: str, gaitsim: Any) -> None:
    (folder / "components" / "controller" / "brake.py").write_text(OURS)
    (folder / "start.json").write_text(start)
    signed(folder)
    remember(read_bundle(folder, "spec"))
    ended = gaitsim("check", "results/R")
    assert (ended.code, ended.err) == (
        3,
        "results/R/start.json: this is not a mapping of addresses to numbers; restore this file from a copy.\n",
    )
