"""The store of known maxima: one SQL table, in a file of the user or in a shared database.

An entry is a maximum of a canonical design (see `gsp.determinant.canonical`), or the claim of a
process that is searching it. A claim expires, so that a killed process does not block others. A
value is replaced by a better one only, except one of an older method of searching
(`gsp.determinant.record.METHOD`), which counts as absent. SQLAlchemy is imported when a store is
opened.
"""

from __future__ import annotations

import os
import socket
import time
import uuid
import weakref
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from gsp import arguments
from gsp.checks import check_array
from gsp.determinant.record import METHOD
from gsp.determinant.store.connection import (
    MissingStore,
    Reported,
    StoreError,
    engine_of,
    location,
    require_file,
    without_password,
)
from gsp.determinant.store.schema import FIELDS, check_entry, table_of_maxima
from gsp.errors import InvalidInput, expected

if TYPE_CHECKING:
    import pandas as pd

# Seconds after which a claim that is not renewed expires.
CLAIM_SECONDS = 30.0
# Longest time of a claim [s]. One that expires later was written with a wrong clock.
LONGEST_CLAIM_SECONDS = 3600.0
# A better value is better by more than rounding.
LEAST_IMPROVEMENT = 1.0 + 1e-12


def _a_number(what: str, value: Any) -> float:
    """Return any number: damaged entries have infinite ones."""
    number = check_array(what, value, (), finite=False)
    if number.ndim:
        raise InvalidInput(expected(what, "one number", f"shape {number.shape}"))
    return float(number)


