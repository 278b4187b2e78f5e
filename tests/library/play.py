"""Hand-made signals played to one component, as a run calls it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from components.calls import Tables, primitive

from gaitsim.simulation.run import Mode


def played(
    reference: str,
    signals: Mapping[str, Sequence[float]],
    mode: Mode,
    /,
    dt: float = 1e-3,
    initial: Mapping[str, float] | None = None,
    **values: float,
) -> dict[str, list[float]]:
    """The outputs of a part at each instant of its inputs: start once, then output and update in turn."""
    kind = primitive(reference)
    tables = Tables(kind).put(values)
    samples = [dict(zip(signals, row, strict=True)) for row in zip(*signals.values(), strict=True)]
    tables.put(samples[0])
    if "start" in kind.functions:
        assert not tables.call("start", mode)
    for name, value in (initial or {}).items():
        setattr(tables.x, name, value)
    found: dict[str, list[float]] = {name: [] for name in kind.outputs}
    for sample in samples:
        tables.put(sample)
        assert not tables.call("output", mode, dt)
        for name, row in found.items():
            row.append(float(getattr(tables.y, name)))
        assert not tables.call("update", mode, dt)
    return found
