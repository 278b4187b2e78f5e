"""The text of a spec as data with marks: scalar rules, refusals, files, and the way back."""

from __future__ import annotations

import math
import os
import random
import socket
from pathlib import Path
from typing import Any

import pytest
import yaml

from gaitsim.errors import ExitCode, InvalidSpec, Mark
from gaitsim.text import document
from gaitsim.text.document import MappingNode, ScalarNode, dump, parse, parse_value, plain, read

WRITTEN: dict[str, Any] = {
    "null": None, "~": None, "": None, "Null": "Null",
    "true": True, "false": False, "True": "True", "no": "no", "on": "on", "y": "y",
    "0": 0, "-7": -7, "+7": 7, "010": "010", "1_000": "1_000", "0x1f": "0x1f", "12:30": "12:30",
    "1e3": 1000.0, ".5": 0.5, "-2.": -2.0, "1.5E-2": 0.015, "01.5": "01.5", "1e": "1e",
    ".": ".", ".inf": ".inf", "nan": "nan", "2026-11-22": "2026-11-22", "5 %": "5 %",
    "=height * 2": "=height * 2", "'1'": "1", '"null"': "null", "''": "", "٣": "٣",
}  # fmt: skip


def refusal(text: str) -> str:
    with pytest.raises(InvalidSpec) as caught:
        parse(text, "a.yaml")
    assert caught.value.exit_code is ExitCode.INVALID
    return str(caught.value)


