"""Defaults of the command line: poses, ellipsoid."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.errors import InvalidInput
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import norm
from gsp.model.design import Design

# Half the width of the box around the home poses: this share of the design's size, and this angle.
SPREAD, SPREAD_TURN = 1 / 6, np.deg2rad(10.0)


def neighbourhood(designs: Sequence[Design], order: str = "rpy") -> PoseBox:
    """Return the box around the home poses of designs from which `gsp rank` samples by default.

    It exceeds the home poses by a sixth of the rms radius of the first design (rounded to one
    digit) and by 10° on every side.

    Raises
    ------
    InvalidInput
        If none of the designs records a home pose.
    """
    homes = [design.home for design in designs if design.home is not None]
    if not homes:
        raise InvalidInput("--box: expected a box of poses, as no design records a pose in [home]")
    pose = Pose(np.stack([h.position for h in homes]), np.stack([h.rotation for h in homes]))
    reach = float(f"{designs[0].rms_radius * SPREAD:.0e}")
    return PoseBox.around(pose, [reach] * 3 + [SPREAD_TURN] * 3, order=order)


def anchor_spheroid(designs: Sequence[Design]) -> Ellipsoid:
    """Return a flat spheroid around the platform anchor points: semi-axes (r, r, r/2).

    r is the largest distance of a platform anchor point from the platform origin.
    """
    radius = max(float(norm(design.platform_points).max()) for design in designs)
    if radius == 0.0:
        raise InvalidInput("--ellipsoid: expected one, as all platform anchors are at the origin")
    return Ellipsoid((radius, radius, radius / 2.0))


def own_ellipsoid(design: Design) -> Ellipsoid | None:
    """Return the ellipsoid of a design, else the spheroid around its anchors, if it has a size."""
    if design.ellipsoid is None and design.platform_points.any():
        return anchor_spheroid([design])
    return design.ellipsoid
