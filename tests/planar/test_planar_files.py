"""Planar design files, and the published planar designs."""

import numpy as np
import pytest

import gsp
from gsp.errors import MalformedFile, UnknownDesign, UnwritableOutput
from gsp.planar import (
    PlanarDesign,
    PlanarPose,
    mechanisms,
    planar_design,
    planar_design_names,
    read_planar_design,
)

ARRAYS = ("base_points", "platform_points", "base_directions", "platform_directions", "strokes")


@pytest.mark.parametrize("mechanism", mechanisms(), ids=lambda mechanism: mechanism.name)
def test_designs_are_read_back_bit_by_bit(mechanism, tmp_path):
    rng = np.random.default_rng(mechanisms().index(mechanism))
    design = PlanarDesign(
        mechanism.legs,
        *rng.normal(size=(4, 3, 2)),
        unit="mm",
        name="mine",
        source='a "source"\nof two lines',
        strokes=[[0.1, 0.7], [np.nan, 2.0], [-np.pi if mechanism.legs[2] == "A1" else 0.0, np.nan]],
        characteristic_length=1 / 3,
        ellipsoid=gsp.Ellipsoid([1.0, 2.0, 3.0], [0.1, 0.2, 0.0]),
        home=PlanarPose(rng.normal(size=2), rng.normal()),
    )
    design.write(tmp_path / "a.toml")
    again = read_planar_design(tmp_path / "a.toml")
    assert [leg.name for leg in again.legs] == list(mechanism.legs)
    for name in ("unit", "name", "source", "characteristic_length"):
        assert getattr(again, name) == getattr(design, name)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(again, name), getattr(design, name))
    assert again.home.angle == design.home.angle
    assert (again.home.position == design.home.position).all()
    assert (again.ellipsoid.semi_axes == design.ellipsoid.semi_axes).all()
    with pytest.raises(UnwritableOutput, match="exists already"):
        design.write(tmp_path / "a.toml")


LEG = '[[legs]]\nconstraints = "{}"\nbase_point = [{}, 0]\nplatform_point = [0, {}]\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LEG.format("D1", 1, 1) * 2, "at least three constraints, received 2"),
        (LEG.format("D4", 1, 1) * 3, "line 2, key 'constraints'.*one of D1, D2, D3, A1"),
        (LEG.format("D2", 1, 1) * 3, "'platform_direction': expected this key"),
        (LEG.format("D1", "1, 0", 1) * 3, "line 3, key 'base_point'.*two numbers"),
        ("[home]\nposition = [0, 0]\nrotation = 1\n" + LEG * 3, "one of position, angle, angle_d"),
        ("[home]\nposition = [0, 0]\nangle = [1]\n", "line 3, key 'angle'.*a number"),
        ("[home]\nposition = [0, 0]\nangle = 1\nangle_deg = 2\n", "only one of angle, angle_deg"),
    ],
)
def test_mistakes_are_named_with_line_and_key(text, message, tmp_path):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(MalformedFile, match=message):
        read_planar_design(tmp_path / "a.toml")


def test_angles_of_home_in_degrees(tmp_path):
    text = "[home]\nposition = [1, 2]\nangle_deg = 90\n" + LEG.format("D1", 1, 1) * 3
    (tmp_path / "a.toml").write_text(text)
    assert read_planar_design(tmp_path / "a.toml").home.angle == np.pi / 2


def test_published_designs_are_found_by_name():
    for name in planar_design_names():
        assert planar_design(name).name == name
        assert planar_design(name).source
    with pytest.raises(UnknownDesign, match="lee-2000-planar"):
        planar_design("lee-2000-planr")


def test_the_equilateral_platform_has_the_printed_determinant():
    """`Lee2000`, §1: the largest |det J| is 3/2 of the side, in the central location."""
    design = planar_design("lee-2000-planar")
    a, b = design.base_points, design.platform_points
    rows = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    moment = b[:, 0] * rows[:, 1] - b[:, 1] * rows[:, 0]
    side = np.linalg.norm(b[0] - b[1])
    determinant = np.linalg.det(np.column_stack((rows, moment)))
    assert abs(determinant) == pytest.approx(1.5 * side, rel=1e-14)


def test_the_isotropic_platform_is_isotropic_by_both_measures():
    """`Nawratil`, §4.2: CDN_OE = 1 and CTN = 1."""
    design = planar_design("nawratil-planar-isotropic-3")
    posture = design.at(design.home)
    condition = gsp.planar.indices.condition_number_ellipsoid(posture, design.ellipsoid)
    assert condition == pytest.approx(1.0, abs=1e-9)
    assert gsp.planar.indices.control_number(posture) == pytest.approx(1.0, abs=1e-9)
