"""Sets with proven inside and outside, by branch and prune over positions and rotations."""

from gsp.workspace.sets.questions import (
    dextrous,
    fixed_orientation,
    orientations,
    reachable,
)
from gsp.workspace.sets.region.regions import Region
from gsp.workspace.sets.region.sampling import Estimate

__all__ = ["Estimate", "Region", "dextrous", "fixed_orientation", "orientations", "reachable"]
