"""Frames, reference points and screw motions against Pinocchio, 50 digits, and each other."""

import mpmath
import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.errors import InvalidInput, InvalidRotation
from gsp.geometry import (
    Placement,
    Pose,
    act_jacobian,
    act_twist,
    act_wrench,
    action_matrix,
    angles_from_rotation,
    compose,
    dual_action_matrix,
    exp3,
    exp6,
    force,
    frame,
    interpolate,
    inverse,
    jacobian_at,
    log3,
    log6,
    motion,
    placement_of,
    rotation_from_angles,
    se3,
    twist_at,
    wrench_at,
)
from gsp.geometry.frames.screws import exp3_rates

RNG = np.random.default_rng(10)
ANGLES = (0.0, 1e-300, 1e-16, 1e-12, 1e-8, 1e-5, 1e-3, 0.0999, 0.1001, 0.5, 2.0, 3.0,
          np.pi - 1e-3, np.pi - 1e-6, np.pi - 1e-9)  # fmt: skip
LENGTHS = (0.0, 1e-12, 1.0, 1e12)


def vectors(sizes, rng=RNG):
    """One vector of each size in random directions."""
    raw = rng.normal(size=(len(sizes), 3))
    return np.asarray(sizes)[:, None] * raw / np.linalg.norm(raw, axis=1, keepdims=True)


OMEGA = np.concatenate((vectors(ANGLES), RNG.normal(size=(40, 3))))
TWISTS = np.array([(*v, *w) for w in OMEGA for v in vectors(LENGTHS)])
POSES = Pose(
    np.concatenate((TWISTS[:, :3], np.zeros((4, 3)))),
    np.concatenate(
        (
            exp3(TWISTS[:, 3:]),
            [np.eye(3)],
            [np.diag(d) for d in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1))],
        )
    ),
)


def close(one, other, rtol=1e-13, atol=0.0):
    np.testing.assert_allclose(one, other, rtol=rtol, atol=atol)


def relative(one, other, axis):
    """Largest difference of vectors as a share of the largest entry of the second."""
    size = np.abs(other).max(axis=axis, keepdims=True)
    return float((np.abs(one - other) / np.where(size > 0.0, size, 1.0)).max())


# --- exponentials and logarithms ---


def test_exp3_and_log3_are_those_of_pinocchio():
    turns = exp3(OMEGA)
    close(turns, [pin.exp3(w) for w in OMEGA], atol=4e-16)
    close(log3(turns), [pin.log3(r) for r in turns], rtol=1e-8, atol=1e-15)
    assert relative(log3(turns), OMEGA, 1) < 1e-14


def test_exp6_is_that_of_pinocchio():
    found = exp6(TWISTS)
    theirs = [pin.exp6(pin.Motion(t)) for t in TWISTS]
    close(found.rotation, [m.rotation for m in theirs], atol=4e-16)
    assert relative(found.position, np.array([m.translation for m in theirs]), 1) < 1e-14


def test_log6_is_that_of_pinocchio_and_inverts_exp6():
    placed = Placement(*exp6(TWISTS))
    theirs = np.array([pin.log6(m).vector for m in se3(placed)])
    found = log6(placed)
    # Pinocchio's angle has half of the digits near a half turn, and so have its translations.
    assert relative(found[:, :3], theirs[:, :3], 1) < 1e-6
    assert relative(found[:, 3:], theirs[:, 3:], 1) < 1e-6
    assert relative(found[:, 3:], TWISTS[:, 3:], 1) < 1e-14
    assert relative(found[:, :3], TWISTS[:, :3], 1) < 1e-13


@pytest.mark.parametrize("angle", ANGLES)
def test_exp6_has_all_digits(angle):
    """Against the matrix exponential with 60 digits."""
    twist = np.concatenate((RNG.normal(size=3), vectors([angle])[0]))
    with mpmath.workdps(60):
        x, y, z = (mpmath.mpf(float(t)) for t in twist[3:])
        k = mpmath.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        whole = mpmath.zeros(4)
        for i in range(3):
            whole[i, 3] = mpmath.mpf(float(twist[i]))
            for j in range(3):
                whole[i, j] = k[i, j]
        exact = mpmath.expm(whole, method="taylor")
        expected = np.array([[float(exact[i, j]) for j in range(4)] for i in range(3)])
    found = exp6(twist)
    close(found.position, expected[:, 3], rtol=0.0, atol=1e-15 * np.abs(twist[:3]).max() * 4)
    close(found.rotation, expected[:, :3], rtol=0.0, atol=4e-16)
    small = np.abs(expected[:, :3] - np.eye(3)) < 0.01
    off = ~np.eye(3, dtype=bool) & small & (expected[:, :3] != 0.0)
    if angle < 1e-3:  # tiny entries keep their relative digits, as those of a rotation vector
        antisymmetric = 0.5 * (found.rotation - found.rotation.T)[off]
        close(antisymmetric, 0.5 * (expected[:, :3] - expected[:, :3].T)[off], rtol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-300, 1e-160, 1e-8, 1e-3, 0.0999999, 0.1, 0.5, 2.0, 3.1])
