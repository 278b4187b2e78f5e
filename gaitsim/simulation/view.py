"""The p, u, x and y of a component in Python: named fields over the tables that native code uses too."""

from __future__ import annotations

from typing import Any

from gaitsim.compiler.program import Floats, Program


class View:
    """The fields of one part in one table: numbers, or arrays for states with a size and for series."""

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
    """The views of a part on the tables p, u, x and y."""
    places = program.field_places[part]
    return View(p, places[0]), View(u, places[1]), View(x, places[2]), View(y, places[3])
