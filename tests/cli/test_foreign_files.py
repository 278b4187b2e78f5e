"""Files and names that are none of ours: no word of them is repeated, and none ends a command in a traceback."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.commands import Said
from cli.commands import gaitsim as run_gaitsim

SECRET = "root:$6$hushhush:19000:0:99999:7:::"
SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
simulate: {duration: 2 ms, step: 1 ms}
"""


@pytest.fixture
def gaitsim(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Said]:
    monkeypatch.chdir(tmp_path)
    Path("spec.yaml").write_text(SPEC)
    return lambda *words: run_gaitsim(capsys, *words)


@pytest.mark.parametrize(
    "text", [SECRET, f"{SECRET}\ngaitsim:$6$x:1\n", "password: hushhush", "- hushhush", "hushhush: [", "\thushhush"]
)
def test_a_parent_that_is_no_spec(text: str, gaitsim: Callable[..., Said]) -> None:
    Path("shadow").write_text(text)
    Path("spec.yaml").write_text("gaitsim: 1\nextends: shadow\n")
    said = gaitsim("check", "spec.yaml", "--json")
    assert said.code == 3 and "hushhush" not in said.out + said.err
    assert said.err == (
        "spec.yaml:2:10: extends: shadow is not a spec, as it has none of a spec's sections, such as parts:; "
        "name a spec."
        "\n    2 | extends: shadow\n      |          ^\n"
    )


@pytest.mark.parametrize("name", ["controller/secret.py", "controller/secret.yaml", "joint/kind.yaml"])
def test_a_component_that_links_to_another_kind_of_file(name: str, gaitsim: Callable[..., Said]) -> None:
    Path("shadow").write_text(SECRET)
    link = Path("components") / name
    link.parent.mkdir(parents=True)
    link.symlink_to(Path("shadow").absolute())
    Path("spec.yaml").write_text(SPEC.replace("parts:", "parts:\n  spy: {use: controller/secret}"))
    said = gaitsim("check", "spec.yaml")
    assert said.code == 3 and "hushhush" not in said.out + said.err
    if "kind" not in name:
        rule = f"this links to {Path('shadow').absolute()}, which is not a {link.suffix} file"
        assert f"{link}: {rule}; name a component of your own." in said.err


def test_a_table_that_links_to_another_kind_of_file(gaitsim: Callable[..., Said]) -> None:
    Path("shadow").write_text(SECRET)
    Path("components/norms").mkdir(parents=True)
    Path("components/norms/secret.csv").symlink_to(Path("shadow").absolute())
    curve = "measures: {knee: {use: measure/gait_curve, signal: {from: pivot.angle}, curve: norms/secret.knee}}"
    Path("spec.yaml").write_text(SPEC + curve)
    said = gaitsim("check", "spec.yaml")
    assert said.code == 3 and "hushhush" not in said.out + said.err
    assert "which is not a .csv file; name a table of your own." in said.err


def test_a_name_that_is_no_text(gaitsim: Callable[..., Said]) -> None:
    name = os.fsdecode(b"walk\xff.yaml")
    Path(name).write_text(SPEC)
    for words in (("run", name), ("optimize", name), ("check", "spec.yaml", "--library", name)):
        said = gaitsim(*words)
        assert (said.code, said.err) == (
            2,
            "walk\\udcff.yaml: this name is not UTF-8, so no text can hold it; rename the file.\n",
        )
    folder = Path("results") / os.fsdecode(b"R\xff")
    folder.mkdir(parents=True)
    (folder / "manifest.json").write_text("{}")
    said = gaitsim("results", "list")
    assert (said.code, "damaged" in said.out) == (0, True)
    assert gaitsim("results", "list", "--json").code == 0
    assert gaitsim("check", "missing.yaml").code == 3


def test_a_folder_that_is_gone(gaitsim: Callable[..., Said], tmp_path: Path) -> None:
    Path("away").mkdir()
    os.chdir("away")
    (tmp_path / "away").rmdir()
    said = gaitsim("results", "list")
    os.chdir(tmp_path)
    assert (said.code, said.err) == (2, "the current folder no longer exists; change to another one.\n")


@pytest.mark.parametrize("where", ["reference", "part", "address", "key"])
def test_a_word_of_two_megabytes_is_not_repeated(where: str, gaitsim: Callable[..., Said]) -> None:
    long = "a" * 2_000_000
    text = {
        "reference": SPEC.replace("segment/rod", f"segment/{long}"),
        "part": SPEC.replace("pivot", long),
        "key": SPEC.replace("mass", long),
        "address": SPEC.replace("pendulum.proximal", f"{long}.proximal"),
    }[where]
    Path("spec.yaml").write_text(text)
    said = gaitsim("check", "spec.yaml", "--json")
    assert len(said.err) < 5000 and len(said.out) < 9000, (len(said.err), len(said.out))


def test_printed_commands_can_be_pasted(gaitsim: Callable[..., Said]) -> None:
    name = "my walk; echo it's.yaml"
    Path(name).write_text(SPEC)
    Path("results").mkdir()
    saved = gaitsim("run", name, "--vary", "pendulum.mass=1 kg,2 kg", "--json")
    folder = json.loads(saved.out)["result"]
    said = gaitsim("optimize", folder)
    again = f"gaitsim optimize '{folder.replace(chr(39), chr(39) + chr(34) + chr(39) + chr(34) + chr(39))}' --resume"
    assert again in said.err
    said = gaitsim("new", "a b", "--from", "pendulum_pid")
    assert said.err == "next: cd 'a b' && gaitsim run pendulum_pid.yaml; more in a b/README.md\n"
