"""Films of a recorded motion, as video files and in MuJoCo's viewer."""

import gaitsim.compiler  # noqa: F401  MuJoCo is imported there first
from gaitsim.animation.errors import CannotAnimate, NoDisplay, NoOpenGL

__all__ = ["CannotAnimate", "NoDisplay", "NoOpenGL"]
