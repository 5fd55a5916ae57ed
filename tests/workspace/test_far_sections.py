"""Sections of designs with strokes of thousands of sizes: curves end soon, and on their spheres."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.workspace import exact_shells, section
from gsp.workspace.boundary.tracing import STEPS_PER_CURVE


def far_design(sizes):
    """Greatest lengths that differ by less than the anchors do, so that several bound."""
    lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    most = lift.rms_radius * (sizes + 0.1 * np.arange(6))
    return lift.replace(strokes=np.stack((0.5 * lift.at(lift.home).joints, most), axis=1))


def assert_on_spheres(design, curve):
    p, r = curve.pose.position, curve.pose.rotation
    reach = p[:, None] + np.einsum("nij,lj->nli", r, design.platform_points) - design.base_points
    lengths, most = np.linalg.norm(reach, axis=-1), design.strokes[:, 1]
    assert curve.held
    for leg, side in curve.held:
        np.testing.assert_allclose(lengths[:, leg], design.strokes[leg, side], rtol=1e-12)
    assert (lengths <= most * (1.0 + 1e-12)).all()
    assert (lengths >= design.strokes[:, 0] * (1.0 - 1e-12)).all()


@pytest.mark.parametrize("sizes", [1e3, 1e5])
def test_a_far_section_of_one_orientation_is_the_exact_one(sizes):
    design = far_design(sizes)
    found = section(design, rotation=np.eye(3), rays=3, connecting=False, progress=False)
    assert not any(curve.lost for curve in found.curves)
    for curve in found.curves:
        assert_on_spheres(design, curve)
        assert 4 < len(curve.pose.position) < STEPS_PER_CURVE
    exact = exact_shells(design, np.eye(3))
    outer = {arc.label for arc in exact.section(found.origin, found.axes) if "1" in arc.label}
    assert len(outer) > 1
    assert {curve.label for curve in found.curves if "1" in curve.label} == outer


def test_far_curves_with_free_orientations_end_soon_on_their_spheres():
    design = far_design(1e3)
    found = section(design, rays=3, starts=1, most=2, connecting=False, progress=False)
    assert len(found.curves) == 2
    for curve in found.curves:
        assert curve.maximal.all()
        assert not curve.lost
        assert len(curve.pose.position) < STEPS_PER_CURVE / 2
        assert_on_spheres(design, curve)
