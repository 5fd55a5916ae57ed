"""Designs: what they hold, which arguments are errors, and designs made from them."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidDesign, InvalidInput
from gsp.model.design import design_from_toml, toml_from_design
from tests.support import LEG_NAMES, random_design, random_pose

FIELDS = ("base_points", "platform_points", "base_directions", "platform_directions")
ANGLE = np.arange(6) * np.pi / 3
RING = np.stack((np.cos(ANGLE), np.sin(ANGLE), 0 * ANGLE), axis=1)


def hexapod(**changes):
    given = {"legs": ["D1"] * 6, "base_points": 2 * RING, "platform_points": RING}
    return gsp.Design(**{**given, **changes})


def mixed(**changes):
    return random_design(np.random.default_rng(0), LEG_NAMES).replace(**changes)


def test_names_and_units():
    design = mixed(unit="mm")
    assert design.joint_names == ("d1", "d2", "d3", "d4", "theta5", "d6", "theta6")
    assert design.joint_units == ("mm", "mm", "mm", "mm", "rad", "mm", "rad")
    assert design.mechanism.name == "D1 D2 D3 D4^2 A1^2"
    assert design.n_legs == 6
    assert repr(design) == "Design('unnamed', legs=[D1, D2, D3, D4, A1, D4 A1], unit='mm')"


@pytest.mark.parametrize("unit", [" ", "mm ", "\tmm", "\u00a0mm", "mm\n", 3, None])
def test_units_that_look_like_others_are_refused(unit):
    with pytest.raises(InvalidInput, match="unit: expected"):
        mixed(unit=unit)


def test_directions_are_units_where_there_is_a_line_and_nan_elsewhere():
    design = mixed()
    for lines, used in (
        (design.base_directions, [0, 0, 1, 1, 1, 1]),
        (design.platform_directions, [0, 1, 0, 1, 1, 1]),
    ):
        np.testing.assert_array_equal(np.isfinite(lines).all(axis=1), np.array(used, dtype=bool))
        np.testing.assert_allclose(
            np.linalg.norm(lines[np.array(used, bool)], axis=1), 1, rtol=1e-15
        )


@pytest.mark.parametrize("scale", [1e-300, 1e-200, 1e-150, 1.0, 1e150, 1e200, 1e300])
def test_directions_of_any_size(scale):
    design = mixed()
    other = design.replace(base_directions=design.base_directions * scale)
    np.testing.assert_allclose(other.base_directions, design.base_directions, rtol=1e-14)


def test_arrays_are_read_only_copies():
    points = 2 * RING
    design = hexapod(base_points=points)
    points[0, 0] = 50.0
    assert design.base_points[0, 0] == 2.0
    for name in FIELDS:
        with pytest.raises(ValueError, match="read-only"):
            getattr(design, name)[0, 0] = 1.0
    with pytest.raises(AttributeError):
        design.name = "other"


def test_legs_in_other_forms():
    assert [leg.name for leg in hexapod(legs=("D1",) * 6).legs] == ["D1"] * 6
    assert [leg.name for leg in hexapod(legs=iter(["d1"] * 6)).legs] == ["D1"] * 6
    pairs = gsp.Design([("D4", "A1")] * 3, *np.ones((2, 3, 3)), np.eye(3), np.eye(3))
    assert [leg.name for leg in pairs.legs] == ["D4 A1"] * 3


def test_redundant_legs_are_accepted():
    assert random_design(np.random.default_rng(0), ["D1"] * 9).at(
        gsp.Pose([0, 0, 2])
    ).jacobian.shape == (9, 6)


BAD = {
    "one text": ({"legs": "D1 D1 D1 D1 D1 D1"}, "legs: expected a sequence"),
    "no legs": ({"legs": None}, "legs: expected a sequence"),
    "a number of legs": ({"legs": 6}, "legs: expected a sequence"),
    "bytes": ({"legs": b"D1D1D1"}, "legs: expected a sequence"),
    "unknown leg": ({"legs": ["D1"] * 5 + ["D7"]}, r"legs\[5\]: expected one of 'D1'.*'D7'"),
    "empty leg": ({"legs": ["D1"] * 5 + [""]}, r"legs\[5\]: expected one of"),
    "none leg": ({"legs": [None] * 6}, r"legs\[0\]: expected one of"),
    "number leg": ({"legs": [1] * 6}, r"legs\[0\]: expected one of"),
    "too few": ({"legs": ["D1"] * 5}, "legs: expected at least six constraints, received 5"),
    "none at all": ({"legs": []}, "legs: expected at least six constraints, received 0"),
    "too few points": ({"base_points": RING[:5]}, r"base_points: expected shape .*6, 3.*\(5, 3\)"),
    "flat points": ({"base_points": RING.ravel()}, "base_points: expected shape"),
    "points of points": ({"base_points": RING[None]}, r"base_points: expected shape \(6, 3\)"),
    "transposed": ({"platform_points": RING.T}, "platform_points: expected shape"),
    "nan point": ({"platform_points": RING * [1, np.nan, 1]}, r"platform_points .*\[0, 1\]"),
    "inf point": ({"base_points": RING + np.inf}, "base_points .*expected finite"),
    "text points": ({"base_points": "RING"}, "base_points: expected real numbers"),
    "texts as points": ({"base_points": RING.astype(str)}, "base_points: expected real numbers"),
    "complex": ({"base_points": RING + 0j}, "base_points: expected real numbers"),
    "booleans": ({"base_points": RING > 0}, "base_points: expected real numbers"),
    "ragged": ({"base_points": [[1, 2, 3]] * 5 + [[1]]}, "base_points: expected real numbers"),
    "none": ({"base_points": None}, "base_points: expected real numbers"),
    "objects": ({"base_points": np.full((6, 3), None)}, "base_points: expected real numbers"),
    "no line": ({"legs": ["D3"] * 6}, r"base_directions\[0\]: expected a direction, as"),
    "no platform line": ({"legs": ["D1"] * 5 + ["D2"]}, r"platform_directions\[5\]: expected"),
    "zero line": (
        {"legs": ["D3"] * 6, "base_directions": np.zeros((6, 3))},
        r"base_directions\[0\]: expected a finite direction other than zero",
    ),
    "nan line": (
        {"legs": ["D1"] * 5 + ["D3"], "base_directions": np.full((6, 3), np.nan)},
        r"base_directions\[5\]: expected a finite direction",
    ),
    "inf line": (
        {"legs": ["D3"] * 6, "base_directions": np.full((6, 3), np.inf)},
        r"base_directions\[0\]: expected a finite direction",
    ),
    "line of two": (
        {"legs": ["D3"] * 6, "base_directions": RING[:, :2]}, "base_directions: expected",
    ),
    "lines of lines": (
        {"legs": ["D3"] * 6, "base_directions": RING[None]}, "base_directions: expected shape",
    ),
    "unit": ({"unit": 5}, "unit: expected a text"),
    "no name": ({"name": None}, "name: expected a text"),
    "source": ({"source": b"paper"}, "source: expected a text"),
    "length": ({"characteristic_length": -1.0}, "characteristic_length: expected a positive"),
    "nan length": ({"characteristic_length": np.nan}, "characteristic_length: expected a positive"),
    "text length": ({"characteristic_length": "95"}, "characteristic_length: expected a positive"),
    "huge length": ({"characteristic_length": 1e200}, "expected a positive number from 1e-100"),
    "ellipsoid": ({"ellipsoid": [1, 2, 3]}, r"ellipsoid: expected a gsp\.Ellipsoid or None"),
    "home": ({"home": [0, 0, 1]}, r"home: expected a single Pose or None"),
    "homes": ({"home": gsp.Pose(np.zeros((2, 3)))}, r"home: expected a single Pose"),
    "strokes": ({"strokes": np.ones((5, 2))}, "strokes: expected shape"),
    "strokes reversed": ({"strokes": [[2, 1]] * 6}, "strokes: expected .*least ≤ greatest"),
    "strokes text": ({"strokes": "long"}, "strokes: expected real numbers"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_designs(name):
    given, message = BAD[name]
    with pytest.raises(InvalidInput, match=message):
        hexapod(**given)


@pytest.mark.parametrize(
    "name", ["unknown leg", "too few", "no line", "zero line", "strokes reversed"]
)
def test_bad_designs_are_invalid_designs(name):
    with pytest.raises(InvalidDesign):
        hexapod(**BAD[name][0])


@pytest.mark.parametrize("pose", [None, [0, 0, 1], np.eye(4), "pose", gsp.Pose], ids=repr)
def test_at_needs_a_pose(pose):
    with pytest.raises(InvalidInput, match=r"pose: expected a gsp\.Pose, received"):
        hexapod().at(pose)


def assert_same(one, two, skip=()):
    assert [leg.name for leg in one.legs] == [leg.name for leg in two.legs]
    for name in (*FIELDS, "strokes"):
        if name not in skip:
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    for name in ("unit", "name", "source", "characteristic_length"):
        if name not in skip:
            assert getattr(one, name) == getattr(two, name)


def test_replace():
    design = mixed(name="x", strokes=np.arange(14.0).reshape(7, 2))
    assert_same(design.replace(), design)
    assert_same(design.replace(name="y"), design, skip=("name",))
    assert design.replace(name="y").name == "y"
    with pytest.raises(
        InvalidInput,
        match=r"Design.replace, keyword argument: expected one of legs, .*received colour",
    ):
        design.replace(colour="red")
    with pytest.raises(InvalidInput, match="strokes"):
        design.replace(legs=["D1"] * 6)


def test_scaled():
    design = mixed(
        strokes=np.arange(14.0).reshape(7, 2),
        characteristic_length=3.0,
        ellipsoid=gsp.Ellipsoid([1, 2, 3], [1, 0, 0]),
        home=gsp.Pose([0, 0, 2]),
    )
    other, pose = design.scaled(10.0), random_pose(np.random.default_rng(1))
    there = gsp.Pose(10.0 * pose.position, pose.rotation)
    factor = np.where(design.at(pose).angular, 1.0, 10.0)
    np.testing.assert_allclose(other.at(there).joints, factor * design.at(pose).joints, rtol=1e-13)
    np.testing.assert_allclose(other.strokes, factor[:, None] * design.strokes)
    assert (other.characteristic_length, other.home.position[2]) == (30.0, 20.0)
    np.testing.assert_allclose(other.ellipsoid.vertices, 10 * design.ellipsoid.vertices)
    assert other.rms_radius == pytest.approx(10 * design.rms_radius)
    for bad in (0, -1, np.nan, "2", None):
        with pytest.raises(InvalidInput, match="factor: expected a positive number"):
            design.scaled(bad)


def test_exchanged():
    design, pose = mixed(home=gsp.Pose([0, 0, 2])), random_pose(np.random.default_rng(1), (4,))
    other = design.exchanged()
    assert [leg.name for leg in other.legs] == ["D1", "D3", "D2", "D4", "A1", "D4 A1"]
    assert other.mechanism == design.mechanism.exchanged()
    np.testing.assert_allclose(other.at(pose.inverse()).joints, design.at(pose).joints, rtol=1e-12)
    np.testing.assert_array_equal(other.home.position, [0, 0, -2])
    assert_same(other.exchanged(), design)


def test_rms_radius():
    assert hexapod().rms_radius == pytest.approx(np.sqrt((4 + 1) / 2))
    at_origin = gsp.Design(["D4 A1"] * 3, np.zeros((3, 3)), np.zeros((3, 3)), np.eye(3), np.eye(3))
    assert at_origin.rms_radius == 1.0
    away = at_origin.replace(platform_points=np.full((3, 3), 0.1), base_points=np.full((3, 3), 0.7))
    assert away.rms_radius == 1.0
    posture = at_origin.at(gsp.Pose.from_rpy([0.1, 0.2, 0.3], [0.2, 0.3, 0.4]))
    assert not posture.singular()
    assert gsp.evaluate(at_origin, posture.pose).notna().all(axis=None)


def test_strokes_of_no_limit_are_none():
    assert hexapod(strokes=np.full((6, 2), np.nan)).strokes is None
    assert hexapod(strokes=[[np.nan, 1.0]] * 6).strokes.shape == (6, 2)


def test_rms_radius_and_singular_do_not_depend_on_the_origins_of_the_frames():
    design, pose = mixed(), random_pose(np.random.default_rng(1), (5,))
    a, b = np.array([30.0, -20.0, 10.0]), np.array([-5.0, 40.0, 7.0])
    moved = design.replace(
        base_points=design.base_points + a, platform_points=design.platform_points + b
    )
    there = gsp.Pose(pose.position + a - pose.rotation @ b, pose.rotation)
    assert moved.rms_radius == pytest.approx(design.rms_radius, rel=1e-12)
    np.testing.assert_allclose(moved.at(there).joints, design.at(pose).joints, rtol=1e-10)
    np.testing.assert_array_equal(moved.at(there).singular(), design.at(pose).singular())


def test_rows_and_angular_name_leg_and_constraint_of_each_row():
    design = mixed()
    names = [(row.leg, row.constraint.name) for row in design.rows]
    assert names == [(0, "D1"), (1, "D2"), (2, "D3"), (3, "D4"), (4, "A1"), (5, "D4"), (5, "A1")]
    assert design.angular.tolist() == [name == "A1" for _, name in names]
    with pytest.raises(ValueError, match="read-only"):
        design.angular[0] = True


@pytest.mark.parametrize("key", ["base_points", "platform_points"])
@pytest.mark.parametrize("factor", [1e101, 1e200, 1e308])
def test_lengths_whose_squares_overflow_are_errors(key, factor):
    with pytest.raises(InvalidInput, match=f"{key}: expected coordinates of at most 1e\\+100"):
        hexapod(**{key: factor * RING / 2})


@pytest.mark.parametrize("factor", [1e-101, 1e-200, 1e-308])
def test_lengths_whose_squares_vanish_are_errors(factor):
    with pytest.raises(InvalidInput, match="expected a coordinate of at least 1e-100"):
        hexapod(base_points=factor * RING, platform_points=factor * RING)


@pytest.mark.parametrize("factor", [1e-97, 1e97])
def test_within_these_bounds_values_scale(factor):
    design, pose = mixed(), random_pose(np.random.default_rng(1), (5,))
    scaled = design.scaled(factor).at(pose.scaled(factor))
    units = np.where(design.angular, 1.0, factor)
    np.testing.assert_allclose(scaled.joints, design.at(pose).joints * units, rtol=1e-12)
    np.testing.assert_allclose(
        gsp.indices.condition_number(scaled, factor),
        gsp.indices.condition_number(design.at(pose), 1.0),
        rtol=1e-9,
    )


def test_a_body_in_one_point_at_the_origin_is_a_design():
    assert hexapod(platform_points=np.zeros((6, 3))).n_legs == 6


@pytest.mark.parametrize("kind", [gsp.Design, gsp.planar.PlanarDesign])
def test_an_unknown_keyword_is_said_of_the_class_that_is_called(kind):
    with pytest.raises(TypeError, match=rf"^{kind.__name__}\.__init__\(\) got an unexpected"):
        kind(["D1"] * 6, np.zeros((6, 3)), np.ones((6, 3)), strokse=1.0)


def test_legs_are_taken_as_records():
    given = hexapod()
    again = gsp.Design(given.legs, given.base_points, given.platform_points)
    assert again.legs == given.legs
    flat = gsp.planar.PlanarDesign(["D1"] * 3, np.eye(3, 2), 2 * np.eye(3, 2))
    assert flat.replace(legs=flat.legs).legs == flat.legs
    with pytest.raises(InvalidDesign, match=r"legs\[0\]: expected one of 'D1'"):
        gsp.Design(flat.legs, np.eye(3), np.eye(3))


@pytest.mark.parametrize("pair", [(-1.0, 2.0), (-2.0, -1.0), (np.nan, -1.0), (-np.inf, -1.0)])
def test_no_stroke_of_a_distance_is_below_zero(pair):
    """In a design and in limits; angles and −∞, which bounds nothing, are accepted."""
    strokes = [(1.0, 2.0)] * 3 + [pair] + [(1.0, 2.0)] * 2
    with pytest.raises(InvalidDesign, match=r"strokes\[3\]: expected bounds ≥ 0"):
        hexapod(strokes=strokes)
    with pytest.raises(InvalidInput, match=r"limits\.strokes\[3\]: expected bounds ≥ 0"):
        gsp.feasible(hexapod(), gsp.Pose([0, 0, 1]), gsp.Limits(strokes=strokes))
    mixed = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    angles = np.where(mixed.angular[:, None], pair, np.nan)
    assert (mixed.replace(strokes=angles).strokes[mixed.angular] == pair)[:, 1].all()
    assert hexapod(strokes=[(-np.inf, 2.0)] * 6).strokes.shape == (6, 2)


@pytest.mark.parametrize("pair", [(np.inf, np.inf), (np.nan, -np.inf), (np.inf, np.nan)])
def test_bounds_that_no_number_meets_are_refused(pair):
    """In a design and in limits; [-inf, inf] and NaN are no bounds."""
    strokes = [(1.0, 2.0)] * 5 + [pair]
    with pytest.raises(InvalidDesign, match=r"strokes\[5\]: expected least < ∞"):
        hexapod(strokes=strokes)
    with pytest.raises(InvalidInput, match=r"limits of joint 6: expected least < ∞"):
        gsp.Limits(strokes=strokes)


@pytest.mark.parametrize("far", [1.001e100, 1e308])
def test_strokes_and_positions_have_the_range_of_lengths(far):
    """Their squares overflow beyond it: a shell of 1e308 had the volume 0."""
    strokes, refused = [(1.0, 2.0)] * 5 + [(0.0, far)], "expected numbers of at most 1e\\+100"
    position = [None, None, (0.0, far)]
    home = gsp.catalogue.design("workspace-6-3").home
    text = toml_from_design(gsp.hexapod(2, 0.3, 1, 0.3, 1.5, strokes=(1, 2)))
    for call in (
        lambda: hexapod(strokes=strokes),
        lambda: gsp.Limits(strokes=strokes),
        lambda: gsp.Limits(position=position),
        lambda: gsp.hexapod(2, 0.3, 1, 0.3, 1.5, strokes=(0.0, far)),
        lambda: gsp.travel(hexapod(), home, [0, 0, 1, 0, 0, 0], strokes=strokes),
        lambda: design_from_toml(text.replace("[1.0, 2.0]", f"[1.0, {far!r}]"), "text"),
        lambda: gsp.workspace.Shells(np.zeros((1, 3)), [0.0], [far]),
        lambda: gsp.workspace.Shells([[far, 0.0, 0.0]], [0.0], [1.0]),
        lambda: gsp.planar.PlanarDesign(
            ["D1"] * 3, np.eye(3, 2), 2 * np.eye(3, 2), strokes=strokes[-3:]
        ),
    ):
        with pytest.raises(InvalidInput, match=refused):
            call()
    open_ends = [(-np.inf, np.inf)] * 5 + [(1.0, 1e100)]
    assert hexapod(strokes=open_ends).strokes.tolist() == [list(pair) for pair in open_ends]


@pytest.mark.parametrize("length", [1e-155, 1e155, 0.0, -1.0, np.inf, "1"])
def test_a_characteristic_length_has_one_range_everywhere(length):
    """Beyond it the columns of a table were 0 where the index of one pose was not."""
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    posture = design.at(design.home)
    line = gsp.sweeps.translation(design.home, [0.0, 0.0, 1.0], [0.0, 1.0])
    calls = (
        lambda: gsp.indices.control_number(posture, length),
        lambda: gsp.indices.singularity_distance(posture, length),
        lambda: posture.homogeneous(length),
        lambda: posture.singular_values(length),
        lambda: gsp.evaluate(design, design.home, ["CTN"], length=length),
        lambda: gsp.rank([design], design.home, ["CTN"], length=length),
        lambda: gsp.prepare(design, "CTN", length=length),
        lambda: gsp.Limits(length=length),
        lambda: gsp.sweeps.sweep(design, line, ["CTN"], length=length),
    )
    for call in calls:
        with pytest.raises(InvalidInput, match="length: expected"):
            call()
