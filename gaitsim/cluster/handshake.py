"""Asked of every worker before anything else; sent by value, so that any gaitsim, or none, can answer."""

from __future__ import annotations


def installed() -> dict[str, str]:
    """The worker's fingerprint; empty if it has no gaitsim, or one that knows no fingerprint."""
    try:
        from gaitsim.cluster.fingerprint import fingerprint
    except ImportError:
        return {}
    return fingerprint()
