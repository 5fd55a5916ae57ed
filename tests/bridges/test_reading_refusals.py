"""Models are read as the mechanism that they are, or refused with the reason."""

import json
import re

import numpy as np
import pytest

import gsp
from gsp.bridges import export, read_model
from gsp.bridges.exports import SUFFIXES
from gsp.errors import MalformedFile
from gsp.geometry.pose import Pose
from tests import driven
from tests.bridges.test_reading import LIFT, foreign_mjcf, foreign_sdf, ring

GEOM = '<geom size="0.1"/>'
HEAD = '<mujoco model="other"><worldbody>'


def assert_anchors(found, design=LIFT, shift=(0.0, 0.0, 0.0)):
    np.testing.assert_allclose(found.base_points, design.base_points, atol=1e-9)
    np.testing.assert_allclose(found.platform_points, design.platform_points + shift, atol=1e-9)


def assert_refused(folder, name, text, message):
    path = folder / name
    path.write_text(text)
    with pytest.raises(MalformedFile, match=message) as error:
        read_model(path)
    assert str(error.value).startswith(str(path))


def edited(text, *changes):
    for old, new in changes:
        assert re.search(old, text, re.DOTALL), old
        text = re.sub(old, new, text, count=1, flags=re.DOTALL)
    return text


def exported(form, folder, design=LIFT):
    path = folder / f"lift{SUFFIXES[form]}"
    export(design, design.home, form, path, overwrite=True)
    return path


def without_balls(text):
    return re.sub("<drake:ball_constraint .*?</drake:ball_constraint>", "", text, flags=re.DOTALL)


def test_a_pose_in_which_a_leg_is_undefined_is_refused(tmp_path):
    """The slide of a leg whose two spherical joints coincide counts a length that is not known."""
    path = tmp_path / "upright.xml"
    place = ring([LIFT.base_points[2] - LIFT.home.position])[0]
    text = edited(upright_mjcf("sites"), ('name="p2" pos="[^"]*"', f'name="p2" pos="{place}"'))
    assert_refused(tmp_path, path.name, text, "all legs are defined, received d3, where the anchor")


# Loops that the file has open.


def test_the_gap_of_a_fixed_loop_does_not_move_anchors(tmp_path):
    """The platform is raised in the tree; or the file of loops has it at another place."""
    path = exported("urdf", tmp_path)
    text, beside = path.read_text(), tmp_path / "lift.urdf.loops.json"
    raised = edited(text, (r'(name="base_to_platform".*?xyz="0.0 0.0 )1.5"', r'\g<1>1.75"'))
    path.write_text(raised)
    found = read_model(path)
    assert_anchors(found)
    assert found.home.position[2] == 1.75
    path.write_text(without_balls(text))  # which would contradict the file beside it
    content = json.loads(beside.read_text())
    for loop in content["loops"]:
        loop["position"][2] += 0.25
    beside.write_text(json.dumps(content))
    assert_anchors(read_model(path), shift=[0.0, 0.0, 0.25])


def upright_mjcf(weld):
    """Ball, slide and ball, with all legs drawn upright; each ends in a body that is welded."""
    bodies = loops = sites = ""
    lengths = LIFT.at(LIFT.home).joints
    for i, (a, b, length) in enumerate(
        zip(LIFT.base_points, LIFT.platform_points, lengths, strict=True)
    ):
        bodies += f"""<body pos="{ring([a])[0]}"><joint type="ball"/><geom size="0.1"/>
          <body pos="0 0 1"><joint name="s{i}" type="slide" axis="0 0 1" range="-0.5 0.5"/>
          <geom size="0.1"/><body name="end{i}" pos="0 0 {length - 1}" quat="0.48 0.6 0.64 0">
          <joint type="ball"/><geom size="0.1"/><site name="e{i}"/></body></body></body>"""
        sites += f'<site name="p{i}" pos="{ring([b])[0]}" quat="0.6 0 0.8 0"/>'
        loops += {
            "relpose": f'<weld body1="top" body2="end{i}" relpose="{ring([b])[0]} 0.6 0 0 0.8"/>',
            "sites": f'<weld site1="e{i}" site2="p{i}"/>',
            "no torque": f'<weld site1="p{i}" site2="e{i}" torquescale="0"/>',
        }[weld]
    return f"""{HEAD}<body name="top" pos="{ring([LIFT.home.position])[0]}"><freejoint/>
      <geom size="0.1"/>{sites}</body>{bodies}</worldbody><equality>{loops}</equality></mujoco>"""


