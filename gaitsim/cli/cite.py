"""gaitsim cite: the references of a model as BibTeX."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Set, Spec, Trust, opening

if TYPE_CHECKING:
    from gaitsim.study.opened import Opened


def cite(
    spec: Spec,
    settings: Set = None,
    results: Results = None,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Print BibTeX for everything that a model uses.

    This includes the sources of its numbers, its components, MuJoCo, and the search that tuned it.

    Examples:

    gaitsim cite specs/hopping_leg_mass.yaml > used.bib

    gaitsim cite results/2026-11-22-hopping-3f9c --json
    """
    from gaitsim.components.bibliography import read_bibliography
    from gaitsim.results.citation import citations

    opened = opening(spec, settings, library, trusted=trust, results=results).open()
    model = opened.model()
    # A result keeps its components but no bibliography: that is the library's.
    folders = [*opened.library.folders, *opening(spec, None, library).library().folders]
    found = citations(model, read_bibliography(folders), _algorithm(opened))
    if json:
        console.give_json(
            {
                "entries": [{"key": e.key, "bibtex": e.bibtex, "used_by": e.used_by} for e in found.entries],
                "words": found.texts,
            }
        )
        return
    console.give("\n\n".join(entry.bibtex for entry in found.entries))
    for text, places in found.texts.items():
        console.say(f"in words, to be cited by hand: {text} ({_few(places)})")


def _algorithm(opened: Opened) -> tuple[str, ...]:
    """The keys of the search whose values are used; none if nothing was tuned."""
    from gaitsim.optimization.algorithms import ALGORITHMS
    from gaitsim.spec.schema import optimize_section

    if not opened.starts:
        return ()
    searched = opened.manifest.get("search", {}).get("algorithm")
    entry = ALGORITHMS.get(searched or optimize_section(opened.document).algorithm)
    return entry.citations if entry else ()


def _few(names: tuple[str, ...]) -> str:
    return ", ".join(names if len(names) < 4 else [*names[:2], f"{len(names) - 2} more"])
