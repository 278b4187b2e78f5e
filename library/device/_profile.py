"""The shape of a torque that rises to a peak and falls again."""


def swell(now, peak_at, rise, fall):
    """Smooth pulse by 3 s^2 - 2 s^3: 0 at `peak_at - rise`, 1 at `peak_at`, 0 at `peak_at + fall`."""
    share = 1 + (now - peak_at) / rise if now < peak_at else 1 - (now - peak_at) / fall
    share = max(0.0, share)
    return share * share * (3 - 2 * share)
