"""`gsp.hexapod`: anchors by their angles, special cases, and errors that name the argument."""

import math

import numpy as np
import pytest

import gsp
from gsp.errors import GspError, InvalidDesign, InvalidInput
from gsp.families import lee
from tests import campaign

# Angle of each anchor: multiple of 60°, and which half of the angle of the pair is added.
BASE = ((0, -1), (0, 1), (2, -1), (2, 1), (4, -1), (4, 1))
PLATFORM = {
    "pairs": ((-1, 1), (1, -1), (1, 1), (3, -1), (3, 1), (5, -1)),
    "zigzag": BASE,
}


def on_circle(radius, angle, places):
    polar = [math.radians(60 * turn) + 0.5 * side * angle for turn, side in places]
    return [(radius * math.cos(t), radius * math.sin(t), 0.0) for t in polar]


@pytest.mark.parametrize("arrangement", PLATFORM)
def test_anchors_and_lengths_agree_with_their_angles(arrangement):
    rng = np.random.default_rng(1)
    for _ in range(campaign.count(20, 2000)):
        rb, rp, h = rng.uniform(0.1, 10.0, size=3)
        beta, alpha = rng.uniform(0.0, 2 * math.pi / 3, size=2)
        design = gsp.hexapod(rb, beta, rp, alpha, h, arrangement=arrangement)
        base, platform = on_circle(rb, beta, BASE), on_circle(rp, alpha, PLATFORM[arrangement])
        np.testing.assert_allclose(design.base_points, base, rtol=0, atol=1e-14 * rb)
        np.testing.assert_allclose(design.platform_points, platform, rtol=0, atol=1e-14 * rp)
        # The law of cosines, with the angle between the two ends of each leg.
        between = math.pi / 3 - (alpha + beta) / 2
        if arrangement == "zigzag":
            between = (alpha - beta) / 2
        length = math.sqrt(h * h + rb * rb + rp * rp - 2 * rb * rp * math.cos(between))
        np.testing.assert_allclose(design.at(design.home).joints, length, rtol=1e-13)


@pytest.mark.parametrize(
    ("side_platform", "side_base", "height"), [(1, 2, 1), (1, 1, 0.6), (2, 3.5, 1)]
)
def test_angles_of_zero_give_the_octahedron_of_lee(side_platform, side_base, height):
    radius = 3**-0.5
    design = gsp.hexapod(side_base * radius, 0, side_platform * radius, 0, height)
    assert len({tuple(p) for p in design.base_points.tolist()}) == 3
    assert len({tuple(p) for p in design.platform_points.tolist()}) == 3
    found = abs(np.linalg.det(design.at(design.home).jacobian))
    known = lee.octahedral_3_3(side_platform, side_base)
    assert found == pytest.approx(abs(np.linalg.det(known.at(design.home).jacobian)), rel=1e-12)
    closed = lee.central_determinant(side_platform, side_base, height)
    assert found == pytest.approx(float(closed), rel=1e-12)


def test_pairs_are_the_hexagons_of_lee():
    """Joints that are separated by the share s of a side are on a circle, in pairs."""
    a, b, h = 1.2, 2.0, 0.9
    for alpha, beta in ((0.0, 0.2), (0.2, 0.0), (0.1, 0.3), (1 / 3, 0.15)):
        sizes = []
        for side, share in ((b, beta), (a, alpha)):
            radius = side * math.sqrt((3 * share * share - 3 * share + 1) / 3)
            sizes += [radius, 2 * math.asin(share * side / 2 / radius)]
        found = np.linalg.det(gsp.hexapod(*sizes, h).at(gsp.Pose([0, 0, h])).jacobian)
        assert abs(found) == pytest.approx(lee.central_determinant(a, b, h, alpha, beta), rel=1e-12)


def test_numbers_of_different_anchors():
    counts = {(0, 20): (3, 6), (20, 0): (6, 3), (0, 0): (3, 3), (60, 60): (6, 6)}
    for (beta, alpha), wanted in counts.items():
        design = gsp.hexapod(2, beta, 1, alpha, 1, degrees=True)
        sides = (design.base_points, design.platform_points)
        assert tuple(len(np.unique(points, axis=0)) for points in sides) == wanted
    regular = gsp.hexapod(2, 60, 1, 60, 1, degrees=True).base_points
    np.testing.assert_allclose(np.linalg.norm(np.diff(regular, axis=0), axis=1), 2, rtol=1e-14)