@pytest.mark.parametrize("weld", ["relpose", "sites"])
def test_legs_that_are_drawn_upright_and_welded(weld, tmp_path):
    path = tmp_path / "upright.xml"
    path.write_text(upright_mjcf(weld))
    found = read_model(path)
    assert_anchors(found)
    middle = LIFT.at(LIFT.home).joints[:, None]
    np.testing.assert_allclose(found.strokes, middle + [-0.5, 0.5], rtol=1e-12)


@pytest.mark.parametrize("aside", [0.0, 0.05])
def test_a_turn_beside_a_slide_is_about_its_line(aside, tmp_path):
    """Aside of it, the leg is no longer what the slide counts, once the turn has moved."""
    path = tmp_path / "aside.xml"
    turn = f'type="hinge" axis="0 0 1" pos="{aside} 0 0"/><joint name="s0" type="slide"'
    path.write_text(edited(upright_mjcf("sites"), ('name="s0" type="slide"', turn)))
    if not aside:
        assert_anchors(read_model(path))
        return
    message = "leg 1 .*: expected a turn beside the slide about the line .* misses by 0.05 m"
    assert_refused(tmp_path, path.name, path.read_text(), message)


def test_a_weld_without_torque_is_a_ball(tmp_path):
    path = tmp_path / "upright.xml"
    ball, site = '<joint type="ball"/>', '<geom size="0.1"/><site'
    path.write_text(upright_mjcf("no torque").replace(ball + site, site))
    assert_anchors(read_model(path))


@pytest.mark.parametrize("moved", [0.0, 0.1])
def test_loops_that_are_stated_twice_are_refused(moved, tmp_path):
    path = exported("urdf", tmp_path)
    beside = tmp_path / "lift.urdf.loops.json"
    content = json.loads(beside.read_text())
    again = json.loads(json.dumps(content["loops"][2]))
    again["position"][0] += moved
    content["loops"].append(again)
    beside.write_text(json.dumps(content))
    with pytest.raises(MalformedFile, match="expected a name of its own, received 'leg3'"):
        read_model(path)
    again["name"] = "leg3b"
    beside.write_text(json.dumps(content))
    with pytest.raises(MalformedFile, match=r"loop 'leg3b': expected .* once, received a se"):
        read_model(path)


# What holds the platform beside the legs, and joints that are coupled.

MJCF = foreign_mjcf(LIFT)
PASSIVE_LEGS = edited(MJCF, ("</mujoco>", '<actuator><motor joint="hand"/></actuator></mujoco>'), (
    "</worldbody>", '<body name="arm"><joint name="hand" type="hinge"/><geom size="0.1"/></body>'
    "</worldbody>"))  # fmt: skip
MOTORS = "".join(f'<motor joint="ram{i}"/>' for i in range(6))
DRIVEN = edited(MJCF, ("</mujoco>", f"<actuator>{MOTORS}</actuator></mujoco>"))
SLIDES = "".join(f'<joint type="slide" axis="{x}"/>' for x in ("1 0 0", "0 1 0", "0 0 1"))
TENDON = """<tendon><fixed name="both"><joint joint="ram0" coef="1"/><joint joint="ram1" coef="1"/>
  </fixed></tendon>"""
