"""Numbers of complex assembly modes: `python -m gsp.kinematics.modes.census` prints the table."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

import numpy as np

from gsp.catalogue import mechanisms
from gsp.files.knowledge import knowledge
from gsp.kinematics.modes.equations import Layout
from gsp.kinematics.modes.starts import TRACE_TOLERANCE, Start, completed, seeded, trace
from gsp.model.mechanism import Mechanism

COLUMNS = ("mechanism", "complex_modes", "method", "confidence")
# Seeds that are tried until the trace test is passed, and loops without a new solution before it.
CENSUS_SEEDS, CENSUS_QUIET_LOOPS = 3, (6, 12)


@cache
def _rows() -> list[dict[str, str]]:
    with knowledge("catalogue", "root_counts.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def root_counts() -> dict[str, int]:
    """Return the numbers of the table, by the names of the mechanisms."""
    return {row["mechanism"]: int(row["complex_modes"]) for row in _rows()}


@cache
def confirmed_counts() -> Mapping[str, int]:
    """Return the numbers of the table that its column of confidence doesn't call not confirmed."""
    confirmed = [row for row in _rows() if not row["confidence"].startswith("not confirmed")]
    return MappingProxyType({row["mechanism"]: int(row["complex_modes"]) for row in confirmed})


def counted(mechanism: Mechanism, seed: int = 1) -> tuple[Start, float, int]:
    """Return a system with all solutions, how far its trace is from linear, and the seed.

    A system that does not pass the trace test is left for that of the next seed.
    """
    layout = Layout.of([leg.name for leg in mechanism.legs])
    for tried in range(seed, seed + CENSUS_SEEDS):
        rng = np.random.default_rng(tried)
        start = seeded(layout, rng)
        for quiet in CENSUS_QUIET_LOOPS:
            start = completed(start, rng, quiet=quiet, patient=True)
            error = trace(start, rng)
            if layout.angular.sum() == 3:
                # The rotations are a finite number, which loops of distances do not exchange.
                error = max(error, trace(start, rng, angles=True))
            if error < TRACE_TOLERANCE:
                return start, error, tried
    return start, error, tried


def row_of(mechanism: Mechanism, seed: int = 1) -> dict[str, str]:
    """Return one row of the table."""
    start, error, used = counted(mechanism, seed)
    return {
        "mechanism": mechanism.name,
        "complex_modes": str(len(start.poses)),
        "method": f"monodromy, lost paths again, {start.loops} loops, seed {used}",
        "confidence": ("" if error < TRACE_TOLERANCE else "not confirmed: ")
        + f"trace test: {error:.0e}",
    }


def text_of(rows: list[dict[str, str]]) -> str:
    """Return the table as CSV."""
    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def table(seed: int = 1) -> list[dict[str, str]]:
    """Return the rows of all mechanisms, in the order of the catalogue.

    With base and platform exchanged the solutions are the inverse poses. So their number is found
    once for a mechanism and its exchanged one, for that which comes first.
    """
    rows: dict[str, dict[str, str]] = {}
    for mechanism in mechanisms():
        other = mechanism.exchanged().name
        if other in rows:
            number = rows[other]["complex_modes"]
            entries = (mechanism.name, number, f"inverse poses of {other}", f"as {other}")
            rows[mechanism.name] = dict(zip(COLUMNS, entries, strict=True))
        else:
            rows[mechanism.name] = row_of(mechanism, seed)
    return list(rows.values())


if __name__ == "__main__":
    print(text_of(table()), end="")
