"""The store of known maxima: one SQL table, in a file of the user or in a shared database.

Where: the environment variable `GSP_STORE` (a path, a SQLAlchemy URL such as
"postgresql+psycopg://lab-server/gsp", or "off"), else `maxima.sqlite` in the user's data folder.

An entry is a maximum of a canonical design (see `gsp.determinant.canonical`), or the claim of a
process that is searching it. A claim expires, so that a killed process blocks nobody for long. A
value only ever gives way to a better one. SQLAlchemy is imported when a store is opened.
"""

from __future__ import annotations

import json
import os
import socket
import time
import uuid
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gsp.determinant.canonical import Canonical
from gsp.determinant.record import Maximum
from gsp.errors import GspError
from gsp.geometry.matrices import absolute_determinant
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd
    import sqlalchemy as sa

ENVIRONMENT = "GSP_STORE"
OFF = ("", "off", "none")
# Seconds after which the claim of a silent process is free again.
CLAIM = 30.0
# A better value is better by more than rounding.
BETTER = 1.0 + 1e-12

NUMBERS = ("value", "evaluations", "seed", "starts", "agreed", "summits", "converged")
FIELDS = ("key", *NUMBERS, "position", "rotation", "design", "domain", "library", "found")


class StoreError(GspError, OSError):
    """The store of known maxima cannot be opened, read or written."""


class StoreWarning(UserWarning):
    """The store cannot be used; computing goes on without it."""


def location() -> str | None:
    """Return where the store is, as a SQLAlchemy URL, or None if it is switched off."""
    given = os.environ.get(ENVIRONMENT)
    if given is not None and given.strip().lower() in OFF:
        return None
    if given is not None:
        return given if "://" in given else f"sqlite:///{Path(given).expanduser().absolute()}"
    import platformdirs

    return f"sqlite:///{Path(platformdirs.user_data_dir('gsp', appauthor=False)) / 'maxima.sqlite'}"


class Store:
    """A store of known maxima; every method raises StoreError if the database fails.

    Parameters
    ----------
    url : str
        SQLAlchemy URL. The file, its folder and the table are made if they are not there.

    Raises
    ------
    StoreError
        If it cannot be opened; the message says where it is and why.
    """

    def __init__(self, url: str) -> None:
        try:
            import sqlalchemy as sa
        except ImportError as error:
            raise StoreError(f"store {url}: expected the package sqlalchemy: {error}") from error
        self.sa = sa
        self.url = _hidden(url)
        self.worker = f"{socket.gethostname()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
        self.table = _table(sa)
        with self._told("opened"):
            self.engine = _engine(sa, url)
        with suppress(_Taken), self._told("opened"):
            self._make_table()

    def _make_table(self) -> None:
        """Make the table unless it is there; another process may make it at the same moment."""
        if self.sa.inspect(self.engine).has_table(self.table.name):
            return
        with self.engine.begin() as connection:
            connection.execute(self.sa.schema.CreateTable(self.table, if_not_exists=True))

    def _told(self, what: str) -> _Told:
        return _Told(f"store of maxima {self.url} cannot be {what}")

    def get(self, key: str) -> dict[str, Any] | None:
        """Return the entry of a key, or None; an entry without a value is a claim."""
        with self._told("read"), self.engine.connect() as connection:
            row = connection.execute(self.table.select().where(self.table.c.key == key)).first()
        return None if row is None else dict(row._mapping)

    def claim(self, key: str, seconds: float = CLAIM) -> bool:
        """Claim a key for this process, and say whether it is ours; a claim may be renewed."""
        c, now = self.table.c, time.time()
        free = (c.worker == self.worker) | (c.expires < now)
        ours = {"worker": self.worker, "expires": now + seconds}
        try:
            with self._told("written"), self.engine.begin() as connection:
                update = self.table.update().where(c.key == key, c.value.is_(None), free)
                if connection.execute(update.values(**ours)).rowcount:
                    return True
                known = connection.execute(self.table.select().where(c.key == key)).first()
                if known is not None:
                    return False
                connection.execute(self.table.insert().values(key=key, **ours))
        except _Taken:
            return False
        return True

    def release(self, key: str) -> None:
        """Give up a claim of this process."""
        c = self.table.c
        mine = self.table.delete().where(c.key == key, c.value.is_(None), c.worker == self.worker)
        with self._told("written"), self.engine.begin() as connection:
            connection.execute(mine)

    def put(self, entry: Mapping[str, Any]) -> bool:
        """Store an entry unless there is one that is as good, and say whether it was stored."""
        c, values = self.table.c, {**entry, "worker": None, "expires": None}
        worse = c.value.is_(None) | (c.value * BETTER < entry["value"])
        update = self.table.update().where(c.key == entry["key"], worse).values(**values)
        for _ in range(2):
            try:
                with self._told("written"), self.engine.begin() as connection:
                    if connection.execute(update).rowcount:
                        return True
                    here = self.table.select().where(c.key == entry["key"])
                    if connection.execute(here).first() is not None:
                        return False
                    connection.execute(self.table.insert().values(**values))
                return True
            except _Taken:
                continue
        return False

    def remove(self, key: str | None = None) -> int:
        """Remove the entry of a key, or all entries, and return how many there were."""
        delete = self.table.delete()
        with self._told("written"), self.engine.begin() as connection:
            return connection.execute(
                delete if key is None else delete.where(self.table.c.key == key)
            ).rowcount

    def entries(self) -> pd.DataFrame:
        """Return a table of the stored maxima, claims left out, oldest first."""
        import pandas as pd

        c = self.table.c
        wanted = self.table.select().where(c.value.is_not(None)).order_by(c.found, c.key)
        with self._told("read"), self.engine.connect() as connection:
            rows = [dict(row._mapping) for row in connection.execute(wanted)]
        return pd.DataFrame(rows, columns=list(FIELDS))


