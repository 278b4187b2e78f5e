"""A ball on the ground: restitution, static load and depth, against closed forms and measured values."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gaitsim.components.find import Library, library_folders
from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

BALL = """
gaitsim: 1
parts:
  ball: {use: segment/point_mass, mass: MASS}
  guide: {use: joint/vertical, parent: world, child: ball.center}
  ground: {use: contact/CONTACT, frame: ball.center}
  elastic: {use: sensor/elastic_energy}
initial: {guide.position: HEIGHT, guide.velocity: SPEED}
simulate: {duration: DURATION, step: STEP, gravity: GRAVITY}
"""


def made(text: str, folder: Path) -> Model:
    path = folder / "spec.yaml"
    path.write_text(text, encoding="utf-8")
    return resolve(read_spec(path), Library(library_folders(path)), "spec")


def ball(folder: Path, contact: str, **words: str) -> Any:
    text = BALL.replace("CONTACT", contact)
    usual = {"MASS": "1 kg", "SPEED": "0 m/s", "GRAVITY": "9.81 m/s^2", "STEP": "0.1 ms", "DURATION": "1 s"}
    for word, value in {**usual, **words}.items():
        text = text.replace(word, value)
    outcome = Simulator(made(text, folder)).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    return outcome.trajectory


@pytest.mark.parametrize(("zeta", "restitution"), [(0.1, 0.74408), (0.2, 0.57174), (0.5, 0.29844), (0.7, 0.21028)])
def test_restitution_of_spring_and_damper(tmp_path: Path, zeta: float, restitution: float) -> None:
    # Without gravity and without adhesion: contact ends where the force does.
    damping = 2 * zeta * math.sqrt(1e4)
    found = ball(
        tmp_path,
        f"spring_damper, stiffness: 10 kN/m, damping: {damping:.12g} N s/m",
        HEIGHT="1 cm",
        SPEED="-1 m/s",
        GRAVITY="0 m/s^2",
        STEP="0.005 ms",
        DURATION="0.1 s",
    )
    assert found["guide.velocity"][-1] == pytest.approx(restitution, abs=2e-4)
    assert found["ground.force"].min() >= 0
    assert found["ground.load"].max() == 0


def test_static_load_of_spring_and_damper(tmp_path: Path) -> None:
    law = "spring_damper, stiffness: 78480 N/m, damping: 4 kN s/m, to: {energy: elastic.energy}"
    found = ball(tmp_path, law, MASS="80 kg", HEIGHT="0 m")
    assert found["ground.height"][-1] == pytest.approx(-0.01, rel=1e-6)
    assert found["ground.force"][-1] == pytest.approx(80 * 9.81, rel=1e-6)
    assert found["ground.load"][-1] == pytest.approx(1, rel=1e-6)
    assert found["ground.in_contact"][-1] == 1
    assert found["elastic.total"][-1] == pytest.approx(0.5 * 78480 * 0.01**2, rel=1e-5)


SOLREF = {
    "default": "",
    ".01 1": ", time_constant: 10 ms",
    ".005 1": ", time_constant: 5 ms",
    ".02 .5": ", damping_ratio: 0.5",
    ".02 .1": ", damping_ratio: 0.1",
    "-100000 -1000": ", law: stiffness, reference_stiffness: 1e5 1/s^2, reference_damping: 1000 1/s",
    "-10000 -200": ", law: stiffness, reference_stiffness: 1e4 1/s^2, reference_damping: 200 1/s",
    "-10000 -20": ", law: stiffness, reference_stiffness: 1e4 1/s^2, reference_damping: 20 1/s",
}


@pytest.mark.parametrize("mass", ["1 kg", "40 kg"])
@pytest.mark.parametrize(
    ("solref", "depth"),
    [("default", 3.6718e-4), (".01 1", 1.0776e-4), (".005 1", 2.7301e-5), ("-100000 -1000", 1.0929e-5)],
)
def test_static_depth_of_mujocos_contact(tmp_path: Path, solref: str, depth: float, mass: str) -> None:
    law = f"mujoco, radius: 5 cm{SOLREF[solref]}"
    found = ball(tmp_path, law, MASS=mass, HEIGHT="5 cm", STEP="1 ms", DURATION="2 s")
    assert found["ground.height"][-1] == pytest.approx(-depth, rel=2e-4)
    assert found["ground.load"][-1] == pytest.approx(1, rel=1e-4)
    assert found["ground.in_contact"][-1] == 1


@pytest.mark.parametrize(
    ("solref", "depth", "restitution", "peak"),
    [
        ("default", 0.01035, 0.0, 14.67),
        (".005 1", 0.00257, 0.026, 55.4),
        (".02 .5", 0.00767, 0.2276, 15.31),
        (".02 .1", 0.00242, 0.744, 64.3),
        ("-10000 -200", 0.00516, 0.0, 28.07),
        ("-10000 -20", 0.01213, 0.7331, 13.58),
    ],
)
def test_a_drop_on_mujocos_contact(tmp_path: Path, solref: str, depth: float, restitution: float, peak: float) -> None:
    found = ball(tmp_path, f"mujoco, radius: 5 cm{SOLREF[solref]}", HEIGHT="15 cm", DURATION="0.3 s")
    assert -found["ground.height"].min() == pytest.approx(depth, abs=2e-5)
    assert found["ground.load"].max() == pytest.approx(peak, rel=0.01)
    lowest = int(np.argmin(found["ground.height"]))
    left = lowest + np.flatnonzero(found["ground.height"][lowest:] >= 0)
    speed = found["guide.velocity"][left[0]] if left.size else 0.0
    assert speed / math.sqrt(2 * 9.81 * 0.1) == pytest.approx(restitution, abs=0.003)
