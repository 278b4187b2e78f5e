"""Where components are looked for: what a person named or marked, and no folder that merely lies above a spec."""

from __future__ import annotations

from pathlib import Path

from gaitsim.components.find import Library, library_folders
from gaitsim.distribution import shipped_folder


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


def test_a_folder_that_is_named_twice_is_one(tmp_path: Path) -> None:
    """As in the test of a component that joined the shipped library."""
    again = tmp_path / "again"
    again.symlink_to(shipped_folder())
    library = Library((shipped_folder(), shipped_folder(), again))
    assert library.folders == (shipped_folder(),)
    assert library.find("muscle/geyer2003").reference == "muscle/geyer2003"
