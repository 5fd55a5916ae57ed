"""Maxima of |det J| that clients request: from the store, else one search in another process."""

from __future__ import annotations

import multiprocessing
import signal
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any

from gsp.determinant import Maximum, maximum
from gsp.determinant.canonical import canonical
from gsp.determinant.domain import check_domain
from gsp.determinant.maxima import known_maximum
from gsp.errors import GspError
from gsp.model.design import Design

# Searches that run at the same time; further ones wait.
MOST_SEARCHES = 2
# Searches that run or wait. More are refused.
MOST_WAITING = 32
WAITING, PROCESSING, KNOWN, FAILED, CANCELLED = (
    "waiting",
    "processing",
    "known",
    "failed",
    "cancelled",
)
# Seconds that a process gets to release its claim in the store.
GRACE = 5.0


class TooManySearches(GspError, RuntimeError):
    """More searches are waiting than the server takes."""


@dataclass(eq=False, kw_only=True)
class Search:
    """One search, which any number of clients wait for.

    Attributes
    ----------
    design : Design
    status : "waiting", "processing", "known", "failed" or "cancelled"
    done, total : int
        Progress; total is 0 before the first round.
    maximum : Maximum or None
    reason : str
        Why it failed.
    clients : set of str
        Who waits for it.
    """

    design: Design
    status: str = WAITING
    done: int = 0
    total: int = 0
    maximum: Maximum | None = None
    reason: str = ""
    clients: set[str] = field(default_factory=set)
    process: Any = None
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def running(self) -> bool:
        """Whether it waits or runs."""
        return self.status in (WAITING, PROCESSING)


class Searches:
    """The searches of a server, by the canonical form of the design: one for all clients.

    Parameters
    ----------
    most : int
        How many run at the same time.
    run : function (design, connection)
        What a process runs. It sends (done, total), a Maximum, or the text of an error.
    """

    def __init__(
        self, most: int = MOST_SEARCHES, run: Callable[[Design, Connection], None] | None = None
    ) -> None:
        self._run = search if run is None else run
        self._free = threading.BoundedSemaphore(most)
        self._lock = threading.Lock()
        self._all: dict[str, Search] = {}

    def ask(self, design: Design, client: str) -> Search:
        """Return the search of the maximum of a design; it is started if there is none.

        A maximum that is known, by closed form or from the store, is returned at once.

        Raises
        ------
        TooManySearches
        MissingParameter
            If the design needs a home pose for the domain of its maximum and has none.
        """
        found = known_maximum(design)
        if found is not None:
            return Search(design=design, status=KNOWN, maximum=found)
        key = canonical(design, check_domain(design, None)).key
        with self._lock:
            running = self._all.get(key)
            if running is None or not running.running:
                if sum(one.running for one in self._all.values()) >= MOST_WAITING:
                    raise TooManySearches(f"{MOST_WAITING} searches are waiting; try again later")
                self._all = {k: one for k, one in self._all.items() if one.running}
                running = self._all[key] = Search(design=design)
                threading.Thread(target=self._follow, args=(running,), daemon=True).start()
            running.clients.add(client)
        return running

    def leave(self, search: Search, client: str) -> None:
        """Remove a client from a search; a search without clients is stopped."""
        with self._lock:
            search.clients.discard(client)
            stopped = not search.clients and search.running
            if stopped:
                search.status = CANCELLED
            process = search.process
        if stopped and process is not None:
            process.terminate()

    def close(self) -> None:
        """Stop all searches."""
        for one in list(self._all.values()):
            for client in list(one.clients):
                self.leave(one, client)
            one.ended.wait(GRACE)

    def _follow(self, found: Search) -> None:
        """Run one search in another process, and note what it sends."""
        with self._free:
            context = multiprocessing.get_context("spawn")
            mine, other = context.Pipe(duplex=False)
            process = context.Process(target=self._run, args=(found.design, other), daemon=True)
            with self._lock:
                if found.running:
                    found.status, found.process = PROCESSING, process
                    process.start()
            other.close()
            if found.process is not None:
                self._receive(found, mine)
                process.join(GRACE)
            found.ended.set()

    def _receive(self, found: Search, mine: Connection) -> None:
        while found.status == PROCESSING:
            try:
                word = mine.recv()
            except (EOFError, OSError):
                if found.status == PROCESSING:
                    found.status, found.reason = FAILED, "the process of the search has ended"
                return
            if isinstance(word, tuple):
                found.done, found.total = word
            elif isinstance(word, Maximum):
                found.maximum, found.status = word, KNOWN
            else:
                found.status, found.reason = FAILED, str(word)


def search(design: Design, pipe: Connection) -> None:
    """Search the maximum of a design and send progress and result; the main function of a process.

    A stopped process releases its claim in the store, as `gsp.determinant.maximum` does on errors.
    """
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the server
    try:
        found = maximum(design, progress=lambda done, total: pipe.send((done, total)))
        pipe.send(found)
    except GspError as error:
        pipe.send(str(error))
    except BrokenPipeError:
        pass  # the server was killed; the claim in the store was released on the way
