"""The maxima of |det J| that are searched where λ is requested by name and none is given."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from gsp import determinant
from gsp.evaluation.request import Request
from gsp.evaluation.settings import Job
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices.table import MAXIMUM_SHARES


def with_maxima(request: Request, report: Callable[[int, int], object]) -> Request:
    """Return the request with the maxima that `gsp.determinant.reference` finds.

    Parameters
    ----------
    request : Request
    report : function (done, total)
        Called after each search.
    """
    jobs = list(request.jobs)
    for done, number in enumerate(request.sought, 1):
        design, settings = jobs[number]
        found = determinant.reference(design, progress=False)
        # A design that is singular in every pose has no λ: its maximum stays None.
        jobs[number] = Job(design, replace(settings, maximum=found.value or None, found=found))
        report(done, request.steps)
    return replace(request, jobs=jobs)


def mended(job: Job, pose: Pose, names: Sequence[str], columns: Array) -> Job:
    """Return a job with a better maximum if λ exceeds 1, and correct the column of λ in place.

    Parameters
    ----------
    job : Job
    pose : Pose, batch shape (...)
        n poses.
    names : sequence of str
        Names of the indices.
    columns : (n_names, n) array

    Returns
    -------
    Job
        The same one if no λ exceeds 1 within the domain of a maximum that was searched; see
        `gsp.determinant.mended`.
    """
    found = job.settings.found
    shares = [i for i, name in enumerate(names) if name in MAXIMUM_SHARES]
    if found is None or not found.value or not shares:
        return job
    better = determinant.mended(found, job.design, pose.reshape(pose.size), columns[shares[0]])
    if better is found:
        return job
    columns[shares] *= found.value / better.value
    return Job(job.design, replace(job.settings, maximum=better.value, found=better))


def facts(jobs: Sequence[Job], pose: Pose) -> dict[str, Any]:
    """Return what a table records about maxima that were searched, by the names of the designs.

    Among it, in "outside", the number of poses that the domain of the maximum does not hold: λ
    may exceed 1 there.
    """
    stated = {
        job.design.name: {
            **job.settings.found.facts(),
            "outside": determinant.outside(job.settings.found, pose),
        }
        for job in jobs
        if job.settings.found
    }
    return {"maxima": stated} if stated else {}
