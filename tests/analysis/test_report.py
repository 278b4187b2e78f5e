from __future__ import annotations

import base64
import re
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import panels
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.report import facts
from gaitsim.analysis.report.figures import FIGURES, missing
from gaitsim.analysis.report.report import EMBEDDED, write
from gaitsim.analysis.signals.motion import motion_figures
from gaitsim.simulation.outcome import Outcome
from tests.analysis.replays import command, cut, of_result, of_spec
from tests.simulation.models import ROOT

VOID = {"meta", "img", "source", "link", "br", "hr"}


class Page(HTMLParser):
    """What a page holds: its elements, and that each one is closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.words: list[str] = []
        self.feed(text.replace("<wbr>", ""))  # where a word may be broken

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.found if name == tag]

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def page_of(path: Path) -> Page:
    page = Page(path.read_text(encoding="utf-8"))
    assert page.open == []
    return page


def drawn(replay: Replay) -> list[Drawing]:
    return [drawing for figures in FIGURES for drawing in figures(replay)]


@pytest.fixture(scope="module")
def pendulum() -> Replay:
    return of_spec("pendulum_pid")


def test_a_page_needs_nothing_else(pendulum: Replay, tmp_path: Path) -> None:
    page = page_of(write(tmp_path / "report.html", [pendulum], drawn(pendulum)))
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"""(src|href|srcset)=["'](?!data:|#)""", text)
    assert not re.search(r"url\(|@import|<script|<link", text.split("data:image")[0])
    images = page.all("img")
    assert len(images) == 2
    assert all(
        image["alt"] and image["src"] and image["src"].startswith("data:image/svg+xml;base64,") for image in images
    )
    assert all(source["srcset"] for source in page.all("source"))
    assert page.all("html") == [{"lang": "en"}]
    assert {"name": "viewport", "content": "width=device-width, initial-scale=1"} in page.all("meta")
    ids = {attributes["id"] for _, attributes in page.found if "id" in attributes}
    assert {link["href"] for link in page.all("a")} <= {f"#{name}" for name in ids}


def test_numbers_parts_and_sources_are_on_the_page(pendulum: Replay, tmp_path: Path) -> None:
    text = page_of(write(tmp_path / "report.html", [pendulum], [], remarks=["the video is missing"])).text
    assert "An inverted pendulum that a PID controller with delay keeps upright" in text
    assert "completed ran its whole time of 10 s" in text
    assert "the video is missing" in text
    value = facts.formatted(pendulum.outcome.metrics["torque"])
    assert f"torque {value} N·m" in text
    assert "balance.proportional 60 N·m/rad 20 200" in text
    assert "controller/pid" in text and "segment/rod" in text
    assert "add energy: {use: sensor/mechanical_energy}" in text
    assert "10 s in steps of 1 ms" in text


def test_the_same_figures_give_the_same_page(pendulum: Replay, tmp_path: Path) -> None:
    pages = []
    for name in ("one", "two"):
        path = write(
            tmp_path / name / "report.html", [replace(pendulum, manifest={"kind": "run"})], motion_figures(pendulum)
        )
        pages.append(re.sub(r"none kept.*", "", path.read_text(encoding="utf-8")))
    assert pages[0] == pages[1]
    assert not list(tmp_path.rglob("*.partial"))


def test_a_small_video_is_embedded_and_a_large_one_linked(pendulum: Replay, tmp_path: Path) -> None:
    video = tmp_path / "video.mp4"
    video.write_bytes(b"film")
    page = page_of(write(tmp_path / "report.html", [pendulum], [], video))
    assert page.all("video")[0]["src"] == f"data:video/mp4;base64,{base64.b64encode(b'film').decode()}"
    video.write_bytes(bytes(EMBEDDED + 1))
    page = page_of(write(tmp_path / "report.html", [pendulum], [], video))
    assert page.all("video")[0]["src"] == "video.mp4"
    assert "This video is a file beside the report" in page.text
    film = tmp_path / "video.gif"
    film.write_bytes(b"GIF89a")
    page = page_of(write(tmp_path / "report.html", [pendulum], [], film))
    assert page.all("img")[0]["alt"] == "The model moving, with its scopes"


def test_what_is_written_in_a_spec_cannot_become_code(pendulum: Replay, tmp_path: Path) -> None:
    figure, (axes,) = panels()
    axes.plot([0, 1])
    evil = Drawing("x", "<script>alert(1)</script>", 'a "quoted" <b>caption</b>', figure)
    named = replace(pendulum, notices=("<img src=x onerror=alert(1)>",))
    page = page_of(write(tmp_path / "report.html", [named], [evil]))
    assert page.all("script") == []
    assert all(image["src"] != "x" for image in page.all("img"))
    assert page.all("img")[0]["alt"] == '<script>alert(1)</script>. a "quoted" <b>caption</b>'


def test_a_large_figure_is_made_of_pixels(pendulum: Replay, tmp_path: Path) -> None:
    figure, (axes,) = panels()
    axes.scatter(*np.random.default_rng(1).random((2, 8000)))
    before = tuple(figure.get_size_inches())
    page = page_of(write(tmp_path / "report.html", [pendulum], [Drawing("dots", "Dots", "Many.", figure)]))
    assert str(page.all("img")[0]["src"]).startswith("data:image/png;base64,")
    assert tuple(figure.get_size_inches()) == before


