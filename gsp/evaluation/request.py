"""A checked request: indices, designs, poses, and how they are computed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import Any

from gsp.arguments import flag
from gsp.checks import check_integer, check_type, plain_text
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.evaluation.backends import Check, check_backend
from gsp.evaluation.settings import Job, maximum_of_each, settings_of
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.indices import INDICES, index_names
from gsp.model.design import Design
from gsp.progress import Progress, check_progress

# A block is what one thread or process computes at once. Large blocks cost less per pose, as
# Python runs between them only, one thread at a time; many blocks fill all cores to the end, and an
# even number of equal ones fills two. The size depends on the poses and indices alone, so the
# result cannot depend on the workers.
POSES_PER_BLOCK, LEAST_POSES_PER_BLOCK = 32768, 8192
BLOCKS_PER_DESIGN = 32
# Slow indices take 30 to 60 µs per pose, and compiled ones less than one: a block of them ends
# soon, as progress and Ctrl-C wait for it.
SLOW_POSES_PER_BLOCK = 128
# Indices that "all" leaves out for designs with legs that are driven at the base: one needs bounds
# of the rows, the other a maximum of |det J|, which has no bound there.
NOT_OF_DRIVES = ("singularity_distance", "quality_index")


@dataclass(frozen=True, eq=False, kw_only=True)
class Request:
    """The checked arguments of `evaluate` or `rank`.

    Attributes
    ----------
    jobs : sequence of Job
        The designs, each with the settings of its indices.
    pose : Pose, batch shape (...)
    names : tuple of str
        Names of the indices.
    left_out : tuple of str
        Names of indices that are not defined for these designs, where all were asked for.
    sought : tuple of int
        Numbers of the jobs whose maximum of |det J| has to be searched first.
    singular : bool
        Whether singular poses are marked.
    checks : tuple of functions (design, pose) -> (n,) or (k, n) bool array
        Other conditions that are evaluated at each pose.
    backend, workers, executor, out, resume, progress : see `evaluate`
    """

    jobs: Sequence[Job]
    pose: Pose
    names: tuple[str, ...]
    left_out: tuple[str, ...] = ()
    sought: tuple[int, ...] = ()
    singular: bool = False
    checks: tuple[Check, ...] = ()
    backend: str = "compiled"
    workers: int | None = None
    executor: Executor | None = None
    out: str | PathLike[str] | None = None
    resume: bool = False
    progress: Progress = None

    @cached_property
    def cut(self) -> list[slice]:
        """The poses of each block, as slices of the flat batch."""
        return [slice(i, i + self.block) for i in range(0, self.pose.size, self.block)]

    @property
    def block(self) -> int:
        """Number of poses per block."""
        if any(INDICES[name].slow for name in self.names):
            return SLOW_POSES_PER_BLOCK
        size = self.pose.size
        even = min(size // LEAST_POSES_PER_BLOCK, BLOCKS_PER_DESIGN) // 2 * 2
        return -(-size // max(even, -(-size // POSES_PER_BLOCK)))

    @property
    def designs_at_once(self) -> int:
        """Number of designs that a thread or process computes at once where each is one block."""
        slow = any(INDICES[name].slow for name in self.names)
        return max(1, (SLOW_POSES_PER_BLOCK if slow else LEAST_POSES_PER_BLOCK) // self.pose.size)

    @property
    def steps(self) -> int:
        """Number of steps that progress counts: searches for maxima, then blocks."""
        return len(self.sought) + len(self.jobs) * len(self.cut)


def make_request(
    designs: Sequence[Design],
    pose: Pose,
    indices: Iterable[str] | str | None,
    *,
    length: float | None,
    ellipsoid: Ellipsoid | None,
    maximum: Any,
    progress: Progress = None,
    **how: Any,
) -> Request:
    """Return the checked request of `evaluate` or `rank`; the arguments are theirs."""
    check_designs(designs)
    check_type("pose", pose, Pose)
    if not pose.size:
        raise InvalidInput(expected("pose", "at least one pose", "an empty batch"))
    check_progress(progress)
    how["backend"] = check_backend(how["backend"])
    if how["workers"] is not None:
        check_integer("workers", how["workers"])
    if how["executor"] is not None:
        check_type("executor", how["executor"], Executor, "a concurrent.futures.Executor")
    jobs = [
        Job(design, settings_of(design, length, ellipsoid, most))
        for design, most in zip(designs, maximum_of_each(maximum, designs), strict=True)
    ]
    names, sought = choose_indices(indices, jobs)
    return Request(
        jobs=jobs,
        pose=pose,
        names=names,
        left_out=tuple(name for name in INDICES if name not in names) if _every(indices) else (),
        sought=sought,
        progress=progress,
        **how,
    )


def _every(indices: object) -> bool:
    """Whether indices are given as "all"."""
    given = indices[0] if isinstance(indices, list | tuple) and len(indices) == 1 else indices
    return isinstance(given := plain_text(given), str) and given.strip().casefold() == "all"


def left_out(request: Request) -> dict[str, list[str]]:
    """Return what a table records about the indices that "all" left out."""
    return {"left_out": list(request.left_out)} if request.left_out else {}


def check_resume(resume: object, *places: object) -> None:
    """Raise InvalidInput if a run is to be resumed and no place of its results is given."""
    if flag("resume", resume) and all(place is None for place in places):
        raise InvalidInput(expected("resume", "out=, where the interrupted run stored", "none"))


def check_designs(designs: Sequence[Any]) -> None:
    """Raise InvalidInput if there is no design, or something that is not a design."""
    if not designs:
        raise InvalidInput(expected("designs", "at least one design", "none"))
    for i, design in enumerate(designs):
        check_type("design" if len(designs) == 1 else f"designs[{i}]", design, Design)


def kind_of(design: Design) -> tuple[str, ...]:
    """Return what the units of indices and the parameters that they need depend on."""
    return (design.unit, *[leg.name for leg in design.legs])


def names_for(given: Iterable[str] | str, designs: Sequence[Design]) -> tuple[str, ...]:
    """Return the names of indices; "all" for those that designs of so many actuators have."""
    names = index_names(given)
    if not _every(given):
        return names
    numbers = {len(design.joint_names) for design in designs}
    defined = (None, *numbers) if len(numbers) == 1 else (None,)
    left_out = NOT_OF_DRIVES if any(design.driven for design in designs) else ()
    return tuple(
        name for name in names if INDICES[name].actuators in defined and name not in left_out
    )


def choose_indices(
    given: Iterable[str] | str | None, jobs: Sequence[Job]
) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return the names of the indices, and the numbers of jobs whose maximum is to be searched.

    Without names these are the routine indices whose parameters are given; for "all", those that
    are defined for the numbers of actuators. An index that is named needs its parameters, but for
    the maximum of |det J|, which can be searched.

    Raises
    ------
    InvalidInput, UnknownIndex, MissingParameter
    """
    if given is None:
        return tuple(
            name
            for name, index in INDICES.items()
            if index.routine and not any(index.missing(d, s.given()) for d, s in jobs)
        ), ()
    names = names_for(given, [job.design for job in jobs])
    wants = any("maximum" in INDICES[name].parameters for name in names)
    sought = [i for i, (_, settings) in enumerate(jobs) if wants and settings.maximum is None]
    kinds: dict[Any, Job] = {}
    for job in jobs:
        kinds.setdefault((kind_of(job.design), job.settings.given()), job)
    for name in names:
        index = INDICES[name]
        for design, settings in kinds.values():
            for need in index.missing(design, (*settings.given(), "maximum")):
                which = f" (design {brief(design.name)})" if design.name else ""
                raise MissingParameter(index.missing_message(need, design) + which)
    return names, tuple(sought)
