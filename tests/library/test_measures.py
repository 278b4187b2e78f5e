"""Every measure on a hand-made signal with a known answer."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from components.calls import FILES, Tables, metrics, primitive

from gaitsim.components.load import function_of

NAN = pytest.approx(math.nan, nan_ok=True)


def blocks(*lengths: int) -> list[float]:
    """0 for the first length, 1 for the second, and so on."""
    return [float(i % 2) for i, length in enumerate(lengths) for _ in range(length)]


def test_every_measure_of_the_library_is_tested_here() -> None:
    texts = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*.py"))
    measures = [f.stem for f in FILES if f.parent.name == "measure" and not f.stem.startswith("_")]
    untested = [name for name in measures if f'"measure/{name}"' not in texts]
    assert untested == []


def test_apex() -> None:
    # Five peaks of 1.1, 1.2 ... in flight; a wiggle in contact is none.
    heights, airborne = [], []
    for top in (1.1, 1.2, 1.3, 1.4, 1.5):
        heights += [1.0, top - 0.05, top, top - 0.05, 1.0, 0.8, 0.9, 0.8]
        airborne += [1.0] * 5 + [0.0] * 3
    signals = {"height": heights, "airborne": airborne}
    found = metrics("measure/apex", signals, 0.1, reference=1.0)
    assert found == pytest.approx({"value": 0.4, "spread": 0.2, "hops": 5})
    assert metrics("measure/apex", signals, 0.1, average=1)["value"] == pytest.approx(1.5)
    assert metrics("measure/apex", signals, 0.1, average=16)["value"] == pytest.approx(1.3)
    none = metrics("measure/apex", {"height": [1.0, 0.9, 0.8]}, 0.1)
    assert none == {"value": NAN, "spread": NAN, "hops": 0}


def test_apex_keeps_the_last_sixteen_in_its_ring() -> None:
    heights = [h for top in range(1, 41) for h in (0.0, float(top), 0.0)]
    found = metrics("measure/apex", {"height": heights}, 0.1, average=16)
    assert found == pytest.approx({"value": np.mean(range(25, 41)), "spread": 15, "hops": 40})


def test_contact_time() -> None:
    contact = blocks(3, 10, 2, 20, 2, 30, 2, 40, 1, 7)  # the last one is still going on
    found = metrics("measure/contact_time", {"contact": contact}, 0.01)
    assert found == pytest.approx({"value": 0.3, "contacts": 4})
    found = metrics("measure/contact_time", {"contact": contact}, 0.01, average=1)
    assert found["value"] == pytest.approx(0.4)
    # A contact that was there from the start has lasted nobody knows how long.
    cut = metrics("measure/contact_time", {"contact": blocks(0, 10, 2)}, 0.01)
    assert cut == {"value": NAN, "contacts": 0}
    cut = metrics("measure/contact_time", {"contact": blocks(0, 10, 2, 5, 2)}, 0.01)
    assert cut == pytest.approx({"value": 0.05, "contacts": 1})


def test_frequency() -> None:
    # Rises at 0.10, 0.20, 0.40, 0.70 and 1.10 s: the last three periods are 0.9 s.
    signal = blocks(10, 5, 5, 5, 15, 5, 25, 5, 35, 5)
    found = metrics("measure/frequency", {"signal": signal}, 0.01)
    assert found == pytest.approx({"value": 3 / 0.9})
    one = metrics("measure/frequency", {"signal": signal}, 0.01, average=1)
    assert one["value"] == pytest.approx(1 / 0.4)
    # More periods asked for than seen: all that there are.
    every = metrics("measure/frequency", {"signal": signal}, 0.01, average=15)
    assert every["value"] == pytest.approx(4 / 1.0)
    # On from the start is not a rise, and one rise makes no period.
    assert metrics("measure/frequency", {"signal": blocks(0, 5, 5, 5)}, 0.01) == {"value": NAN}


def test_frequency_over_more_rises_than_it_keeps() -> None:
    signal = blocks(*[5] * 80)
    for average in (3, 15):
        found = metrics("measure/frequency", {"signal": signal}, 0.01, average=average)
        assert found["value"] == pytest.approx(10)


def test_peak_with_a_gate() -> None:
    gate = blocks(2, 3, 2, 3, 2, 3, 2, 3, 2)
    signal = [0.0] * len(gate)
    for i, top in zip((3, 8, 13, 18), (10.0, 20.0, 30.0, 40.0), strict=True):
        assert gate[i] == 1
        signal[i] = top
    signal[0] = signal[5] = 99.0  # outside
    found = metrics("measure/peak", {"signal": signal, "gate": gate}, 0.01)
    assert found["value"] == pytest.approx(30)
    assert found["overall"] == 40
    assert metrics("measure/peak", {"signal": signal, "gate": gate}, 0.01, average=2)["value"] == pytest.approx(35)
    # A negative signal has its peak too: nothing is compared with a zero from before.
    below = metrics("measure/peak", {"signal": [-s - 1 for s in signal], "gate": gate}, 0.01)
    assert below["value"] == pytest.approx(-1)


def test_peak_without_a_gate_is_the_highest_of_the_run() -> None:
    found = metrics("measure/peak", {"signal": [-5.0, -2.0, -3.0]}, 0.01)
    assert found == {"value": -2, "overall": -2}


def test_range() -> None:
    found = metrics("measure/range", {"signal": [2.0, -1.0, 5.0, 3.0]}, 0.01)
    assert found == {"value": 6, "low": -1, "high": 5, "change": 1}


def test_fall() -> None:
    assert metrics("measure/fall", {"height": [1.0] * 40}, 0.01, below=0.5) == {"value": 0.4, "fell": 0}
    tables = Tables(primitive("measure/fall"))
    for height, stop in ((1.0, 0), (0.5, 0), (0.49, 1), (1.0, 1)):
        tables.put({"below": 0.5, "height": height})
        assert not tables.call("update", "rapid")
        tables.call("output", "rapid")
        assert tables.y.stop == stop


@pytest.mark.parametrize("direction", [1, -1])
def test_section(direction: float) -> None:
    """Passages at 0.5, 1.2 and 2.1 s, of which the run is asked to end at the third."""
    kind = primitive("measure/section")
    tables = Tables(kind).put({"direction": direction, "stop_after": 3, "crossing": 0.4})
    assert not tables.call("output", "rapid")
    assert tables.y.guard == pytest.approx(0.4 * direction)
    for time, value in ((0.5, 10.0), (1.2, 11.0), (2.1, 13.0)):
        assert not tables.call("output", "rapid")
        assert tables.y.stop == 0
        assert not tables.put({"signal": value}).call("reset", "rapid", time)
    assert not tables.call("output", "rapid")
    assert tables.y.stop == 1
    found = SimpleNamespace()
    function_of(kind.cls, "finish")(tables.p, tables.x, found)
    assert vars(found) == pytest.approx({"passages": 3, "value": 13, "first": 10, "period": 0.9})
