"""Indices at poses that are drawn from a region: their means, extremes and shares."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.evaluation.evaluations import evaluate
from gsp.evaluation.request import names_for
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.limits import Limits
from gsp.progress import Progress, during
from gsp.proof.branching.requirements import with_maximum
from gsp.workspace.sets.inside.poses import poses
from gsp.workspace.sets.inside.summaries import index_summary, overall_values, satisfied
from gsp.workspace.sets.region.sampling import Estimate, share_error

if TYPE_CHECKING:
    import pandas as pd

    from gsp.workspace.sets.region.regions import Region


@dataclass(frozen=True, eq=False, kw_only=True)
class IndexSample(ReadOnly):
    """Indices at poses that are drawn evenly from a region; see `Region.index_sample`.

    Attributes
    ----------
    region : Region
    pose : Pose of shape (n,)
        Independent poses of the region.
    values : mapping from index name to (n,) array [unit of the index]
        NaN where the index is not defined.
    """

    region: Region
    pose: Pose
    values: Mapping[str, Array]

    def summary(self) -> pd.DataFrame:
        """Return one row per index, over the poses where it is defined.

        The columns of `IndexMap.summary`, and mean_error and global_error: the standard errors of
        mean and global. Extremes are those of the poses that were drawn; `Region.worst` proves a
        bound. An index without a bound, such as the condition number, need not have a finite mean
        over a region with singular poses; then the error of the mean states nothing. Its global
        index is a mean of numbers from 0 to 1 and does.

        *Source: as of `IndexMap.summary`; the errors are those of independent poses.*
        """
        import pandas as pd

        n = self.pose.size
        rows = {}
        for name, values in self.values.items():
            row = index_summary(name, values, np.full(n, 1.0 / n))
            row["mean_error"] = _error(values)
            row["global_error"] = _error(overall_values(name, values))
            rows[name] = row
        return pd.DataFrame.from_dict(rows, orient="index")

    def share_where(self, bound: str) -> Estimate:
        """Return the share of the poses of the region where an index satisfies a bound [1].

        Poses where the index is undefined do not satisfy it.

        Parameters
        ----------
        bound : str
            An index of the sample, by name or symbol, and a bound: "λ >= 0.3", "CDN_CL <= 20".

        Returns
        -------
        Estimate [1]
            The share from 0 to 1, and its standard error, which is not 0 if all poses agree.

        Raises
        ------
        InvalidInput
            On another text, or an index that the sample does not have.
        UnknownIndex
            If the text names no index.

        *Source: ours*
        """
        hits = satisfied(self.values, bound).astype(float)
        return Estimate(float(hits.mean()), share_error(hits), len(hits))

    def to_dataframe(self, order: str = "rpy") -> pd.DataFrame:
        """Return one row per pose: x, y, z, three angles in degrees, and the indices.

        Parameters
        ----------
        order : str
            The angle set: see `gsp.geometry.rotation_from_angles`.

        Returns
        -------
        pandas.DataFrame
            Columns x, y, z [unit of the design], angle_1, angle_2, angle_3 [degrees], and one per
            index [unit of the index].

        Raises
        ------
        InvalidInput
            On an unknown order.
        """
        import pandas as pd

        angles = self.pose.angles(order, degrees=True)
        columns = np.concatenate((self.pose.position, angles), axis=1).T
        return pd.DataFrame({**dict(zip(POSE_COLUMNS, columns, strict=True)), **self.values})


def index_sample(
    region: Any,
    indices: Iterable[str] | str | None,
    count: int,
    given: Mapping[str, Any],
    rng: np.random.Generator | int,
    progress: Progress,
) -> IndexSample:
    """Return indices at poses of a region: see `gsp.workspace.Region.index_sample`."""
    design, chosen = region.problem.design, indices
    maximum = given["maximum"]
    if indices is not None:
        chosen = names_for(indices, [design])
        if any(INDICES[name].share_of for name in chosen):
            # The maximum by which `worst` and bounds of λ are measured.
            of_share = Limits(indices="quality_index >= 0", maximum=maximum)
            maximum = with_maximum(design, of_share).maximum
    with during("poses of the region"):
        drawn = poses(region, count, rng)
    given = {**given, "maximum": maximum}
    table = evaluate(design, drawn, chosen, progress=progress, **given)
    values = {str(name): table[name].to_numpy(copy=True) for name in table.columns}
    return IndexSample(region=region, pose=drawn, values=values)


def _error(values: Array) -> float:
    """Return the standard error of a mean of independent values, NaN left out."""
    known = values[~np.isnan(values)]
    if len(known) < 2:
        return float("nan")
    if not np.isfinite(known).all():
        return float("inf")
    return float(known.std(ddof=1) / np.sqrt(len(known)))
