"""Compile what the tests use into the cache of numba: `python -m tests.compile [PART ...]`.

`make test` runs the parts beside each other and beside the type checks, which need one core only.
Without it each process of the tests compiles the same functions when a test needs them.
"""

from __future__ import annotations

import sys
from importlib import import_module

import numpy as np

import gsp

# Modules whose functions have stated signatures: they are compiled at import.
KERNELS = (
    "gsp.kernels.compiled.ascent", "gsp.kernels.compiled.evaluation",
    "gsp.kernels.compiled.inverse", "gsp.kinematics.newton.compiled",
    "gsp.kinematics.newton.tracking", "gsp.kinematics.modes.tracking",
)  # fmt: skip
NO_TURN = gsp.PoseBox([0, 0, 0], [0, 0, 0])
RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])


def proofs() -> None:
    """Compile bounds over boxes of poses, and over all poses."""
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    box = gsp.PoseBox.around(design.home, [5, 5, 5, 0.05, 0.05, 0.05])
    gsp.certify(design, box)
    gsp.bounds(design, box, "CDN_CL", 1.0, length=100.0, budget=8)
    gsp.indices.singularity_distance(design.at(design.home), 100.0)
    gsp.certify_maximum(gsp.families.lee.octahedral_3_3(1.0, 1.2), budget=8)


def workspaces() -> None:
    """Compile kernels, forward kinematics, assembly modes and sets of positions."""
    from gsp.workspace import dextrous, fixed_orientation, reachable

    for name in KERNELS:
        import_module(name)
    equal = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    few = {"resolution": 1.0, "budget": 64}
    assert fixed_orientation(equal, limits=gsp.Limits(leg_radius=0.01), **few).parts
    reachable(equal, **few)
    reachable(equal, rotations=NO_TURN, **few)
    dextrous(equal, NO_TURN, **few)


PARTS = {"proofs": proofs, "workspaces": workspaces}

if __name__ == "__main__":
    for part in sys.argv[1:] or PARTS:
        PARTS[part]()
