"""MuJoCo's viewer, which plays a recorded motion in a loop."""

from __future__ import annotations

import time
import warnings
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from gaitsim.analysis.replays.replay import Replay
from gaitsim.animation import overlay
from gaitsim.animation.camera import FIELD, Views, follow
from gaitsim.animation.errors import NoDisplay
from gaitsim.animation.opengl import has_display
from gaitsim.animation.player import Player
from gaitsim.animation.posture import Floats, Posture, rows_at
from gaitsim.animation.stage import stage_of
from gaitsim.errors import command

_SPACING = 1 / 60  # s between two postures that the camera's path is made of
_FRAME = 1 / 60  # s of the viewer's time
_KEYS = "space\nleft, right\nup, down\nhome", "pause\nstep\nfaster, slower\nfrom the start"


def view(replay: Replay, speed: float = 1.0, paused: bool = False) -> None:
    """Show a run until the window is closed.

    Call `check_display` before.

    Args:
        replay: The run.
        speed: Seconds of motion per second.
        paused: Whether to start paused.

    Raises:
        CannotAnimate: The model cannot be drawn.
        NoDisplay: There is no display.
    """
    show = Show(replay, speed, paused)
    from mujoco import viewer

    mechanics, data = show.posture.stage.mechanics, show.posture.data
    try:
        opened = viewer.launch_passive(
            mechanics, data, key_callback=show.player.press, show_left_ui=False, show_right_ui=False
        )
    except RuntimeError as error:  # on macOS it wants to be started by MuJoCo's own interpreter
        raise NoDisplay(f"MuJoCo's viewer does not start: {error}") from error
    with opened as window:
        show.begin(window)
        before = time.perf_counter()
        while window.is_running():
            began = time.perf_counter()
            show.player.advance(began - before)
            before = began
            with window.lock():
                show.frame(window)
            window.set_texts(show.texts())
            window.sync()
            time.sleep(max(0.0, _FRAME - (time.perf_counter() - began)))


def check_display(path: Path) -> None:
    """Check that a window can be opened.

    Raises:
        NoDisplay: With the next move for the spec or result.
    """
    move = f"make a video instead: {command('analyze', path)}"
    if not has_display():
        raise NoDisplay(f"there is no display for a window; {move}")
    # The viewer opens its window in another thread. If that failed, it would wait forever.
    if not _opens_windows():
        raise NoDisplay(f"no window with OpenGL can be opened on this display; {move}")


def _opens_windows() -> bool:
    import glfw

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # our own message replaces glfw's warning
        if not glfw.init():
            return False
        glfw.window_hint(glfw.VISIBLE, False)
        window = glfw.create_window(64, 64, "", None, None)
        if window:
            glfw.destroy_window(window)
        glfw.terminate()
        return bool(window)


class Show:
    """The content of the viewer's window at the time of the player."""

    def __init__(self, replay: Replay, speed: float, paused: bool) -> None:
        stage = stage_of(replay.model)
        stage.mechanics.vis.global_.fovy = FIELD
        self.posture = Posture(stage, replay.trajectory)
        first, last = (float(replay.trajectory.times[end]) for end in (0, -1))
        self.player = Player(first, last, speed, paused)
        self._times = np.arange(first, last + _SPACING, _SPACING)
        self._views: Views = follow(self.posture, rows_at(replay.trajectory, self._times), _SPACING, 1.5)
        self._looked: Floats = self._views.points[0]

    def begin(self, window: Any) -> None:
        """Point the camera. The user may turn it afterwards."""
        camera = self._views.camera(0)
        window.cam.azimuth, window.cam.elevation = camera.azimuth, camera.elevation
        window.cam.distance, window.cam.lookat[:] = camera.distance, camera.lookat
        window.opt.flags[mujoco.mjtVisFlag.mjVIS_ACTUATOR] = False
        window.opt.sitegroup[:] = 0

    def frame(self, window: Any) -> None:
        """Show the posture, colours and arrows at the time of the player. The window must be locked."""
        row = int(rows_at(self.posture.trajectory, [self.player.time])[0])
        self.posture.take(row)
        overlay.paint_muscles(self.posture)
        window.user_scn.ngeom = 0
        overlay.add(window.user_scn, self.posture, self._views)
        looked = self._views.points[int(np.searchsorted(self._times, self.player.time).clip(0, len(self._times) - 1))]
        window.cam.lookat[:] += looked - self._looked
        self._looked = looked

    def texts(self) -> list[tuple[Any, Any, str, str]]:
        """The texts in the window."""
        paused = "paused" if self.player.paused else ""
        values = f"{self.player.time:.3f} s\n{self.player.speed:g} x real time\n{paused}"
        top, bottom = mujoco.mjtGridPos.mjGRID_TOPLEFT, mujoco.mjtGridPos.mjGRID_BOTTOMLEFT
        return [(None, top, "t\nspeed\n", values), (None, bottom, *_KEYS)]
