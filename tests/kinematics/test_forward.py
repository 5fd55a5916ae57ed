"""Forward kinematics finds the pose that made the joint values, or reports that it did not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp.errors import InvalidInput
from gsp.geometry.pose import Pose, PoseBox
from gsp.kinematics.newton import reference
from gsp.kinematics.newton.centred import centred

ROUNDING = 1e-9


def ring(degrees, radius, z=0.0):
    angle = np.deg2rad(degrees)
    return np.stack((radius * np.cos(angle), radius * np.sin(angle), z + 0 * angle), axis=1)


HEXAPOD = gsp.Design(
    ["D1"] * 6,
    base_points=ring([-10, 10, 110, 130, 230, 250], 1.0),
    platform_points=ring([-50, 50, 70, 170, 190, 290], 0.6),
)
POSES = PoseBox([(-0.2, 0.2), (-0.2, 0.2), (0.8, 1.2)], [(-0.3, 0.3)] * 3)


def difference(pose, other):
    return np.maximum(
        np.abs(pose.position - other.position).max(axis=-1),
        np.abs(pose.rotation - other.rotation).max(axis=(-2, -1)),
    )


def side(design, pose):
    return np.sign(np.linalg.det(design.at(pose).jacobian))


@pytest.mark.parametrize(("number", "width", "loss"), [(50_000, 0.2, 0.0), (10_000, 0.35, 1e-3)])
def test_perturbed_starts_of_a_regular_hexapod(number, width, loss):
    rng = np.random.default_rng(4)
    truth = POSES.sample(number, rng=rng)
    guess = truth.moved(rng.uniform(-width, width, (number, 6)))
    found = gsp.forward(HEXAPOD, HEXAPOD.at(truth).joints, guess)
    assert (~found.converged).mean() <= loss
    assert found.residual[found.converged].max() <= 1e-12
    # A guess beyond a singularity belongs to another assembly, and must be answered by that one.
    sides = side(HEXAPOD, guess)
    assert (side(HEXAPOD, found.pose[found.converged]) == sides[found.converged]).all()
    same = found.converged & (side(HEXAPOD, truth) == sides)
    assert same.mean() > 0.99
    assert difference(found.pose[same], truth[same]).max() < ROUNDING


@pytest.mark.parametrize("mechanism", gsp.catalogue.mechanisms()[::7], ids=str)
def test_returns_to_the_pose_of_every_kind_of_mechanism(mechanism):
    rng = np.random.default_rng(7)
    n = len(mechanism.legs)
    design = gsp.Design(
        [leg.name for leg in mechanism.legs],
        *(rng.uniform(-1, 1, (n, 3)) for _ in range(2)),
        *(rng.normal(size=(n, 3)) for _ in range(2)),
    )
    truth = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (1, 2)], [(-0.5, 0.5)] * 3).sample(64, rng=rng)
    posture = design.at(truth)
    guess = truth.moved(1e-4 * rng.normal(size=(64, 6)))
    found = gsp.forward(design, posture.joints, guess)
    values = posture.singular_values(design.rms_radius)[:, -1]
    regular = values > 1e-2  # the others may have a second solution as near as the first
    assert regular.sum() >= 32
    assert found.converged[regular].all()
    assert difference(found.pose[regular], truth[regular]).max() < ROUNDING
    assert (found.iterations[regular] <= 5).all()


@pytest.mark.parametrize("name", ["D1^2 D2 D3 D4 A1", "D4^3 A1^3", "D2^3 D3^3", "D4^6"])
def test_far_guesses_give_a_solution_on_their_side_or_none(name):
    """Irregular mechanisms have many assemblies: what is called converged must be one of them."""
    mechanism = gsp.catalogue.mechanism(name)
    rng = np.random.default_rng(3)
    n = len(mechanism.legs)
    design = gsp.Design(
        [leg.name for leg in mechanism.legs],
        *(rng.uniform(-1, 1, (n, 3)) for _ in range(2)),
        *(rng.normal(size=(n, 3)) for _ in range(2)),
    )
    truth = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (1, 2)], [(-0.5, 0.5)] * 3).sample(500, rng=rng)
    joints = design.at(truth).joints
    guess = truth.moved(rng.uniform(-0.5, 0.5, (500, 6)))
    found = gsp.forward(design, joints, guess)
    done = found.converged
    assert 0.3 < done.mean() < 1.0
    posture = design.at(found.pose[done])
    errors = (posture.joints - joints[done]) / np.where(posture.angular, 1.0, design.rms_radius)
    assert np.abs(errors).max() <= 1e-12
    assert (side(design, found.pose[done]) == side(design, guess[done])).all()
    assert np.isnan(found.pose.position[~done]).all()


@pytest.mark.parametrize("name", ["D2^3 D3^3", "D4^6", "D1^2 D2 D3 D4 A1"])
def test_no_step_crosses_a_singularity_twice(name, monkeypatch):
    """Sampled along each step that was taken: the ends alone do not show two crossings."""
    mechanism = gsp.catalogue.mechanism(name)
    rng = np.random.default_rng(6)
    n, number, samples = len(mechanism.legs), 120, 40
    design = gsp.Design(
        [leg.name for leg in mechanism.legs],
        *(rng.uniform(-1, 1, (n, 3)) for _ in range(2)),
        *(rng.normal(size=(n, 3)) for _ in range(2)),
    )
    paths, verdicts = [], []

    def bends(centred, pose, move):
        paths.append((pose, move))
        return measure(centred, pose, move)

    def taken(step):
        verdicts.append(decide(step))
        return verdicts[-1]

    measure, decide = reference.row_bends, reference.taken
    monkeypatch.setattr(reference, "row_bends", bends)
    monkeypatch.setattr(reference, "taken", taken)
    truth = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (0.8, 2)], [(-0.5, 0.5)] * 3).sample(number, rng=rng)
    guess = truth.moved(rng.uniform(-0.5, 0.5, (number, 6)))
    joints = design.at(truth).joints
    found = gsp.forward(design, joints, guess, backend="numpy", max_iterations=60)
    assert found.converged.sum() > 30
    small = centred(design).design
    shares = np.linspace(0.0, 1.0, samples)[:, None, None]
    steps = 0
    for (start, move), took in zip(paths, verdicts, strict=True):
        chosen = took > 0.5
        posture = small.at(start[chosen].moved(shares * move[chosen]))
        # The row of two lines changes its sign where they meet, which is not a singularity.
        determinant = np.linalg.det(posture.jacobian) * signs_of(posture).prod(axis=-1)
        assert (np.sign(determinant) == np.sign(determinant[:1])).all()
        steps += chosen.sum()
    assert steps > 600
    by_compiled = gsp.forward(design, joints, guess, max_iterations=60)
    assert (by_compiled.status == found.status).mean() > 0.99


def signs_of(posture):
    """−1 where the distance of two lines is along s × t."""
    signs = np.ones(posture.joints.shape)
    for i, row in enumerate(posture.design.rows):
        if row.constraint.name == "D4":
            normal = np.cross(posture.lines.t[..., row.leg, :], posture.lines.s[row.leg])
            signs[..., i] = np.sign((posture.segments.direction[..., row.leg, :] * normal).sum(-1))
    return signs


@pytest.mark.parametrize("number", range(0, 195, 28))
def test_compiled_and_numpy_make_the_same_steps(number):
    mechanism = gsp.catalogue.mechanisms()[number]
    rng = np.random.default_rng(number)
    n, unit = len(mechanism.legs), 10.0 ** rng.uniform(-6, 6)
    shift = 1e3 * rng.normal(size=(2, 1, 3))
    design = gsp.Design(
        [leg.name for leg in mechanism.legs],
        *(unit * (rng.uniform(-1, 1, (n, 3)) + shift[i]) for i in range(2)),
        *(rng.normal(size=(n, 3)) for _ in range(2)),
    )
    inner = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (0.8, 2)], [(-0.5, 0.5)] * 3).sample(60, rng=rng)
    # A pose of the anchors' centres is that of frames that are far from them.
    turned = inner.rotation @ shift[1, 0]
    truth = Pose(unit * (inner.position + shift[0, 0] - turned), inner.rotation)
    step = rng.uniform(-0.1, 0.1, (60, 6))
    moved = inner.moved(step)
    guess = Pose(
        unit * (moved.position + shift[0, 0] - moved.rotation @ shift[1, 0]), moved.rotation
    )
    joints = design.at(truth).joints
    one = gsp.forward(design, joints, guess)
    other = gsp.forward(design, joints, guess, backend="numpy")
    assert one.status.tolist() == other.status.tolist()
    assert (one.iterations == other.iterations).mean() > 0.9
    assert one.converged.sum() > 30
    close = one.pose[one.converged].rotation - other.pose[one.converged].rotation
    assert np.abs(close).max() < 1e-9


def test_bits_are_the_same_alone_and_in_any_batch():
    rng = np.random.default_rng(8)
    truth = POSES.sample(60, rng=rng)
    joints = HEXAPOD.at(truth).joints.copy()
    joints[7], joints[20, 3] = np.nan, 9.0
    guess = truth.moved(rng.uniform(-0.3, 0.3, (60, 6)))
    together = gsp.forward(HEXAPOD, joints, guess)
    order = rng.permutation(60)
    shuffled = gsp.forward(HEXAPOD, joints[order], guess[order])
    for i in range(60):
        alone = gsp.forward(HEXAPOD, joints[i], guess[i])
        for one in (shuffled.pose[np.flatnonzero(order == i)[0]], alone.pose):
            assert one.position.tobytes() == together.pose.position[i].tobytes()
            assert one.rotation.tobytes() == together.pose.rotation[i].tobytes()
        assert alone.status == together.status[i]
        assert alone.iterations == together.iterations[i]
        np.testing.assert_array_equal(alone.residual, together.residual[i])


def test_converges_quadratically():
    truth = POSES.sample(1, rng=1)
    step = np.array([0.1, -0.08, 0.06, 0.1, 0.1, -0.1])
    errors = []
    for most in (1, 2, 3):
        found = gsp.forward(
            HEXAPOD, HEXAPOD.at(truth).joints, truth.moved(step), max_iterations=most
        )
        errors.append(found.residual.item())
    assert errors[0] < 0.1
    assert errors[1] < 3 * errors[0] ** 2
    assert errors[2] < 3 * errors[1] ** 2


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_batches_broadcast(shape):
    truth = POSES.sample(6, rng=3)[: int(np.prod(shape))].reshape(*shape)
    found = gsp.forward(HEXAPOD, HEXAPOD.at(truth).joints, Pose([0, 0, 1]))
    assert found.pose.shape == found.converged.shape == found.residual.shape == shape
    assert found.iterations.shape == found.singular.shape == shape
    assert found.converged.all()
    assert difference(found.pose, truth).max(initial=0.0) < ROUNDING


def test_more_than_one_block_gives_the_same_as_one_by_one():
    truth = POSES.sample(8200, rng=5)
    joints = HEXAPOD.at(truth).joints
    found = gsp.forward(HEXAPOD, joints, Pose([0, 0, 1]))
    for i in (0, 8191, 8192, 8199):
        alone = gsp.forward(HEXAPOD, joints[i], Pose([0, 0, 1]))
        np.testing.assert_array_equal(alone.pose.position, found.pose.position[i])


def test_redundant_legs_that_agree_and_that_contradict_each_other():
    design = HEXAPOD.replace(
        legs=["D1"] * 7,
        base_points=np.vstack((HEXAPOD.base_points, [[0.1, 0.2, -0.1]])),
        platform_points=np.vstack((HEXAPOD.platform_points, [[-0.2, 0.1, 0.0]])),
        base_directions=None,
        platform_directions=None,
    )
    truth = POSES.sample(20, rng=1)
    joints = design.at(truth).joints
    found = gsp.forward(design, joints, truth.moved([0.05, 0.05, 0, 0.1, 0, 0.1]))
    assert found.converged.all()
    assert difference(found.pose, truth).max() < ROUNDING
    wrong = gsp.forward(design, joints + np.eye(7)[6] / 100, truth)
    assert not wrong.converged.any()
    assert np.isnan(wrong.pose.position).all()
    assert (wrong.residual > 1e-4).all()


def _singular_with_seven_legs():
    """Designs of seven actuators and a pose where their rank is five or less."""
    rng = np.random.default_rng(0)
    here = Pose.from_rpy([0.1, 0.2, 1.0], [0.1, -0.2, 0.3])
    base, platform, s, t = rng.normal(size=(4, 7, 3))
    line = np.outer(rng.normal(size=7), [1.0, 2.0, 0.5])
    circle = ring([0, 10, 77, 150, 200, 300, 320], 1.0)
    point = np.array([0.3, -0.2, 2.5])
    ends = platform @ here.rotation.T + here.position
    share, shift = rng.uniform(1.5, 3.0, (7, 1)), np.array([0.2, 0.1, 0.4])
    doubled = [0, 1, 2, 3, 4, 0, 1]
    return {
        "anchors of the platform in a line": (["D1"] * 7, base, line),
        "similar polygons in circles": (["D1"] * 7, circle, 0.5 * circle),
        "parallel legs": (["D1"] * 7, base, (base - shift) @ here.rotation),
        "lines through a point here": (["D1"] * 7, point + share * (ends - point), platform),
        "two lines and five couples": (["D1"] * 2 + ["A1"] * 5, base, platform, s, t),
        "couples only": (["A1"] * 7, base, platform, s, t),
        "two legs doubled": (["D1"] * 7, base[doubled], platform[doubled]),
    }, here


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
@pytest.mark.parametrize("name", list(_singular_with_seven_legs()[0]))
def test_more_than_six_legs_do_not_converge_at_singular_postures(name, backend):
    """From a guess at the solution, and from one beside it that may be regular."""
    designs, here = _singular_with_seven_legs()
    design = gsp.Design(*designs[name])
    assert design.at(here).singular()
    joints = design.at(here).joints
    for guess in (here, here.moved([0.02, -0.01, 0.015, 0.01, 0.02, -0.01])):
        found = gsp.forward(design, joints, guess, backend=backend)
        assert found.status == "singular"
        assert np.isnan(found.pose.position).all()
    assert gsp.prepare(design).forward(joints, here).status == "singular"


def test_a_singular_guess_has_the_status_singular():
    platform = gsp.Design(["D1"] * 6, ring(range(0, 360, 60), 1.0), ring(range(0, 360, 60), 0.5))
    guess = Pose([0, 0, 1])  # similar hexagons: the architecture is singular
    found = gsp.forward(platform, platform.at(guess).joints, guess)
    assert found.status == "singular"
    assert found.singular
    assert np.isnan(found.pose.position).all()


def test_joint_values_of_a_singular_posture_are_reported():
    """Two legs' heights meet at a fold: the parallel-singular pose is reached by bisection."""
    turned = PoseBox([0, 0, 1], [0, 0, (0.0, 2.0)]).grid([1, 1, 1, 1, 1, 2001])[0, 0, 0, 0, 0]
    sides = side(HEXAPOD, turned)
    cut = np.flatnonzero(sides[1:] != sides[:-1])[0]
    low, high = (turned.angles()[i, 2] for i in (cut, cut + 1))
    for _ in range(80):
        middle = (low + high) / 2
        pose = Pose.from_rpy([0, 0, 1], [0, 0, middle])
        low, high = (middle, high) if side(HEXAPOD, pose) == sides[cut] else (low, middle)
    fold = Pose.from_rpy([0, 0, 1], [0, 0, low])
    guess = Pose.from_rpy([0.01, 0, 1], [0.02, 0, low - 0.1])
    found = gsp.forward(HEXAPOD, HEXAPOD.at(fold).joints, guess)
    assert found.status == "singular"
    assert np.isnan(found.pose.rotation).all()


