"""The maxima of |det J| that are searched where λ is asked for by name and none is given."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from gsp import determinant
from gsp.evaluation.request import Request
from gsp.evaluation.settings import Job


def with_maxima(request: Request, report: Callable[[int, int], object]) -> Request:
    """Return the request with the maxima that `gsp.determinant.maximum` finds.

    Parameters
    ----------
    request : Request
    report : function (done, total)
        Called after each search.
    """
    jobs = list(request.jobs)
    for done, number in enumerate(request.sought, 1):
        design, settings = jobs[number]
        found = determinant.maximum(design)
        # A design that is singular in every pose has no λ: its maximum stays None.
        jobs[number] = Job(design, replace(settings, maximum=found.value or None, found=found))
        report(done, request.steps)
    return replace(request, jobs=jobs)


def facts(jobs: Sequence[Job]) -> dict[str, Any]:
    """Return what a table records about maxima that were searched, by the names of the designs."""
    stated = {job.design.name: job.settings.found.facts() for job in jobs if job.settings.found}
    return {"maxima": stated} if stated else {}
