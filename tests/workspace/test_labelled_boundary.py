"""Labelled curves on the boundary of regions: complete, and where their labels state."""

import re
from functools import cache
from inspect import signature

import matplotlib

matplotlib.use("Agg")
import numpy as np
import pytest

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput
from gsp.plots.workspace import boundary
from gsp.workspace import boundary_curves, exact_shells, fixed_orientation, reachable
from gsp.workspace.passed_cells import crosses
from tests.plots.ink import crossing, overlaps, unseen
from tests.workspace.test_section_labels import lengths, random_design

VERTICAL = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
INCLINED = ([0.1, 0.05, 0.0], [[1.0, 0.2, 0.0], [0.0, 0.1, 1.0]])
TURN = gsp.geometry.rotation_from_angles([0.1, -0.15, 0.2], "rpy")
SIX_THREE = gsp.catalogue.design("workspace-6-3")


@cache
def fixed(seed):
    """Return a design, a plane, a rotation, and the curves of one orientation."""
    design = SIX_THREE if seed is None else random_design(seed, 6, 1.0)
    plane = VERTICAL if seed is None else INCLINED
    rotation = np.eye(3) if seed is None else TURN
    region = fixed_orientation(design, rotation, plane=plane)
    return design, plane, rotation, boundary_curves(region)


@cache
def any_orientation():
    region = reachable(SIX_THREE, plane=VERTICAL, half_space=[0, 0, 1, 0], resolution=1.0)
    return boundary_curves(region)


def distance(points, ends):
    """Distances of points (n, 3) from a polyline (m, 3)."""
    first, step = ends[:-1], np.diff(ends, axis=0)
    squared = np.maximum((step**2).sum(axis=1), 1e-300)
    share = np.einsum("nmk,mk->nm", points[:, None] - first, step) / squared
    nearest = first + np.clip(share, 0.0, 1.0)[..., None] * step
    return np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)


@pytest.mark.parametrize("seed", [None, 1, 3])
def test_curves_of_one_orientation_are_the_exact_arcs(seed):
    design, plane, rotation, found = fixed(seed)
    arcs = exact_shells(design, rotation).section(*plane)
    assert not found.missed.any()
    assert found.labelled == 1.0
    drawn = {}
    for curve, outer in zip(found.section.curves, found.outer, strict=True):
        assert outer.all()
        drawn.setdefault(curve.label, []).append(curve.pose.position)
    assert set(drawn) == {arc.label for arc in arcs}
    size = np.ptp(np.concatenate([arc.points for arc in arcs]), axis=0).max()
    for arc in arcs:
        near = np.min([distance(arc.points, line) for line in drawn[arc.label]], axis=0)
        assert near.max() < 2e-3 * size, arc.label


def test_curves_of_any_orientation_are_on_the_boundary():
    found = any_orientation()
    assert not found.missed.any()
    design = SIX_THREE
    labels = set()
    for curve, outer in zip(found.section.curves, found.outer, strict=True):
        values = lengths(curve.pose, design.base_points, design.platform_points)
        for leg, mark in enumerate(curve.label.split()):
            if mark != "-":
                assert np.abs(values[:, leg] - design.strokes[leg, int(mark)]).max() < 1e-9
        assert (values > design.strokes[:, 0] - 1e-8).all()
        assert (values < design.strokes[:, 1] + 1e-8).all()
        if outer.any():
            labels.add(curve.label)
    # Those of figure 3.2 of Workspace-3 that bound the set from outside, above the base.
    assert {"- 1 1 1 1 -", "1 - 1 1 - 1", "0 - 1 1 - 0", "1 0 - - 0 1"} <= labels
    # Where rays leave the set, between what is proven inside and outside, is on a curve.
    angles = np.random.default_rng(1).uniform(0.4, np.pi - 0.4, 8)
    ways = np.stack((np.cos(angles), 0.0 * angles, np.sin(angles)), axis=1)
    crossings = found.section.on_rays(angles)
    ends = crossings[crossings["outer"]].groupby("ray")["distance"].first().to_numpy()
    proven = {code: ends_of(found.region, ways, code) for code in (-1, 1)}
    assert (ends > proven[1]).all()
    assert (ends < proven[-1]).all()
    assert np.median(proven[-1] - proven[1]) < 0.02


