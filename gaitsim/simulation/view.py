"""The p, u, x, y of a component in Python: named fields over the same tables that native code uses."""

from __future__ import annotations

from typing import Any

from gaitsim.compiler.program import Floats, Program


class View:
    """Fields of one part in one table: numbers, or arrays for states with a size and for series."""

    __slots__ = ("_places", "_table")

    def __init__(self, table: Floats, places: dict[str, int | slice]) -> None:
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_places", places)

    def __getattr__(self, name: str) -> Any:
        try:
            return self._table[self._places[name]]
        except KeyError:
            raise AttributeError(name) from None

    def __setattr__(self, name: str, value: Any) -> None:
        self._table[self._places[name]] = value

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={self._table[place]}" for name, place in self._places.items())
        return f"({fields})"


def views(program: Program, part: int, p: Floats, u: Floats, x: Floats, y: Floats) -> tuple[View, View, View, View]:
    """The four views of a part."""
    kind = program.model.parts[part].type
    states = {name: state.size for name, state in kind.states.items() if state.size is not None}
    series = {name: one.size for name, one in kind.series.items()}
    sized: tuple[dict[str, int], ...] = (series, {}, states, {})
    layouts = (program.parameters, program.inputs, program.states, program.outputs)
    made = []
    for table, layout, sizes in zip((p, u, x, y), layouts, sized, strict=True):
        places: dict[str, int | slice] = {name: layout.place(part, name) for name in layout.fields[part]}
        places |= {n: slice(layout.place(part, n), layout.place(part, n) + size) for n, size in sizes.items()}
        made.append(View(table, places))
    a, b, c, d = made
    return a, b, c, d
