"""What README and docs show is right: code runs, commands exist, specs are valid."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest
from typer.main import get_command

import gaitsim
from gaitsim.cli.main import app, main
from gaitsim.components.find import Library, shipped_folder
from gaitsim.components.review import review
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
RESULT = re.compile(r"results/20[\w-]+")


def blocks(language: str) -> list[Any]:
    """The fenced code of a language on all pages."""
    found = []
    for page in PAGES:
        texts = re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)
        found += [pytest.param(text, id=f"{page.stem}-{k}") for k, text in enumerate(texts, start=1)]
    return found


def commands() -> list[str]:
    """The commands in indented code, lines that are continued joined, without their comments."""
    found = list[str]()
    for page in PAGES:
        text = page.read_text(encoding="utf-8").replace("\\\n", " ")
        lines = [line for line in text.splitlines() if line.startswith("    ")]
        for line in lines:
            parts = re.split(r"\s&&\s", line.strip())
            found += [part.partition(" #")[0].strip() for part in parts if part.startswith("gaitsim ")]
    return list(dict.fromkeys(found))


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A small search, as the pages speak of one."""
    place = tmp_path_factory.mktemp("docs")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        with pytest.raises(SystemExit) as ended:
            main(["optimize", str(ROOT / "specs" / "hopping_leg_mass.yaml"), "--smoke", "--workers", "0"])
        assert ended.value.code == 0
    (found,) = (place / "results").iterdir()
    return str(found)


@pytest.mark.parametrize("text", blocks("python"))
def test_code_of_the_pages_runs(text: str, result: str, tmp_path: Path) -> None:
    if "(Component)" in text:
        kind = tmp_path / "components" / "activation"
        kind.mkdir(parents=True)
        (kind / "my_activation.py").write_text(text)
        assert review("activation/my_activation", Library((tmp_path / "components", shipped_folder()))) == []
        return
    space: dict[str, Any] = {}
    mpl.use("agg")
    exec(RESULT.sub(result, text), space)
    assert space["gaitsim"] is gaitsim


@pytest.mark.parametrize("text", blocks("yaml"))
def test_specs_of_the_pages_run(text: str) -> None:
    text = text.replace("duration: 20 s", "duration: 0.1 s")
    model = resolve(parse(text, "page.yaml"), Library((shipped_folder(),)), "page")
    assert Simulator(model).run().status == "completed"


def test_the_component_of_the_page_takes_the_place_of_the_librarys(tmp_path: Path) -> None:
    (text,) = [block.values[0] for block in blocks("python") if "(Component)" in block.values[0]]
    (spec,) = [block.values[0] for block in blocks("yaml")]
    (tmp_path / "activation").mkdir()
    (tmp_path / "activation" / "my_activation.py").write_text(text)
    spec = spec.replace("duration: 20 s", "duration: 0.5 s") + "use_for: {activation: activation/my_activation}\n"
    model = resolve(parse(spec, "page.yaml"), Library((tmp_path, shipped_folder())), "page")
    assert "activation/my_activation" in {part.type.reference for part in model.parts}
    assert Simulator(model).run().status == "completed"


@pytest.mark.parametrize("line", commands())
def test_commands_of_the_pages_exist(line: str) -> None:
    """Every command, option and spec that a page names; nothing is run."""
    words = [word for word in shlex.split(line)[1:] if word != "--install-completion"]  # it writes files
    if ">" in words:
        words = words[: words.index(">")]
    here: Any = get_command(app)
    while hasattr(here, "commands") and words and words[0] in here.commands:
        here, words = here.commands[words[0]], words[1:]
    here.make_context("gaitsim", words, resilient_parsing=False) if words else here
    for spec in (word for word in words if word.startswith("specs/")):
        assert (ROOT / spec).is_file()


def test_the_pages_have_examples() -> None:
    assert len(commands()) > 40
    assert len(blocks("python")) >= 3
