"""Tables on plain texts: columns are aligned, long cells are folded on a terminal and nowhere else."""

from __future__ import annotations

from itertools import chain

from gaitsim.cli.table import rows_of


def drawn(columns: list[str], rows: list[list[str]], width: int | None = None) -> list[str]:
    return [*chain.from_iterable(rows_of(columns, rows, width))]


def test_columns_are_as_wide_as_their_widest_cell() -> None:
    table = drawn(["metric", "value", "unit"], [["hop_height", "0.2", "m"], ["duty", "0.45", ""]])
    assert table == [" metric      value  unit", " hop_height  0.2    m", " duty        0.45"]


def test_a_table_may_have_no_rows_and_an_empty_row() -> None:
    assert drawn(["a", "b"], []) == [" a  b"]
    assert drawn(["a"], [[""]]) == [" a", ""]


def test_a_cell_may_have_lines_and_tabs() -> None:
    assert drawn(["a", "b"], [["1\n2", "x\ty"]]) == [" a  b", " 1  x       y", " 2"]


def test_letters_of_two_places_and_of_none_are_aligned() -> None:
    assert drawn(["a", "b"], [["日本", "1"], ["ho\u0308he", "2"]]) == [" a     b", " 日本  1", " ho\u0308he  2"]


def test_brackets_are_letters_like_others() -> None:
    assert drawn(["speed [m/s]"], [["[bold]"]]) == [" speed [m/s]", " [bold]"]


def test_on_a_terminal_the_widest_column_is_folded_between_words() -> None:
    table = drawn(["name", "what"], [["push", "a force on the trunk"], ["x" * 6, "y" * 12]], width=17)
    assert table == [
        " name    what",
        " push    a force",
        "         on the",
        "         trunk",
        " xxxxxx  yyyyyyyy",
        "         yyyy",
    ]


def test_the_narrowest_terminal_still_gets_all_letters() -> None:
    table = drawn(["a"], [["metric of a name"]], width=1)
    assert table[1:] == [" metr", " ic", " of a", " name"]
