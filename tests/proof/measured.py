"""All bounded quantities of a design, by the library and as bounds over a box."""

from __future__ import annotations

import numpy as np

import gsp
from gsp.limits.bounds import bounded_quantities
from gsp.limits.legs import leg_pairs
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, boxes_of, problem_of
from tests.support import turn

LENGTH = 0.8
OBJECT = gsp.Ellipsoid([0.3, 0.5, 0.9], [0.1, -0.2, 0.3], turn([0.3, -0.4, 0.2]))
CORNERS = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 6, indexing="ij"), axis=-1).reshape(-1, 6)


def commensurable(design):
    """Whether |det J| has a unit."""
    return len(design.joint_names) == 6 or not design.angular.any()


def limits(design):
    n = len(design.joint_names)
    axes = np.tile([0.0, 0.0, 1.0], (design.n_legs, 1))
    indices = ["CDN_CL <= 1e9", "σ_min >= 0", "CDN_OE <= 1e9", "CTN >= 0"]
    if commensurable(design):
        indices.append("|det J| >= 0")
    return gsp.Limits(
        strokes=np.tile((0.0, 100.0), (n, 1)),
        base_cone=1.5,
        platform_cone=1.5,
        base_axes=axes,
        platform_axes=axes,
        length=LENGTH,
        indices=indices,
        ellipsoid=OBJECT,
        leg_radius=0.01,
    )


def random_box(rng, size, order="rpy"):
    middle = np.concatenate((rng.uniform(-0.3, 0.3, 3) + [0.0, 0.0, 1.5], rng.uniform(-1, 1, 3)))
    half = size * rng.random(6) * (rng.random(6) < 0.9)  # some coordinates are fixed
    pairs = np.stack((middle - half, middle + half), axis=1)
    return gsp.PoseBox(pairs[:3].tolist(), pairs[3:].tolist(), order=order)


def measured(design, pose):
    """All quantities by the library: joints, cosines of cones, σ_min, condition number."""
    posture = design.at(pose)
    joints = np.where(posture.angular, np.cos(posture.joints), posture.joints)
    values = bounded_quantities(design, limits(design), crossed=True)
    every = values.quantities.values(pose.position, pose.rotation)
    n, legs = len(design.joint_names), design.n_legs
    cones = np.cos(every[..., n : n + 2 * legs].reshape(*pose.shape, 2, legs))
    sigma = posture.singular_values(LENGTH)
    with np.errstate(divide="ignore"):  # designs with four A1 rows are singular: σ_min may be 0
        condition = sigma[..., 0] / sigma[..., -1]
    indices = (
        sigma[..., -1],
        condition,
        # The unit is put back with the length.
        gsp.indices.manipulability(posture, LENGTH) * LENGTH ** (3 - design.angular.sum()),
        gsp.indices.condition_number_ellipsoid(posture, OBJECT, LENGTH),
        gsp.indices.control_number(posture, LENGTH),
    )
    by_leg = np.swapaxes(cones, -1, -2).reshape(*pose.shape, 2 * legs)
    gaps = every[..., n + 2 * legs : n + 2 * legs + len(leg_pairs(design))]
    return np.concatenate(
        (joints, pose.position, by_leg, np.stack(indices, axis=-1), gaps), axis=-1
    )


def bounds(design, box):
    problem = problem_of(design, limits(design))
    angles = Angles.of(box.order)
    out, _ = enclose(problem, problem.frame(angles), boxes_of(box, angles))
    return problem.names, out[0]
