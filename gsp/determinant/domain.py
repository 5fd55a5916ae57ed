"""Over which poses the maximum of |det J| is taken."""

from __future__ import annotations

from typing import Literal

import numpy as np

from gsp.determinant.bounds import upper_bound
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import cross, norm
from gsp.model.design import Design

# Half-width of the default box in every angle.
TURN_DEG = 30.0

# The sine between the lines of a D4 leg below which they count as parallel.
PARALLEL = 1e-5

Domain = PoseBox | Literal["all"] | None


class UnboundedDeterminant(InvalidInput):
    """|det J| grows without bound in the domain that its maximum was asked over."""


def needs_box(design: Design) -> bool:
    """Whether the maximum of a design is taken over a box: if it has D2 or D4 rows.

    With D4 rows, or with D2 and D3 rows, |det J| is unbounded over all poses. With D2 rows
    and neither of them it is bounded (see `gsp.determinant.upper_bound`), and `domain="all"` may
    be asked for.
    """
    return any(row.constraint.name in ("D2", "D4") for row in design.rows)


def default_box(design: Design) -> PoseBox:
    """Return the box that the maximum is taken over if none is given.

    Around the home pose of the design, or else around the pose with the centres of the anchors in
    one place and the axes parallel. Its half-widths are the longest stroke of the distance
    actuators, or else `design.size`, in each coordinate; and in each of roll, pitch, yaw 30°, or
    a sixth of the least angle between the lines of a D4 leg there if that is less, so that nowhere
    in the box they come nearer to parallel than half of that angle.

    Raises
    ------
    UnboundedDeterminant
        If the lines of a D4 leg are parallel at the centre of the box.
    """
    middle = design.home
    if middle is None:
        away = design.base_points.mean(axis=0) - design.platform_points.mean(axis=0)
        middle = Pose(away)
    turn = min(np.deg2rad(TURN_DEG), _least_angle(design, middle) / 6.0)
    if turn < PARALLEL:
        raise UnboundedDeterminant(
            expected("domain", "a gsp.PoseBox around poses where no D4 leg has parallel lines",
                     "none, and the lines of a D4 leg are parallel at the default centre")
        )  # fmt: skip
    return PoseBox.around(middle, np.repeat([_reach(design), turn], 3))


def _least_angle(design: Design, pose: Pose) -> float:
    """Least angle in [0, π/2] between the lines of a D4 leg; π/2 without D4 legs."""
    lines = design.at(pose).lines
    d4 = [row.leg for row in design.rows if row.constraint.name == "D4"]
    sines = norm(cross(lines.t[d4], lines.s[d4]))
    return float(np.arcsin(np.clip(sines, 0.0, 1.0)).min(initial=np.pi / 2))


def _reach(design: Design) -> float:
    if design.strokes is None:
        return design.size
    spans = (design.strokes[:, 1] - design.strokes[:, 0])[~design.angular]
    spans = spans[np.isfinite(spans) & (spans > 0.0)]
    return float(spans.max()) if spans.size else design.size


def check_domain(design: Design, domain: Domain) -> PoseBox | None:
    """Return the box to search, or None for all poses.

    Raises
    ------
    InvalidInput
        On anything but a PoseBox, "all" or None, on a box without width, and on "all" for a
        design whose |det J| has no bound.
    """
    if domain is None:
        return default_box(design) if needs_box(design) else None
    if isinstance(domain, str) and domain == "all":
        if not np.isfinite(upper_bound(design)):
            wanted = "a gsp.PoseBox, as |det J| is unbounded over all poses with these legs"
            raise InvalidInput(expected("domain", wanted, "'all'"))
        return None
    if not isinstance(domain, PoseBox):
        raise InvalidInput(expected("domain", 'a gsp.PoseBox, "all" or None', repr(domain)))
    if not (domain.high > domain.low).any():
        raise InvalidInput(expected("domain", "a box with some width", "a single pose"))
    return domain
