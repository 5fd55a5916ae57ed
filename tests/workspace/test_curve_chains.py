"""The curves of the figures of Workspace-3 and Workspace-A: all of them, and no others."""

from functools import cache

import numpy as np
import pytest
from scipy.optimize import fsolve

import gsp
from gsp.errors import InvalidInput
from gsp.workspace import boundary_curves, curve_chain, exact_shells, reachable

VERTICAL = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SIX_THREE = gsp.catalogue.design("workspace-6-3")
U0 = np.array([0.0, 0.0, 7.804])  # eq. (3.13)
# Labels of legs 1 to 3, and x, z, β near the points; A is on OZ, with l1 = l6 free.
POINTS = {
    "B": ("000", (0.6, 0.9, -38)),
    "C": ("001", (4.3, 0.1, -119)),
    "D": ("011", (8.7, 3.8, -82)),
    "E": ("111", (4.2, 10.4, -118)),
    "F": ("111", (0.0, 13.0, 0)),
    "G": ("011", (6.6, 8.1, 32)),
}
UPWARD = {"AB": "-0000-", "BC": "00--00", "CD": "0-11-0", "DE": "-1111-", "EF": "11--11"}
DOWNWARD = {"FG": "-1111-", "GD": "01--10", "DC": "0-11-0", "CB": "00--00", "BA": "-0000-"}
DOWN, UP = -0.5 * np.pi, 0.5 * np.pi


@cache
def mapped():
    # Curve BC passes z = −0.24, and would end at the border z = 0.
    region = reachable(SIX_THREE, plane=VERTICAL, half_space=[0, 0, 1, -0.5], resolution=2.0)
    return boundary_curves(region, interior=True, connecting=True)


def first_curve(label, z):
    """Number of the curve with a label that passes OZ at a height."""
    section = mapped().section
    near = [
        np.linalg.norm(section.curves[i].pose.position - [0.0, 0.0, z], axis=1).min()
        for i in section.find(label)
    ]
    return section.find(label)[int(np.argmin(near))]


@cache
def sweep(name):
    """Numbers of the curves of the upward or of the downward sweep of rays from u0."""
    curve, turn = {
        "upward": (first_curve("-0000-", 2.369), (DOWN, UP)),
        "downward": (first_curve("-1111-", 12.961), (UP, DOWN)),
    }[name]
    return curve_chain(mapped().section, curve, *turn, origin=U0)


@pytest.fixture(scope="module")
def places(formula):
    """The named points, solved with scipy from eqs. (3.3), (3.4) in the plane of symmetry."""
    result = {}
    for name, (text, (x, z, beta)) in POINTS.items():
        target = [(8.0, 15.0)[int(mark)] for mark in text]

        def gap(q, target=target):
            return formula(q[0], 0.0, q[1], 0.0, q[2], 0.0)[:3] - target

        result[name] = fsolve(gap, (x, z, np.deg2rad(beta)), xtol=1e-13)
    return result


@pytest.mark.parametrize(
    ("name", "curves"), [("upward", UPWARD), ("downward", DOWNWARD)], ids=["3.3", "3.4"]
)
def test_a_sweep_of_rays_has_the_curves_of_its_figure_in_their_order(name, curves, places):
    section = mapped().section
    chain = [section.curves[i] for i in sweep(name)]
    assert [c.label.replace(" ", "") for c in chain] == list(curves.values())
    for curve, ends in zip(chain, curves, strict=True):
        found = [section.bifurcations[i].pose for i in (curve.first, curve.last)]
        for end in set(ends) - {"A"}:
            x, z, beta = places[end]
            assert any(
                np.abs(p.position - [x, 0.0, z]).max() < 1e-9
                and abs(p.angles("approach-roll")[1] - beta) < 1e-9
                for p in found
            )


