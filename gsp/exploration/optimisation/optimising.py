"""`optimise`: the best designs of a space for a task."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.evaluation.settings import Settings
from gsp.exploration.assessing import Run, checked, fingerprint, requested
from gsp.exploration.exploring import designs_of
from gsp.exploration.fronts import nondominated
from gsp.exploration.optimisation.climbing import climbed, why_not_climb
from gsp.exploration.optimisation.evaluating import Evaluator
from gsp.exploration.optimisation.failures import none_has_value, none_meets
from gsp.exploration.optimisation.goals import Goals, read_bounds
from gsp.exploration.optimisation.jobs import Job
from gsp.exploration.optimisation.populations import evolve, spread, unit_sample
from gsp.exploration.scores import ranks, score
from gsp.exploration.space import Space
from gsp.exploration.task import Task
from gsp.exploration.toml import record_of
from gsp.geometry.pose import PoseBox
from gsp.geometry.vectors import Array
from gsp.progress import Progress, meter
from gsp.proof.extremes import ENDS_TOLERANCE
from gsp.ranking.comparison import attributes

if TYPE_CHECKING:
    import pandas as pd

Method = Literal["gradient", "evolution", "front"]
# Designs from which climbs start, of each of which there may be a local maximum.
CLIMBS = 4
# Designs by which a search is recognised: functions of spaces may have the same name.
PROBED = 4


@arguments.validated(
    space=arguments.kind(Space, "a gsp.Space"),
    task=arguments.kind(Task, "a gsp.Task"),
    method=arguments.optional(arguments.one_of("gradient", "evolution", "front")),
    feasible=arguments.number,
    certify=arguments.flag,
    evaluations=arguments.integer(1),
    starts=arguments.integer(1),
    seed=arguments.integer(0),
)
def optimise(
    space: Space,
    task: Task,
    *,
    method: Method | None = None,
    require: Mapping[str, float] | None = None,
    feasible: float = 1.0,
    certify: bool = False,
    evaluations: int = 1000,
    starts: int = CLIMBS,
    seed: int = 0,
    tolerance: float = ENDS_TOLERANCE,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    parts: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Search the best design of a space for a task, or the designs of its Pareto front.

    Parameters
    ----------
    space : Space
    task : Task
        With one objective, its score: the weighted geometric mean of what is wanted. With "front"
        each wanted value is an objective, and weights do not count.
    method : "gradient", "evolution", "front" or None
        "gradient": sequential quadratic programming (SLSQP of scipy) with derivatives in closed
        form, from the best designs of a sample; no proven worst values, certificates, or limits
        other than strokes. "evolution": differential evolution of scipy, for everything, also
        choices; then a climb from its best design where there are derivatives. "front": NSGA-II of
        pymoo (extra `optimise`). None: "gradient" where it can be used, else "evolution".
    require : mapping from text to number [unit of the index], or None
        Bounds of values, such as {"worst CTN": 0.2, "proven worst CDN_CL": 8.0}: at least, or at
        most where lower is better.
    feasible : float [1]
        Least share of poses within the limits of the task, in [0, 1].
    certify : bool
        Whether every pose of the box has to be proven regular and within the limits, by
        `gsp.certify` with the same budget.
    evaluations : int
        Number of designs: of the sample in which climbs start, or of all generations, of which
        "evolution" and "front" have at least one of five designs.
    starts : int
        Number of climbs of "gradient".
    seed : int
    tolerance : float [1]
    budget : int or None
        See `gsp.exploration.assess`.
    workers, executor, out, parts, resume, progress : see `gsp.rank`
        What is stored are the evaluated designs: an interrupted search repeats its steps with them,
        and continues to the same bits.

    Returns
    -------
    pandas.DataFrame
        Designs that satisfy all bounds, have all values that are wanted, and that no other found
        design beats: the best one, or the front. Columns as of `gsp.exploration.explore`. `attrs`
        holds space, task, bounds, method, seed, version and the number of designs evaluated.
        Neither method proves that there is no better design.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or value, a method that the task does not allow, if no design
        that was found satisfies all bounds (the message has the nearest one, and what it misses),
        or if something that is wanted is undefined for all that do.
    UnknownIndex, MissingParameter
        On parameters that an index needs.
    MissingSoftware
        If `out` is given and pyarrow is not installed, or pymoo for "front".
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.

    Examples
    --------
    >>> import gsp
    >>> def octahedron(b, height):
    ...     return gsp.families.lee.octahedral_3_3(1.0, b).replace(home=None).scaled(1.0 / height)
    >>> space = gsp.Space(octahedron, {"b": (1.2, 4.0), "height": (0.5, 2.0)})
    >>> task = gsp.Task(poses=gsp.Pose([[0.0, 0.0, 1.0]]), wanted="mean LCI", length=1.0)
    >>> table = gsp.exploration.optimise(space, task, evaluations=20)
    >>> len(table)
    1
    """
    goals = Goals(
        task=task, bounds=read_bounds(require), feasible=_share(feasible), certify=certify
    )
    if certify and not isinstance(task.poses, PoseBox):
        got = type(task.poses).__name__
        raise InvalidInput(expected("task.poses", "a PoseBox, as certificates are of boxes", got))
    why_not = why_not_climb(space, goals)
    if method == "gradient" and why_not:
        raise InvalidInput(f"method='gradient': {why_not}; try method='evolution'")
    facts = {
        "space": space.record(),
        "method": method or ("evolution" if why_not else "gradient"),
        "require": {wish.column: bound for wish, bound in goals.bounds},
        "feasible": goals.feasible,
        "certify": certify,
        "evaluations": evaluations,
        "starts": starts,
        "seed": seed,
    }
    designs, _ = designs_of(space, space.sample(PROBED, seed=seed))
    probed, proofs = checked(designs, goals.watched, tolerance, budget)
    run = Run(workers=workers, executor=executor, out=out, parts=parts, resume=resume)
    request, _ = requested(probed, goals.watched, run, progress)
    job = Job(fingerprint(request, goals.watched, proofs, facts), run)
    with job.opened() as place, meter(progress, "designs") as report:
        if job.finished:
            return job.result()
        most = evaluations + starts
        evaluator = Evaluator(
            space, goals, proofs, run, place, lambda done: report(done, max(most, done))
        )
        search(evaluator, facts, climbs=not why_not)
        return job.written(best_designs(evaluator, facts))


