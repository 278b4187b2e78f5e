"""The error of a cluster without workers."""

from __future__ import annotations

from gaitsim.errors import ExitCode, GaitsimError


class ClusterError(GaitsimError):
    """The workers cannot be reached, or are lost."""

    exit_code = ExitCode.CLUSTER
