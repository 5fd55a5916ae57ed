"""The picture of a design in space."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.optimize import linprog

import gsp
from gsp.catalogue import design, design_names, instantiate, mechanisms
from gsp.errors import InvalidInput
from gsp.families import lee
from gsp.model.legs import DRIVEN_LEGS
from gsp.model.legs import LEGS as KINDS
from gsp.plots import mechanism
from gsp.plots.common.style import LEGS
from tests import campaign
from tests.plots.ink import assert_ink, overlaps

DESIGN = design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


def rods(ax) -> list[np.ndarray]:
    """Ends of the thin rods of the legs, (2, 3) each."""
    return [np.array(line.get_data_3d()).T for line in ax.lines if line.get_linewidth() == 2.0]


def test_rods_are_as_long_as_the_joint_distances():
    """The legs of distances d1 … d4 come first; the common normal of A1 follows."""
    ax = mechanism(DESIGN)
    lengths = [np.linalg.norm(b - a) for a, b in rods(ax)]
    np.testing.assert_allclose(lengths[:4], DESIGN.at(DESIGN.home).joints[:4], rtol=1e-12)
    assert len(lengths) == DESIGN.n_legs


def test_feet_lie_on_the_anchor_lines():
    ax = mechanism(DESIGN)
    pose = DESIGN.home
    for i, (foot, top) in enumerate(rods(ax)):
        off = foot - DESIGN.base_points[i]
        s, t = DESIGN.base_directions[i], pose.rotation @ DESIGN.platform_directions[i]
        distance = np.linalg.norm(np.cross(off, s) if np.isfinite(s).all() else off)
        assert distance < 1e-9
        off = top - (pose.position + pose.rotation @ DESIGN.platform_points[i])
        assert np.linalg.norm(np.cross(off, t) if np.isfinite(t).all() else off) < 1e-9


def test_scales_are_equal():
    ax = mechanism(DESIGN)
    spans = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
    aspect = np.array(ax._box_aspect)
    np.testing.assert_allclose(aspect / aspect.max(), np.array(spans) / max(spans), rtol=1e-6)


def test_legend_names_the_legs_that_are_there():
    texts = [t.get_text() for t in mechanism(DESIGN).get_legend().get_texts()]
    assert texts == [
        "D1 (SPS)", "D2 (SPC)", "D3 (CPS)", "A1 (CCC)", "D4 A1 (CCC)", "S joint",
        "P joint", "C joint", "base", "platform",
    ]  # fmt: skip
    assert set(LEGS) == {kind.name for kind in (*KINDS, *DRIVEN_LEGS)}
    assert len(set(LEGS.values())) == len(LEGS)


def hulls(ax) -> list[np.ndarray]:
    """Corners of the bodies that are drawn as faces, base first."""
    faces = [c for c in ax.collections if type(c).__name__ == "Poly3DCollection"]
    edges = [c for c in ax.collections if type(c).__name__ == "Line3DCollection"]
    assert len(faces) <= 3
    return [np.concatenate(np.array(c._segments3d, dtype=float)) for c in edges]


def off_hull(points, corners) -> float:
    """Greatest distance of points from the convex hull of corners, by linear programming."""
    worst = 0.0
    for point in points:
        n = len(corners)
        # min t: |Σ w_i c_i − p| ≤ t in every coordinate, Σ w_i = 1, w ≥ 0
        upper = np.block([[corners.T, -np.ones((3, 1))], [-corners.T, -np.ones((3, 1))]])
        found = linprog(
            np.r_[np.zeros(n), 1.0],
            upper,
            np.r_[point, -point],
            np.r_[np.ones(n), 0.0][None],
            [1.0],
            bounds=[(0, None)] * (n + 1),
        )
        worst = max(worst, found.fun)
    return worst


def random_design(seed, legs=("D1",) * 6, **changes):
    rng = np.random.default_rng(seed)
    n = len(legs)
    return gsp.Design(
        list(legs),
        rng.normal(size=(n, 3)),
        rng.normal(size=(n, 3)),
        rng.normal(size=(n, 3)),
        rng.normal(size=(n, 3)),
        home=gsp.Pose([0.1, 0.2, 3.0]),
    ).replace(**changes)


def ring(n, radius):
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)


PLAIN = gsp.Design(["D1"] * 6, ring(6, 2.0), ring(6, 1.0), home=gsp.Pose([0, 0, 1.5]))
LINE = np.linspace(-1, 1, 6)[:, None] * np.array([1.0, 2.0, 0.5])
AWKWARD = {
    **{name: design(name) for name in design_names()},
    "spatial": random_design(1),
    "eight legs": random_design(2, ["D1"] * 8),
    "seven kinds": random_design(3, ["D1", "D2", "D3", "D4", "A1", "D4 A1", "D1"]),
    "coplanar": PLAIN,
    "collinear platform": PLAIN.replace(platform_points=LINE),
    "collinear base": PLAIN.replace(base_points=LINE),
    "coincident platform": PLAIN.replace(platform_points=np.zeros((6, 3))),
    "coincident base": PLAIN.replace(base_points=np.ones((6, 3))),
    "pairs": PLAIN.replace(base_points=np.repeat(ring(3, 2.0), 2, axis=0)),
    "equal frames": PLAIN.replace(base_points=ring(6, 1.0) + [0, 0, 1], home=gsp.Pose([0, 0, 0])),
    "octahedron": lee.octahedral_3_3(1.0, 2.0).replace(home=gsp.Pose([0, 0, 1])),
    "6-3": lee.platform_3_6(1.0, 2.0, 0.2).exchanged().replace(home=gsp.Pose([0, 0, 0.6])),
    "eight near legs": gsp.Design(
        ["D1"] * 8, ring(8, 0.2), ring(8, 1.0), home=gsp.Pose.from_rpy([0, 0, 3], [0, 0, 0.3])
    ),
    "eight legs in pairs": gsp.Design(
        ["D1"] * 8,
        np.repeat(ring(4, 2.0), 2, axis=0),
        np.roll(np.repeat(ring(4, 1.0), 2, axis=0), 1, axis=0),
        home=gsp.Pose.from_rpy([0, 0, 1.5], [0, 0, 0.8]),
    ),
    **{
        text: instantiate(gsp.catalogue.mechanism(text), design("toz-kucuk-2016-d3-6"))
        for text in ("D4^6", "D4^3 A1^3", "D2^4 D3 A1")
    },
    "flat pose": PLAIN.replace(home=gsp.Pose([0, 0, 0])),
    "huge": PLAIN.scaled(1e12),
    "tiny": PLAIN.scaled(1e-12),
    "all lines through one point": gsp.Design(
        ["D4 A1"] * 3, np.zeros((3, 3)), np.zeros((3, 3)), np.eye(3), np.roll(np.eye(3), 1, 0),
        home=gsp.Pose.from_rpy([0.2, 0.3, 1.0], [0.1, 0.2, 0.3]),
    ),
    "off centre ellipsoid": PLAIN.replace(ellipsoid=gsp.Ellipsoid([2, 1, 0.1], [0, 0, 3])),
    "dollars": PLAIN.replace(name="a$_b$ $c", unit="$"),
}  # fmt: skip


@pytest.mark.parametrize("name", campaign.some(AWKWARD, 10))
def test_legs_and_numbers_are_in_the_picture_and_bodies_pass_through_their_joints(name):
    ax = mechanism(AWKWARD[name])
    assert not overlaps(ax)
    every_leg_and_number_is_shown(ax, AWKWARD[name].n_legs)
    bodies_pass_through_their_joints(ax, AWKWARD[name])


def every_leg_and_number_is_shown(ax, n_legs):
    assert_ink(ax.figure, least=100)
    limits = np.array([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()]).T
    assert len(rods(ax)) == n_legs
    for ends in rods(ax):
        assert ((ends >= limits[0]) & (ends <= limits[1])).all()
    numbers = ", ".join(t.get_text() for t in ax.texts if t.get_bbox_patch() is not None)
    assert sorted(map(int, numbers.split(", "))) == list(range(1, n_legs + 1))


def bodies_pass_through_their_joints(ax, design):
    feet = np.array(rods(ax)).swapaxes(0, 1)
    if design.driven:  # the tips of rods are on carriages and cranks
        feet[0] = design.base_points
    extended = [side for side in feet if np.ptp(side, axis=0).max() > 1e-9 * np.ptp(feet)]
    bodies = hulls(ax)
    assert len(bodies) == len(extended)
    for side, corners in zip(extended, bodies, strict=True):
        size = np.ptp(feet)
        assert off_hull(side / size, corners / size) < 1e-6
        # Every corner of a body is a joint.
        gaps = np.linalg.norm(corners[:, None] - side, axis=-1).min(axis=1)
        assert gaps.max() < 1e-9 * size


def test_numbers_of_legs_are_in_front_of_bodies_and_joints():
    ax = mechanism(AWKWARD["eight legs"])
    ax.figure.canvas.draw()  # orders of what is in space are set while it is drawn
    numbers = [text for text in ax.texts if text.get_bbox_patch() is not None]
    assert len(numbers) == 8
    behind = max(artist.get_zorder() for artist in (*ax.collections, *ax.patches, *ax.lines))
    assert min(text.get_zorder() for text in numbers) > behind


def test_the_operation_ellipsoid_is_drawn_where_the_design_has_one():
    drawn = design("nawratil-isotropic-3-mu-0")
    turned = gsp.Pose.from_rpy([1.0, 2.0, 3.0], [0.3, 0.4, 0.5])
    rings = [line for line in mechanism(drawn, turned).lines if line.get_linewidth() == 0.8]
    assert len(rings) == 3
    for line in rings:
        own = (np.array(line.get_data_3d()).T - turned.position) @ turned.rotation
        np.testing.assert_allclose(np.sum((own / drawn.ellipsoid.semi_axes) ** 2, axis=1), 1.0)
    plain_lines = [line.get_linewidth() for line in mechanism(design("nawratil-k-plus")).lines]
    assert 0.8 not in plain_lines


@pytest.mark.parametrize("i", range(0, 195, 39))
def test_mechanisms_of_the_catalogue_draw(i):
    placed = instantiate(mechanisms()[i], design("toz-kucuk-2016-d3-6"))
    assert_ink(mechanism(placed).figure, least=100)


def test_undefined_legs_are_named():
    points = DESIGN.base_points.copy()
    points[0] = DESIGN.platform_points[0]
    ax = mechanism(DESIGN.replace(base_points=points), gsp.Pose([0.0, 0.0, 0.0]))
    assert "undefined here: d1" in ax.get_title()
    assert len(rods(ax)) < DESIGN.n_legs


def test_given_axes_and_pose_are_used():
    ax = plt.figure().add_subplot(projection="3d")
    assert mechanism(DESIGN, gsp.Pose([0.0, 0.0, 120.0]), ax) is ax


def test_batches_and_missing_poses_are_errors():
    with pytest.raises(InvalidInput, match="a single pose"):
        mechanism(DESIGN, gsp.Pose(np.zeros((2, 3))))
    with pytest.raises(InvalidInput, match="no home pose"):
        mechanism(DESIGN.replace(home=None))
    missed = gsp.forward(DESIGN, np.full(6, np.nan), DESIGN.home).pose
    for arguments in ((3,), ("d",), (DESIGN, 3), (DESIGN, missed), (DESIGN, None, 3)):
        with pytest.raises(InvalidInput):
            mechanism(*arguments)
    with pytest.raises(InvalidInput, match="3d"):
        mechanism(DESIGN, ax=plt.figure().add_subplot())


@pytest.mark.parametrize("frame", ["O", "P"])
def test_a_distant_frame_does_not_shrink_the_mechanism(frame):
    given = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    plain = mechanism(given)
    far = np.array([1e4, 2e4, -1e4])
    points, home = given.platform_points, given.home
    if frame == "O":
        base, home = given.base_points + far, gsp.Pose(home.position + far, home.rotation)
    else:
        base, points = given.base_points, points + far
        home = gsp.Pose(home.position - home.rotation @ far, home.rotation)
    moved = gsp.Design(
        [leg.name for leg in given.legs],
        base,
        points,
        given.base_directions,
        given.platform_directions,
        home=home,
    )
    ax = mechanism(moved)
    assert f"far outside: frame {frame}" in ax.get_title()
    spans = [np.ptp(axes.get_xlim3d()) for axes in (plain, ax)]
    assert spans[1] < 1.1 * spans[0]


@pytest.mark.parametrize("side", ["base", "platform"])
def test_an_anchor_far_away_on_its_line_leaves_the_mechanism_its_size(side):
    leg = next(i for i, kind in enumerate(DESIGN.legs) if kind.name.startswith("D4"))
    points = getattr(DESIGN, f"{side}_points").copy()
    points[leg] += 1e4 * DESIGN.rms_radius * getattr(DESIGN, f"{side}_directions")[leg]
    far = mechanism(DESIGN.replace(**{f"{side}_points": points}))
    near = mechanism(DESIGN)
    for axis in "xyz":
        low, high = (getattr(ax, f"get_{axis}lim")() for ax in (far, near))
        assert np.ptp(low) < 1.6 * np.ptp(high)
    # Legs and feet are the same.
    for one, other in zip(rods(far), rods(near), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9 * 1e4 * DESIGN.rms_radius)


@pytest.mark.parametrize("name", ["lane-rotary", "lane-modified-paradex"])
def test_rods_rails_and_cranks_are_drawn(name):
    drawn = design(name)
    ax = mechanism(drawn)
    feet = drawn.at(drawn.home).segments
    for (tip, top), low, high in zip(rods(ax), feet.base_feet, feet.platform_feet, strict=True):
        np.testing.assert_allclose([tip, top], [low, high], rtol=0, atol=1e-12)
    dashed = [np.array(x.get_data_3d()).T for x in ax.lines if x.get_linestyle() == "--"]
    assert len(dashed) == 6
    for (low, high), s in zip(dashed, drawn.base_directions, strict=True):
        assert np.linalg.norm(np.cross(high - low, s)) < 1e-9
    cranks = [np.array(x.get_data_3d()).T for x in ax.lines if x.get_linewidth() == 4.2]
    arms = [np.linalg.norm(high - low) for low, high in cranks]
    expected = [1.25] * 6 if name == "lane-rotary" else []
    np.testing.assert_allclose(arms, expected, rtol=1e-12)
