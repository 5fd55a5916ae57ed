"""Results that take long to make, kept until their source or the library changes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
WORK = ROOT / "build" / "website"
# What a result depends on, beside its own source.
LIBRARY = ("gsp/**/*.py", "catalogue/**/*.toml", "indices/**/*.toml")


def kept(source: Path, folder: Path, suffix: str, make: Callable[[Path], None]) -> Path:
    """Return the file in `folder` made from a source; `make` writes it if there is none.

    Its name has a digest of the source and the library. Those made from an older state go.
    """
    folder.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256(source.read_bytes() + library()).hexdigest()[:12]
    result = folder / f"{source.stem}-{digest}{suffix}"
    if not result.exists():
        for old in folder.glob(f"{source.stem}-{12 * '?'}{suffix}"):
            old.unlink()
        make(result)
    return result


@cache
def library() -> bytes:
    """Return a digest of the library: its code and its data."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in LIBRARY for path in ROOT.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.digest()