@pytest.mark.parametrize("turns", [0, 1, 5], ids=["no turn", "one turn", "5 turns"])
def test_exp3_rates_have_all_digits(angle, turns):
    """Against the integral of exp(s [φ]×) over s from 0 to 1, whose series is summed exactly."""
    vector = (angle + 2.0 * np.pi * turns) * np.array([0.6, -0.48, 0.64])
    with mpmath.workdps(180):
        x, y, z = (mpmath.mpf(float(t)) for t in vector)
        k = mpmath.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        term, total = mpmath.eye(3), mpmath.eye(3)
        for n in range(2, 900):
            term = term * k / n
            total += term
            if mpmath.mnorm(term) < mpmath.mpf(10) ** -40:
                break
        exact = np.array([[float(total[i, j]) for j in range(3)] for i in range(3)])
    found = exp3_rates(vector)
    close(found, exact, rtol=0.0, atol=4e-16)
    if angle < 1e-3 and not turns:  # small entries keep their relative digits
        close(found - found.T, exact - exact.T, rtol=1e-12)


def test_exp3_rates_are_the_derivative_of_exp3():
    points = np.random.default_rng(5).normal(size=(40, 3))
    step = 1e-6 * np.eye(3)
    ahead, behind = exp3(points[:, None] + step), exp3(points[:, None] - step)
    omega = log3(ahead @ np.swapaxes(behind, -1, -2)) / 2e-6  # angular velocity for each component
    close(np.swapaxes(omega, -1, -2), exp3_rates(points), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("axis", [*np.eye(3), np.array([0.6, 0.0, -0.8])])
def test_half_turns_have_either_sign(axis):
    turn = 2.0 * np.outer(axis, axis) - np.eye(3)
    vector = log3(turn)
    assert np.linalg.norm(vector) == pytest.approx(np.pi, rel=1e-15)
    close(exp3(vector), turn, atol=1e-15)
    assert min(np.abs(vector - s * np.pi * axis).max() for s in (1, -1)) < 1e-15
    for length in LENGTHS:
        place = Placement(length * np.array([1.0, 2.0, 3.0]), turn)
        again = exp6(log6(place))
        close(again.position, place.position, atol=4e-15 * length)
        close(again.rotation, turn, atol=1e-15)


def test_interpolation_is_that_of_pinocchio():
    one, two = POSES[:-4], POSES[:-4][::-1]
    share = np.random.default_rng(3).uniform(-0.5, 1.5, one.size)  # the same in any order of tests
    found = interpolate(one, two, share)
    theirs = [
        pin.SE3.Interpolate(a, b, t)
        for a, b, t in zip(one.to_se3(), two.to_se3(), share, strict=True)
    ]
    # Where the angle between two poses is near π the digits of Pinocchio are fewer.
    between = np.linalg.norm(log3(np.swapaxes(one.rotation, -1, -2) @ two.rotation), axis=1)
    fine = between < np.pi - 1e-2
    close(found.rotation[fine], np.array([m.rotation for m in theirs])[fine], atol=1e-13)
    ours, other = found.position[fine], np.array([m.translation for m in theirs])[fine]
    size = np.maximum(np.abs(one.position), np.abs(two.position)).max(axis=1)[fine]
    assert (np.abs(ours - other).max(axis=1) <= 1e-13 * size).all()


def test_interpolation_ends_and_middle():
    one, two = Pose.exp(RNG.normal(size=(30, 6))), Pose.exp(RNG.normal(size=(30, 6)))
    close(one.interpolate(two, 0.0).position, one.position, atol=1e-14)
    close(one.interpolate(two, 1.0).position, two.position, atol=1e-14)
    close(one.interpolate(two, 1.0).rotation, two.rotation, atol=1e-14)
    step = one.inverse().compose(one.interpolate(two, 0.25))
    close(
        step.compose(step).compose(step).compose(step).position,
        one.inverse().compose(two).position,
        atol=1e-14,
    )
    assert one.interpolate(two[:1], [[0.2], [0.7]]).shape == (2, 30)


def test_rpy_is_that_of_pinocchio():
    angles = np.concatenate((RNG.uniform(-3.0, 3.0, (50, 3)) * [1, 0.5, 1],
                             [[0, 0, 0], [1e-9, -1e-12, 1e-300], [3.1, 1.5, -3.1]]))  # fmt: skip
    turns = rotation_from_angles(angles)
    close(turns, [pin.rpy.rpyToMatrix(a) for a in angles], atol=4e-16)
    close(angles_from_rotation(turns), [pin.rpy.matrixToRpy(r) for r in turns], atol=1e-14)
    for pitch in (np.pi / 2, -np.pi / 2):  # only a sum of the other two is defined there
        turn = pin.rpy.rpyToMatrix(np.array([0.3, pitch, 0.7]))
        close(rotation_from_angles(angles_from_rotation(turn)), turn, atol=1e-15)


# --- frames and reference points ---


def test_actions_are_those_of_pinocchio():
    spatial = RNG.normal(size=(POSES.size, 6))
    placements = POSES.to_se3()
    pairs = list(zip(placements, spatial, strict=True))
    close(action_matrix(POSES), [m.action for m in placements], atol=1e-15)
    close(dual_action_matrix(POSES), [m.toDualActionMatrix() for m in placements], atol=1e-15)
    size = 1.0 + np.abs(POSES.position).max(axis=1)[:, None]
    twists = np.array([m.act(pin.Motion(x)).vector for m, x in pairs])
    close(act_twist(POSES, spatial) / size, twists / size, atol=1e-14)
    wrenches = np.array([m.act(pin.Force(x)).vector for m, x in pairs])
    close(act_wrench(POSES, spatial) / size, wrenches / size, atol=1e-14)
    back = np.array([m.actInv(pin.Motion(x)).vector for m, x in pairs])
    close(act_twist(POSES.inverse(), spatial) / size, back / size, atol=1e-14)


def test_composition_and_inverse_are_those_of_pinocchio():
    one, two = POSES.to_se3(), POSES[::-1].to_se3()
    product = compose(POSES, POSES[::-1])
    size = 1e-15 * (1.0 + np.abs(POSES.position) + np.abs(POSES.position[::-1])).max(axis=1)
    theirs = np.array([(a * b).translation for a, b in zip(one, two, strict=True)])
    assert (np.abs(product.position - theirs).max(axis=1) <= 4 * size).all()
    close(product.rotation, [(a * b).rotation for a, b in zip(one, two, strict=True)], atol=1e-15)
    back = inverse(POSES)
    close(back.rotation, [a.inverse().rotation for a in one])
    close(back.position, [a.inverse().translation for a in one], rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("far", [0.0, 1e-9, 1.0, 1e9])
def test_reference_points(far):
    """Power and rates stay, and Pinocchio's pure translations do the same."""
    r = far * RNG.normal(size=3)
    twist, wrench, rows = RNG.normal(size=6), RNG.normal(size=6), RNG.normal(size=(7, 6))
    size = 1.0 + far
    shift = pin.SE3(np.eye(3), -r)
    close(twist_at(twist, r) / size, shift.act(pin.Motion(twist)).vector / size, atol=1e-15)
    close(wrench_at(wrench, r) / size, shift.act(pin.Force(wrench)).vector / size, atol=1e-15)
    power = twist_at(twist, r) @ wrench_at(wrench, r)
    assert power == pytest.approx(twist @ wrench, abs=1e-14 * size**2)
    close(jacobian_at(rows, r) @ twist_at(twist, r), rows @ twist, atol=1e-14 * size**2)
    close(jacobian_at(jacobian_at(rows, r), -r), rows, atol=1e-14 * size)
    place = Pose.exp(RNG.normal(size=6))
    close(act_jacobian(place, rows) @ act_twist(place, twist), rows @ twist, atol=1e-13)


def test_jacobian_of_a_design_about_a_point_of_its_platform():
    """A design whose platform frame lies at the point has that Jacobian."""
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    point = np.array([12.0, -7.0, 30.0])
    moved = gsp.Design(
        [leg.name for leg in design.legs],
        design.base_points,
        design.platform_points - point,
        base_directions=design.base_directions,
        platform_directions=design.platform_directions,
    )
    pose = design.home
    there = moved.at(Pose(pose.position + pose.rotation @ point, pose.rotation))
    found = jacobian_at(design.at(pose).jacobian, pose.rotation @ point)
    close(found, there.jacobian, rtol=1e-11, atol=1e-11)


# --- objects of Pinocchio, batches, invalid arguments ---


def test_objects_of_pinocchio_are_returned_as_such():
    m, v, f = pin.SE3.Random(), pin.Motion.Random(), pin.Force.Random()
    framed = pin.Frame("tool", 0, m, pin.FrameType.OP_FRAME)
    assert isinstance(exp6(v), pin.SE3)
    assert isinstance(log6(m), pin.Motion)
    assert isinstance(log6(framed), pin.Motion)
    assert isinstance(interpolate(m, framed, 0.3), pin.SE3)
    assert isinstance(twist_at(v, [1, 2, 3]), pin.Motion)
    assert isinstance(wrench_at(f, [1, 2, 3]), pin.Force)
    close(twist_at(v, [1, 2, 3]).vector, twist_at(v.vector, [1, 2, 3]))
    close(wrench_at(f, [1, 2, 3]).vector, wrench_at(f.vector, [1, 2, 3]))
    close(act_twist(m, v).vector, act_twist(Pose.from_se3(m), v.vector), atol=1e-15)
    close(act_wrench(framed, f).vector, act_wrench(m, f.vector), atol=1e-15)
    close(motion(v).vector, v.vector)
    close(force(f.vector).vector, f.vector)
    assert [x.vector.tolist() for x in motion(np.eye(6)[:2])] == np.eye(6)[:2].tolist()
    tool = Pose.from_se3(framed).to_frame("tool", 0)
    assert tool == frame("tool", m)
    assert tool.placement.isApprox(m)
    assert tool.name == "tool"
    model = pin.Model()
    assert model.frames[model.addFrame(tool)].name == "tool"
    close(Pose.from_se3([framed, m]).position, [m.translation] * 2)


@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 3)])
def test_batch_shapes(shape):
    twist = RNG.normal(size=(*shape, 6))
    place = exp6(twist)
    assert place.position.shape == (*shape, 3)
    assert place.rotation.shape == (*shape, 3, 3)
    assert log6(place).shape == act_twist(place, twist).shape == (*shape, 6)
    assert action_matrix(place).shape == dual_action_matrix(place).shape == (*shape, 6, 6)
    assert act_jacobian(place, np.ones((4, 6))).shape == (*shape, 4, 6)
    assert Pose.exp(twist).log().shape == (*shape, 6)
    for i in np.ndindex(shape):
        assert (log6(Placement(place.position[i], place.rotation[i])) == log6(place)[i]).all()


