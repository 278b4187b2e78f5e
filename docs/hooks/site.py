"""What mkdocs calls: pages of the reference are written from the declarations when the site is built."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import archive
import commands
import components
import references
import spec_format
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from parts_of_text import Page

ROOT = Path(__file__).resolve().parents[2]
ROOT_PAGES = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the generated pages of the components into the navigation.

    Args:
        config: The site's configuration; its `nav` has one entry `Components: reference/components/index.md`.

    Returns:
        The same configuration.
    """
    config.nav = _with_kinds(config.nav)
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages and pictures to the files of the site.

    Args:
        files: What is in `docs/`.
        config: The site's configuration.

    Returns:
        The same collection.
    """
    own = [commands.page(), spec_format.page(), archive.page(), references.page()]
    pages: list[Page] = [*components.pages(), *own, *_root_pages()]
    for page in pages:
        files.append(File.generated(config, page.path, content=page.content))
    return files


def _with_kinds(nav: Any) -> Any:
    """The navigation with a page for each kind of component after their overview."""
    if isinstance(nav, list):
        return [_with_kinds(entry) for entry in nav]
    if isinstance(nav, dict):
        return {title: _kinds(entry) if title == "Components" else _with_kinds(entry) for title, entry in nav.items()}
    return nav


def _kinds(overview: str) -> list[Any]:
    return [overview, *({kind: components.path_of(kind)} for kind in components.kinds())]


def _root_pages() -> list[Page]:
    """Pages that lie in the root of the repository; their links into docs/ are made relative to docs/."""
    texts = {made: (ROOT / name).read_text(encoding="utf-8") for name, made in ROOT_PAGES.items()}
    return [Page(made, text.replace("](docs/", "](")) for made, text in texts.items()]
