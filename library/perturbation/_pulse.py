"""How much of a step lies within a pulse."""


def share_of_step(begin, dt, onset, duration):
    """Share of the step from `begin` on that lies within the pulse, so that the impulse is exact at any step."""
    return max(0.0, min(begin + dt, onset + duration) - max(begin, onset)) / dt


def share_at_start(p):
    """1 if the pulse has begun when the run starts, else 0: there is no step yet to take a share of."""
    return 1.0 if p.event_number < 0.5 and p.onset <= 0 and p.duration > 0 else 0.0
