"""From a model to programs and to MuJoCo.

MuJoCo looks for OpenGL as it is imported and fails where MUJOCO_GL names none that is there. Only
pictures need OpenGL, so it is then imported without; `gaitsim.animation` says what is missing. A
command imports it without in any case: that saves a process that GLFW starts to ask for its version,
and our pictures load what they need. In a notebook mujoco.Renderer stays whole.
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


if "gaitsim.cli.main" in sys.modules:
    _import_without_opengl()
else:
    try:
        import mujoco  # noqa: F401
    except (ImportError, RuntimeError, AttributeError, OSError):
        _import_without_opengl()