EQUAL = "</equality>"
HOLDING = {
    "guide": ("<freejoint/>", '<joint type="slide" axis="0 0 1"/>', "of 1 degree of freedom"),
    "ball": ("<freejoint/>", '<joint type="ball"/>', r"a joint of 3 degrees of freedom \(ball"),
    "slides": ("<freejoint/>", SLIDES, "a joint of 3 degrees of freedom"),
    "pin": (EQUAL, f'<connect body1="top" body2="world" anchor="0 0 0"/>{EQUAL}',
            "nothing but the legs that holds the platform 'top', received a joint of 3"),
    "weld": (EQUAL, f'<weld body1="top" body2="world"/>{EQUAL}', "'top', which is fixed to it"),
    "coupled": (EQUAL, f'<joint joint1="ram0" joint2="ram3"/>{EQUAL}',
                "a constraint between the joints 'ram0' and 'ram3'"),
    "locked": (EQUAL, f'<joint joint1="ram2"/>{EQUAL}', "a constraint that holds the joint 'ram2'"),
    "tendon": (EQUAL, f'<tendon tendon1="both"/>{EQUAL}{TENDON}', "received tendon"),
    "slide welded": (EQUAL, f'<weld body1="rod2" body2="tube2"/>{EQUAL}', "leg 3 .*freedoms"),
    "one inactive": ("<connect ", '<connect active="false" ', "received 5 legs with 5"),
    "no actuator": ('<motor joint="ram5"/>', "", "leg 6 .*: expected an actuator of the slide 'ra"),
    "one motor": ('<motor joint="ram0"/><motor joint="ram1"/>', '<motor tendon="both"/>',
                  "one actuator of 'ram0' and 'ram1'"),
    "site": ("</actuator>", '<motor site="tip0"/></actuator>', "an actuator of .*received a site"),
}  # fmt: skip


@pytest.mark.parametrize("case", HOLDING)
def test_what_holds_platform_or_joints_in_mjcf(case, tmp_path):
    old, new, message = HOLDING[case]
    extra = ("</mujoco>", f"{TENDON}</mujoco>") if case == "one motor" else ("top", "top")
    assert_refused(tmp_path, "held.xml", edited(DRIVEN, extra, (old, new)), message)


def test_all_legs_inactive(tmp_path):
    text = MJCF.replace("<connect ", '<connect active="false" ')
    assert_refused(tmp_path, "open.xml", text, "at least 3 chains of joints from 'world'")


def test_actuators_of_other_joints_leave_no_slide_driven(tmp_path):
    message = "leg 1 .*: expected an actuator of the slide 'ram0', received none, though the file"
    assert_refused(tmp_path, "hand.xml", PASSIVE_LEGS, message)


def test_driven_hinges_of_legs_are_refused(tmp_path):
    text = edited(DRIVEN, ('<joint type="hinge"', '<joint name="first" type="hinge"'),
                  ("</actuator>", '<motor joint="first"/></actuator>'))  # fmt: skip
    message = "leg 1 .*: expected actuators of 'ram0' only, received one that drives the turn 'fir"
    assert_refused(tmp_path, "hinge.xml", text, message)


HARMLESS = {
    "driven": ("top", "top"),
    "two motors at one slide": ("</actuator>", '<position joint="ram0"/></actuator>'),
    "one joint by a tendon": ('<motor joint="ram0"/>', '<motor tendon="one"/>'),
    "free by six joints": ("<freejoint/>", f'{SLIDES}<joint type="ball"/>'),
    "a cover that is welded": (EQUAL, f'<weld body1="cover2" body2="tube2"/>{EQUAL}'),
    "inactive coupling": (EQUAL, f'<joint joint1="ram0" joint2="ram3" active="false"/>{EQUAL}'),
    "gripper": (
        "<freejoint/>",
        '<freejoint/><body><joint name="f1" type="hinge"/><geom size="0.1"/></body>'
        '<body><joint name="f2" type="hinge"/><geom size="0.1"/></body>',
    ),
}


@pytest.mark.parametrize("case", HARMLESS)
def test_what_holds_nothing_is_read(case, tmp_path):
    text = edited(DRIVEN, HARMLESS[case])
    if case == "gripper":
        text = edited(text, (EQUAL, f'<joint joint1="f1" joint2="f2"/>{EQUAL}'))
    if "tendon" in case:
        one = TENDON.replace("both", "one").replace('<joint joint="ram1" coef="1"/>', "")
        text = edited(text, ("</mujoco>", f"{one}</mujoco>"))
    path = tmp_path / "driven.xml"
    path.write_text(text)
    assert_anchors(read_model(path))


def test_the_platform_is_the_body_of_the_loops(tmp_path):
    """Among bodies that are fixed to each other; also where a loop names it first."""
    path = exported("urdf", tmp_path)
    beside = tmp_path / "lift.urdf.loops.json"
    content = json.loads(beside.read_text())
    for loop in content["loops"]:
        loop["link_1"], loop["link_2"] = loop["link_2"], loop["link_1"]
        loop["position"] = [-x for x in loop["position"]]  # none of them is turned
    beside.write_text(json.dumps(content))
    text = path.read_text()
    path.write_text(text[: text.index("<gazebo>")] + "</robot>")
    assert_anchors(read_model(path))
    links = re.findall(r'  <link name="platform">.*?</link>\n', text, re.DOTALL)
    joint = text.index("<joint")
    last = text.replace(links[0], "")[: joint - len(links[0])] + links[0] + text[joint:]
    path.write_text(last)
    beside.unlink()
    assert_anchors(read_model(path))