def ends_of(region, ways, code):
    """Distances of points of a code near to where rays from the origin leave the others."""
    low, high = np.full(len(ways), 8.0), np.full(len(ways), 20.0)
    for _ in range(14):
        middle = 0.5 * (low + high)
        codes = region.contains(middle[:, None] * ways)
        inside = codes == 1 if code == 1 else codes != -1
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return low if code == 1 else high


def test_with_few_curves_the_others_are_missed():
    _, _, _, whole = fixed(None)
    found = boundary_curves(whole.region, most=2)
    assert len(found.section.curves) == 2
    assert found.missed.any()
    assert (found.unlabelled | ~found.missed).all()
    passed = (whole.region.codes == 0) & ~found.unlabelled
    assert found.labelled == passed.sum() / (passed.sum() + found.missed.sum())
    ax = boundary(found)
    cells = [c for c in ax.collections if len(c.get_paths()) == found.missed.sum()]
    assert len(cells) == 1


def test_other_limits_than_strokes():
    limits = gsp.Limits(base_cone=0.5)
    region = fixed_orientation(
        SIX_THREE, limits=limits, plane=VERTICAL, resolution=2.0, budget=4000
    )
    found = boundary_curves(region)
    assert found.labelled == 1.0
    assert any("cone" in curve.label for curve in found.section.curves)


def test_along_a_wall_the_platform_turns_and_the_wall_ends_where_no_orientation_is_left():
    limits = gsp.Limits(position=[None, None, (3.0, None)])
    region = reachable(SIX_THREE, limits, plane=VERTICAL, resolution=2.0)
    found = boundary_curves(region)
    assert found.incomplete == ()
    assert not found.missed.any()
    walls = [curve for curve in found.section.curves if curve.label.endswith("z=0")]
    places = np.concatenate([curve.pose.position for curve in walls])
    assert np.abs(places[:, 2] - 3.0).max() < 1e-9
    for curve in walls:
        values = lengths(curve.pose, SIX_THREE.base_points, SIX_THREE.platform_points)
        assert (values > SIX_THREE.strokes[:, 0] - 1e-8).all()
        assert (values < SIX_THREE.strokes[:, 1] + 1e-8).all()
        assert found.outer[found.section.curves.index(curve)].all()
    # Beside the ends of the whole wall the region is proven, in and out.
    for end, way in ((places[:, 0].min(), -1.0), (places[:, 0].max(), 1.0)):
        beside = [[end + way * step, 0.0, 3.0 + 1e-6] for step in (-0.02, 0.02)]
        assert region.contains(beside).tolist() == [1, -1]


def test_what_the_budget_ends_is_stated():
    whole = any_orientation()
    assert (whole.waiting, whole.incomplete, whole.stopped_by) == (0, (), None)
    waiting = []
    for budget in (20, 40):
        some = boundary_curves(whole.region, budget=budget)
        statuses = [curve.status for curve in some.section.curves]
        assert 0 < len(statuses) < len(whole.section.curves)
        assert some.incomplete == tuple(i for i, s in enumerate(statuses) if s == "budget")
        assert some.missed.any()
        assert some.stopped_by == "budget"
        waiting.append(some.waiting)
    assert max(waiting) > 0
    one = boundary_curves(whole.region, budget=5)
    assert [curve.status for curve in one.section.curves] == ["budget"]
    assert len(one.section.curves[0].pose.position) <= 6


def test_what_the_greatest_number_of_curves_ends_is_stated():
    """Also where every curve that was followed is complete."""
    _, _, _, whole = fixed(None)
    number = len(whole.section.curves)
    some = boundary_curves(whole.region, most=number - 2)
    assert (len(some.section.curves), some.incomplete) == (number - 2, ())
    assert some.stopped_by == "most"
    assert boundary_curves(whole.region, most=number).stopped_by is None


