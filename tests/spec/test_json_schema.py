"""The JSON Schema accepts every spec of the archive, and refuses what the reader refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest

from gaitsim.components.find import Library, library_folders
from gaitsim.spec.json_schema import spec_schema
from gaitsim.text.document import parse, plain, read

SPECS = sorted((Path(__file__).parents[2] / "specs").glob("*.yaml"))
SPECS = [path for path in SPECS if not path.name.endswith(".tuned.yaml")]


@pytest.fixture(scope="module")
def validator() -> Any:
    schema = spec_schema(Library(library_folders(SPECS[0])))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_spec_is_valid(path: Path, validator: Any) -> None:
    assert [error.message for error in validator.iter_errors(plain(read(path)))] == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("parts: {a: {use: segment/rod, mas: 2 kg}}", "'mas' was unexpected"),
        ("parts: {a: {use: segment/rot}}", "'segment/rot' is not one of"),
        ("parts: {a: {use: segment/rod, mass: [1]}}", "[1] is not valid"),
        ("parts: {a: {use: sensor/noise, seed: 1.5}}", "1.5 is not valid"),
        ("parts: {a: {use: sensor/noise, seed: {tune: [1, 5]}}}", "is not valid"),
        ("part: {}\nparts: {}", "'part' was unexpected"),
    ],
)
def test_mistakes_are_refused(text: str, said: str, validator: Any) -> None:
    document = plain(parse(f"gaitsim: 1\nsimulate: {{duration: 1 s, step: 1 ms}}\n{text}\n", "a.yaml"))
    messages = [error.message for error in validator.iter_errors(document)]
    assert any(said in message for message in messages), messages
