"""Connections to the store of known maxima: where it is, its engine, and its errors.

Where: the environment variable `GSP_STORE` (a path, a SQLAlchemy URL such as
"postgresql+psycopg://lab-server/gsp", or "off"), else `maxima.sqlite` in the user's data folder.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from gsp.errors import GspError, expected

if TYPE_CHECKING:
    import sqlalchemy as sa

ENVIRONMENT = "GSP_STORE"
WORDS_FOR_OFF = ("", "off", "none")


class StoreError(GspError, OSError):
    """The store of known maxima cannot be opened, read or written."""


class MissingStore(StoreError):
    """There is no store of known maxima, and it should not be made."""


class StoreWarning(UserWarning):
    """The store cannot be used; the computation continues without it."""


def location() -> str | None:
    """Return the location of the store as a SQLAlchemy URL, or None if it is switched off."""
    given = os.environ.get(ENVIRONMENT)
    if given is not None and given.strip().lower() in WORDS_FOR_OFF:
        return None
    if given is not None:
        return given if "://" in given else _address(Path(given).expanduser().absolute())
    import platformdirs

    return _address(Path(platformdirs.user_data_dir("gsp", appauthor=False)) / "maxima.sqlite")


def _address(file: Path) -> str:
    """Return the URL of a file; "%" and "?" in its path would start an escape and a query."""
    return "sqlite:///" + str(file).replace("%", "%25").replace("?", "%3F")


def _database(url: str) -> str:
    """Return what a URL names after its server, here the path of a file, without escapes."""
    return unquote(url.partition(":///")[2].partition("?")[0])


def require_file(url: str) -> None:
    """Raise MissingStore if a URL is that of a SQLite file that is not there.

    A connection would make it. It is known without SQLAlchemy, whose import takes longer than it
    takes to show a design.

    Raises
    ------
    MissingStore
    """
    file = _database(url)
    sqlite = url.lower().partition(":")[0].partition("+")[0] == "sqlite"
    if sqlite and file not in ("", ":memory:") and "?" not in url and not os.path.lexists(file):
        raise MissingStore(f"no file {file}; the first maximum found makes it")


def engine_of(sa: Any, url: str) -> sa.Engine:
    """Return an engine of SQLAlchemy; the folder of a file is made if needed."""
    made, options = sa.make_url(url), {"poolclass": sa.pool.NullPool}
    if made.get_backend_name() == "sqlite":
        if made.database in (None, "", ":memory:"):  # exists only while connected
            options["poolclass"] = sa.pool.StaticPool
        elif not made.query:
            # SQLAlchemy 2.0 leaves the escapes in, later versions do not.
            made = made.set(database=str(_folder_made(Path(_database(url)))))
        options["connect_args"] = {"timeout": 30.0}
    return sa.create_engine(made, **options)  # type: ignore[no-any-return]


def _folder_made(file: Path) -> Path:
    """Return the path of a file, whose folder is made if needed; an error for that of a folder."""
    if file.is_dir():
        wanted = 'the path of a file, an address such as "sqlite:///…", or "off"'
        raise OSError(expected(ENVIRONMENT, wanted, f"the folder {file}"))
    file.parent.mkdir(parents=True, exist_ok=True)
    return file


def without_password(url: str) -> str:
    """Return a URL without its password."""
    head, mark, tail = url.partition("://")
    secret = "@" in tail and not tail.startswith("/")  # without a server it is part of a path
    return f"{head}{mark}***@{tail.rpartition('@')[2]}" if secret else url


class Reported:
    """Converts errors of the database to a StoreError with the location and the reason."""

    def __init__(self, message: str) -> None:
        self.message = message

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: Any) -> None:
        import sqlalchemy.exc

        if isinstance(error, StoreError):
            return
        if isinstance(error, sqlalchemy.exc.SQLAlchemyError | OSError | ImportError):
            reason = str(getattr(error, "orig", None) or error).strip().splitlines()
            raise StoreError(f"{self.message}: {reason[0] if reason else kind}") from error