def test_a_second_mechanism_is_read_where_it_is_named(tmp_path):
    """A hexapod on a platform of another; and two on one base."""
    upper = foreign_mjcf(LIFT).replace("top", "roof").replace("foreign", "upper")
    inner = re.search(r"<worldbody>(.*)</worldbody>", upper, re.DOTALL)[1]
    loops = re.search(r"<equality>(.*)</equality>", upper, re.DOTALL)[1]
    for old in ("tube", "rod", "ram", "tip", "ball", "cover"):
        inner, loops = inner.replace(f'"{old}', f'"u{old}'), loops.replace(f'"{old}', f'"u{old}')
    inner = inner.replace('type="uball"', 'type="ball"')
    roof, legs = re.search(r"(.*?</body>)(.*)", inner, re.DOTALL).groups()
    above = roof.replace('pos="0.0 0.0 1.5"', 'pos="0 0 3"')
    assert above != roof
    stacked = edited(MJCF, ("</body>", f"{legs}</body>"), (EQUAL, f"{loops}{EQUAL}"),
                     ("</worldbody>", f"{above}</worldbody>"))  # fmt: skip
    assert_refused(tmp_path, "stack.xml", stacked, "one mechanism with loops, .*loops also at 'utu")
    assert_anchors(read_model(tmp_path / "stack.xml", platform="top"))
    found = read_model(tmp_path / "stack.xml", base="top", platform="roof")
    assert_anchors(found)


# Which of the two actuators of a leg between lines is driven.

CCC = gsp.Design(
    ["D4"] * 4 + ["A1"] * 2,
    *np.random.default_rng(6).normal(size=(4, 6, 3)),
    unit="m",
    home=Pose([0.1, 0.2, 3.0]),
)


@pytest.mark.parametrize("form", ["urdf", "sdf"])
def test_legs_between_lines_need_a_statement_of_what_is_driven(form, tmp_path):
    path = exported(form, tmp_path, CCC)
    beside = next(tmp_path.glob("*.json"))
    content = json.loads(beside.read_text())
    del content["joints_at_zero"]
    beside.write_text(json.dumps(content))
    assert [leg.name for leg in read_model(path).legs] == [leg.name for leg in CCC.legs]
    message = "leg 1 .*: expected which of 'd1' and 'spin1' an actuator drives, received no stat"
    text = re.sub(r'"leg(\d)_turn"', r'"spin\1"', without_transmissions(path.read_text()))
    assert_refused(tmp_path, path.name, text, message)
    text = re.sub(r'"d(\d)"', r'"slide\1"', text)
    assert_refused(tmp_path, path.name, text, "expected which of 'slide1' and 'spin1'")


def without_transmissions(text):
    return re.sub(r"<transmission.*?</transmission>", "", text, flags=re.DOTALL)


def test_transmissions_of_urdf_state_what_is_driven(tmp_path):
    path = exported("urdf", tmp_path)
    beside = tmp_path / "lift.urdf.loops.json"
    loops = {"loops": json.loads(beside.read_text())["loops"]}
    beside.write_text(json.dumps(loops))
    motor = '<transmission name="t{0}"><joint name="d{0}"/><actuator name="m{0}"/></transmission>'
    words = [motor.format(i) for i in range(1, 7)]
    assert_anchors(read_model(path))
    text = without_transmissions(path.read_text())
    path.write_text(edited(text, ("</robot>", "".join(words) + "</robot>")))
    assert_anchors(read_model(path))
    some = edited(text, ("</robot>", "".join(words[1:]) + "</robot>"))
    assert_refused(tmp_path, path.name, some, "leg 1 .*: expected an actuator of the slide 'd1'")


