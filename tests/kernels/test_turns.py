"""Formulas of rotations that exist in several forms (docs/design.md), each against scipy.

Compiled functions run without being compiled, which would take seconds.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gsp.geometry.rotations import ANGLE_SETS, angle_of, skew_part
from gsp.geometry.scalars import rotation_from_quaternion
from gsp.kernels.compiled import ascent
from gsp.kernels.formulas.linear import rotated
from gsp.kinematics.modes import tracking
from gsp.proof.paths import pieces
from gsp.proof.paths.series import Series
from gsp.proof.verification.balls import Number
from gsp.proof.verification.motions import Axes, Piece
from gsp.variation import stages
from gsp.workspace.sets.compiled import frames

RNG = np.random.default_rng(12)
START = Rotation.random(random_state=5).as_matrix()


def traced(axis, angle):
    """Of boxes of poses: about a unit axis, from a series of sine and cosine."""
    turn = np.reshape(stages._rotation(list(axis), angle), (3, 3))
    return turn @ START


def short(axis, angle):
    """Of steps of forward kinematics: exp(ω) R, from series without functions of angles."""
    return np.reshape(rotated(list(angle * axis), list(START.ravel())), (3, 3))


def climbing(axis, angle):
    """Of climbs along rays: exp(ω) R for ω = Σ steps × turns."""
    out, p = np.empty(9), np.zeros(3)
    step = np.array([0.0, angle])
    ascent._move.py_func(p, START.ravel(), p, axis[None], 1.0, step, 1.0, np.empty(3), out)
    return out.reshape(3, 3)


def of_cell(axis, angle):
    """Of cells of angles: about a unit axis."""
    out = np.empty((3, 3))
    frames._turned.py_func(axis, angle, out)
    return out @ START


def of_frame(axis, angle):
    """Of frames of cells: a rotation turned about a unit axis."""
    out = np.empty(9)
    frames.turn_about.py_func(START.ravel(), axis, angle, out)
    return out.reshape(3, 3)


def of_path(axis, angle):
    """Of pieces of paths: exp([v]×) of a series with one coefficient, as the middle of balls."""
    vector = Series.constant((angle * axis)[:, None], np.zeros((3, 1)), 1)
    return pieces._exponential(vector).mid[0, :, :, 0] @ START


def of_check(axis, angle):
    """Of pieces of paths in the independent check, as the middle of balls."""
    flint, still = pytest.importorskip("flint"), np.zeros((1, 3)).tolist()
    piece = Piece(flint, still, [list(angle * axis)], np.eye(3).tolist(), still[0], 0.0, 0.0)
    return middles(piece.platform([ball(0.0)])[1]) @ START


def ball(x):
    return Number(pytest.importorskip("flint").arb(x), [0] * 6, [])


def middles(rows):
    return np.array([[float(x.value.mid()) for x in row] for row in rows])


FORMS = [traced, short, climbing, of_cell, of_frame, of_path, of_check]


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, -0.3, 0.5, 2.5])
def test_rotations_about_an_axis(form, angle):
    if form is short:
        angle = min(angle, 0.5)
    for axis in RNG.normal(size=(5, 3)):
        unit = axis / np.linalg.norm(axis)
        expected = Rotation.from_rotvec(angle * unit).as_matrix() @ START
        np.testing.assert_allclose(form(unit, angle), expected, rtol=0, atol=2e-15)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.5, 2.5, np.pi - 1e-9, np.pi])
def test_angles_and_axes_of_rotations(angle):
    """Of arrays; compiled between two rotations, as an upper bound."""
    axes = RNG.normal(size=(5, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    turns = Rotation.from_rotvec(angle * axes).as_matrix()
    np.testing.assert_allclose(skew_part(turns), np.sin(angle) * axes, rtol=0, atol=2e-15)
    np.testing.assert_allclose(angle_of(turns), angle, rtol=0, atol=2e-15)
    for turn in turns:
        bound = frames.angle_between.py_func((turn @ START).ravel(), START.ravel())
        assert 0.0 <= bound - angle <= 2e-7


@pytest.mark.parametrize("order", ["rpy", "approach-roll", "ZXZ", "yzx"])
def test_three_turns_of_the_independent_check(order):
    sequence, places = ANGLE_SETS.get(order, (order, (0, 1, 2)))
    for angles in RNG.normal(size=(5, 3)):
        expected = Rotation.from_euler(sequence, angles[list(places)]).as_matrix()
        found = Axes(order).rotation([ball(x) for x in angles.tolist()])
        np.testing.assert_allclose(middles(found), expected, rtol=0, atol=2e-15)


def test_rotations_from_quaternions():
    for x in RNG.normal(size=(5, 4)):
        expected = (x @ x) * Rotation.from_quat(x, scalar_first=True).as_matrix().ravel()
        compiled = np.empty(9)
        tracking.rotation_of.py_func(x, compiled)
        np.testing.assert_allclose(rotation_from_quaternion(x), expected, rtol=0, atol=1e-14)
        np.testing.assert_allclose(compiled, expected, rtol=0, atol=1e-14)
    assert rotation_from_quaternion((1, 1, 0, 2)) == [-2, -4, 4, 4, -4, -2, 4, 2, 4]


def test_spin_and_twist_of_a_box_of_angles(monkeypatch):
    """The bound of compiled cells is that of the proofs, without its roundings."""
    monkeypatch.setattr(frames, "_turned", frames._turned.py_func)
    axes, low = np.linalg.qr(RNG.normal(size=(3, 3)))[0], RNG.normal(size=3)
    high, frame = low + [0.1, 0.2, 0.3], np.empty(20)
    frames.frame_of.py_func(low, high, np.vstack((axes, START)), frame)
    one = np.array([0.05, 0.1, 0.15])
    turns = frame[frames.TURNS : frames.SPIN].reshape(3, 3)
    skewed = min(1.0, abs(turns[0] @ turns[2]) / (one[0] * one[2]) + one[1])
    square = one @ one + 2.0 * one[0] * one[2] * skewed
    np.testing.assert_allclose(frame[frames.SPIN], np.sqrt(square), rtol=1e-13)
    # No velocity of the three angles inside the box turns faster.
    for signs in np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T:
        assert np.linalg.norm(signs @ turns) <= frame[frames.SPIN]


class Numbers:
    """In place of a traced graph: a stage that is made with it computes with these floats."""

    def __init__(self, **given):
        self.given = given

    def lanes(self, name, count):
        assert len(self.given[name]) == count
        return [float(x) for x in self.given[name]]

    uniform = lanes


def test_boxes_of_poses_and_cells_have_the_same_frame(monkeypatch):
    """Rotation, turns, spin and twist of a box, as proofs trace them and as cells compile them."""
    axes, low = np.linalg.qr(RNG.normal(size=(3, 3)))[0], RNG.normal(size=3)
    high, frame = low + [0.1, 0.2, 0.3], np.empty(20)
    graph = Numbers(box=[0, 0, 0, *low, 0, 0, 0, *high], frame=[*axes.ravel(), *START.ravel()])
    monkeypatch.setattr(stages, "Graph", lambda: graph)
    patch = [value for _, _, value in stages._boxes().outputs]
    monkeypatch.setattr(frames, "_turned", frames._turned.py_func)
    frames.frame_of.py_func(low, high, np.vstack((axes, START)), frame)
    angles = Rotation.from_rotvec(axes * (0.5 * (low + high))[:, None]).as_matrix()
    expected = angles[0] @ angles[1] @ angles[2] @ START
    np.testing.assert_allclose(np.reshape(patch[3:12], (3, 3)), expected, atol=4e-15)
    np.testing.assert_allclose(frame[:9], expected.ravel(), atol=4e-15)
    np.testing.assert_allclose(patch[15:24], frame[frames.TURNS : frames.SPIN], rtol=1e-8)
    np.testing.assert_allclose(patch[26], frame[frames.SPIN], rtol=1e-8)
    np.testing.assert_allclose(patch[27], frame[frames.TWIST], rtol=1e-8)