def _share(value: float) -> float:
    if not 0.0 <= value <= 1.0:
        raise InvalidInput(expected("feasible", "a share in [0, 1]", value))
    return value


def search(evaluator: Evaluator, facts: dict[str, Any], *, climbs: bool) -> None:
    """Evaluate the designs of a search: see `optimise`."""
    dimension, seed, most = len(evaluator.space.names), facts["seed"], facts["evaluations"]
    if facts["method"] == "front":
        spread(evaluator, dimension, most, seed)
        return
    if facts["method"] == "evolution":
        evolve(evaluator, dimension, most, seed)
    else:
        evaluator.evaluate(unit_sample(dimension, most, seed))
    starts = facts["starts"] if facts["method"] == "gradient" else 1
    if climbs:
        for start in [evaluator.points[i] for i in order(evaluator)[:starts]]:
            found = evaluator.step(partial(_climb, evaluator, start))
            evaluator.evaluate(np.array([found["point"]]))


def _climb(evaluator: Evaluator, start: Array) -> dict[str, Any]:
    return {"point": climbed(evaluator, start).tolist()}


def order(evaluator: Evaluator) -> list[int]:
    """Return the numbers of the evaluated designs, best first; violations come last."""
    goals = evaluator.goals
    keys = [
        (goals.violation(row), -float(goals.shares @ goals.merits(row))) for row in evaluator.rows
    ]
    return sorted(range(len(keys)), key=keys.__getitem__)


def best_designs(evaluator: Evaluator, facts: dict[str, Any]) -> pd.DataFrame:
    """Return the designs that satisfy all bounds, have values, and that no other one beats.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    import pandas as pd

    goals, rows, ranking = evaluator.goals, evaluator.rows, order(evaluator)
    accepted = [i for i in ranking if goals.violation(rows[i]) == 0.0]
    if not accepted:
        raise InvalidInput(none_meets(evaluator, ranking[0]))
    accepted = [i for i in accepted if not goals.without_value(rows[i])]
    if not accepted:
        raise InvalidInput(none_has_value(evaluator))
    if facts["method"] == "front":
        merits = np.array([goals.merits(rows[i]) for i in accepted])
        chosen = [i for i, kept in zip(accepted, nondominated(merits), strict=True) if kept]
    else:
        chosen = accepted[:1]
    frame = pd.DataFrame([rows[i] for i in chosen])
    names = list(evaluator.space.names)
    frame = frame[[*names, *(column for column in frame if column not in (*names, "error"))]]
    frame.insert(len(names), "score", score(frame, goals.task))
    frame.insert(len(names), "rank", ranks(frame))
    designs = [evaluator.space.design(**{name: rows[i][name] for name in names}) for i in chosen]
    request, _ = requested(designs, goals.watched, evaluator.run._replace(resume=False), False)
    given = Settings(goals.task.length, goals.task.ellipsoid)
    frame.attrs.update(
        attributes(request, "score", designs, given),
        task=record_of(goals.task),
        evaluated=len(rows),
        **facts,
    )
    return frame
