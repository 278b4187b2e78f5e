"""Parents by `extends:`, and single settings laid over a spec."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gaitsim.errors import ExitCode, InvalidSpec, Mark, Usage
from gaitsim.spec.inheritance import merged, override, split_setting, with_parents
from gaitsim.text.document import MappingNode, parse, plain

WALK = """\
gaitsim: 1
parts:
  trunk: {use: segment/hat}
  leg:
    use: leg/reflex_leg
    gain: {value: 1.2, tune: [0, 5]}
    points: [{on: shank, at: [1 cm, 2 cm]}, {on: foot}]
measures:
  effort: {use: measure/effort, weight: 1}
initial: {leg_l.knee.angle: 5 deg}
optimize:
simulate: {duration: 20 s}
"""


def laid(base: str, over: str) -> Any:
    return plain(merged(parse(base, "base.yaml"), parse(over, "over.yaml")))


def test_mappings_merge_by_key_and_the_rest_is_replaced() -> None:
    assert laid("a: {b: 1, c: {d: [1, 2]}}\nz: 0", "a: {c: {d: [3], e: x}, f: 2}") == {
        "a": {"b": 1, "c": {"d": [3], "e": "x"}, "f": 2},
        "z": 0,
    }
    assert laid("a: 1\nb: {c: 1}", "a: {c: 1}\nb: 2") == {"a": {"c": 1}, "b": 2}


def test_a_value_node_is_replaced_whole() -> None:
    node = "a: {value: 1, tune: [0, 2], spread: 1}"
    assert laid(node, "a: 3") == {"a": 3}
    assert laid(node, "a: {value: 2}") == {"a": {"value": 2}}
    assert laid(node, "a: {from: b.c}") == {"a": {"from": "b.c"}}
    assert laid("a: {from: b.c}", "a: {value: 2, source: x}") == {"a": {"value": 2, "source": "x"}}
    assert laid("a: {b: 1}", "a: {}") == {"a": {"b": 1}}


def test_order_and_marks_are_kept() -> None:
    spec = merged(parse("a: 1\nb: {c: 1}", "base.yaml"), parse("z: 0\nb: {d: 2}\n", "over.yaml"))
    assert list(spec.entries) == ["a", "b", "z"]
    assert spec.keys["a"] == Mark("base.yaml", 1, 1, "a: 1")
    assert spec.keys["b"] == Mark("over.yaml", 2, 1, "b: {d: 2}")
    inner = spec.entries["b"]
    assert isinstance(inner, MappingNode)
    assert inner.entries["c"].mark == Mark("base.yaml", 2, 8, "b: {c: 1}")
    assert inner.entries["d"].mark == Mark("over.yaml", 2, 8, "b: {d: 2}")


def test_null_removes_what_is_there_and_waits_where_a_composite_may_have_it() -> None:
    assert laid("a: {b: 1, c: 2}\nd:", "a: {b: null}\nd: ~") == {"a": {"c": 2}}
    assert laid("parts: {leg: {use: x}}", "parts: {leg: {knee: null}}") == {
        "parts": {"leg": {"use": "x", "knee": None}}
    }


def chain(folder: Path, **texts: str) -> MappingNode:
    for name, text in texts.items():
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return with_parents(folder / "walk.yaml", "walk.yaml")


def test_parents_are_laid_first(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "first.yaml").write_text("gaitsim: 1\na: 1\nb: 1\nc: 1")
    (tmp_path / "old" / "base.yaml").write_text("extends: first.yaml\nb: 2\nc: 2")
    spec = chain(tmp_path, walk="extends: old/base.yaml\nc: 3")
    assert plain(spec) == {"gaitsim": 1, "a": 1, "b": 2, "c": 3}
    assert [node.mark.file for node in spec.entries.values()] == [
        "old/first.yaml",
        "old/first.yaml",
        "old/base.yaml",
        "walk.yaml",
    ]


def test_a_ring_of_parents_is_printed(tmp_path: Path) -> None:
    with pytest.raises(InvalidSpec) as caught:
        chain(tmp_path, walk="extends: ./walk.yaml")
    assert str(caught.value) == (
        "walk.yaml:1:10: extends: these extend each other in a ring: walk.yaml -> walk.yaml; "
        "remove one extends.\n    1 | extends: ./walk.yaml\n      |          ^"
    )
    with pytest.raises(InvalidSpec) as caught:
        chain(tmp_path, walk="extends: a.yaml", a="extends: b.yaml", b="extends: a.yaml")
    assert str(caught.value) == (
        "b.yaml:1:10: extends: these extend each other in a ring: a.yaml -> b.yaml -> a.yaml; "
        "remove one extends.\n    1 | extends: a.yaml\n      |          ^"
    )


@pytest.mark.parametrize("parent", ["[a, b]", "3", "null", "{a: b}"])
def test_a_parent_is_one_file(tmp_path: Path, parent: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        chain(tmp_path, walk=f"extends: {parent}")
    assert str(caught.value) == (
        "walk.yaml:1:10: extends: extends names one parent; write a file, such as "
        f"extends: walk.yaml.\n    1 | extends: {parent}\n      |          ^"
    )


def test_what_is_wrong_with_a_parent_is_said_where_it_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidSpec) as caught:
        chain(tmp_path, base="a: 1", walk="a: 1\nextends: bas.yaml")
    assert str(caught.value) == (
        "walk.yaml:2:10: extends: bas.yaml: there is no such file. Did you mean base.yaml?\n"
        "    2 | extends: bas.yaml\n      |          ^"
    )
    with pytest.raises(InvalidSpec) as caught:
        chain(tmp_path, base="parts: [1", walk="extends: base.yaml")
    assert str(caught.value).startswith("base.yaml:1:8: ")


def test_settings_are_split_at_the_first_equals_sign() -> None:
    assert split_setting("leg.knee.damping=5") == ("leg.knee.damping", "5")
    assert split_setting(" thigh.mass = =mass ") == ("thigh.mass", "=mass")
    assert split_setting("about=''") == ("about", "''")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "gain",
            "--set gain: a setting is address=value; write, for example, --set leg.knee.damping=5.",
        ),
        (
            "gain=",
            ('--set gain=: there is no value after the =; write null to remove it, or "" for an empty text.'),
        ),
        (
            "a..b=1",
            ("--set a..b=1: an address is words with one dot between them, such as leg.knee.damping."),
        ),
        (
            "=1",
            "--set =1: an address is words with one dot between them, such as leg.knee.damping.",
        ),
    ],
)
def test_settings_that_are_none_are_refused(text: str, said: str) -> None:
    with pytest.raises(Usage) as caught:
        split_setting(text)
    assert str(caught.value) == said
    assert caught.value.exit_code is ExitCode.USAGE


def at(address: str, text: str, *walked: str | int) -> Any:
    data = plain(override(parse(WALK, "walk.yaml"), address, text))
    for word in walked:
        data = data[word]
    return data


def test_the_first_word_decides_the_section() -> None:
    assert at("trunk.mass", "80 kg", "parts", "trunk") == {"use": "segment/hat", "mass": "80 kg"}
    assert at("parts.trunk.mass", "80 kg", "parts", "trunk", "mass") == "80 kg"
    assert at("effort.weight", "1e3", "measures", "effort", "weight") == 1000.0
    assert at("new.gain", "1", "parts", "new") == {"gain": 1}
    assert at("simulate.duration", "5 s", "simulate") == {"duration": "5 s"}
    assert at("optimize.seed", "2", "optimize") == {"seed": 2}
    assert at("use_for.muscle", "muscle/hill", "use_for") == {"muscle": "muscle/hill"}
    assert at("about", "a try", "about") == "a try"
    assert at("initial.leg_l.knee.angle", "9 deg", "initial") == {"leg_l.knee.angle": "9 deg"}
    assert at("initial.trunk.z", "1 m", "initial", "trunk.z") == "1 m"


def test_values_merge_replace_and_remove_as_in_extends() -> None:
    assert at("leg.gain", "1.3", "parts", "leg", "gain") == 1.3
    assert at("leg.gain", "{value: 2}", "parts", "leg", "gain") == {"value": 2}
    assert at("leg.gain.value", "2", "parts", "leg", "gain") == {"value": 2, "tune": [0, 5]}
    assert at("leg.gain.tune.1", "9", "parts", "leg", "gain", "tune") == [0, 9]
    assert at("leg.points.0.at.1", "=2*h", "parts", "leg", "points", 0, "at") == ["1 cm", "=2*h"]
    assert at("leg.points.1", "{on: toe}", "parts", "leg", "points", 1) == {"on": "toe"}
    assert at("trunk", "{mass: 1}", "parts", "trunk") == {"use": "segment/hat", "mass": 1}
    assert at("leg.signal", "{from: a.b, delay: 5 ms}", "parts", "leg", "signal", "from") == "a.b"
    assert "trunk" not in at("trunk", "null", "parts")


def test_only_what_is_set_bears_the_mark_of_the_setting() -> None:
    before = parse(WALK, "walk.yaml")
    parts = override(before, "trunk.mass", "80 kg").entries["parts"]
    assert plain(before) == plain(parse(WALK, "walk.yaml"))
    assert isinstance(parts, MappingNode)
    trunk = parts.entries["trunk"]
    assert isinstance(trunk, MappingNode)
    assert (trunk.mark.line, trunk.entries["use"].mark.line) == (3, 3)
    assert trunk.keys["mass"] == trunk.entries["mass"].mark == Mark("--set trunk.mass=80 kg")


@pytest.mark.parametrize(
    ("address", "text", "said"),
    [
        (
            "trunk.use.value",
            "1",
            ("--set trunk.use.value=1: trunk.use: use is segment/hat, with no value inside; set trunk.use as a whole."),
        ),
        (
            "leg.points.2.on",
            "foot",
            ("--set leg.points.2.on=foot: leg.points: 2 is not an item of this list; number its items from 0 to 1."),
        ),
        (
            "leg.points.on",
            "foot",
            ("--set leg.points.on=foot: leg.points: on is not an item of this list; number its items from 0 to 1."),
        ),
        (
            "leg.gain",
            "{a: 1, a: 2}",
            ("--set leg.gain={a: 1, a: 2}: a occurs twice here; remove or rename one of the two."),
        ),
    ],
)
def test_settings_that_do_not_fit_are_refused(address: str, text: str, said: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        at(address, text)
    assert str(caught.value) == said


def test_an_address_is_words() -> None:
    with pytest.raises(Usage) as caught:
        override(parse(WALK, "walk.yaml"), "a..b", "1", origin="--vary")
    assert str(caught.value) == (
        "--vary a..b=1: an address is words with one dot between them, such as leg.knee.damping."
    )
    with pytest.raises(Usage):
        at("a" + ".a" * 5000, "1")