def test_both_sweeps_together_are_figure_3_2():
    assert not mapped().missed.any()
    both = set(sweep("upward")) | set(sweep("downward"))
    assert len(both) == 7
    ends = mapped().section.on_rays([-0.4, 0.0, 0.4, 0.8, 1.2])
    assert set(ends.loc[ends["outer"], "curve"]) <= both


def test_rays_that_start_from_ef_end_on_fg_as_in_figure_b_1():
    """Curve EF is left where it is no maximum, and everywhere FG is farther."""
    section = mapped().section
    ef, fg = sweep("upward")[-1], sweep("downward")[0]
    # The origin of the plane is not u0, so the distances are those of the curves themselves.
    flat = {i: section.curves[i].pose.position[:, [0, 2]] - U0[[0, 2]] for i in (ef, fg)}
    angle = {i: np.arctan2(*points.T[::-1]) for i, points in flat.items()}
    away = {i: np.hypot(*points.T) for i, points in flat.items()}
    order = {i: np.argsort(a) for i, a in angle.items()}
    rays = np.deg2rad(np.arange(35.0, 88.0, 2.0))
    near, far = (np.interp(rays, angle[i][order[i]], away[i][order[i]]) for i in (ef, fg))
    assert (far > near + 0.2).all()
    assert 0.2 < section.curves[ef].maximal.mean() < 0.6


def turned_shells():
    turn = gsp.Pose.from_angles([0, 0, 0], [0, 0, -30], "approach-roll", degrees=True).rotation
    return exact_shells(SIX_THREE, turn)


def half_plane(theta_deg):
    """Outward direction, and normal, of the half-plane at θ [deg]."""
    theta = np.deg2rad(theta_deg)
    return np.array([np.cos(theta), np.sin(theta), 0.0]), np.array(
        [-np.sin(theta), np.cos(theta), 0.0]
    )


@pytest.mark.parametrize(
    ("theta", "labels"),
    [
        (15.0, {"-1----", "0-----"}),
        (45.0, {"---1--", "--0---"}),
        (30.0, {"-1----", "--0---"}),
    ],
    ids=["a", "b", "c"],
)
def test_figure_d_1_has_two_arcs_from_oz_to_their_common_point(theta, labels):
    outward, _ = half_plane(theta)
    arcs = [
        arc
        for arc in turned_shells().section([0, 0, 0], [outward, [0, 0, 1]])
        if arc.points[:, 2].max() > 1e-9 and (arc.points @ outward).max() > 1e-9
    ]
    assert len(arcs) == 2
    assert {arc.label.replace(" ", "") for arc in arcs} == labels
    ends = np.array([p for arc in arcs for p in (arc.first, arc.last)])
    ends = ends[np.argsort(ends @ outward)]
    assert np.abs(ends[:2] @ outward).max() < 1e-9
    assert np.abs(ends[2] - ends[3]).max() < 1e-9


def test_figure_d_2_has_two_curves_near_the_plane_and_what_joins_them():
    outward, normal = half_plane(30.0)
    near = [
        edge.label.replace(" ", "")
        for edge in turned_shells().edges()
        if edge.points[:, 2].mean() > 0.0
        and np.abs(edge.points @ normal).max() < 0.1
        and (edge.points @ outward).min() > -1e-9
    ]
    # The source has one corner B'' (0 1 0 1 - -); there are two, which [- 1 0 - - -] joins.
    assert sorted(near) == ["-1-1--", "-10---", "0-0---"]


def test_a_chain_begins_on_the_curve_that_the_first_ray_meets():
    section = mapped().section
    curve = first_curve("-1111-", 12.961)
    with pytest.raises(InvalidInput, match="curve: expected one that the first ray meets"):
        curve_chain(section, curve, DOWN, UP, origin=U0)
    with pytest.raises(InvalidInput, match="a number of a curve below"):
        curve_chain(section, len(section.curves), DOWN, UP)
    assert curve_chain(section, curve, UP, UP - 0.1, origin=U0) == (curve,)