def open_store() -> Store | None:
    """Return the store of this user, or None if it is switched off.

    Raises
    ------
    StoreError
    """
    url = location()
    return None if url is None else Store(url)


def entry_of(maximum: Maximum, form: Canonical) -> dict[str, Any]:
    """Return a maximum as an entry of the store; its value is that of the canonical design."""
    inner, value = None, 0.0
    if maximum.pose is not None:
        inner = form.inward(maximum.pose)
        value = float(absolute_determinant(form.design.at(inner).jacobian))
    return {
        "key": form.key,
        "value": value,
        "position": None if inner is None else json.dumps(inner.position.tolist()),
        "rotation": None if inner is None else json.dumps(inner.rotation.tolist()),
        "evaluations": maximum.evaluations,
        "seed": maximum.seed,
        "starts": maximum.starts,
        "agreed": maximum.agreed,
        "summits": maximum.summits,
        "converged": int(maximum.converged),
        "design": json.dumps({"legs": form.legs, "rows": form.rows}),
        "domain": None if form.domain is None else json.dumps(form.domain),
        "library": f"gsp {__version__}",
        "found": time.time(),
    }


def _table(sa: Any) -> sa.Table:
    text, number, whole = sa.Text, sa.Double, sa.BigInteger
    return sa.Table(  # type: ignore[no-any-return]
        "gsp_maxima",
        sa.MetaData(),
        sa.Column("key", sa.String(64), primary_key=True),
        sa.Column("value", number),
        sa.Column("worker", text),
        sa.Column("expires", number),
        *(sa.Column(name, whole) for name in NUMBERS[1:]),
        *(sa.Column(name, text) for name in FIELDS[8:-1]),
        sa.Column("found", number),
    )


def _engine(sa: Any, url: str) -> sa.Engine:
    made, options = sa.make_url(url), {"poolclass": sa.pool.NullPool}
    if made.get_backend_name() == "sqlite":
        if made.database and not made.query and made.database != ":memory:":
            Path(made.database).parent.mkdir(parents=True, exist_ok=True)
        options["connect_args"] = {"timeout": 30.0}
    return sa.create_engine(url, **options)  # type: ignore[no-any-return]


def _hidden(url: str) -> str:
    """Return a URL without its password."""
    head, mark, tail = url.partition("://")
    return f"{head}{mark}***@{tail.rpartition('@')[2]}" if "@" in tail else url


class _Taken(Exception):
    """Another process was faster."""


class _Told:
    """Turns errors of the database into one StoreError that says where and why."""

    def __init__(self, message: str) -> None:
        self.message = message

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: Any) -> None:
        import sqlalchemy.exc

        if isinstance(error, sqlalchemy.exc.IntegrityError):
            raise _Taken from error
        if isinstance(error, sqlalchemy.exc.SQLAlchemyError | OSError | ImportError):
            reason = str(getattr(error, "orig", None) or error).strip().splitlines()
            raise StoreError(f"{self.message}: {reason[0] if reason else kind}") from error
