"""What processes of the store's tests run: `python workers.py TASK …`, with GSP_STORE set."""

from __future__ import annotations

import sys
import time

import numpy as np

import gsp
from gsp.determinant import maxima, maximum, open_store
from gsp.families import lee


def find(delay: str) -> None:
    """Find one maximum, with a search that takes a while longer; print how it was found."""
    search = maxima.search

    def slow(*args: object) -> object:
        print("searching", flush=True)
        time.sleep(float(delay))
        return search(*args)

    maxima.search = slow
    found = maximum(lee.octahedral_3_3(1.0, 1.0))
    print(found.method, repr(found.value), flush=True)


def claim(key: str, seconds: str) -> None:
    """Claim a key for some seconds, print it, and wait until killed."""
    store = open_store()
    print(store.claim(key, float(seconds)), flush=True)
    time.sleep(600)


def value(seed: str) -> None:
    """Print how the maximum of a random design was found, its value, and its position."""
    rng = np.random.default_rng(int(seed))
    found = maximum(gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3))))
    place = repr(found.pose.position.tolist()).replace(" ", "")
    print(found.method, repr(found.value), place, flush=True)


def put(key: str, value: str) -> None:
    """Offer a value for a key many times."""
    store = open_store()
    for i in range(20):
        store.put({"key": key, "value": float(value) - 1e-3 * (19 - i)})


if __name__ == "__main__":
    {"find": find, "claim": claim, "put": put, "value": value}[sys.argv[1]](*sys.argv[2:])
