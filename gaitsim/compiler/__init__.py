"""From a model to a program, to native code, and to MuJoCo.

MuJoCo loads OpenGL when it is imported, and fails if MUJOCO_GL names an OpenGL that is missing. Only pictures need
OpenGL, so MuJoCo is then imported without it, and `gaitsim.animation` reports what is missing. Commands always import
it without OpenGL: GLFW would start a process to find its version, and our pictures load OpenGL themselves. In a
notebook, mujoco.Renderer works as usual.
"""

import os
import sys


def _import_without_opengl() -> None:
    wanted = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = "off"
    try:
        import mujoco  # noqa: F401
    finally:
        os.environ.pop("MUJOCO_GL")
        if wanted is not None:
            os.environ["MUJOCO_GL"] = wanted


if "gaitsim.cli.program" in sys.modules:
    _import_without_opengl()
else:
    try:
        import mujoco  # noqa: F401
    except (ImportError, RuntimeError, AttributeError, OSError):
        _import_without_opengl()
