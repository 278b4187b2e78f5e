"""From a model to programs and to MuJoCo.

MuJoCo looks for OpenGL as it is imported and fails where MUJOCO_GL names none that is there. Only
pictures need OpenGL, so it is then imported without; `gaitsim.animation` says what is missing.
"""

import os

try:
    import mujoco
except (ImportError, RuntimeError, AttributeError, OSError):
    _wanted = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = "off"
    try:
        import mujoco  # noqa: F401
    finally:
        os.environ.pop("MUJOCO_GL")
        if _wanted is not None:
            os.environ["MUJOCO_GL"] = _wanted