@pytest.mark.parametrize("other", ["leg1_base_x", ""])
def test_transmissions_and_the_file_of_loops_state_the_same(other, tmp_path):
    """A transmission on another joint than the file has values for, or none on one of them."""
    path = exported("urdf", tmp_path)
    text = path.read_text()
    start = text.index("<transmission")
    one = "<transmission.*?</transmission>" if not other else 'joint name="d1"'
    new = f'joint name="{other}"' if other else ""
    path.write_text(text[:start] + edited(text[start:], (one, new)))
    message = r"loops\.json, key joints_at_zero: expected the joints .* with 'd1'"
    with pytest.raises(MalformedFile, match=message):
        read_model(path)


def test_limits_of_urdf_may_be_infinite(tmp_path):
    path = exported("urdf", tmp_path, LIFT.replace(strokes=[(0.1, 9.0)] * 6))
    limit = r'(<joint name="d1".*?)lower="[^"]*" upper="[^"]*"'
    text = path.read_text()
    path.write_text(edited(text, (limit, r'\1lower="-inf" upper="inf"')))
    assert np.isfinite(read_model(path).strokes).all(axis=1).tolist() == [False] + [True] * 5
    turned = edited(text, (limit, r'\1lower="inf" upper="inf"'))
    assert_refused(tmp_path, path.name, turned, "lower: expected a finite number, received 'inf'")


def test_a_root_that_gazebo_fixes_to_the_world(tmp_path):
    path = exported("urdf", tmp_path)
    fixed = """<gazebo><joint name="f" type="fixed"><parent>world</parent><child>base</child>
        </joint></gazebo></robot>"""
    text = edited(path.read_text(), ("</robot>", fixed))
    path.write_text(text)
    assert_anchors(read_model(path))
    wrong = text.replace(
        "<child>base</child>\n        </joint></gazebo>", "<child>platform</child></joint></gazebo>"
    )
    assert wrong != text
    assert_refused(
        tmp_path, path.name, wrong, "one fixed joint at most of the world, with the root 'base'"
    )
    twice = text.replace("</robot>", fixed.replace('"f"', '"g"'))
    assert_refused(tmp_path, path.name, twice, "name='g'>: expected one fixed joint at most")


TIES_OF_DRAKE = {
    "coupled": (r'(<joint name="d1"[^>]*>)', r'\1<drake:mimic joint="d2" multiplier="1"/>'),
    "pinned": ("</model>", '<drake:ball_constraint name="x"/></model>'),
    "strut": ("</model>", '<drake:joint name="strut" type="planar"/></model>'),
}


@pytest.mark.parametrize("case", TIES_OF_DRAKE)
def test_tags_of_drake_that_tie_are_refused_in_sdf(case, tmp_path):
    path = exported("sdf", tmp_path)
    text = edited(path.read_text(), TIES_OF_DRAKE[case])
    assert_refused(tmp_path, path.name, text, "<drake:.*: expected joints of the format, and no")


@pytest.mark.parametrize("form", ["mjcf", "urdf"])
def test_limits_that_no_length_can_have_are_named(form, tmp_path):
    path = exported(form, tmp_path, LIFT.replace(strokes=[(0.1, 9.0)] * 6))
    change = {
        "urdf": (r'(<joint name="d3".*?)lower="[^"]*" upper="[^"]*"', r'\1lower="-20" upper="-10"'),
        "mjcf": (r'(<joint name="d3"[^>]*?)range="[^"]*"', r'\1range="-20 -10"'),
    }[form]
    text = edited(path.read_text(), change)
    message = "leg 3 .*: expected limits that a length can have, received limits of 'd3' from -"
    assert_refused(tmp_path, path.name, text, message)


@pytest.mark.parametrize(
    ("limits", "stroke"),
    [("2.5 3.5", None), ("-9 -8", None), ("-7 7", (0.0, np.pi)), ("-0.1 0.2", (-0.1, 0.2))],
)
def test_limits_that_no_angle_can_have(limits, stroke, tmp_path):
    """The angle of an A1 leg is in (0, π); limits of the file count from its configuration."""
    design = driven.of_five_legs()
    angle = float(design.at(design.home).joints[-1])
    path = exported("urdf", tmp_path, design.replace(strokes=[*[(np.nan,) * 2] * 5, (0.0, np.pi)]))
    low, high = limits.split()
    turn = r'(<joint name="theta5".*?)lower="[^"]*" upper="[^"]*"'
    text = edited(path.read_text(), (turn, rf'\1lower="{low}" upper="{high}"'))
    if stroke is None:
        message = "leg 5 .*: expected limits that an angle can have, received limits of 'theta5'"
        assert_refused(tmp_path, path.name, text, message)
        return
    path.write_text(text)
    wanted = stroke if stroke == (0.0, np.pi) else angle + np.array(stroke)
    np.testing.assert_allclose(read_model(path).strokes[-1], wanted, atol=1e-9)


