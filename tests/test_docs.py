"""What README, CONTRIBUTING and docs/ show is right: a page is a session, and its blocks are run in order.

A block with a title is a file and is written. `sh` blocks are commands, and `text` blocks what they print, with lines
left out. Untitled `python` blocks are run, and untitled `yaml` blocks are pieces of a spec.

The fast tests run what is cheap: checks, listings, new files, and runs of 20 ms in plain Python. The slow ones run
everything, with searches and limits made small. Benchmarks, clusters, viewers and make are only looked up.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import pytest
from typer.main import get_command

from gaitsim.cli.main import main
from gaitsim.cli.program import whole_program
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.text.document import parse

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(
    r'^(?P<in> *)```(?P<language>\w+)(?: title="(?P<title>[^"]+)")?\n(?P<text>.*?)^(?P=in)```$', re.M | re.S
)
RESULT = re.compile(r"results/20\d\d-\d\d-\d\d-(\w+)-[0-9a-f]{4}")
LINK = re.compile(r"\]\((?!https?:)([^)#]+)(?:#[^)]*)?\)")
NAMED = re.compile(r"`((?:gaitsim|tests|library|specs|bench|docs)/[\w./]+)`")
GROUPS = ("archive", "library", "results")
QUICK = {"check", "show", "cite", "new", "schema", "library list", "library show", "library check", "library new"}
QUICK |= {
    "results list",
    "results show",
    "results note",
    "results remove",
    "results export",
    "results import",
    "projects",
}
UNRUN = ("view", "--cluster", "--help", "--install-completion")
SHORT = ["--mode", "normal", "--set", "simulate.duration=20 ms"]
TREE: Any = get_command(whole_program())  # made once: to make it takes longer than most commands
LONG = ("--vary", "--draws", "--convergence", "--adopt", "--resume", "simulate.")


class Block(NamedTuple):
    """Fenced code of a page."""

    language: str
    title: str
    text: str


def blocks(page: Path) -> list[Block]:
    found = BLOCK.finditer(page.read_text(encoding="utf-8"))
    return [Block(m["language"], m["title"] or "", re.sub(f"^{m['in']}", "", m["text"], flags=re.M)) for m in found]


def commands(text: str) -> Iterator[list[str]]:
    """The words of each command of a block."""
    for line in text.replace("\\\n", " ").splitlines():
        for command in re.split(r"\s&&\s", line):
            words = shlex.split(command, comments=True)
            if words:
                yield words


def name_of(words: list[str]) -> str:
    """The name of a command of gaitsim: `run`, or `library show`."""
    return " ".join(words[1:3] if words[1] in GROUPS else words[1:2])


@dataclass
class Session:
    """A folder in which the blocks of a page are run, and what the last commands printed."""

    whole: bool
    patch: pytest.MonkeyPatch
    capture: pytest.CaptureFixture[str]
    space: dict[str, Any] = field(default_factory=dict)
    printed: str = ""
    complete: bool = True

    def do(self, block: Block, told: bool) -> None:
        """Run a block. told: what it prints follows on the page; only then may it be a mistake in a spec."""
        if block.title:
            path = Path(block.title)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")
        elif block.language == "sh":
            self.printed, self.complete = "", True
            for words in commands(block.text):
                self.command(words, told)
        elif block.language == "text" and self.complete:
            for line in block.text.splitlines() if self.printed else ():
                assert " ".join(line.split()) in self.printed, self.printed
            self.printed = ""
        elif block.language == "python":
            text = resolved(block.text)
            compile(block.text, "page", "exec")
            if text is not None:
                exec(text, self.space)
        elif block.language == "yaml":
            parse(block.text, "page.yaml")

    def command(self, words: list[str], told: bool) -> None:
        match words[0]:
            case "cd":
                self.patch.chdir(words[1])
            case "gaitsim":
                self.gaitsim(words, told)
            case "make":
                assert re.search(f"^{words[1]}:", (ROOT / "Makefile").read_text(), re.M), words
            case "pip":
                assert words[2].split("[")[0] in (".", "gaitsim")
            case "python":
                assert (ROOT / words[1]).is_file(), words
            case "pytest":
                assert list(Path(words[1]).glob("test_*.py"))
                if self.whole:
                    pytest_words = ["-q", "-p", "no:cacheprovider", *words[1:]]
                    subprocess.run([sys.executable, "-m", "pytest", *pytest_words], check=True)
            case _:
                assert words == [".", ".venv/bin/activate"], words

    def gaitsim(self, words: list[str], told: bool) -> None:
        target = ""
        if ">" in words:
            words, target = words[: words.index(">")], words[-1]
        exists(words)
        found = [resolved(word) for word in words]
        wanted = self.wanted([word for word in found if word is not None]) if None not in found else None
        if wanted is None:
            self.complete = False
            return
        self.capture.readouterr()
        with pytest.raises(SystemExit) as ended:
            main(wanted)
        said = self.capture.readouterr()
        assert ended.value.code == 0 or (told and ended.value.code == 3), f"{wanted}: {said.out}\n{said.err}"
        self.complete &= wanted == words[1:]
        self.printed += " ".join(f"{said.out} {said.err} ".split())
        if target:
            Path(target).write_text(said.out, encoding="utf-8")

    def wanted(self, words: list[str]) -> list[str] | None:
        """What is run for a command: as it is, made small, or nothing."""
        if any(word in words for word in UNRUN):
            return None
        if self.whole:
            return small(words)[1:]
        if any(word.startswith(LONG) for word in words) or (name_of(words) == "check" and "walking" in words[2]):
            return None
        match name_of(words):
            case "run":
                return words[1:] + SHORT if "walking" not in words[2] else None
            case "optimize":
                quick = "--smoke" in words and "specs/hopping_leg_mass.yaml" in words
                return small(words)[1:] if quick and "normal" not in words else None
            case name:
                return words[1:] if name in QUICK else None


def resolved(text: str) -> str | None:
    """A text with the results that it names replaced by those that were made last; None if there is none."""
    lacking = False

    def newest(match: re.Match[str]) -> str:
        nonlocal lacking
        made = sorted(Path("results").glob(f"*-{match[1]}-*"), key=lambda path: path.stat().st_mtime_ns)
        lacking |= not made
        return str(made[-1]) if made else match[0]

    text = RESULT.sub(newest, text)
    return None if lacking else text


def small(words: list[str]) -> list[str]:
    """A command with its search or its scan made small."""
    match name_of(words):
        case "optimize":
            short = [] if {"--smoke", "--resume"} & set(words) else ["--generations", "1", "--population", "4"]
            brief = ["--set", "simulate.duration=0.1 s"] if "normal" in words else []
            return words + short + brief + ([] if "--workers" in words else ["--workers", "0"])
        case "cohort" if "--resume" not in words:
            return [*words, "--set", "simulate.duration=0.2 s"]
        case "limit":
            return [*words, "--points", "3", "--tolerance", "0.5"]
    return words


def exists(words: list[str]) -> None:
    """Every command and option that a page names, and every spec."""
    here = TREE
    rest = [word for word in words[1:] if word not in ("--install-completion", "--help")]
    while hasattr(here, "commands") and rest and rest[0] in here.commands:
        here, rest = here.commands[rest[0]], rest[1:]
    if rest:
        here.make_context("gaitsim", rest, resilient_parsing=False)
    for spec in (word for word in rest if word.startswith("specs/")):
        assert (ROOT / spec).is_file(), spec


def run_page(page: Path, whole: bool, folder: Path, patch: pytest.MonkeyPatch, capture: Any) -> None:
    patch.chdir(folder)
    (folder / "specs").mkdir()
    for spec in (ROOT / "specs").rglob("*.*"):
        place = folder / spec.relative_to(ROOT)
        place.parent.mkdir(exist_ok=True)
        place.write_bytes(spec.read_bytes())
    mpl.use("agg")
    session = Session(whole, patch, capture)
    found = blocks(page)
    for block, following in zip(found, [*found[1:], None], strict=True):
        session.do(block, following is not None and following.language == "text")


NAMES = [str(page.relative_to(ROOT)) for page in PAGES]
WITH_CODE = [name for name in NAMES if blocks(ROOT / name)]


@pytest.mark.parametrize("name", WITH_CODE)
def test_the_cheap_blocks_of_a_page_run(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_page(ROOT / name, False, tmp_path, monkeypatch, capsys)


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_CODE)
def test_all_blocks_of_a_page_run(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_page(ROOT / name, True, tmp_path, monkeypatch, capsys)


def test_the_pages_have_examples() -> None:
    found = [block for name in WITH_CODE for block in blocks(ROOT / name)]
    assert sum(len(list(commands(b.text))) for b in found if b.language == "sh") > 80
    assert sum(bool(b.title) for b in found) >= 8
    assert sum(b.language == "text" for b in found) >= 5


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md"])
def test_links_lead_to_files(name: str) -> None:
    """Links of pages in docs/ are checked when the site is built."""
    links = LINK.findall((ROOT / name).read_text(encoding="utf-8"))
    assert links and not [link for link in links if not (ROOT / link).is_file()]


def test_the_readme_leads_to_every_page() -> None:
    links = LINK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    pages = {f"docs/{path.relative_to(ROOT / 'docs').as_posix()}" for path in (ROOT / "docs").rglob("*.md")}
    assert pages - {"docs/index.md"} <= set(links)  # the index of the site says what README says


@pytest.mark.parametrize("name", NAMES)
def test_named_files_exist(name: str) -> None:
    named = NAMED.findall((ROOT / name).read_text(encoding="utf-8"))
    assert not [path for path in named if not (ROOT / path).exists() and not path.endswith(".tuned.yaml")]


@pytest.mark.slow
def test_the_site_has_every_component_and_command(tmp_path: Path) -> None:
    """Built strictly: a link or an anchor that leads nowhere is an error."""
    words = ["build", "--strict", "--quiet", "--config-file", str(ROOT / "mkdocs.yml"), "--site-dir", str(tmp_path)]
    built = subprocess.run([sys.executable, "-m", "mkdocs", *words], capture_output=True, text=True, cwd=ROOT)
    assert built.returncode == 0, built.stderr
    for reference in Library((shipped_folder(),)).references():
        kind, name = reference.split("/")
        assert f'id="{name}"' in (tmp_path / "reference" / "components" / f"{kind}.html").read_text(encoding="utf-8")
    pictures = list((tmp_path / "reference" / "components" / "curves").glob("muscle.*.svg"))
    assert len(pictures) == len(Library((shipped_folder(),)).references("muscle"))
    listed = (tmp_path / "reference" / "commands.html").read_text(encoding="utf-8")
    assert all(f'id="gaitsim-{name.replace(" ", "-")}"' in listed for name in ("run", "optimize", "library-check"))