def test_bad_elements_do_not_change_the_others():
    truth = POSES.sample(5, rng=2)
    joints = HEXAPOD.at(truth).joints.copy()
    joints[1, 2], joints[2, 0], joints[3] = np.nan, -1.0, 20.0 * np.array([1, 0, 1, 0, 1, 0])
    found = gsp.forward(HEXAPOD, joints, Pose([0, 0, 1]))
    assert found.status.tolist() == [
        "converged",
        "undefined",
        "undefined",
        "singular",
        "converged",
    ]
    assert np.isnan(found.pose.position[1:4]).all()
    assert np.isnan(HEXAPOD.at(found.pose).joints[1:4]).all()
    assert np.isnan(found.residual[1])


def test_an_undefined_guess_is_reported():
    design = HEXAPOD.replace(platform_points=HEXAPOD.base_points)
    found = gsp.forward(design, np.ones(6), Pose([0, 0, 0]))
    assert found.status == "undefined"


def test_lines_that_meet_are_reached_and_crossed_neither_way():
    """D4 = 0 is an ordinary target, though the distance itself has a kink there."""
    rng = np.random.default_rng(11)
    n = 6
    design = gsp.Design(
        ["D4"] * n,
        *(rng.uniform(-1, 1, (n, 3)) for _ in range(2)),
        *(rng.normal(size=(n, 3)) for _ in range(2)),
    )
    here = Pose([0.1, 0.2, 1.0])
    target = design.at(here).joints.copy()
    row = int(np.argmin(target))
    target[row] = 0.0
    found = gsp.forward(design, target, here)
    assert found.converged
    assert design.at(found.pose).joints[row] < 1e-12
    back = gsp.forward(design, design.at(here).joints, found.pose.moved(np.zeros(6)))
    assert back.converged


