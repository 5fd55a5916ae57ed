"""Rays per second on the vertical plane of Workspace-3: `python -m benchmarks.workspace_rays`.

Three ways to the ends of the same rays, one after another in one process on one core:

- scipy's SLSQP, one ray at a time, each from the pose of the ray before (as the sweeps of the
  source do), with forward differences (as in its eq. (A.3));
- `gsp.workspace.boundary.rays.ray_ends`: all rays at once from the radiating point, solved and
  checked;
- `Section.on_rays`: rays on curves that are known already.
"""

from __future__ import annotations

import time

import numpy as np
from scipy.optimize import minimize

import gsp
from gsp.limits.bounds import bounded_quantities
from gsp.workspace.boundary.mapping import section
from gsp.workspace.boundary.rays import ray_ends

NAME = "workspace-6-3"
AXES = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
RAYS, FEW = 1000, 60


def main() -> None:
    design = gsp.catalogue.design(NAME)
    phi = np.deg2rad(np.linspace(100.0, 175.0, RAYS))
    slow, ends = slsqp(design, phi[:: RAYS // FEW])
    climbed(design, phi)  # loads the compiled code
    cold, found = climbed(design, phi)
    known = on_curves(design, phi)
    error = np.abs(found.distance[:: RAYS // FEW] - ends)
    print(f"SLSQP, warm, one by one   {slow:10.0f} rays/s")
    print(f"ray_ends, all at once     {cold:10.0f} rays/s  {cold / slow:6.1f} ×")
    print(f"on_rays, curves known     {known:10.0f} rays/s  {known / slow:6.1f} ×")
    print(
        f"local maxima {found.maximal.mean():.3f}; median difference of ends {np.median(error):.1e}"
    )


def slsqp(design: gsp.Design, phi: np.ndarray) -> tuple[float, np.ndarray]:
    """Rays per second, and distances."""
    base, platform = design.base_points, design.platform_points
    origin = design.home.position
    state, ends = np.zeros(4), []
    start = time.perf_counter()
    for angle in phi:
        direction = np.cos(angle) * AXES[0] + np.sin(angle) * AXES[1]

        def slack(q: np.ndarray, direction: np.ndarray = direction) -> np.ndarray:
            (sa, sb, sg), (ca, cb, cg) = np.sin(q[1:]), np.cos(q[1:])
            turn = np.array(
                [
                    [cb * cg + sa * sb * sg, sa * sb * cg - cb * sg, ca * sb],
                    [ca * sg, ca * cg, -sa],
                    [sa * cb * sg - sb * cg, sb * sg + sa * cb * cg, ca * cb],
                ]
            )
            gap = origin + q[0] * direction + platform @ turn.T - base
            length = np.sqrt((gap * gap).sum(axis=1))
            return np.concatenate((length - 8.0, 15.0 - length))

        result = minimize(
            lambda q: -q[0],
            state,
            method="SLSQP",
            options={"ftol": 1e-12, "maxiter": 200},
            constraints={"type": "ineq", "fun": slack},
        )
        state = result.x
        ends.append(result.x[0])
    return len(phi) / (time.perf_counter() - start), np.array(ends)


def climbed(design: gsp.Design, phi: np.ndarray):
    bounds = bounded_quantities(design)
    direction = np.cos(phi)[:, None] * AXES[0] + np.sin(phi)[:, None] * AXES[1]
    place = np.broadcast_to(design.home.position, (len(phi), 3))
    turn = np.broadcast_to(design.home.rotation, (len(phi), 3, 3))
    start = time.perf_counter()
    found = ray_ends(bounds, np.eye(3), place, turn, direction)
    return len(phi) / (time.perf_counter() - start), found


def on_curves(design: gsp.Design, phi: np.ndarray) -> float:
    mapped = section(design, axes=AXES, rays=phi[::200], starts=2, connecting=False)
    start = time.perf_counter()
    mapped.on_rays(phi)
    return len(phi) / (time.perf_counter() - start)


if __name__ == "__main__":
    main()