def test_infinite_ends_of_ranges_of_mjcf(tmp_path):
    path = exported("mjcf", tmp_path, LIFT.replace(strokes=[(0.1, 9.0)] * 6))
    joint = r'(<joint name="d3"[^>]*?)range="[^"]*"'
    path.write_text(edited(path.read_text(), (joint, r'\1range="-inf 9"')))
    np.testing.assert_array_equal(np.isnan(read_model(path).strokes[2]), [True, False])
    text = edited(path.read_text(), (joint, r'\1range="nan 9"'))
    assert_refused(tmp_path, path.name, text, "range: expected numbers, received 'nan 9'")


@pytest.mark.parametrize("form", ["mjcf", "urdf", "sdf"])
def test_strokes_with_one_end_are_read_back(form, tmp_path):
    strokes = [(np.nan, 2.5), (1.2, np.nan), (np.nan, np.nan), (1.0, 3.0), (1.5, 2.2), (0.5, 5.0)]
    found = read_model(exported(form, tmp_path, LIFT.replace(strokes=strokes))).strokes
    np.testing.assert_allclose(np.nan_to_num(found), np.nan_to_num(strokes), atol=1e-9)
    assert np.isnan(found).tolist() == np.isnan(strokes).tolist()


@pytest.mark.parametrize("holder", ["platform", "leg1_platform"])
def test_joints_of_sdf_between_frames(holder, tmp_path):
    """A frame on a frame of the platform, or of a joint that carries it, is the platform."""
    path = exported("sdf", tmp_path)
    start, end = path.read_text().split('<joint name="leg2_base"')
    top = f'<frame name="top" attached_to="{holder}"><pose relative_to="platform"/></frame>'
    frames = f'{top}<frame name="tip" attached_to="top"/></model>'
    end = end.replace("<child>platform<", "<child>tip<").replace("</model>", frames)
    assert end.count(">tip<") == 5
    text = f'{start}<joint name="leg2_base"{end}'
    path.write_text(text)
    assert_anchors(read_model(path))
    path.write_text(text.replace("<parent>leg2_lower<", "<parent>leg2_base<"))
    assert_anchors(read_model(path))
    for attached in ("tip", "nowhere"):
        wrong = text.replace(f'"top" attached_to="{holder}"', f'"top" attached_to="{attached}"')
        message = "a link, joint or frame of the model|a link of the model, or a frame or joint"
        assert_refused(tmp_path, path.name, wrong, message)


# Legs with six joints of which two do the same.


@pytest.mark.parametrize(("second", "independent"), [("0 1 0", 6), ("0 0 1", 5), ("1 0 0", 5)])
def test_legs_of_five_independent_freedoms_are_refused(second, independent, tmp_path):
    """A turn about the leg is one of the ball at its end; parallel axes at a point are one."""
    text = foreign_sdf(LIFT, ("universal", "ball"), cylinder=False)
    path = tmp_path / "legs.sdf"
    path.write_text(text.replace("<axis2><xyz>0 1 0", f"<axis2><xyz>{second}"))
    if independent == 6:
        assert_anchors(read_model(path))
        return
    with pytest.raises(MalformedFile, match=r"leg 1 .*(6, of them 5 independent|turns whose axes)"):
        read_model(path)


def test_axes_that_nearly_meet_are_refused_with_their_distance(tmp_path):
    first = r'(<joint type="hinge" axis="[^"]*"/><joint type="hinge")'
    text = edited(MJCF, (first, r'\1 pos="0 0 2e-4"'))
    assert_refused(tmp_path, "near.xml", text, r"axes miss each other by \d.*e-05 m, which is more")