def test_curves_end_at_the_border_of_a_half_space():
    curves = boundary_curves(any_orientation().region, interior=True).section.curves
    heights = [curve.pose.position[:, 2] for curve in curves]
    assert all(z.min() > -1e-8 for z in heights)
    cut = [
        np.abs(z[[0, -1]]).min()
        for z, c in zip(heights, curves, strict=True)
        if c.status == "border"
    ]
    assert len(cut) >= 2
    assert max(cut) < 1e-9


def test_a_picture_has_every_label_once_and_none_overlap():
    found = any_orientation()
    ax = boundary(found, interior=True)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert len(labels) == len(set(labels))
    drawn = {name for label in labels for name in re.findall(r"\[(.*?)\]", label)}
    heights = [line.get_ydata() for line in ax.lines]
    # The region is above z = 0, and ends of curves are on it up to rounding.
    assert all(np.nanmin(z, initial=0.0) >= -1e-14 for z in heights)
    for curve in found.section.curves:
        above = curve.pose.position[:, 2] >= 0.0
        if curve.label not in drawn and above.any():
            # It is beneath the dots at its ends, which are 4 points wide.
            places = curve.pose.position[above][:, [0, 2]]
            flat = ax.transData.transform(places) * 72.0 / ax.figure.dpi
            ends = np.linalg.norm(flat[:, None] - flat[[0, -1]], axis=-1)
            assert (ends.min(axis=1) < 3.0).all()
    assert len(drawn) >= 7
    assert not overlaps(ax)
    assert not crossing(ax)
    assert not unseen(ax)
    thick = boundary(found, labels=False)
    assert len(thick.lines) < len(ax.lines)


@pytest.mark.parametrize(
    ("low", "high", "first", "last", "meets"),
    [
        ([0, 0], [1, 1], [-1, 0.5], [2, 0.5], True),
        ([0, 0], [1, 1], [0.5, -1], [0.5, -0.1], False),
        ([0, 0], [1, 1], [-1, 0.2], [0.2, -1], False),
        ([0, 0], [1, 1], [-0.5, 1.0], [0.5, 1.5], False),
        ([0, 0], [1, 1], [-0.5, 0.5], [0.5, 1.5], True),
        ([0, 0], [1, 1], [0.3, 0.3], [0.3, 0.3], True),
        ([0, 0], [1, 1], [1.3, 0.3], [1.3, 0.3], False),
    ],
)
def test_segments_meet_closed_boxes(low, high, first, last, meets):
    box = np.array([low], dtype=float), np.array([high], dtype=float)
    ends = np.array(first, dtype=float), np.array(last, dtype=float)
    assert crosses(*box, *ends).tolist() == [meets]
    assert crosses(*box, *ends[::-1]).tolist() == [meets]


def test_regions_without_such_curves_are_refused():
    box = gsp.PoseBox([0, 0, 0], [0, 0, (-10, 10)], degrees=True)
    ranged = reachable(SIX_THREE, plane=VERTICAL, rotations=box, resolution=4.0)
    space = fixed_orientation(SIX_THREE, resolution=4.0)
    nothing = gsp.Limits(position=[None, None, (50.0, None)])
    empty = fixed_orientation(SIX_THREE, limits=nothing, plane=VERTICAL)
    for region, error, words in (
        (ranged, InvalidInput, "one of a range"),
        (space, InvalidInput, "in a plane"),
        (empty, EmptyWorkspace, "empty region"),
        (SIX_THREE, InvalidInput, "Region"),
    ):
        with pytest.raises(error, match=words):
            boundary_curves(region)


def test_sections_and_boundary_curves_end_after_equally_many_curves():
    functions = (gsp.workspace.section, boundary_curves)
    assert len({signature(function).parameters["most"].default for function in functions}) == 1