def test_without_size_angles_and_distances_still_solve():
    """All anchors at the origins: the design has no size, and its lines still fix the pose."""
    rng = np.random.default_rng(2)
    design = gsp.Design(
        ["D4 A1"] * 3,
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        rng.normal(size=(3, 3)),
        rng.normal(size=(3, 3)),
    )
    truth = Pose.from_rpy([0.2, 0.3, 1.0], [0.1, 0.2, 0.3])
    found = gsp.forward(design, design.at(truth).joints, truth.moved(np.full(6, 0.01)))
    assert found.converged
    assert difference(found.pose, truth) < ROUNDING


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("x", np.ones(6), Pose([0, 0, 1])), "design: expected a gsp.Design"),
        ((HEXAPOD, np.ones(6), np.ones(3)), "guess: expected a gsp.Pose"),
        ((HEXAPOD, np.ones(5), Pose([0, 0, 1])), r"joints: expected shape \(\.\.\., 6\)"),
        ((HEXAPOD, np.ones((3, 6)), Pose(np.ones((2, 3)))), "broadcast"),
    ],
)
def test_bad_input(arguments, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.forward(*arguments)


def test_bad_options():
    with pytest.raises(InvalidInput, match="tolerance"):
        gsp.forward(HEXAPOD, np.ones(6), Pose([0, 0, 1]), tolerance=0.0)
    with pytest.raises(InvalidInput, match="max_iterations"):
        gsp.forward(HEXAPOD, np.ones(6), Pose([0, 0, 1]), max_iterations=0)


def test_far_starts_end_at_the_nearest_mode():
    rng = np.random.default_rng(8)
    truth = POSES.sample(12, rng=rng)
    joints = HEXAPOD.at(truth).joints
    guess = Pose(truth.position, Rotation.random(12, rng=rng).as_matrix())
    alone = gsp.forward(HEXAPOD, joints, guess)
    found = gsp.forward(HEXAPOD, joints, guess, fallback="modes")
    failed = ~alone.converged
    assert 2 < failed.sum() < 12
    assert found.converged.all()
    np.testing.assert_array_equal(found.status == "nearest mode", failed)
    np.testing.assert_array_equal(found.pose.position[~failed], alone.pose.position[~failed])
    np.testing.assert_allclose(HEXAPOD.at(found.pose).joints, joints, atol=1e-11)
    for i in np.flatnonzero(failed)[:4]:
        # The metric of `gsp.nearest`, by the angle of the rotation between two poses.
        modes = gsp.assembly_modes(HEXAPOD, joints[i]).poses
        middle = HEXAPOD.platform_points.mean(axis=0)
        moved = (modes.position + modes.rotation @ middle) - (
            guess.position[i] + guess.rotation[i] @ middle
        )
        trace = np.einsum("nij,ij->n", modes.rotation, guess.rotation[i])
        angle = np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))
        apart = np.hypot(np.linalg.norm(moved, axis=1) / HEXAPOD.rms_radius, angle)
        nearest = modes[int(apart.argmin())]
        assert difference(nearest, found.pose[i]) < ROUNDING