class Store:
    """A store of known maxima; every method raises StoreError if the database fails.

    Parameters
    ----------
    url : str
        SQLAlchemy URL.
    make : bool
        Whether the file, its folder and the table are made if they are not there.

    Raises
    ------
    MissingStore
        Without `make`, if there is no file or no table.
    StoreError
        If it cannot be opened; the message states its location and the reason.
    """

    @arguments.validated(url=arguments.text, make=arguments.flag)
    def __init__(self, url: str, *, make: bool = True) -> None:
        if not make:
            require_file(url)
        try:
            import sqlalchemy as sa
        except ImportError as error:
            raise StoreError(f"store {url}: expected the package sqlalchemy: {error}") from error
        self.sa = sa
        self.url = without_password(url)
        self.worker = f"{socket.gethostname()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
        self.table = table_of_maxima(sa)
        with self._reported("opened"):
            self.engine = engine_of(sa, url)
        # A store in memory has one connection, which is closed with it.
        weakref.finalize(self, self.engine.dispose)
        with self._reported("opened"):
            self._make_table(make)

    def _make_table(self, make: bool) -> None:
        """Make the table, or the columns that a table of an older version does not have.

        Another process may do the same at the same moment.
        """
        if not self.sa.inspect(self.engine).has_table(self.table.name):
            if not make:
                raise MissingStore(f"no table of maxima in {self.url}")
            statement = self.sa.schema.CreateTable(self.table, if_not_exists=True)
            with suppress(self.sa.exc.IntegrityError), self.engine.begin() as connection:
                connection.execute(statement)
            return
        there = {c["name"] for c in self.sa.inspect(self.engine).get_columns(self.table.name)}
        for column in self.table.columns:
            if column.name not in there:
                kind = column.type.compile(self.engine.dialect)
                self._add_column(f"{column.name} {kind}")

    def _add_column(self, text: str) -> None:
        name = self.table.name
        try:
            with self.engine.begin() as connection:
                connection.execute(self.sa.text(f"ALTER TABLE {name} ADD COLUMN {text}"))
        except self.sa.exc.DBAPIError:
            there = {c["name"] for c in self.sa.inspect(self.engine).get_columns(name)}
            if text.split()[0] not in there:
                raise

    def _reported(self, what: str) -> Reported:
        return Reported(f"store of maxima {self.url} cannot be {what}")

    def _insert(self) -> Any:
        """Return the INSERT of the database's dialect, which has ON CONFLICT."""
        name = self.engine.dialect.name
        if name == "sqlite":
            from sqlalchemy.dialects.sqlite import insert
        elif name == "postgresql":
            from sqlalchemy.dialects.postgresql import insert  # type: ignore[assignment]
        else:
            raise StoreError(expected(f"store {self.url}", "SQLite or PostgreSQL", name))
        return insert(self.table)

    @property
    def _outdated(self) -> Any:
        """Whether a row holds a value of an older method."""
        c = self.table.c
        return c.value.is_not(None) & (self.sa.func.coalesce(c.version, 1) < METHOD)

    @arguments.validated(key=arguments.text)
    def get(self, key: str) -> dict[str, Any] | None:
        """Return the entry of a key as it is stored, or None; one without a value is a claim.

        Values of an older method of searching are left out. `gsp.determinant.store.damage` returns
        what is wrong with an entry.

        Parameters
        ----------
        key : str
            Of a canonical form.

        Returns
        -------
        dict or None

        Raises
        ------
        InvalidInput
            If `key` is not a text.
        """
        wanted = self.table.select().where(self.table.c.key == key, ~self._outdated)
        with self._reported("read"), self.engine.connect() as connection:
            row = connection.execute(wanted).first()
        return None if row is None else dict(row._mapping)

    @arguments.validated(key=arguments.text, seconds=arguments.number)
    def claim(self, key: str, seconds: float = CLAIM_SECONDS) -> bool:
        """Claim a key for this process, and return whether it holds it; a claim may be renewed.

        Parameters
        ----------
        key : str
            Of a canonical form.
        seconds : float [s]
            After which the claim expires; at most an hour.

        Returns
        -------
        bool
            False if there is a value, or the claim of another process.

        Raises
        ------
        InvalidInput
            If `seconds` is not in [0, 3600].
        """
        c, now = self.table.c, time.time()
        empty = dict.fromkeys(FIELDS[1:])
        ours = {**empty, "worker": self.worker, "expires": now + seconds}
        if not 0.0 <= seconds <= LONGEST_CLAIM_SECONDS:
            wanted = f"a number in [0, {LONGEST_CLAIM_SECONDS:g}]"
            raise InvalidInput(expected("seconds", wanted, seconds))
        stale = (
            c.expires.is_(None)
            | (c.expires < now)
            | (c.expires > now + 2.0 * LONGEST_CLAIM_SECONDS)
        )
        free = (c.value.is_(None) & ((c.worker == self.worker) | stale)) | self._outdated
        with self._reported("written"), self.engine.begin() as connection:
            return self._changed(connection, {"key": key, **ours}, free)

    @arguments.validated(entry=arguments.mapping)
    def put(self, entry: Mapping[str, Any]) -> bool:
        """Store an entry unless there is one that is as good, and return whether it was stored.

        Parameters
        ----------
        entry : mapping from names of columns
            With "key" and "value" at least; see `gsp.determinant.store.entries`.

        Returns
        -------
        bool

        Raises
        ------
        InvalidInput
            On unknown columns, a key that is not a text, or a value that is not a number ≥ 0.
        """
        entry = check_entry(entry)
        c, values = self.table.c, {**entry, "worker": None, "expires": None}
        values.setdefault("version", METHOD)
        worse = c.value.is_(None) | (c.value * LEAST_IMPROVEMENT < entry["value"]) | self._outdated
        with self._reported("written"), self.engine.begin() as connection:
            return self._changed(connection, values, worse)

    def _changed(self, connection: Any, values: Mapping[str, Any], where: Any) -> bool:
        """Insert a row, or change that of its key where a condition holds, in one statement."""
        others = {name: value for name, value in values.items() if name != "key"}
        statement = self._insert().values(**values)
        upsert = statement.on_conflict_do_update(index_elements=["key"], set_=others, where=where)
        return connection.execute(upsert.returning(self.table.c.key)).first() is not None

    @arguments.validated(key=arguments.text)
    def release(self, key: str) -> None:
        """Release a claim of this process.

        Parameters
        ----------
        key : str
            Of a canonical form.

        Raises
        ------
        InvalidInput
            If `key` is not a text.
        """
        c = self.table.c
        mine = self.table.delete().where(c.key == key, c.value.is_(None), c.worker == self.worker)
        with self._reported("written"), self.engine.begin() as connection:
            connection.execute(mine)

    @arguments.validated(
        key=arguments.optional(arguments.text), value=arguments.optional(_a_number)
    )
    def remove(self, key: str | None = None, value: float | None = None) -> int:
        """Remove the entry of a key, or all entries.

        Parameters
        ----------
        key : str or None
            None stands for all.
        value : float or None [unit of |det J| for designs of size 1]
            If given, only an entry with this value is removed.

        Returns
        -------
        int
            How many there were.

        Raises
        ------
        InvalidInput
            If `key` is not a text, or `value` is not a number.
        """
        delete = self.table.delete()
        if key is not None:
            delete = delete.where(self.table.c.key == key)
        if value is not None:
            delete = delete.where(self.table.c.value == value)
        with self._reported("written"), self.engine.begin() as connection:
            return connection.execute(delete).rowcount

    def entries(self) -> pd.DataFrame:
        """Return a table of the stored maxima as they are stored, oldest first.

        Claims and values of an older method of searching are left out.
        `gsp.determinant.store.damage` returns what is wrong with a row.
        """
        import pandas as pd

        return pd.DataFrame(self.rows(), columns=list(FIELDS))

    def rows(self) -> list[dict[str, Any]]:
        """Return the stored maxima as `entries` does, one mapping from columns to values each."""
        c = self.table.c
        wanted = self.table.select().where(c.value.is_not(None), ~self._outdated)
        wanted = wanted.order_by(c.found, c.key)
        with self._reported("read"), self.engine.connect() as connection:
            return [dict(row._mapping) for row in connection.execute(wanted)]


@arguments.validated(make=arguments.flag)
def open_store(*, make: bool = True) -> Store | None:
    """Return the store of this user, or None if it is switched off.

    Parameters
    ----------
    make : bool
        Whether a store that is not there is made.

    Returns
    -------
    Store or None

    Raises
    ------
    MissingStore
        Without `make`, if it is not there.
    StoreError
    """
    url = location()
    return None if url is None else Store(url, make=make)