def test_a_leg_far_from_the_others_does_not_widen_the_tolerance(tmp_path):
    """The first axis of one leg misses the second by 2e-4; another leg is drawn 1000 away."""
    text = upright_mjcf("sites").replace('type="ball"/>', 'type="hinge" axis="1 0 0"/>'
                                         '<joint type="hinge" axis="0 1 0" pos="0 0 2e-4"/>'
                                         '<joint type="hinge" axis="0 0 1"/>', 1)  # fmt: skip
    message = "leg 1 .*axes miss each other by"
    assert_refused(tmp_path, "near.xml", text, message)
    last = ring([LIFT.base_points[-1]])[0]
    assert_refused(tmp_path, "far.xml", text.replace(last, "1000 0 0"), message)


def test_joints_that_are_all_at_one_point_are_refused(tmp_path):
    legs = "".join(
        f'<body name="b{i}"><joint type="hinge" axis="1 0 0"/>{GEOM}</body>' for i in range(3)
    )
    loops = "".join(f'<connect body1="b{i}" body2="top" anchor="0 0 0"/>' for i in range(3))
    top = f'<body name="top"><joint type="hinge" axis="0 1 0"/>{GEOM}</body>'
    text = f"{HEAD}{top}{legs}</worldbody><equality>{loops}</equality></mujoco>"
    assert_refused(tmp_path, "point.xml", text, "a joint of 1 degree of freedom")
    assert_refused(tmp_path, "point.xml", text.replace("hinge", "free", 1), "received 4")


ONE_MOTOR = "".join(f'<joint name="d{i}"/>' for i in (1, 2)) + '<actuator name="m"/>'
SAME_MOTOR = '<transmission><joint name="d{}"/><actuator name="d1_actuator"/></transmission>'
CONTROL = """<ros2_control><joint name="d2"><param name="mimic">d1</param></joint>
    </ros2_control>"""
CONTROL_OF_ONE = '<ros2_control><joint name="d1"><command_interface/></joint></ros2_control>'
INNER = """<ros2_control><transmission><joint name="leg1_base_x"/><actuator name="m"/>
    </transmission></ros2_control>"""
IDLE = '<transmission><joint name="d1"/></transmission>'
PLUGIN = """<gazebo><plugin filename="libmimic.so"><joint>d1</joint><mimicJoint>d2</mimicJoint>
    </plugin></gazebo>"""
HELD = """<drake:ball_constraint name="held"><drake:ball_constraint_body_A name="base"/>
    <drake:ball_constraint_body_B name="platform"/></drake:ball_constraint>"""


@pytest.mark.parametrize(
    ("element", "message"),
    [
        (f"<transmission>{ONE_MOTOR}</transmission>", "<actuator>: expected one for each of 2 joi"),
        (IDLE, "<actuator>: expected one for the joint, received 0"),
        (SAME_MOTOR.format(2), "<actuator>: expected one of no other transmission"),
        (CONTROL, "a mimic of 'd1'"),
        (PLUGIN, "a plugin of a mimic of 'd2'"),
        (HELD, "no constraints but those of its loops"),
        ('<loop_joint name="x" type="fixed"/>', "no constraints but those of its loops"),
        ('<coupling name="x"/>', "no constraints but those of its loops"),
        ('<loop name="x" type="fixed"/>', "no constraints but those of its loops"),
        ('<drake:joint name="strut" type="ball"/>', "name='strut'>: expected joints of the format"),
        (CONTROL_OF_ONE, "expected the joints that have an actuator in .*, received none for 'd2'"),
        (
            INNER,
            "<joint name='leg1_base_x'>: expected the joints .*, received one for 'leg1_base_x'",
        ),
    ],
)
def test_elements_of_urdf_that_tie_joints_or_links_are_refused(element, message, tmp_path):
    path = exported("urdf", tmp_path)
    text = edited(path.read_text(), ("</robot>", element + "</robot>"))
    assert_refused(tmp_path, path.name, text, message)


def test_flags_of_mujoco(tmp_path):
    """Those that open the loops are refused; without limits there are no strokes."""
    path = exported("mjcf", tmp_path, LIFT.replace(strokes=[(0.1, 9.0)] * 6))

    def flagged(flag):
        option = f'<option><flag {flag}="disable"/></option><compiler'
        return edited(path.read_text(), ("<compiler", option))

    for flag in ("equality", "constraint"):
        assert_refused(tmp_path, "open.xml", flagged(flag), f"<flag>, {flag}: expected enable")
    assert np.isfinite(read_model(path).strokes).all()
    (tmp_path / "free.xml").write_text(flagged("limit"))
    assert read_model(tmp_path / "free.xml").strokes is None


