"""Pictures of a posture as arrays of pixels."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gaitsim.animation import overlay
from gaitsim.animation.camera import FIELD, Views
from gaitsim.animation.opengl import OpenGL
from gaitsim.animation.posture import Posture

Pixels = NDArray[np.uint8]
_GEOMS = 2000


class Canvas:
    """Draws one stage during a block. Sizes are in pixels."""

    def __init__(self, posture: Posture, width: int, height: int) -> None:
        self.posture, self.width, self.height = posture, width, height
        mechanics = posture.stage.mechanics
        mechanics.vis.global_.fovy = FIELD
        mechanics.vis.global_.offwidth, mechanics.vis.global_.offheight = width, height
        self._opengl = OpenGL(width, height)
        self._scene = mujoco.MjvScene(mechanics, maxgeom=_GEOMS)
        self._wishes = seen()
        self._painter: Any = None

    def __enter__(self) -> Canvas:
        """Make OpenGL ready.

        Raises:
            NoOpenGL: OpenGL does not work here.
        """
        self._opengl.__enter__()
        self._painter = self._opengl.painter(self.posture.stage.mechanics)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._painter.free()
        self._opengl.__exit__(kind, error, trace)

    def picture(self, views: Views, frame: int) -> Pixels:
        """The present posture in the view of a frame: an array of height x width x 3."""
        overlay.paint_muscles(self.posture)
        mechanics, data = self.posture.stage.mechanics, self.posture.data
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(mechanics, data, self._wishes, None, views.camera(frame), everything, self._scene)
        overlay.add(self._scene, self.posture, views)
        area = mujoco.MjrRect(0, 0, self.width, self.height)
        mujoco.mjr_render(area, self._scene, self._painter)
        pixels = np.empty((self.height, self.width, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(pixels, None, area, self._painter)
        return pixels[::-1]


def seen() -> Any:
    """MuJoCo's options of what is visible: bodies and paths, without marks of sites and actuators."""
    wishes = mujoco.MjvOption()
    wishes.flags[mujoco.mjtVisFlag.mjVIS_ACTUATOR] = False
    wishes.sitegroup[:] = 0
    return wishes
