"""gaitsim check: is a spec sound? Nothing is simulated."""

from __future__ import annotations

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Set, Spec, open_library, read_document


def check(spec: Spec, settings: Set = None, library: Libraries = None, json: Json = False) -> None:
    """Check a spec: grammar, units, wiring, components, mechanics. All faults at once.

    Example: gaitsim check specs/hopping_geyer2003.yaml
    """
    from gaitsim.simulation.run import Simulator
    from gaitsim.spec.resolve import resolve
    from gaitsim.spec.study import variants

    document = read_document(spec, settings)
    models = [resolve(row.document, open_library(spec, library), spec.stem) for row in variants(document, [])]
    for each in models:
        Simulator(each)
    model = models[0]
    for notice in model.notices:
        console.say(notice)
    counts = {
        "parts": len(model.parts),
        "connections": len(model.connections),
        "tuned": len(model.free),
        "metrics": len(model.metrics),
    }
    if json:
        console.give_json({"status": "valid", **counts, "notices": list(model.notices)})
    else:
        console.give(f"{spec}: valid ({', '.join(f'{n} {name}' for name, n in counts.items())})")
