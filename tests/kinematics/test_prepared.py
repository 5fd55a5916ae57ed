"""`gsp.prepare`: one pose at a time gives what a posture and the index's function give."""

import numpy as np
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.evaluation.backends import COMPILED
from gsp.indices import INDICES

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
GIVEN = {"length": 95.0, "maximum": 1e6, "ellipsoid": gsp.Ellipsoid([50, 40, 30], [3, 2, 10])}


@pytest.mark.parametrize("name", COMPILED)
@pytest.mark.parametrize("number", [0, 60, 120, 180])
def test_it_gives_the_jacobian_and_the_value(name, number):
    design = instantiate(mechanisms()[number], TEMPLATE)
    fast = gsp.prepare(design, name, **GIVEN)
    arguments = {key: GIVEN[key] for key in INDICES[name].parameters}
    for pose in (BOX.sample(5, rng=number)[i] for i in range(5)):
        jacobian, value = fast(pose.position, pose.rotation)
        posture = design.at(pose)
        scale = np.abs(posture.jacobian).max()
        np.testing.assert_allclose(jacobian, posture.jacobian, rtol=0, atol=1e-14 * scale)
        assert value == pytest.approx(
            float(INDICES[name].function(posture, **arguments)), rel=1e-10
        )


def test_what_is_undefined_is_as_in_a_posture():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, ring, ring)
    jacobian, value = gsp.prepare(design, length=1.0)([0, 0, 0], np.eye(3))
    assert np.isnan(value)
    assert np.isnan(jacobian).all()


def test_a_singular_posture_has_the_worst_value():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    fast = gsp.prepare(gsp.Design(["D1"] * 6, 2 * ring, ring), length=1.0)
    assert fast([0, 0, 1], np.eye(3))[1] == np.inf


@pytest.mark.parametrize(
    ("position", "rotation", "message"),
    [
        ([0, 0], np.eye(3), "position"),
        ([0, 0, np.nan], np.eye(3), "finite"),
        ([0, 0, 1], 2 * np.eye(3), "rotation matrix"),
        ([0, 0, 1], -np.eye(3), "rotation matrix"),
        ([[0, 0, 1]], np.eye(3), "single pose"),
        ("here", np.eye(3), "real numbers"),
    ],
)
def test_bad_poses_are_refused_as_by_pose(position, rotation, message):
    with pytest.raises(gsp.GspError, match=message):
        gsp.prepare(TEMPLATE)(position, rotation)


def test_what_it_cannot_do_is_refused():
    with pytest.raises(gsp.GspError, match="nearest"):
        gsp.prepare(TEMPLATE, "condition")
    with pytest.raises(gsp.GspError, match="maximum"):
        gsp.prepare(TEMPLATE, "quality_index")
