"""The maxima of |det J| that are found where λ is asked for by name and no maximum is given."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

from gsp import determinant
from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.blocks import Job
from gsp.evaluation.settings import check_index


def listed(indices: Iterable[str] | None) -> Iterable[str] | None:
    """Return names of indices, known ones, so that they can be read twice."""
    if indices is None:
        return None
    if not isinstance(indices, Iterable):
        raise InvalidInput(expected("indices", "names of indices", brief(indices)))
    return tuple(map(check_index, (indices,) if isinstance(indices, str) else indices))


def with_maxima(
    jobs: Sequence[Job], indices: Iterable[str] | None, tell: Callable[[int, int], object]
) -> list[Job]:
    """Return the jobs, with maxima found by `gsp.determinant.maximum` where they are needed."""
    iterable = isinstance(indices, Iterable) and not isinstance(indices, str)
    named = tuple(indices) if iterable and indices is not None else (indices,)
    if "quality_index" not in named or all(s.maximum is not None for _, s in jobs):
        return list(jobs)
    result = []
    for done, (design, settings) in enumerate(jobs, 1):
        if settings.maximum is None:
            found = determinant.maximum(design)
            # A design that is singular in every pose has no λ: its maximum stays None.
            settings = replace(settings, maximum=found.value or None, found=found)
        result.append((design, settings))
        tell(done, len(jobs))
    return result


def facts(jobs: Sequence[Job]) -> dict[str, Any]:
    """Return what a table states about found maxima, by the names of the designs."""
    stated = {d.name: s.found.facts() for d, s in jobs if s.found is not None}
    return {"maxima": stated} if stated else {}
