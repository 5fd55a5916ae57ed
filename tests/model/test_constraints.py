"""The five constraints: values, rows, printed formulas, and where they do not exist."""

import numpy as np
import pytest

import gsp
from gsp.geometry.vectors import cross
from gsp.model.constraints import CONSTRAINT, CONSTRAINTS
from gsp.planar.constraints import PLANAR_CONSTRAINT
from tests.support import derivative, random_design, random_pose

SHAPES = [(), (1,), (3, 1, 2)]
SIX = {name: ("D1",) * 5 + (name,) for name in CONSTRAINT}


def last_row(name, seed, shape=()):
    """Value and row of one constraint at random geometry, with its d, R b, s and R t."""
    rng = np.random.default_rng(seed)
    design, pose = random_design(rng, SIX[name]), random_pose(rng, shape)
    posture = design.at(pose)
    geometry = {k: getattr(posture.lines, k)[..., 5, :] for k in ("d", "arm", "s", "t")}
    return posture.joints[..., 5], posture.jacobian[..., 5, :], geometry, design, pose


def test_table():
    assert [c.name for c in CONSTRAINTS] == ["D1", "D2", "D3", "D4", "A1"]
    assert list(CONSTRAINT) == [c.name for c in CONSTRAINTS]
    with pytest.raises(TypeError):
        CONSTRAINT["D5"] = CONSTRAINTS[0]


@pytest.mark.parametrize("table", [CONSTRAINT, PLANAR_CONSTRAINT], ids=["space", "plane"])
def test_an_exchange_swaps_the_primitives_and_keeps_the_quantity(table):
    for one in table.values():
        other = table[one.exchanged]
        swapped = other.platform, other.base, other.quantity, other.exchanged
        assert swapped == (one.base, one.platform, one.quantity, one.name)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", CONSTRAINT)
