"""Maxima for clients: from the store, else one search for all of them, in another process."""

from __future__ import annotations

import time

import numpy as np
import pytest

import gsp
from gsp.app import searches
from gsp.determinant.maxima import known_maximum


def slow(design, pipe):
    """A search that reports once and continues."""
    pipe.send((1, 12))
    time.sleep(60.0)


def failing(design, pipe):
    """A search that ends with an error."""
    pipe.send("no maximum")


def until(condition, seconds=30.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.005)
    assert condition()


def some_hexapod(angle):
    return gsp.hexapod(2.0, angle, 1.1, 0.3, 1.5)


def test_a_closed_form_needs_no_process():
    design = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    found = searches.Searches().ask(design, "one")
    assert found.status == searches.KNOWN
    assert found.maximum.value == pytest.approx(0.75 * 3**0.5, rel=1e-12)


def test_known_maxima_are_those_of_the_library():
    """Nothing is known before the search; after it the value and the pose are the same."""
    design = some_hexapod(0.31)
    assert known_maximum(design) is None
    found = gsp.determinant.maximum(some_hexapod(0.31), progress=False)
    again = known_maximum(some_hexapod(0.31))
    assert again.value == found.value
    assert (again.pose.position == found.pose.position).all()
    assert known_maximum(design.scaled(2.0)).value == pytest.approx(8.0 * found.value, rel=1e-12)


def test_clients_share_one_search_and_the_last_one_stops_it():
    """Two designs of the same form, one of them shifted and in another unit."""
    design = some_hexapod(0.32)
    same = design.scaled(3.0).with_origin([0.1, 0.2, 0.0])
    asked = searches.Searches(run=slow)
    first, second = asked.ask(design, "one"), asked.ask(same, "two")
    assert first is second
    until(lambda: first.done == 1)
    assert (first.status, first.total) == (searches.PROCESSING, 12)
    asked.leave(first, "one")
    assert first.status == searches.PROCESSING
    asked.leave(first, "two")
    assert first.ended.wait(20.0)
    assert (first.status, first.process.is_alive()) == (searches.CANCELLED, False)
    assert asked.ask(design, "one") is not first
    asked.close()


def test_errors_of_a_search_are_noted():
    found = searches.Searches(run=failing).ask(some_hexapod(0.33), "one")
    assert found.ended.wait(30.0)
    assert (found.status, found.reason) == (searches.FAILED, "no maximum")


def test_the_number_of_waiting_searches_is_limited(monkeypatch):
    monkeypatch.setattr(searches, "MOST_WAITING", 1)
    asked = searches.Searches(run=slow)
    asked.ask(some_hexapod(0.34), "one")
    with pytest.raises(searches.TooManySearches, match="try again later"):
        asked.ask(some_hexapod(0.35), "two")
    asked.close()


def test_the_process_itself_sends_progress_and_the_maximum():
    """Called here: `search` is the main function of the process."""

    class Pipe:
        def __init__(self):
            self.words = []

        def send(self, word):
            self.words.append(word)

    import signal

    before = [signal.getsignal(s) for s in (signal.SIGTERM, signal.SIGINT)]
    pipe, design = Pipe(), some_hexapod(0.36)
    try:
        searches.search(design, pipe)
    finally:
        signal.signal(signal.SIGTERM, before[0])
        signal.signal(signal.SIGINT, before[1])
    found = pipe.words[-1]
    value = abs(np.linalg.det(design.at(found.pose).jacobian))
    assert found.value == pytest.approx(value, rel=1e-9)
