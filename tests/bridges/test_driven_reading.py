"""Models of machines with drives at the base become the designs that they are."""

import math

import numpy as np
import pytest

import gsp
from gsp import Crank
from gsp.bridges import Solids, export, read_model
from gsp.errors import MalformedFile
from gsp.geometry.pose import Pose
from tests import campaign, driven
from tests.bridges.test_reading import FORMS, assert_same, ring, round_trip

FIVE = driven.of_five_legs()
DESIGNS = {**driven.DESIGNS, "five legs": FIVE, "lane": gsp.catalogue.design("lane-rotary")}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", campaign.some(DESIGNS, 5))
def test_exports_come_back(name, form, tmp_path):
    assert_same(round_trip(DESIGNS[name], form, tmp_path), DESIGNS[name], 1e-12)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("scale", [1e-3, 1e4])
def test_other_sizes_frames_and_strokes(form, scale, tmp_path):
    design = DESIGNS["mixed"].with_origin([0.0, 20.0, 0.0])
    shift = np.array([40.0, 0.0, -3.0])
    home = Pose(design.home.position + shift, design.home.rotation)
    design = design.replace(base_points=design.base_points + shift, home=home)
    values = design.at(home).joints
    design = design.replace(strokes=np.stack((values - 0.1, values + 0.05), axis=1)).scaled(scale)
    solids = Solids(metres=1.0, density=2700.0 / scale**3)
    found = round_trip(design, form, tmp_path, solids)
    assert_same(found, design, 1e-11)  # the origin is twenty sizes away
    np.testing.assert_allclose(
        found.at(found.home).joints, design.at(design.home).joints, rtol=1e-9
    )


def test_without_the_file_beside_it_sdf_gives_the_same_mechanism(tmp_path):
    """Travels and angles count from the configuration of the file; rates are the same."""
    path = tmp_path / "model.sdf"
    export(FIVE, FIVE.home, "sdf", path)
    (tmp_path / "model.sdf.joints.json").unlink()
    found = read_model(path)
    posture, ours = found.at(found.home), FIVE.at(FIVE.home)
    np.testing.assert_allclose(posture.joints[[0, 2, 3]], 0.0, atol=1e-12)
    np.testing.assert_allclose(posture.jacobian, ours.jacobian, atol=1e-11)


EYE = np.eye(3)
# Models as other people write them: universal joints, a base that is turned, no references.


def foreign_mjcf(design, *, axes=EYE, limits="", joint="turn", actuators=True):
    """RUS or PUS legs, whose joints are zero in the configuration of the file."""
    posture = design.at(design.home)
    tips, bodies, loops, motors = driven.tips(design, posture), "", "", ""
    for leg, tip in tips.items():
        a, s = design.base_points[leg], design.base_directions[leg]
        rod = posture.segments.along[leg]
        side = np.cross(rod, [0.6, 0.0, 0.8])
        start = a if joint == "turn" else tip
        kind = "hinge" if joint == "turn" else "slide"
        at, out, x, y, tip_text, end = ring([start, s, side, np.cross(rod, side), tip - start, rod])
        bodies += f"""<body name="arm{leg}" pos="{at}">
          <joint name="motor{leg}" type="{kind}" axis="{out}" {limits}/>
          <geom type="sphere" size="0.01"/>
          <body name="rod{leg}" pos="{tip_text}">
            <joint type="hinge" axis="{x}"/><joint type="hinge" axis="{y}" armature="0.1"/>
            <geom type="sphere" size="0.01"/></body></body>"""
        loops += f'<connect body1="rod{leg}" body2="top" anchor="{end}"/>'
        motors += f'<motor joint="motor{leg}"/>'
    turn = " ".join(map(repr, map(float, np.roll(Pose(np.zeros(3), axes).quaternion, 1))))
    top = ring([axes @ design.home.position])[0]
    home = Pose(np.zeros(3), axes @ design.home.rotation)
    place = " ".join(map(repr, map(float, np.roll(home.quaternion, 1))))
    motors = f"<actuator>{motors}</actuator>" if actuators else ""
    return f"""<mujoco model="foreign"><compiler autolimits="true" angle="radian"/><worldbody>
      <body name="frame" quat="{turn}">{bodies}</body>
      <body name="top" pos="{top}" quat="{place}"><freejoint/><geom type="box" size="1 1 0.1"/>
      </body></worldbody><equality>{loops}</equality>{motors}</mujoco>"""