def test_zigzag_is_pairs_with_the_other_angle():
    first = gsp.hexapod(2, 25, 1, 35, 1.5, arrangement="zigzag", degrees=True)
    second = gsp.hexapod(2, 25, 1, 85, 1.5, degrees=True)
    np.testing.assert_allclose(first.platform_points, second.platform_points, atol=1e-15)


@pytest.mark.parametrize(
    ("arrangement", "beta", "alpha"), [("pairs", 50, 70), ("pairs", 0, 120), ("zigzag", 40, 40)]
)
def test_similar_hexagons_are_singular_in_every_pose(arrangement, beta, alpha):
    design = gsp.hexapod(2, beta, 1, alpha, 1.5, arrangement=arrangement, degrees=True)
    poses = gsp.PoseBox.around(design.home, [0.5] * 3 + [0.4] * 3).sample(20, rng=0)
    values = np.linalg.svd(design.at(poses).jacobian, compute_uv=False)
    assert (values[:, -1] < 1e-14 * values[:, 0]).all()
    other = gsp.hexapod(2, beta, 1, alpha - 30, 1.5, arrangement=arrangement, degrees=True)
    values = np.linalg.svd(other.at(poses).jacobian, compute_uv=False)
    assert (values[:, -1] > 1e-4 * values[:, 0]).all()


def test_degrees_strokes_and_names():
    radians = gsp.hexapod(2, np.pi / 9, 1, np.pi / 6, 1.5)
    degrees = gsp.hexapod(2, 20, 1, 30, 1.5, degrees=True, strokes=(1, 3), unit="m", name="mine")
    np.testing.assert_allclose(radians.base_points, degrees.base_points, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(degrees.strokes, [[1, 3]] * 6)
    assert (degrees.unit, degrees.name, radians.strokes) == ("m", "mine", None)
    assert degrees.home.position.tolist() == [0, 0, 1.5]
    each = gsp.hexapod(2, 0, 1, 0, 1, strokes=[[1, 2 + i] for i in range(6)])
    assert each.strokes[:, 1].tolist() == [2, 3, 4, 5, 6, 7]
    assert gsp.hexapod(2, 2 * np.pi / 3, 1, 0, 1).n_legs == 6
    assert gsp.hexapod(2, 120, 1, 0, 1, degrees=True).n_legs == 6


WRONG = {
    "no radius": ({"base_radius": 0}, InvalidInput, "base_radius: expected a positive number"),
    "radius": ({"platform_radius": -1}, InvalidInput, "platform_radius: expected a positive"),
    "height": ({"height": 0}, InvalidInput, "height: expected a positive number"),
    "negative": ({"base_angle": -0.1}, InvalidInput, r"base_angle: expected an angle in \[0, 2π/3"),
    "degrees": ({"platform_angle": 20}, InvalidInput, "platform_angle: .* need degrees=True"),
    "large": ({"base_angle": 121, "degrees": True}, InvalidInput, r"in \[0, 120\] degrees"),
    "arrangement": ({"arrangement": "star"}, InvalidInput, "arrangement: expected .*zigzag"),
    "strokes": ({"strokes": [[1, 2]] * 5}, InvalidInput, "strokes: expected shape"),
    "order": ({"strokes": (2, 1)}, InvalidDesign, "least ≤ greatest"),
}


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_the_argument(case):
    changes, kind, text = WRONG[case]
    right = {"base_radius": 2, "base_angle": 0.3, "platform_radius": 1, "platform_angle": 0.3}
    with pytest.raises(kind, match=text) as caught:
        gsp.hexapod(**{**right, "height": 1.0, **changes})
    assert isinstance(caught.value, GspError)


def test_angles_beyond_any_number_of_degrees_have_no_hint():
    with pytest.raises(InvalidInput) as caught:
        gsp.hexapod(2, 300, 1, 0, 1)
    assert "degrees" not in str(caught.value)
