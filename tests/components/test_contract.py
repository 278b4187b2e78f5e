"""Every component file of the library keeps the contract; a new file is tested once it is saved."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from gaitsim.compiler.kernel import address_of
from gaitsim.components.bibliography import entries
from gaitsim.components.checks.audit import audit
from gaitsim.components.composite import Composite
from gaitsim.components.find import Library
from gaitsim.components.primitive import Primitive
from gaitsim.components.review import review
from gaitsim.simulation.curves import graphs, why_no_curves

from .calls import FILES, FOLDER, component, reference_of, stages

_ENTRIES = entries((FOLDER / "references.bib").read_text(encoding="utf-8"))

every_file = pytest.mark.parametrize("path", FILES, ids=reference_of)


def test_the_library_is_found() -> None:
    assert {"muscle/geyer2003", "segment/rod", "measure/apex"} <= {reference_of(f) for f in FILES}
    assert {"geyer2003", "geyer2010"} <= set(_ENTRIES)


@pytest.mark.parametrize("key", sorted(_ENTRIES))
def test_an_entry_of_the_bibliography_is_whole(key: str) -> None:
    text = (FOLDER / "references.bib").read_text(encoding="utf-8")
    assert len(re.findall(rf"^@\w+\{{{key},", text, re.MULTILINE)) == 1, "it stands there twice"
    fields = set(re.findall(r"^\s*(\w+)\s*=", _ENTRIES[key], re.MULTILINE))
    assert {"author", "title", "year"} <= fields
    assert _ENTRIES[key].endswith("\n}") and _ENTRIES[key].count("{") == _ENTRIES[key].count("}")


@every_file
def test_it_keeps_the_contract(path: Path) -> None:
    """What a review asks: docs, sources that exist, bounds, a kind; and its units hold on every path, to the end."""
    reference = reference_of(path)
    found = component(reference)
    assert found.path == path
    assert (path.parent / "kind.yaml").is_file()
    assert [str(fault) for fault in review(reference, Library((FOLDER,)))] == []
    if isinstance(found, Primitive):
        report = audit(path.read_text(encoding="utf-8"), str(path), found.shared)
        assert (report.faults, report.unreached, report.complete) == ((), (), True)


@every_file
def test_it_draws_its_curves_or_says_why_it_has_none(path: Path) -> None:
    found = component(reference_of(path))
    drawn = graphs(found)
    if not drawn:
        assert not getattr(found, "curves", None)
        assert why_no_curves(found)
        return
    for graph in drawn:
        assert graph.doc.strip()
        for line in graph.lines:
            assert np.isfinite(line.y).mean() > 0.5, f"{graph.name}: half of it is not a number"
    # A flat line tells nothing: some graph must have shape.
    assert any(np.ptp(line.y[np.isfinite(line.y)]) > 0 for graph in drawn for line in graph.lines)


@every_file
def test_it_compiles_to_native_code(path: Path) -> None:
    found = component(reference_of(path))
    if isinstance(found, Composite):
        assert found.parts.entries
        return
    address = address_of(found)
    assert address > 0
    assert address_of(found) == address
    # A part that acts or remembers must have something to call.
    if found.states:
        assert {"start", "update", "reset"} & set(stages(found))
