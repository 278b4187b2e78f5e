"""Machines without OpenGL, with one kind of it, and with a wrong word in MUJOCO_GL."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.simulation.models import ROOT

LIBRARIES = ("libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
DRAW = """
import sys
from gaitsim.animation import NoOpenGL
from gaitsim.animation.opengl import OpenGL
try:
    with OpenGL(64, 64):
        print("drawn")
except NoOpenGL as error:
    print(error)
"""


def told(script: str, **changes: str) -> str:
    """What a new Python says, with other environment variables."""
    environment = {k: v for k, v in os.environ.items() if k not in ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY")}
    made = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, env=environment | changes, check=False
    )
    assert made.returncode == 0, made.stderr
    return made.stdout.strip()


@pytest.fixture
def nothing(tmp_path: Path) -> str:
    """A folder whose files hide the system's OpenGL libraries, and cannot be loaded."""
    for name in LIBRARIES:
        (tmp_path / name).touch()
    return str(tmp_path)


@pytest.mark.parametrize("word", ["", "egl", "1"])
def test_it_draws_without_a_display(word: str) -> None:
    assert told(DRAW, MUJOCO_GL=word) == "drawn"


@pytest.mark.parametrize(
    ("word", "words"),
    [
        ("bogus", "no video: MUJOCO_GL=bogus is no OpenGL; unset it, or write egl or osmesa or glfw."),
        ("off", "no video: MUJOCO_GL=off switches OpenGL off; unset it."),
        ("glfw", "no video: MUJOCO_GL=glfw needs a display; unset it, or write egl or osmesa."),
    ],
)
def test_a_word_that_is_no_opengl_is_said(word: str, words: str) -> None:
    assert told(DRAW, MUJOCO_GL=word) == words


@pytest.mark.parametrize(
    ("word", "words"),
    [
        (
            "",
            "no video: OpenGL is missing; install the system package libegl1 or libosmesa6 (apt install libosmesa6).",
        ),
        ("egl", "no video: MUJOCO_GL=egl needs the system package libegl1 (apt install libegl1)."),
        ("osmesa", "no video: MUJOCO_GL=osmesa needs the system package libosmesa6 (apt install libosmesa6)."),
    ],
)
def test_a_missing_library_is_named_by_its_package(nothing: str, word: str, words: str) -> None:
    assert told(DRAW, MUJOCO_GL=word, LD_LIBRARY_PATH=nothing) == words


@pytest.mark.parametrize("word", ["bogus", *(pytest.param(word, marks=pytest.mark.slow) for word in ("egl", "osmesa"))])
def test_a_run_needs_no_opengl(nothing: str, word: str, tmp_path: Path) -> None:
    spec = ROOT / "specs" / "pendulum_pid.yaml"
    run = f"""
from gaitsim.cli.main import main
main(["run", {str(spec)!r}, "--no-save", "--set", "simulate.duration=0.1 s"])
"""
    assert "completed" in told(run, MUJOCO_GL=word, LD_LIBRARY_PATH=nothing)


def test_the_environment_stays_as_it_was() -> None:
    assert told("import os, gaitsim.compiler; print(os.environ['MUJOCO_GL'])", MUJOCO_GL="bogus") == "bogus"
    assert told("import os, gaitsim.compiler; print(os.environ.get('MUJOCO_GL'))") == "None"
