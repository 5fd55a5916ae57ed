"""Whether packages are installed that need not be, and errors with the way to install them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from gsp.errors import MissingSoftware


def is_installed(module: str) -> bool:
    """Whether a module can be found for import; it is not imported."""
    return find_spec(module) is not None


def check_installed(
    package: str, purpose: str, extra: str = "", *, hint: str = "", module: str = ""
) -> None:
    """Raise MissingSoftware, with the way to install it, if a package is not installed.

    Raises
    ------
    MissingSoftware
    """
    if not is_installed(module or package):
        raise MissingSoftware(package, purpose, extra, hint)


@contextmanager
def optional(
    package: str, purpose: str, extra: str = "", *, hint: str = "", module: str = ""
) -> Iterator[None]:
    """Enclose the import of a package that need not be installed, or that may fail to load.

    Raises
    ------
    MissingSoftware
        If it cannot be imported; the message has the way to install it.
    """
    check_installed(package, purpose, extra, hint=hint, module=module)
    try:
        yield
    except ImportError as error:
        raise MissingSoftware(package, purpose, extra, hint) from error
