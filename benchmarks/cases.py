"""What is measured on: designs, poses, and what the indices are given."""

from __future__ import annotations

import numpy as np

import gsp
from gsp.catalogue import instantiate, mechanism, mechanisms

LENGTH = 95.0
ELLIPSOID = gsp.Ellipsoid([50.0, 40.0, 30.0], [3.0, 2.0, 10.0])
GIVEN = {"length": LENGTH, "ellipsoid": ELLIPSOID, "maximum": 1e6}
INDICES = (
    "condition_number",
    "condition_number_ellipsoid",
    "control_number",
    "quality_index",
    "minimum_singular_value",
)
TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
UPS = instantiate(mechanism("D1^6"), TEMPLATE)


def catalogue() -> list[gsp.Design]:
    return [instantiate(m, TEMPLATE) for m in mechanisms()]


def poses(n: int, seed: int = 1) -> gsp.Pose:
    rng = np.random.default_rng(seed)
    position = rng.uniform((-60, -60, 90), (60, 60, 190), size=(n, 3))
    return gsp.Pose.from_rpy(position, rng.uniform(-0.5, 0.5, size=(n, 3)))
