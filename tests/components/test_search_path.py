"""Where components are looked for: what a person named or marked, and no folder that merely lies above a spec."""

from __future__ import annotations

from pathlib import Path

from gaitsim.components.find import library_folders, shipped_folder


def test_a_library_above_a_spec_counts_only_in_a_marked_lab(tmp_path: Path) -> None:
    (tmp_path / "library").mkdir()
    spec = tmp_path / "study" / "walk.yaml"
    (spec.parent / "library").mkdir(parents=True)
    (tmp_path / "named").mkdir()
    own, named = spec.parent / "library", tmp_path / "named"
    assert library_folders(spec, [named]) == (named, own, shipped_folder())
    own.rmdir()
    assert library_folders(spec) == (shipped_folder(),)
    (tmp_path / "lab.yaml").write_text("gaitsim: 1\n")
    assert library_folders(spec) == (tmp_path / "library", shipped_folder())