@pytest.fixture(params=["CSafeLoader", "SafeLoader"])
def loader(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if not hasattr(yaml, request.param):
        pytest.skip("PyYAML without libyaml")
    monkeypatch.setattr(document, "_LOADER", getattr(yaml, request.param))


@pytest.mark.parametrize("text", WRITTEN)
@pytest.mark.usefixtures("loader")
def test_scalars_follow_five_rules(text: str) -> None:
    value = plain(parse(f"a: {text}", "a.yaml"))["a"]
    assert value == WRITTEN[text]
    assert type(value) is type(WRITTEN[text])


@pytest.mark.usefixtures("loader")
def test_marks_count_letters_from_one() -> None:
    top = parse("\ufeffknie:\r\n  länge: [5 cm, ä]\r\n", "a.yaml")
    knee = top.entries["knie"]
    assert isinstance(knee, MappingNode)
    assert top.keys["knie"] == Mark("a.yaml", 1, 1, "knie:")
    assert knee.keys["länge"] == Mark("a.yaml", 2, 3, "  länge: [5 cm, ä]")
    length = knee.entries["länge"]
    assert isinstance(length, document.SequenceNode)
    assert length.items[1] == ScalarNode("ä", Mark("a.yaml", 2, 17, "  länge: [5 cm, ä]"))


SYNTAX = {
    "a:\n\tb: 1\n": """\
a.yaml:2:1: YAML is not indented with tabs; write spaces.
    2 |  b: 1
      | ^""",
    "a: [1, 2\nb: 3\n": """\
a.yaml:1:4: this [ is not closed before line 2; write the missing ] or comma.
    1 | a: [1, 2
      |    ^""",
    "a: {x: 1\n\nb:\n  c: 5\n": """\
a.yaml:1:4: this { is not closed before line 3; write the missing } or comma.
    1 | a: {x: 1
      |    ^""",
    "a: [{x: 1} {y: 2}]\n": """\
a.yaml:1:12: something is missing before this; write a comma or ].
    1 | a: [{x: 1} {y: 2}]
      |            ^""",
    "a: {from: leg_{else}.load}\n": """\
a.yaml:1:15: between braces a text with { or } needs quotes; write "leg_{else}.load".
    1 | a: {from: leg_{else}.load}
      |               ^""",
    "a: 'x\nb: 1\n": """\
a.yaml:1:4: this quote is never closed; write ' where the text ends.
    1 | a: 'x
      |    ^""",
    "a: b: c\n": """\
a.yaml:1:5: a second ": " in one line; put the text after the first in quotes.
    1 | a: b: c
      |     ^""",
    "a: 1\n  b: 2\n": """\
a.yaml:2:4: this key cannot be nested below the line above, which has a value or lacks its colon; \
align the two, or write "key: value" there.
    2 |   b: 2
      |    ^""",
    " a: 1\nb: 2\n": """\
a.yaml:2:1: this is indented less than the first key; align the two.
    2 | b: 2
      | ^""",
    "a:\n    b: 1\n  c: 2\n": """\
a.yaml:3:3: this fits the indentation of no line above; align it with its neighbours.
    3 |   c: 2
      |   ^""",
    "a: 1\nb\nc: 1\n": """\
a.yaml:2:1: a key without a colon; write "key: value".
    2 | b
      | ^""",
    "a: @x\n": """\
a.yaml:1:4: a text may not begin with @; put the whole text in quotes.
    1 | a: @x
      |    ^""",
    "a: {b, , c}": """\
a.yaml:1:8: no value stands before this ,; write one, or remove it.
    1 | a: {b, , c}
      |        ^""",
    "a: 'x' y\n": """\
a.yaml:1:8: the value ended before this; remove it, or put the whole in quotes.
    1 | a: 'x' y
      |        ^""",
    "a: 1\n- 2\n": """\
a.yaml:2:1: a list item (-) cannot be among keys; indent it below its key.
    2 | - 2
      | ^""",
    "- 1\na: 2\n": """\
a.yaml:2:1: a key cannot be among list items; indent it, or begin it with a dash.
    2 | a: 2
      | ^""",
    "a: - 1\n": """\
a.yaml:1:4: a list item (-) cannot begin here; begin it on a line of its own.
    1 | a: - 1
      |    ^""",
    "a: \x1b[0m\n": """\
a.yaml:1:4: U+001B is a control character, which a spec must not contain; remove it.
    1 | a:  [0m
      |    ^""",
}


@pytest.mark.parametrize("text", SYNTAX)
@pytest.mark.usefixtures("loader")
def test_mistakes_in_yaml_are_explained(text: str) -> None:
    assert refusal(text) == SYNTAX[text]


REFUSED = {
    "a: 1\nb: 2\na: 3\n": """\
a.yaml:3:1: a occurs twice here (first in line 1); remove or rename one of the two.
    3 | a: 3
      | ^""",
    "a: !!python/name:os.system x\n": """\
a.yaml:1:4: !!python/name:os.system is a tag, which a spec may not have; remove it.
    1 | a: !!python/name:os.system x
      |    ^""",
    "a: !x!y 3\n": """\
a.yaml:1:4: a spec may not have tags (!); remove it, or put the text in quotes.
    1 | a: !x!y 3
      |    ^""",
    "a: &k {b: 1}\nc:\n  <<: *k\n": """\
a.yaml:1:4: a spec has no anchors (&), aliases (*) or merge keys (<<); \
write extends: or a composite.
    1 | a: &k {b: 1}
      |    ^
a.yaml:3:3: a spec has no anchors (&), aliases (*) or merge keys (<<); \
write extends: or a composite.
    3 |   <<: *k
      |   ^""",
    "1: x\n? [2]\n: x\n": """\
a.yaml:1:1: a key must be text; write it in quotes: "1".
    1 | 1: x
      | ^
a.yaml:2:3: a key must be text; write a word before the colon.
    2 | ? [2]
      |   ^""",
    "a: 1\n---\nb: 2\n": """\
a.yaml:2:1: a second document begins here; \
one file holds one spec: put the second into a file of its own.
    2 | ---
      | ^""",
    "- 1\n": """\
a.yaml:1:1: this is a list; a spec is keys with values, such as "parts: ...".
    1 | - 1
      | ^""",
    "walk\n": """\
a.yaml:1:1: this is a bare value; a spec is keys with values, such as "parts: ...".
    1 | walk
      | ^""",
    "a: 1e999\n": """\
a.yaml:1:4: this number is too large; write one below 1.8e308.
    1 | a: 1e999
      |    ^""",
    "# nothing\n": 'a.yaml: there is nothing in it; write "parts:" and below it the parts.',
}


@pytest.mark.parametrize("text", REFUSED)
@pytest.mark.usefixtures("loader")
def test_what_a_spec_may_not_hold_is_refused(text: str) -> None:
    assert refusal(text) == REFUSED[text]


@pytest.mark.usefixtures("loader")
@pytest.mark.parametrize("opener", ["[", "{a: ", "\n? "])
def test_endless_nesting_is_refused(opener: str) -> None:
    said = refusal("a: 1\nb: " + opener * 3000 if opener != "\n? " else "? " * 3000)
    assert "this is nested more than 100 levels deep; put an inner part into" in said


def test_a_digit_string_of_any_length_is_refused() -> None:
    assert "this number is too large; write one below 1.8e308." in refusal("a: " + "9" * 9999)


def file_refusal(path: Path, shown: str) -> str:
    with pytest.raises(InvalidSpec) as caught:
        read(path, shown)
    return str(caught.value)


def test_a_file_is_read_with_byte_order_mark_and_carriage_returns(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbfa: 1\r\nb: |\r\n  x\r\n  y\r\n")
    assert plain(read(tmp_path / "a.yaml")) == {"a": 1, "b": "x\ny\n"}
    assert read(tmp_path / "a.yaml").mark.file == str(tmp_path / "a.yaml")
    assert read(tmp_path / "a.yaml", "a.yaml").mark == Mark("a.yaml", 1, 1, "a: 1")


def test_files_that_hold_no_spec_are_refused(tmp_path: Path) -> None:
    empty, holder = tmp_path / "empty.yaml", tmp_path / "folder"
    holder.mkdir()
    empty.touch()
    assert file_refusal(empty, "empty.yaml") == (
        'empty.yaml: there is nothing in it; write "parts:" and below it the parts.'
    )
    assert file_refusal(holder, "folder") == ("folder: this is a folder; it holds no .yaml file.")
    (holder / "walk.yaml").touch()
    (holder / "hop.yaml").touch()
    assert file_refusal(holder, "folder") == ("folder: this is a folder; name one spec in it: hop.yaml, walk.yaml.")
    assert file_refusal(holder / "wakl.yaml", "folder/wakl.yaml") == (
        "folder/wakl.yaml: there is no such file. Did you mean walk.yaml?"
    )
    assert file_refusal(tmp_path / "none" / "walk.yaml", "none/walk.yaml") == (
        f"none/walk.yaml: there is no folder {tmp_path}/none; check the path."
    )
    assert file_refusal(empty / "walk.yaml", "w") == (f"w: there is no folder {empty}; check the path.")
    assert file_refusal(Path("a\0b"), "a") == ("a: it cannot be read (embedded null byte); check the path.")


def test_bytes_that_are_no_text_are_named(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_bytes(b"a: \0")
    assert file_refusal(path, "a.yaml") == (
        "a.yaml: byte 3 is NUL, so this is not a text in UTF-8; save it as text in UTF-8, or name another file."
    )
    path.write_bytes(b"a: 1\nb: \xe4\n")
    assert file_refusal(path, "a.yaml") == (
        "a.yaml: byte 8 (0xe4, in line 2) is not UTF-8; save it as text in UTF-8, or name another file."
    )


def test_a_large_file_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.yaml"
    with path.open("wb") as file:
        file.truncate(6_000_000)
    monkeypatch.setattr(Path, "read_bytes", lambda self: pytest.fail("read"))
    assert file_refusal(path, "a.yaml") == (
        "a.yaml: this file has 6.0 MB and the limit is 5 MB; name a spec, and keep data in other files."
    )


def test_a_file_without_permission_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(self: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a.yaml").touch()
    monkeypatch.setattr(Path, "read_bytes", denied)
    assert file_refusal(tmp_path / "a.yaml", "a.yaml") == (
        "a.yaml: there is no permission to read it; allow it with: chmod u+r a.yaml"
    )


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_pipes_devices_and_dead_links_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    said = "a: this is a pipe or a device; save the spec in a file and name it."
    assert file_refusal(tmp_path / "pipe", "a") == said
    assert file_refusal(Path("/dev/null"), "a") == said
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(tmp_path / "s"))
        assert file_refusal(tmp_path / "s", "a") == said
    (tmp_path / "link").symlink_to("gone.yaml")
    assert file_refusal(tmp_path / "link", "a") == (
        "a: this links to gone.yaml, which does not exist; correct the link."
    )
    (tmp_path / "loop").symlink_to("loop")
    assert file_refusal(tmp_path / "loop", "a") == (
        "a: it cannot be read (Too many levels of symbolic links); check the path."
    )


def test_a_value_alone_follows_the_same_rules() -> None:
    mark = Mark("--set a=1")
    assert parse_value("1e3", "--set a=1") == ScalarNode(1000.0, mark)
    value = parse_value("{from: leg.load, delay: [5 ms]}", "--set a=1")
    assert plain(value) == {"from": "leg.load", "delay": ["5 ms"]}
    assert isinstance(value, MappingNode)
    assert value.keys["from"] == mark
    with pytest.raises(InvalidSpec) as caught:
        parse_value("[1, 2", "--set a=[1, 2")
    assert str(caught.value).startswith("--set a=[1, 2: ")
    with pytest.raises(InvalidSpec) as caught:
        parse_value("{b: 1, b: 2}", "--set a")
    assert str(caught.value) == "--set a: b occurs twice here; remove or rename one of the two."
    with pytest.raises(InvalidSpec) as caught:
        parse_value("#fff", "--set a=#fff")
    assert str(caught.value) == ("--set a=#fff: there is no value; write one, in quotes if it begins with #.")


def test_dump_is_readable_and_quotes_what_would_change() -> None:
    data = {"parts": {"knee": {"at": [1, 2.0, "3 %"], "use": "joint/hinge"}}, "no": "1e3"}
    assert dump(data) == ("parts:\n  knee:\n    at: [1, 2.0, 3 %]\n    use: joint/hinge\n'no': '1e3'\n").replace(
        "'no'", "no"
    )
    assert dump({}) == "{}\n"
    for refused in ([1], {1: 2}, {"a": math.nan}, {"a": {1, 2}}):
        with pytest.raises(TypeError):
            dump(refused)


PIECES = ["a", " ", "\n", "\t", ": ", "#", " #", "- ", "'", '"', "\\", "{", "}", "[", "]", ",", "%",
          "=", "&", "*", "!", "|", ">", "?", "~", "1", "e", ".", "0", "ä", "😀", "\x85", "\u2028",
          "\ufeff", "\x07", "---", "...", "null", "<<", "@", "`", "\r", "\xa0"]  # fmt: skip


def anything(chance: random.Random, depth: int) -> Any:
    kind = chance.randrange(9 if depth else 7)
    if kind == 7:
        return [anything(chance, depth - 1) for _ in range(chance.randrange(4))]
    if kind == 8:
        return {text(chance): anything(chance, depth - 1) for _ in range(chance.randrange(4))}
    if kind == 0:
        return chance.choice([None, True, False, 0, -3, 10**40, 0.1, -0.0, 1e300, 5e-324, 1e16])
    return chance.choice(list(WRITTEN)) if kind == 1 else text(chance)


def text(chance: random.Random) -> str:
    long = chance.random() < 0.02
    return "".join(chance.choices(PIECES, k=chance.randrange(150 if long else 6)))


@pytest.mark.usefixtures("loader")
def test_dump_comes_back_identically() -> None:
    chance = random.Random(1)
    for _ in range(600):
        data = {"a" + text(chance): anything(chance, 3) for _ in range(3)}
        back = plain(parse(dump(data), "a.yaml"))
        assert repr(back) == repr(data)


def test_sides_need_no_quotes_between_braces() -> None:
    text = 'a: {from: leg_{other}.load}\nb: leg_{side}\nc: "{other}"\n'
    node = document.parse(text, "a.yaml")
    assert document.plain(node) == {"a": {"from": "leg_{other}.load"}, "b": "leg_{side}", "c": "{other}"}
    inner = node.entries["a"]
    assert isinstance(inner, document.MappingNode)
    assert inner.entries["from"].mark.text == "a: {from: leg_{other}.load}"
