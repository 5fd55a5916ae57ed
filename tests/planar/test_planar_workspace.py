import numpy as np
import pytest

from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter
from gsp.planar import PlanarDesign, PlanarPose, corner_poses, planar_section, radiating_point
from gsp.planar.bounds import planar_bounds

STROKES = [[0.8, 1.6], [0.9, 1.7], [0.7, 1.5]]


@pytest.fixture(scope="module")
def triangle():
    return PlanarDesign(
        ["D1"] * 3,
        base_points=[[0, 0], [2, 0], [1, 2.2]],
        platform_points=[[-0.5, -0.3], [0.5, -0.3], [0, 0.6]],
        strokes=STROKES,
        name="triangle",
    )


@pytest.fixture(scope="module")
def mapped(triangle):
    return planar_section(triangle, radiating_point(triangle, [1.0, 0.8]).position, rays=12)


def lengths(x, y, phi):
    """Leg lengths, written afresh."""
    base = np.array([[0, 0], [2, 0], [1, 2.2]])
    platform = np.array([[-0.5, -0.3], [0.5, -0.3], [0, 0.6]])
    c, s = np.cos(phi), np.sin(phi)
    return [
        np.hypot(x + c * b[0] - s * b[1] - a[0], y + s * b[0] + c * b[1] - a[1])
        for a, b in zip(base, platform, strict=True)
    ]


def test_radiating_point_has_mean_lengths(triangle):
    pose = radiating_point(triangle, [1.0, 0.8])
    assert triangle.at(pose).joints == pytest.approx([1.2, 1.3, 1.1], abs=1e-12)