BALL = """<drake:ball_constraint name="more"><drake:ball_constraint_body_A name="leg1_upper"/>
    <drake:ball_constraint_p_AP value="0 0 -0.2"/><drake:ball_constraint_body_B name="platform"/>
    <drake:ball_constraint_p_BQ value="{}"/></drake:ball_constraint></robot>"""


def test_balls_of_drake_must_be_those_of_the_loops(tmp_path):
    """A point of a fixed loop may be anywhere, if it is the same of both links; not of a ball."""
    path = exported("urdf", tmp_path)
    text = path.read_text()
    moved = re.sub(r'(constraint_p_BQ value=")[^ ]*', r"\g<1>0.5", text)
    assert_refused(tmp_path, path.name, moved, "expected a point that 'loop leg1' holds as well")
    (tmp_path / "lift.urdf.loops.json").unlink()
    joints = ""
    for i, b in enumerate(LIFT.platform_points, 1):
        joints += f"""<joint name="g{i}" type="ball"><parent>platform</parent>
          <child>leg{i}_upper</child><pose relative_to="platform">{ring([b])[0]} 0 0 0</pose>
          </joint>"""
    text = edited(text, ("<gazebo>.*</gazebo>", f"<gazebo>{joints}</gazebo>"))
    text = re.sub(r'(constraint_body_A name="leg[0-9]_)platform', r"\1upper", text)
    path.write_text(text)
    assert_anchors(read_model(path))
    leg = LIFT.home.position + LIFT.platform_points[0] - LIFT.base_points[0]
    below = LIFT.platform_points[0] - 0.2 * leg / np.linalg.norm(leg)
    hinge = edited(text, ("</robot>", BALL.format(ring([below])[0])))
    assert_refused(tmp_path, path.name, hinge, "expected a point that 'g1' holds as well")


@pytest.mark.parametrize("form", ["mjcf", "sdf"])
def test_a_crank_that_turns_on_without_an_end_has_no_stroke(form, tmp_path):
    """With one end in a program it still comes to every angle; one of a design has both."""
    design = driven.rotary()
    strokes = [(np.nan, 3.0), (-1.0, np.nan), (-3.5, 4.0), (2.0, 3.0), (2.5, 4.0), (-np.pi, np.pi)]
    path = exported(form, tmp_path, design.replace(strokes=strokes))
    found = read_model(path).strokes
    wanted = [(-np.pi, 3.0), (-1.0, np.pi), (np.nan,) * 2, (2.0, 3.0), (2.5, np.pi), (np.nan,) * 2]
    np.testing.assert_allclose(found, wanted, atol=1e-9)
    text = path.read_text()
    if form == "mjcf":
        text = edited(text, (r'(name="theta2"[^>]*?range="[^ ]*) [^"]*', r"\1 inf"))
    else:
        text = edited(text, (r'(name="theta2".*?)<upper>.*?</upper>', r"\1"))
    path.write_text(text)
    assert np.isnan(read_model(path).strokes[1]).all()


def test_quaternions_of_urdf_are_read(tmp_path):
    path = exported("urdf", tmp_path)
    turned = LIFT.home.moved([0, 0, 0, 0, 0, np.pi / 6])
    given = f'quat_xyzw="{" ".join(map(repr, turned.quaternion.tolist()))}"'
    text = path.read_text()
    start = text.index('name="base_to_platform"')
    text = text[:start] + re.sub(r'rpy="[^"]*"', given, text[start:], count=1)
    path.write_text(text)
    np.testing.assert_allclose(read_model(path).home.rotation, turned.rotation, atol=1e-12)
    assert_refused(tmp_path, path.name, text.replace(given, f'{given} rpy="0 0 0"'), "and no rpy")


def test_plugins_of_sdf_that_couple_joints_are_refused(tmp_path):
    path = exported("sdf", tmp_path)
    plugin = """<plugin name="m" filename="libmimic.so"><joint>d1</joint>
        <mimicJoint>d2</mimicJoint></plugin></model>"""
    text = edited(path.read_text(), ("</model>", plugin))
    assert_refused(tmp_path, path.name, text, "a plugin of a mimic of 'd2'")