def test_without_a_mode_the_fallback_changes_nothing():
    impossible = [[np.nan] * 6, [1.0, 1.0, 1.0, 1.0, 1.0, 50.0]]
    guess = Pose([0.0, 0.0, 1.0])
    alone = gsp.forward(HEXAPOD, impossible, guess)
    found = gsp.forward(HEXAPOD, impossible, guess, fallback="modes")
    np.testing.assert_array_equal(found.status, alone.status)
    assert np.isnan(found.pose.position).all()


def test_a_fallback_is_modes_or_none_for_six_actuators():
    joints = HEXAPOD.at(Pose([0.0, 0.0, 1.0])).joints
    with pytest.raises(InvalidInput, match="fallback: expected 'modes' or None, received 'newton'"):
        gsp.forward(HEXAPOD, joints, Pose([0.0, 0.0, 1.0]), fallback="newton")
    points = ring(np.arange(7) * 50.0, 1.0)
    seven = gsp.Design(["D1"] * 7, points, 0.5 * points[::-1])
    with pytest.raises(InvalidInput, match="six actuators"):
        gsp.forward(seven, np.ones(7), Pose([0.0, 0.0, 1.0]), fallback="modes")
    robot = gsp.prepare(HEXAPOD)
    end = robot.forward(joints, Pose([0.0, 0.0, 1.1]), fallback="modes")
    assert end.status == "converged"