def test_a_run_that_failed_before_it_began(pendulum: Replay, tmp_path: Path) -> None:
    outcome = Outcome("failed", "knee: <no pose> closes it", 0, 1e-3, {}, None, 0.0)
    replay = replace(pendulum, outcome=outcome)
    assert drawn(replay) == []
    page = page_of(write(tmp_path / "report.html", [replay], []))
    assert "failed: knee: <no pose> closes it" in page.text
    assert "There are no metrics" in page.text
    assert "pendulum_pid has no instant, so nothing is drawn over time; it failed: knee" in page.text
    assert page.all("figure") == []


@pytest.mark.parametrize("spec", ["pendulum_pid", "hopping_leg_mass", "hopping_geyer2003"])
def test_a_run_of_one_instant_has_a_page(spec: str, tmp_path: Path) -> None:
    replay = cut(of_spec(spec, [("simulate.duration", "0.1 s")]), 1)
    assert drawn(replay) == []
    assert missing(replay) == [f"{spec} has one instant only, so nothing is drawn over time."]
    page_of(write(tmp_path / "report.html", [replay], []))


def test_a_run_that_failed_half_way_has_its_figures(tmp_path: Path) -> None:
    replay = of_spec("hopping_leg_mass", [("simulate.duration", "0.5 s")])
    failed = replace(
        replay, outcome=replace(replay.outcome, status="failed", reason="diverged", metrics={}, score=None)
    )
    drawings = drawn(failed)
    assert {"muscle_extensor", "energies", "joints"} <= {d.name for d in drawings}
    assert all("the whole run" in d.caption for d in drawings if d.name in ("muscle_extensor", "joints"))
    assert "failed: diverged" in page_of(write(tmp_path / "report.html", [failed], drawings)).text


def test_two_runs_stand_beside_each_other(pendulum: Replay, tmp_path: Path) -> None:
    stiff = of_spec("pendulum_pid", [("balance.proportional", "120 N m/rad")])
    pair = [replace(pendulum, label="soft"), replace(stiff, label="stiff")]
    page = page_of(write(tmp_path / "report.html", pair, []))
    assert "metric soft stiff unit meaning" in page.text
    assert page.text.count("Every part with the component") == 2


def test_the_origin_of_a_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    spec = shutil.copy(ROOT / "specs" / "hopping_leg_mass.yaml", tmp_path)  # its commit is that of its repository
    assert command("optimize", spec, "--set", "simulate.duration=1 s", "--smoke", "--workers", "0", "--seed", "7") == 0
    (folder,) = (tmp_path / "results").iterdir()
    replay = of_result(folder)
    said = dict(facts.origin(replay))
    assert said["Seed"] == "7"
    assert said["Evaluations"] == "9, 0 failed; stopped: 2 generations done"
    assert said["Digest"] == replay.manifest["digest"]
    assert said["Commit"].startswith("none")
    assert "mujoco" in said["Versions"]
    table = facts.tuned_table(replay)
    assert table is not None
    assert table.columns == ("parameter", "value", "unit", "lower", "upper", "start", "best", "mean", "std")
    assert table.rows[4][:6] == ("feedback.gain", table.rows[4][6], "–", "1", "5", "3")
    keys = [reference.key for reference in facts.references(replay)]
    assert {"geyer2003", "geyer2010", "winter2009"} <= set(keys)
    (geyer,) = (r for r in facts.references(replay) if r.key == "geyer2003")
    assert geyer.text.startswith("Geyer, Seyfarth & Blickhan (2003). Positive force feedback in bouncing gaits?")
    assert geyer.doi == "10.1098/rspb.2003.2454"


def test_a_commit_with_changes_says_so(pendulum: Replay) -> None:
    for dirty, words in ((True, "abc, with changes that are not committed"), (False, "abc, clean")):
        replay = replace(pendulum, manifest={"kind": "run", "commit": {"hash": "abc", "dirty": dirty}})
        assert dict(facts.origin(replay))["Commit"] == words


def test_the_tree_has_every_part_once_and_inside_its_own() -> None:
    model = of_spec("hopping_leg_mass", [("simulate.duration", "0.1 s")]).model
    roots = facts.tree(model)
    every = [branch.address for branch in facts.walk(roots)]
    assert len(every) == len(set(every))
    assert {part.address for part in model.parts} <= set(every)
    extensor = next(branch for branch in roots if branch.address == "extensor")
    assert [b.address for b in extensor.inner] == ["extensor.path", "extensor.activation_dynamics"]
    assert ("max_isometric_force", "22000", "N", "geyer2003") in extensor.parameters.rows


def test_numbers_as_they_are_shown() -> None:
    assert [facts.formatted(n) for n in (0.162978, -1e-7, None, float("nan"), 22000)] == [
        "0.16298",
        "−1e−07",
        "–",
        "–",
        "22000",
    ]
