"""Sets with proven inside and outside, by branch and prune over positions and rotations."""

from gsp.workspace.sets.questions import (
    dextrous,
    fixed_orientation,
    orientations,
    reachable,
)
from gsp.workspace.sets.region import Estimate, Region

__all__ = ["Estimate", "Region", "dextrous", "fixed_orientation", "orientations", "reachable"]