def test_undefined_elements_stay_undefined():
    twist = np.array([[np.nan] * 6, [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]])
    found = exp6(twist)
    assert np.isnan(found.position[0]).all()
    assert np.isnan(found.rotation[0]).all()
    close(found.position[1], exp6(twist[1]).position)
    assert np.isnan(log6(found)[0]).all()
    close(log6(found)[1], twist[1])
    assert np.isnan(jacobian_at(np.full((2, 6), np.nan), [1, 2, 3]))[:, :3].all()


@pytest.mark.parametrize(
    "call",
    [
        lambda: exp3([1.0, 2.0]),
        lambda: log3(np.zeros((2, 2))),
        lambda: exp6([1.0]),
        lambda: exp6("twist"),
        lambda: log6(5),
        lambda: log6([1, 2]),
        lambda: placement_of(None),
        lambda: act_twist(POSES, np.ones((3, 6))),
        lambda: act_jacobian(POSES, np.ones(6)),
        lambda: twist_at(np.ones((2, 6)), np.ones((3, 3))),
        lambda: jacobian_at(np.ones((2, 5)), np.ones(3)),
        lambda: interpolate(POSES[:2], POSES[:3], 0.5),
        lambda: POSES.to_frame("many"),
        lambda: frame(3, POSES[0]),
        lambda: Pose.exp([np.nan] * 6),
        lambda: POSES[0].interpolate("pose", 0.5),
    ],
)
def test_invalid_arguments_are_errors(call):
    with pytest.raises(InvalidInput):
        call()


def test_matrices_that_are_not_rotations_are_errors():
    with pytest.raises(InvalidRotation):
        log3(np.diag([1.0, 1.0, -1.0]))
    with pytest.raises(InvalidRotation):
        log6(Placement(np.zeros(3), 2.0 * np.eye(3)))
