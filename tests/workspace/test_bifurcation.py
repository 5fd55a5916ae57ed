import numpy as np
import pytest
from scipy.optimize import brentq

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput
from gsp.limits.labels import active_from_label, label
from gsp.workspace import bifurcation_point


def test_the_lowest_point_of_its_branch(platform, formula):
    guess = gsp.Pose.from_angles([0.0, 0.0, 2.4], [0, -54, 0], "approach-roll", degrees=True)
    point = bifurcation_point(platform, "[− 0 0 0 0 −]", guess, held={"x": 0.0, "y": 0.0})
    assert point.label == "- 0 0 0 0 -"
    values = formula(*point.pose.position, *point.pose.angles("approach-roll"))
    assert values[1:5] == pytest.approx([8.0] * 4, abs=1e-12)
    assert values[0] == pytest.approx(values[5], abs=1e-12)
    assert np.allclose(point.joints, values, atol=1e-12)


@pytest.mark.parametrize(
    ("lengths", "betas"),
    [((8.0,) * 3, (0.0, -37.4995677)), ((8.0, 15.0, 15.0), (31.7659153, -82.3621223))],
)
def test_all_tilts_of_the_plane_of_symmetry(formula, lengths, betas):
    """For each β legs 1 and 2 fix (x, z); the sign changes of leg 3 are all there are."""

    def place(beta, side):
        # Legs 1 and 2 keep (x, z) on two circles about −(their arms).
        zero = formula(0.0, 0.0, 0.0, 0.0, beta, 0.0) ** 2
        dx = formula(1.0, 0.0, 0.0, 0.0, beta, 0.0) ** 2 - zero - 1.0
        dz = formula(0.0, 0.0, 1.0, 0.0, beta, 0.0) ** 2 - zero - 1.0
        centres = -0.5 * np.stack((dx, dz), axis=-1)
        rest = np.array(lengths)[:2] ** 2 - (zero - (centres**2).sum(-1))[:2]
        if (rest <= 0).any():
            return None
        gap = centres[1] - centres[0]
        d = np.hypot(*gap)
        along = (d**2 + rest[0] - rest[1]) / (2 * d)
        if rest[0] < along**2:
            return None
        e = gap / d
        return centres[0] + along * e + side * np.sqrt(rest[0] - along**2) * np.array([-e[1], e[0]])

    def error(beta, side):
        found = place(beta, side)
        if found is None:
            return np.nan
        return formula(found[0], 0.0, found[1], 0.0, beta, 0.0)[2] - lengths[2]

    roots = []
    grid = np.linspace(-np.pi + 1e-3, np.pi + 1e-3, 3001)
    for side in (1, -1):
        values = np.array([error(beta, side) for beta in grid])
        for i in np.flatnonzero(values[:-1] * values[1:] < 0):
            roots.append(np.rad2deg(brentq(error, grid[i], grid[i + 1], args=(side,))))
    # Mirrored in the base plane each pose has the opposite tilt.
    wanted = sorted({*betas, *(-b for b in betas)})
    assert sorted(set(np.round(roots, 6) + 0.0)) == pytest.approx(wanted, abs=1e-5)


def test_points_below_the_printed_lowest_height_are_reached(platform):
    """(0, 0, 0) lies inside, although the source gives 2.369: here is an orientation."""
    rng = np.random.default_rng(4)
    turn = gsp.Pose.from_quaternion(np.zeros((500, 3)), rng.normal(size=(500, 4)))
    assert gsp.feasible(platform, turn).ok.sum() > 20
    top = gsp.Pose([0.0, 0.0, 12.9])
    below = gsp.Pose([0.0, 0.0, -12.9])
    assert np.allclose(platform.at(top).joints, platform.at(below).joints)
    assert gsp.feasible(platform, below).ok


def test_labels_are_read_and_written():
    names = (*(f"d{i}" for i in range(1, 7)), "clearance 1-2")
    for text in ("0 1 - - 1 0", "[01−−10]", "(0 1 – – 1 0)"):
        active = active_from_label(text, 6)
        assert label(active, names, 6) == "0 1 - - 1 0"
    assert label(((0, 1), (6, 0)), names, 6) == "1 - - - - - | clearance 1-2=0"


def test_bad_input(platform):
    guess = gsp.Pose([0.0, 0.0, 13.0])
    with pytest.raises(InvalidInput, match="marks"):
        bifurcation_point(platform, "11111", guess)
    with pytest.raises(InvalidInput, match="six equations"):
        bifurcation_point(platform, "1 1 - - 1 1", guess)
    with pytest.raises(InvalidInput, match="coordinates"):
        bifurcation_point(platform, "1 1 - - 1 1", guess, held={"w": 0.0, "y": 0.0})
    with pytest.raises(EmptyWorkspace, match="residual"):
        bifurcation_point(platform, "1 1 1 1 1 1", guess, held={"x": 3.0})
    with pytest.raises(InvalidInput, match="single"):
        bifurcation_point(platform, "1 1 1 1 1 1", gsp.Pose([[0.0, 0.0, 13.0]]))