def test_row_is_the_gradient_of_the_value(name, shape):
    for seed in range(8):
        _, row, _, design, pose = last_row(name, seed, shape)
        assert row.shape == (*shape, 6)
        slope = derivative(lambda q, d=design: d.at(q).joints[..., 5], pose)
        np.testing.assert_allclose(row, slope, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", CONSTRAINT)
def test_value_by_its_geometric_meaning(name):
    """Least distance of point or line from point or line, by minimisation; angle by its cosine."""
    for seed in range(8):
        value, _, g, _, _ = last_row(name, seed)
        d, s, t = g["d"], g["s"], g["t"]
        if name == "A1":
            np.testing.assert_allclose(np.cos(value), s @ t, atol=1e-14)
            assert 0.0 < value < np.pi
            continue
        free = {"D1": [], "D2": [t], "D3": [s], "D4": [s, t]}[name]
        if free:
            along = np.array(free).T
            d = d - along @ np.linalg.lstsq(along, d, rcond=None)[0]
        np.testing.assert_allclose(value, np.linalg.norm(d), rtol=1e-13)


# The formulas (12)–(16) of TozKucuk2016, term by term as printed. d is P + R b − a.


def eq_12(d, arm, s, t, value, p_minus_a):
    return np.concatenate((d, np.cross(arm, d))) / value


def eq_13(d, arm, s, t, value, p_minus_a):
    linear = np.cross(t, np.cross(d, t))
    angular = (p_minus_a @ t) * np.cross(d, t) + (np.cross(d, t) @ arm) * t
    return np.concatenate((linear, angular)) / value


def eq_14(d, arm, s, t, value, p_minus_a):
    """With the bracket that is missing in print closed after × s: ((d × s) × s) × R b."""
    linear = np.cross(s, np.cross(d, s))
    return np.concatenate((linear, np.cross(np.cross(np.cross(d, s), s), arm))) / value


def eq_14_without_the_bracket(d, arm, s, t, value, p_minus_a):
    linear = np.cross(s, np.cross(d, s))
    return np.concatenate((linear, np.cross(np.cross(d, s), arm))) / value


def eq_15(d, arm, s, t, value, p_minus_a):
    n = np.cross(t, s)
    dn = d @ n
    linear = dn * n
    angular = dn * ((arm @ s) * t - (arm @ t) * s)
    angular = angular + dn * (-(s @ t) * d)
    angular = angular + dn * ((d @ t) * s)
    angular = angular - value**2 * (-(s @ t) * n + (n @ t) * s)
    return np.concatenate((linear, angular)) / (value * (n @ n))


def eq_16(d, arm, s, t, value, p_minus_a):
    return np.concatenate((np.zeros(3), np.cross(t, s))) / -np.sin(value)


PRINTED = {"D1": eq_12, "D2": eq_13, "D3": eq_14, "D4": eq_15, "A1": eq_16}


def printed_row(formula, name, seed):
    value, row, g, design, pose = last_row(name, seed)
    p_minus_a = pose.position - design.base_points[5]
    return formula(g["d"], g["arm"], g["s"], g["t"], value, p_minus_a), row


@pytest.mark.parametrize("name", PRINTED)
def test_printed_formulas(name):
    for seed in range(20):
        printed, row = printed_row(PRINTED[name], name, seed)
        np.testing.assert_allclose(printed, row, rtol=1e-11, atol=1e-12)


def test_eq_14_needs_the_bracket():
    for seed in range(20):
        printed, row = printed_row(eq_14_without_the_bracket, "D3", seed)
        assert np.abs(printed - row).max() > 1e-2


def d4_at_zero_distance():
    """Two lines that meet at a right turn, for leg 6."""
    rng = np.random.default_rng(5)
    design, pose = random_design(rng, SIX["D4"]), random_pose(rng)
    s = design.base_directions[5]
    meeting = design.base_points[5] + 0.7 * s
    arm = pose.rotation.T @ (meeting - pose.position)
    t = design.platform_directions[5]
    points = design.platform_points.copy()
    points[5] = arm - 0.4 * t
    return design.replace(platform_points=points), pose


def test_d4_of_meeting_lines_has_a_row():
    design, pose = d4_at_zero_distance()
    posture = design.at(pose)
    normal = np.cross(posture.lines.t[5], posture.lines.s[5])
    normal /= np.linalg.norm(normal)
    assert posture.joints[5] == pytest.approx(0.0, abs=1e-15)
    sign = np.sign(posture.jacobian[5, :3] @ normal)
    slope = derivative(lambda q: np.sign(_offset(design, q)) * design.at(q).joints[5], pose)
    np.testing.assert_allclose(sign * posture.jacobian[5], slope, atol=1e-9)
    assert posture.undefined == ()


def _offset(design, pose):
    lines = design.at(pose).lines
    return lines.d[5] @ cross(lines.t[5], lines.s[5])


def test_d4_at_exactly_zero_takes_plus_t_cross_s():
    x, y, z = np.eye(3)
    design = gsp.Design(
        ["D1"] * 5 + ["D4"],
        np.zeros((6, 3)),
        np.zeros((6, 3)),
        np.tile(x, (6, 1)),
        np.tile(y, (6, 1)),
    )
    posture = design.at(gsp.Pose([0.0, 0.0, 0.0]))
    assert posture.joints[5] == 0.0
    np.testing.assert_array_equal(posture.jacobian[5], np.concatenate((np.cross(y, x), 0 * z)))
    assert [u.joint for u in posture.undefined] == ["d1", "d2", "d3", "d4", "d5"]


def undefined_leg(name):
    """Leg 6 at a pose where its constraint does not exist (for A1 and D4: parallel lines)."""
    rng = np.random.default_rng(7)
    design, pose = random_design(rng, SIX[name]), random_pose(rng)
    a, s = design.base_points[5].copy(), design.base_directions[5]
    points, lines = design.platform_points.copy(), design.platform_directions.copy()
    back = pose.rotation.T
    if name == "D1":
        points[5] = back @ (a - pose.position)
    elif name == "D2":
        points[5] = back @ (a - pose.position) + 0.3 * lines[5]
    elif name == "D3":
        points[5] = back @ (a + 0.6 * s - pose.position)
    else:
        lines[5] = -back @ s
    if name in ("D1", "D3"):
        lines = None
    return design.replace(platform_points=points, platform_directions=lines), pose


@pytest.mark.parametrize("name", CONSTRAINT)
def test_undefined_is_nan_with_its_reason(name):
    design, pose = undefined_leg(name)
    posture = design.at(pose)
    assert np.isnan(posture.joints[5])
    assert np.isnan(posture.jacobian[5]).all()
    assert np.isfinite(posture.joints[:5]).all()
    assert np.isfinite(posture.jacobian[:5]).all()
    ((where, joint, reason),) = posture.undefined
    assert (where, joint) == ((), posture.joint_names[5])
    assert reason == CONSTRAINT[name].undefined
    with pytest.raises(gsp.errors.UndefinedPosture, match=f"{joint} .*{reason}"):
        posture.check_defined()


@pytest.mark.parametrize("name", CONSTRAINT)
def test_near_the_undefined_the_row_exists(name):
    """Just off the bad pose everything is finite again: NaN is not spread further than it must."""
    design, pose = undefined_leg(name)
    near = gsp.Pose(pose.position + 1e-12, pose.rotation)
    if name in ("D4", "A1"):
        tilt = gsp.Pose.from_rpy([0, 0, 0], [1e-12, 1e-12, -1e-12])
        near = gsp.Pose(pose.position, tilt.rotation @ pose.rotation)
    assert design.at(near).undefined == ()
    assert np.isfinite(design.at(near).jacobian).all()
