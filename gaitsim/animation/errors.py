"""Errors of films."""

from __future__ import annotations

from gaitsim.errors import ExitCode, GaitsimError


class NoOpenGL(GaitsimError):
    """This machine cannot draw pictures; the text says what it lacks."""

    exit_code = ExitCode.FAILED


class NoDisplay(GaitsimError):
    """There is no display for a window."""

    exit_code = ExitCode.FAILED


class CannotAnimate(GaitsimError):
    """There is no motion, a joint coordinate was not recorded, or the file cannot be written."""

    exit_code = ExitCode.FAILED
