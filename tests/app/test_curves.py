"""Plots and the ranking of the browser tool agree with the library."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.app.state import choices, curves, motion
from gsp.app.state.session import started
from gsp.errors import GspError

TOZ = "toz-kucuk-2016-d3-6"


@pytest.fixture
def toz():
    return started(choices.named(TOZ))


@pytest.mark.parametrize("where", curves.MOTIONS)
def test_a_curve_has_the_values_of_postures(toz, where):
    toz = motion.with_coordinate(toz, "x", 3.0)
    found = curves.curve(toz, "condition_number", where)
    axis, turning = "xyz".index(where[-1]), where.startswith("turn")
    assert found.here == (0.0 if turning else toz.pose.position[axis])
    for i in (0, len(found.places) // 2, 100):
        twist, way = np.zeros(6), found.places[i] - found.here
        twist[axis + 3 * turning] = np.deg2rad(way) if turning else way
        posture = toz.design.at(toz.pose.moved(twist))
        wanted = gsp.indices.condition_number(posture, toz.length)
        assert found.values[i] == pytest.approx(float(wanted), rel=1e-9)


@pytest.mark.parametrize("axes", curves.PLANES)
def test_a_map_has_the_values_of_postures(toz, axes):
    found = curves.map_over(toz, "manipulability", axes)
    for i, j in ((0, 3), (15, 15), (30, 7)):
        place = np.array(toz.pose.position)
        place[["xyz".index(a) for a in axes]] = found.first[i], found.second[j]
        posture = toz.design.at(gsp.Pose(place, toz.pose.rotation))
        wanted = abs(np.linalg.det(posture.jacobian))
        assert found.values[i, j] == pytest.approx(wanted, rel=1e-9)


def test_the_ranking_is_that_of_the_library(toz):
    state = motion.with_coordinate(toz, "yaw", 3.0)
    found = curves.ranking(state, "control_number", toz.design)
    assert len(found) == 195
    values = [one.value for one in found]
    assert values == sorted(values, reverse=True)
    for one in (found[0], found[57], found[-1]):
        design = gsp.catalogue.instantiate(gsp.catalogue.mechanism(one.name), toz.design)
        wanted = gsp.indices.control_number(design.at(state.pose), toz.length)
        assert one.value == pytest.approx(float(wanted), rel=1e-12)


def test_wrong_words_are_errors(toz):
    for call in (
        lambda: curves.curve(toz, "nothing", "x"),
        lambda: curves.curve(toz, "control_number", "w"),
        lambda: curves.map_over(toz, "control_number", "yx"),
        lambda: curves.map_over(toz, "condition_number_ellipsoid", "xy"),
        lambda: curves.curve(toz, "quality_index", "x"),
        lambda: curves.ranking(toz, "quality_index", toz.design),
    ):
        with pytest.raises(GspError, match="expected"):
            call()
