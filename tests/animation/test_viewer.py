"""What the viewer's window is given, without a window."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from gaitsim.animation.player import RIGHT, SPACE
from gaitsim.animation.viewer import Show
from tests.animation.runs import run_of


@pytest.fixture
def show() -> Show:
    return Show(run_of("hopping_leg_mass"), speed=0.5, paused=True)


def window(show: Show) -> Any:
    """What MuJoCo's viewer has of camera, wishes and a scene of our own."""
    scene = mujoco.MjvScene(show.posture.stage.mechanics, maxgeom=100)
    return SimpleNamespace(cam=mujoco.MjvCamera(), opt=mujoco.MjvOption(), user_scn=scene)


def test_the_posture_follows_the_player(show: Show) -> None:
    opened = window(show)
    show.begin(opened)
    assert opened.cam.azimuth == 90
    for time in (0.0, 0.25, 0.5):
        show.player.time = time
        show.frame(opened)
        assert show.posture.data.time == pytest.approx(time, abs=1e-3)
        height = show.posture.trajectory["guide.position"][show.posture.row]
        assert show.posture.data.qpos[0] == height


def test_arrows_are_there_while_there_is_a_force(show: Show) -> None:
    opened = window(show)
    forces = show.posture.trajectory["ground.force"]
    for row, arrows in ((0, 0), (int(np.argmax(forces)), 1)):
        show.player.time = float(show.posture.trajectory.times[row])
        show.frame(opened)
        assert opened.user_scn.ngeom == arrows


def test_the_mouse_may_turn_the_camera(show: Show) -> None:
    opened = window(show)
    show.begin(opened)
    opened.cam.azimuth, opened.cam.lookat[1] = 30.0, 0.2
    show.player.press(RIGHT)
    show.frame(opened)
    assert (opened.cam.azimuth, opened.cam.lookat[1]) == (30.0, 0.2)


def test_time_speed_and_pause_are_written(show: Show) -> None:
    assert show.texts()[0][3] == "0.000 s\n0.5 x real time\npaused"
    show.player.press(SPACE)
    assert show.texts()[0][3] == "0.000 s\n0.5 x real time\n"
