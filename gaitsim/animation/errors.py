"""Why there is no picture."""

from __future__ import annotations

from gaitsim.errors import ExitCode, GaitsimError


class NoOpenGL(GaitsimError):
    """This machine draws no pictures; one line names what it lacks."""

    exit_code = ExitCode.FAILED


class NoDisplay(GaitsimError):
    """There is no screen for a window."""

    exit_code = ExitCode.FAILED


class CannotAnimate(GaitsimError):
    """There is no motion to show, a joint's coordinate was not recorded, or the file cannot be written."""

    exit_code = ExitCode.FAILED
