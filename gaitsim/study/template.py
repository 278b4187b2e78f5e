"""The files that `gaitsim new` writes into a folder."""

from __future__ import annotations

from pathlib import Path

from gaitsim.components.find import Library
from gaitsim.components.skeleton import new_component, test_of
from gaitsim.distribution import shipped_folder, shipped_specs
from gaitsim.errors import Usage, did_you_mean
from gaitsim.results.tuned import tuned_path
from gaitsim.spec.inheritance import parents, with_parents
from gaitsim.text.document import MappingNode

_README = """\
# {title}

A study with gaitsim. Change whatever you like.

| file | what it is |
|---|---|
| `{origin}.yaml` | a model of gaitsim, unchanged; specs that it extends and tuned values lie beside it |
| `my_{origin}.yaml` | the same model with `controller/my_reflex` as its feedback |
| `components/controller/my_reflex.py` | your component: parameters, ports, one equation |
| `tests/test_my_reflex.py` | its test; run it with `pytest` |

## Next steps

    gaitsim run my_{origin}.yaml                       # metrics of one run
    gaitsim check my_{origin}.yaml --convergence       # is the time step short enough?
    gaitsim optimize my_{origin}.yaml --smoke          # a search of a few seconds; without --smoke, a whole one
    gaitsim results list
    gaitsim analyze results/RESULT                     # figures, a video and report.html
    gaitsim cite my_{origin}.yaml                      # BibTeX for everything the model uses

Change the equation in `components/controller/my_reflex.py`, then:

    gaitsim library check components                   # names, units, sources, bounds
    gaitsim library show controller/my_reflex --plot   # its curves
    gaitsim library list                               # all components that you can use instead
    gaitsim library new muscle my_muscle               # another component of your own
"""
_VARIANT = """\
gaitsim: 1
about: >-
  {origin} with a reflex of my own in the place of its feedback.

extends: {origin}.yaml
parts:
  {feedback}:
    use: controller/my_reflex
"""


def study(origin: str) -> dict[str, str]:
    """The files of a new folder that begins with a shipped spec, as texts by name."""
    specs = shipped_specs()
    if origin not in specs:
        raise Usage(f"--from {origin}: no such spec is shipped. {did_you_mean(origin, specs)}")
    files = _shipped_files(specs[origin])
    document = with_parents(specs[origin], f"{origin}.yaml")
    file, component = new_component("controller", "my_reflex", Library((shipped_folder(),)))
    feedback = feedback_of(document)
    if feedback is not None:
        files[f"my_{origin}.yaml"] = _VARIANT.format(origin=origin, feedback=feedback)
        files[f"components/controller/{file}"] = component
        files["tests/test_my_reflex.py"] = test_of("controller", "my_reflex")
    readme = _README if feedback is not None else _without_own(_README)
    return files | {"README.md": readme.format(title=f"My {origin.replace('_', ' ')}", origin=origin)}


def _without_own(readme: str) -> str:
    """The text for a model without a muscle feedback, so that none was replaced."""
    lines = [line for line in readme.splitlines(keepends=True) if not (line.startswith("| `") and "my_" in line)]
    begin = "    gaitsim library new controller my_reflex           # a component of your own\n\n"
    text = "".join(lines).replace("my_{origin}", "{origin}")
    return text.replace("Change the equation in `components/controller/my_reflex.py`, then:\n\n", begin)


def _shipped_files(spec: Path) -> dict[str, str]:
    """A shipped spec, the specs that it extends, and the tuned values of each."""
    chain = [spec, *parents(spec)]
    files = [file for one in chain for file in (one, tuned_path(one)) if file.is_file()]
    return {file.name: file.read_text(encoding="utf-8") for file in files}


def feedback_of(document: MappingNode) -> str | None:
    """The part of a spec that is the feedback of a muscle."""
    parts = document.entries.get("parts")
    for name, node in (parts.entries if isinstance(parts, MappingNode) else {}).items():
        use = node.entries.get("use") if isinstance(node, MappingNode) else None
        if getattr(use, "value", "") == "controller/muscle_feedback":
            return name
    return None
