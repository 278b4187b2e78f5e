"""The first request to every worker. The function is sent by value, so that a worker with any version of gaitsim, or
none, can answer.
"""

from __future__ import annotations


def installed() -> dict[str, str]:
    """The fingerprint of the worker; empty if it has no gaitsim, or a version without fingerprints."""
    try:
        from gaitsim.cluster.fingerprint import fingerprint
    except ImportError:
        return {}
    return fingerprint()