def test_corners_are_exact_and_come_in_pairs(triangle):
    """The modes of assembly of three RPR legs are the real roots of a polynomial of degree six."""
    found = corner_poses(triangle)
    assert list(found) == [f"{i} {j} {k}" for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    for text, poses in found.items():
        wanted = [STROKES[i][int(mark)] for i, mark in enumerate(text.split())]
        values = lengths(*poses.position.T, poses.angle)
        for value, target in zip(values, wanted, strict=True):
            assert np.abs(value - target).max(initial=0.0) < 1e-12
        assert poses.size in (0, 2, 4, 6)


def test_number_of_modes_by_elimination(triangle):
    """Turn the angle slowly: legs 1 and 2 fix the place, sign changes of leg 3 are the modes."""
    found = corner_poses(triangle)
    phi = np.linspace(-np.pi, np.pi, 200_001)
    c, s = np.cos(phi), np.sin(phi)
    arm = triangle.platform_points
    for text, poses in found.items():
        r = [STROKES[i][int(mark)] for i, mark in enumerate(text.split())]
        centres = triangle.base_points[:, None] - np.stack(
            (c * arm[:, :1] - s * arm[:, 1:], s * arm[:, :1] + c * arm[:, 1:]), axis=-1
        )
        gap = centres[1] - centres[0]
        d = np.linalg.norm(gap, axis=-1)
        along = (d**2 + r[0] ** 2 - r[1] ** 2) / (2 * d)
        with np.errstate(invalid="ignore"):
            height = np.sqrt(r[0] ** 2 - along**2)
        count = 0
        for side in (1, -1):
            e = gap / d[:, None]
            place = centres[0] + along[:, None] * e
            place += side * height[:, None] * np.stack((-e[:, 1], e[:, 0]), axis=-1)
            error = np.linalg.norm(place - centres[2], axis=-1) - r[2]
            count += int((error[:-1] * error[1:] < 0).sum())
        assert count == poses.size


def test_all_corners_are_bifurcation_points_of_the_section(triangle, mapped):
    for text, poses in corner_poses(triangle).items():
        for i in range(poses.size):
            matches = [
                b
                for b in mapped.bifurcations
                if b.label == text
                and np.linalg.norm(b.pose.position[:2] - poses.position[i]) < 1e-9
                and np.abs(b.pose.rotation[0, 0] - np.cos(poses.angle[i])) < 1e-9
            ]
            assert len(matches) == 1


def test_curves_keep_their_legs_at_the_limits(mapped):
    assert mapped.ends.maximal.all()
    for curve in mapped.curves:
        x, y, z = curve.pose.position.T
        phi = np.arctan2(curve.pose.rotation[:, 1, 0], curve.pose.rotation[:, 0, 0])
        values = lengths(x, y, phi)
        assert np.abs(z).max() == 0.0
        assert not curve.lost
        for leg, side in curve.active:
            assert np.abs(values[leg] - STROKES[leg][side]).max() < 1e-10


def test_outer_boundary_against_a_search_over_all_angles(mapped):
    """Just inside some angle is feasible, just outside none is."""
    rays = np.linspace(0.05, 2 * np.pi, 40)
    frame = mapped.on_rays(rays)
    outer = frame[frame["outer"]].drop_duplicates("ray")
    phi = np.linspace(-np.pi, np.pi, 40_001)
    low, high = np.array(STROKES).T[..., None]
    assert len(outer) == len(rays)
    for row in outer.itertuples():
        for nudge, wanted in ((-1e-3, True), (1e-3, False)):
            reach = row.distance + nudge
            x, y = mapped.origin[:2] + reach * np.array([np.cos(row.angle), np.sin(row.angle)])
            values = np.array(lengths(x, y, phi))
            inside = ((values >= low) & (values <= high)).all(axis=0).any()
            assert inside == wanted


def test_one_leg_alone_gives_circles():
    """Legs 2 and 3 reach anywhere: then P is within l + |b| and, if l > |b|, beyond l − |b|."""
    design = PlanarDesign(
        ["D1"] * 3,
        base_points=[[0, 0], [2, 0], [1, 2.2]],
        platform_points=[[-0.3, -0.4], [0.5, -0.3], [0, 0.6]],
        strokes=[[1.2, 1.6], [0.01, 50.0], [0.01, 50.0]],
    )
    mapped = planar_section(design, [1.2, 0.1], rays=8)
    frame = mapped.on_rays([0.1, 0.2, 3.0])
    for row in frame[frame["maximal"]].itertuples():
        radius = np.hypot(row.x, row.y)
        assert min(abs(radius - 2.1), abs(radius - 0.7)) < 1e-9
    assert {c.label for c in mapped.curves if c.maximal.mean() > 0.9} >= {"1 - -", "0 - -"}
    assert any(c.closed for c in mapped.curves)


def test_fixed_angle(triangle):
    start = radiating_point(triangle, [1.0, 0.8])
    mapped = planar_section(triangle, start.position, angle=float(start.angle), rays=12)
    centres = triangle.base_points - triangle.platform_points @ start.rotation.T
    for curve in mapped.curves:
        ((leg, side),) = curve.active
        gap = np.linalg.norm(curve.pose.position[:, :2] - centres[leg], axis=1)
        assert np.abs(gap - STROKES[leg][side]).max() < 1e-10


def test_bad_input(triangle):
    with pytest.raises(
        EmptyWorkspace, match=r"^position: expected a radiating point with a feasible angle"
    ):
        planar_section(triangle, [9.0, 9.0])
    with pytest.raises(EmptyWorkspace, match=r"^angle: expected one that is feasible"):
        planar_section(triangle, [9.0, 9.0], angle=0.0)
    with pytest.raises(MissingParameter, match="strokes"):
        planar_section(triangle.replace(strokes=None), [1.0, 1.0])
    with pytest.raises(MissingParameter, match="origin"):
        planar_section(triangle)
    with pytest.raises(InvalidInput, match="least < greatest"):
        corner_poses(triangle.replace(strokes=[[1.0, 1.0]] * 3))
    with pytest.raises(
        EmptyWorkspace, match=r"^guess: expected a point near a pose with the joints"
    ):
        radiating_point(triangle.replace(strokes=[[9.0, 9.5], [0.1, 0.2], [0.1, 0.2]]), [0, 0])
    assert PlanarPose([0.0, 0.0]).size == 1


def test_bounds_of_lengths_and_angles_compare_in_any_unit(make_design, rng):
    design = make_design(["D1", "D2", "A1"], rng).replace(strokes=[[1, 4], [1, 4], [0.5, 2]])
    position, rotation = np.array([0.3, -0.4, 0.0]), np.eye(3)
    here = planar_bounds(design).comparable(position, rotation)
    there = planar_bounds(design.scaled(1000.0)).comparable(1000.0 * position, rotation)
    for value, other in zip(here, there, strict=True):
        assert other == pytest.approx(value, rel=1e-12, abs=1e-12)