def read_text(tmp_path, text, **options):
    path = tmp_path / "foreign.xml"
    path.write_text(text)
    return read_model(path, **options)


@pytest.mark.parametrize("name", ["cranks", "cranks, other branch", "rotary"])
def test_cranks_in_mjcf_on_a_turned_base(name, tmp_path):
    design = driven.DESIGNS[name]
    axes = Pose.from_rpy([0, 0, 0], [0.4, -0.3, 2.0]).rotation
    found = read_text(tmp_path, foreign_mjcf(design, axes=axes), base="frame", platform="top")
    tips = driven.tips(design, design.at(design.home))
    arms = [tips[i] - design.base_points[i] for i in range(6)]
    legs = [
        Crank(arm=arm, rod=drive.rod, branch=drive.branch)
        for arm, drive in zip(arms, design.drives, strict=True)
    ]
    assert_same(found, design.replace(legs=legs), 1e-9)
    np.testing.assert_allclose(found.at(found.home).joints, 0.0, atol=1e-9)
    np.testing.assert_allclose(
        found.at(found.home).jacobian, design.at(design.home).jacobian, atol=1e-8
    )


@pytest.mark.parametrize("actuators", [True, False])
def test_sliders_in_mjcf(actuators, tmp_path):
    design = driven.hexaglide()
    text = foreign_mjcf(design, joint="slide", limits='range="-0.1 0.3"', actuators=actuators)
    found = read_text(tmp_path, text)
    tips = driven.tips(design, design.at(design.home))
    points = np.array([tips[i] for i in range(6)])
    assert_same(found, design.replace(base_points=points), 1e-9)
    np.testing.assert_allclose(found.strokes, np.tile([-0.1, 0.3], (6, 1)), rtol=1e-12)


@pytest.mark.parametrize(
    ("limits", "angle", "stroke"),
    [
        ('ref="0.5" range="0.1 1.5"', 0.5, (0.1, 1.5)),
        ('ref="3" range="2 4"', 0.0, (-1.0, 1.0)),  # beyond half a turn
        ('ref="6" range="5.5 6.5"', 6.0 - 2 * math.pi, (5.5 - 2 * math.pi, 6.5 - 2 * math.pi)),
        ('ref="1" range="-6.5 6.5"', 1.0, (-6.5, 6.5)),  # all angles are within
    ],
)
def test_angles_count_from_the_zero_of_the_file_or_the_middle_of_its_limits(
    limits, angle, stroke, tmp_path
):
    design = driven.rotary()
    found = read_text(tmp_path, foreign_mjcf(design, limits=limits))
    np.testing.assert_allclose(found.at(found.home).joints, angle, atol=1e-9)
    np.testing.assert_allclose(found.strokes, np.tile(stroke, (6, 1)), atol=1e-9)
    rates = found.at(found.home).jacobian
    np.testing.assert_allclose(rates, design.at(design.home).jacobian, atol=1e-8)


def test_joints_that_are_no_drive_and_rod_are_refused(tmp_path):
    design = driven.rotary()
    text = foreign_mjcf(design)
    motors = text.replace('<motor joint="motor0"/>', "")
    with pytest.raises(MalformedFile, match=r"leg 1 .*an actuator of the turn 'motor0'"):
        read_text(tmp_path, motors)
    # The second turn of a universal joint is parallel to the first: the rod only turns in a plane.
    first = text.index('<joint type="hinge" axis="') + len('<joint type="hinge" axis="')
    x = text[first : text.index('"', first)]
    second = text.index('<joint type="hinge" axis="', first) + len('<joint type="hinge" axis="')
    flat = text[:second] + x + text[text.index('"', second) :]
    with pytest.raises(MalformedFile, match=r"leg 1 .*at the tip a ball, turns whose axes meet"):
        read_text(tmp_path, flat)
    # The tip of a crank on its axis.
    tip = ring([driven.tips(design, design.at(design.home))[0] - design.base_points[0]])[0]
    with pytest.raises(MalformedFile, match=r"leg 1 .*a tip beside the axis of the first joint"):
        read_text(
            tmp_path, text.replace(f'pos="{tip}"', f'pos="{ring(design.base_directions)[0]}"')
        )


def test_a_slider_that_begins_at_the_platform_is_refused(tmp_path):
    """Drives at the platform are none of the design."""
    path = tmp_path / "model.sdf"
    export(driven.hexaglide(), driven.hexaglide().home, "sdf", path)
    with pytest.raises(MalformedFile, match="leg 1"):
        read_model(path, base="platform", platform="base")
