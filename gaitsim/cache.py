"""Bytes that can be made again, kept in the user's cache folder: each entry is whole and sound, or absent.

An entry is one file: the digest of its bytes, then the bytes. A cache that cannot be read or written
ends nothing: what would be in it is made again, and one line says so, once in a process.
"""

from __future__ import annotations

import hashlib
import logging
import os
import tempfile
from functools import cache
from pathlib import Path

from gaitsim.folders import cache_folder
from gaitsim.whole import PARTIAL, whole

_DIGEST_SIZE = hashlib.sha256().digest_size
_REMEDY = "so nothing is kept and each run compiles anew; set GAITSIM_CACHE to a folder that can be written"


def kept(kind: str, key: str) -> bytes | None:
    """The bytes of an entry; None if there is none, or none that is sound."""
    path = _path(kind, key)
    if path is None:
        return None
    try:
        whole = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None  # writing it tells whether the folder can be used
    except OSError as error:
        _tell_unusable(error)
        return None
    data = whole[_DIGEST_SIZE:]
    if hashlib.sha256(data).digest() != whole[:_DIGEST_SIZE]:
        tell_once(f"{path} is damaged; it is made again.")
        return None
    return data


def keep(kind: str, key: str, data: bytes) -> None:
    """Write an entry as a whole, over one that is there."""
    path = _path(kind, key)
    if path is None:
        tell_once(f"there is no absolute path to a cache folder, {_REMEDY}.")
        return
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor, draft = tempfile.mkstemp(dir=path.parent, prefix=f"{key}{PARTIAL}.")
        with whole(path, Path(draft)), os.fdopen(descriptor, "wb") as file:
            file.write(hashlib.sha256(data).digest() + data)
    except OSError as error:
        _tell_unusable(error)


def tell_once(message: str) -> None:
    """Say on stderr what the cache cannot do; after the first time in a process, nothing."""
    if not _told():
        _told().append(message)
        logging.getLogger("gaitsim").warning("gaitsim: %s", message)


@cache
def _told() -> list[str]:
    """What this process has said of its cache."""
    return []


def _path(kind: str, key: str) -> Path | None:
    folder = cache_folder()
    return folder / kind / key if folder else None


def _tell_unusable(error: OSError) -> None:
    tell_once(f"the cache {cache_folder()} cannot be used ({error.strerror or error}), {_REMEDY}.")
