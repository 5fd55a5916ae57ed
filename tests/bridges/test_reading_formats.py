"""Wrong parts of SDF, URDF, YAML and JSON are named, and right ones are read."""

import json
import re

import numpy as np
import pytest

from gsp.bridges import read_model
from gsp.errors import InvalidInput, MalformedFile
from gsp.geometry.pose import Pose
from tests.bridges.test_reading import LIFT, PLATES, POINTS, foreign_sdf, ring
from tests.bridges.test_reading_refusals import assert_anchors, assert_refused, edited, exported

FORMS = ("mjcf", "urdf", "sdf")

# Poses and axes of SDF.

SDF = foreign_sdf(LIFT, ("universal", "ball"), cylinder=False)
AT = r"(<link name=\"disc\"><pose)>[^<]*"


@pytest.mark.parametrize(
    "pose",
    [
        ' degrees="true">0 0 1.5 0 0 30',
        ' rotation_format="quat_xyzw">0 0 1.5 0 0 0.25881904510252074 0.9659258262890683',
        ' rotation_format="euler_rpy" degrees="1">0 0 1.5 0 0 30',
    ],
)
def test_poses_of_sdf_in_degrees_and_quaternions(pose, tmp_path):
    """The platform is turned by 30 degrees: the anchors in its axes are turned back."""
    path = tmp_path / "turned.sdf"
    path.write_text(edited(SDF, (AT, rf"\1{pose}")))
    found = read_model(path)
    back = Pose.from_rpy([0, 0, 0], [0, 0, np.pi / 6]).rotation
    np.testing.assert_allclose(found.home.rotation, back, atol=1e-15)
    np.testing.assert_allclose(found.platform_points, LIFT.platform_points @ back, atol=1e-9)


WRONG_SDF = {
    "format": ((AT, r'\1 rotation_format="quat_wxyz">0 0 1.5 1 0 0 0'), "euler_rpy or quat_xyzw"),
    "flag": ((AT, r'\1 degrees="yes">0 0 1.5 0 0 0'), "<pose> degrees: expected true or false"),
    "zero": ((AT, r'\1 rotation_format="quat_xyzw">0 0 1.5 0 0 0 0'), "a quaternion other than"),
    "version": ((' version="1.7"', ""), "version: expected 1.3 or later, below 2, received none"),
    "old": ((' version="1.7"', ' version="1.2"'), "<sdf>, version: expected 1.3 or later"),
    "choice": (("</xyz>", "</xyz><use_parent_model_frame>1</use_parent_model_frame>"),
               "expected <xyz expressed_in=…>, as of version 1.7, received true"),
    "include": (("</model>", "<include><uri>model://a</uri></include></model>"),
                "<include>: expected a model whose links and joints are its own"),
    "nested": (("</model>", '<model name="in"><link name="q"/></model></model>'), "<model name='"),
    "guide": (("</model>", '<joint name="g" type="prismatic"><parent>frame</parent>'
               "<child>disc</child><axis/></joint></model>"), r"of 1 degree of freedom \(slide"),
    "ground": (("</model>", '<joint name="g" type="prismatic"><parent>world</parent>'
                "<child>disc</child><axis/></joint></model>"), r"of 1 degree of freedom \(slide"),
    "mimic": (("</xyz><limit>", '</xyz><mimic joint="ram1"/><limit>'), "<mimic> of 'ram1'"),
    "static": (('<link name="frame"/>', '<static>true</static><link name="frame"/>'), "<static>"),
    "no links": (("<frame .*</model>", "</model>"), "<link>: expected links, received none"),
    "frame": ((' relative_to="tube0"', ' relative_to="nowhere"'), "relative_to: expected a link"),
    "two poses": (('<link name="disc">', '<link name="disc"><pose/>'), "<pose>: expected one"),
    "macro": (("</model>", "<xacro:leg/></model>"), "<xacro:leg>: expected a model that the prog"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG_SDF)
def test_wrong_parts_of_sdf(case, tmp_path):
    change, message = WRONG_SDF[case]
    assert_refused(tmp_path, "wrong.sdf", edited(SDF, change), message)


def test_kinds_of_joints_in_sdf_are_read_in_any_case(tmp_path):
    path = tmp_path / "lift.sdf"
    path.write_text(SDF.replace('type="prismatic"', 'type="Prismatic"'))
    assert_anchors(read_model(path))


def slides_in_model_axes(text):
    """State the axes of the slides in the axes of the model: along the legs."""
    for i, (a, b) in enumerate(zip(LIFT.base_points, LIFT.platform_points, strict=True)):
        axis = ring([b + LIFT.home.position - a])[0]
        text = edited(text, (rf'(name="ram{i}".*?<xyz>)0 0 1', rf"\g<1>{axis}"))
    return text


@pytest.mark.parametrize(("version", "choice"), [("1.4", None), ("1.6", "true"), ("1.6", "0")])
def test_axes_of_old_versions_of_sdf(version, choice, tmp_path):
    """Below 1.5 axes are in the axes of the model, in 1.5 and 1.6 where the file states it."""
    path = tmp_path / "old.sdf"
    text = SDF.replace('version="1.7"', f'version="{version}"')
    text = text if choice == "0" else slides_in_model_axes(text)
    if choice is not None:
        old = f"<use_parent_model_frame>{choice}</use_parent_model_frame>"
        text = re.sub(r'(name="ram\d".*?</xyz>)', rf"\1{old}", text, flags=re.DOTALL)
    path.write_text(text)
    assert_anchors(read_model(path))


# URDF and the file of its loops.

WRONG_URDF = {
    "xyz and rpy": ((r'(<joint name="d2".*?)xyz="[^"]*" rpy="', r'\1xyz="0 0" rpy="0 '),
                    "<joint name='d2'>, <origin> xyz: expected 3 finite numbers, received '0 0'"),
    "underscore": ((r'(<joint name="d2".*?xyz=")[^ ]*', r"\g<1>1_0"), "received '1_0 "),
    "large": ((r'(<joint name="d2".*?xyz=")[^ ]*', r"\g<1>1e101"), "of at most 1e.100 in size"),
    "digits": ((r'(<joint name="d2".*?xyz=")[^ ]*', "\\g<1>\u0662"), "<origin> xyz: expected 3"),
    "link twice": (("</robot>", '<link name="platform"/></robot>'), "name: expected a name of it"),
    "joint twice": (("</robot>", '<joint name="d1"/></robot>'), "name: expected a name of its own"),
    "two origins": ((r'(<joint name="d1"[^>]*>)', r"\1<origin/>"), "<origin>: expected one"),
    "two axes": ((r'(<joint name="d1"[^>]*>)', r'\1<axis xyz="1 0 0"/>'), "<axis>: expected one"),
    "macro": (("</robot>", "<xacro:leg/></robot>"), "<xacro:leg>: expected a model"),
    "mimic": ((r'(<joint name="d2"[^>]*>)', r'\1<mimic joint="d1"/>'), "<mimic> of 'd1'"),
    "guide": ((r'(name="base_to_platform" type=")floating("[^>]*>)',
               r'\1prismatic\2<axis xyz="0 0 1"/>'), "a joint of 1 degree of freedom"),
    "no axis": ((r'(<joint name="d1".*?)<axis xyz="[^"]*"', r"\1<axis"), "<axis> xyz: expected 3 "),
    "gazebo": (('type="fixed"', 'type="ball"'), "type: expected fixed, as the loop in"),
    "gazebo twice": (('name="[^"]*" type="fixed"', 'name="d1" type="fixed"'),
                     "name: expected a name of its own, received 'd1'"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG_URDF)
def test_wrong_parts_of_urdf(case, tmp_path):
    change, message = WRONG_URDF[case]
    text = exported("urdf", tmp_path).read_text()
    if case.startswith("gazebo"):
        text = text[: text.index("<gazebo>")] + edited(text[text.index("<gazebo>") :], change)
    else:
        text = edited(text, change)
    assert_refused(tmp_path, "lift.urdf", text, message)


@pytest.mark.parametrize("content", ["null", "[]", "{}", '{"loops": []}'])
def test_a_file_of_loops_without_loops_is_named(content, tmp_path):
    path = exported("urdf", tmp_path)
    (tmp_path / "lift.urdf.loops.json").write_text(content)
    with pytest.raises(MalformedFile, match=r"lift\.urdf\.loops\.json, line 1.*: expected a"):
        read_model(path)


@pytest.mark.parametrize("pose", ["", ' relative_to="platform"', ' relative_to="base"'])
def test_frames_of_loops_in_gazebo_elements(pose, tmp_path):
    """Balls that join the rods to the platform, with the place of each in several frames."""
    path = exported("urdf", tmp_path)
    (tmp_path / "lift.urdf.loops.json").unlink()
    joints = ""
    for i, b in enumerate(LIFT.platform_points, 1):
        at = b + LIFT.home.position if "base" in pose else b
        parent, child = ("platform", f"leg{i}_upper") if pose else (f"leg{i}_upper", "platform")
        joints += f"""<joint name="g{i}" type="ball"><parent>{parent}</parent>
          <child>{child}</child><pose{pose} degrees="true">{ring([at])[0]} 0 0 90</pose></joint>"""
    text = edited(path.read_text(), ("<gazebo>.*</gazebo>", f"<gazebo>{joints}</gazebo>"))
    text = re.sub("<drake:ball_constraint .*?</drake:ball_constraint>", "", text, flags=re.DOTALL)
    path.write_text(text)
    assert_anchors(read_model(path))
    wrong = text.replace(f"<pose{pose}", '<pose relative_to="nowhere"')
    assert_refused(tmp_path, "lift.urdf", wrong, "<pose> relative_to: expected the name of a link")


@pytest.mark.parametrize("form", ["urdf", "sdf"])
@pytest.mark.parametrize("key", ["joints_at_zero", "slides_at_zero"])
def test_values_of_joints_that_are_not_there_are_refused(form, key, tmp_path):
    """Else a joint of another name would be passive, or its line begin elsewhere."""
    path = exported(form, tmp_path)
    beside = next(tmp_path.glob("*.json"))
    content = json.loads(beside.read_text())
    content[key]["d7"] = 1.0
    beside.write_text(json.dumps(content))
    with pytest.raises(MalformedFile, match=rf"{key}: expected names of joints .*received 'd7'"):
        read_model(path)


def test_known_names_are_listed_in_all_forms(tmp_path):
    for form in FORMS:
        with pytest.raises(MalformedFile, match=r"unknown base 'nope'[;.] [Kk]nown: .*leg1_lo"):
            read_model(exported(form, tmp_path), base="nope")


def test_mujoco_writes_nothing(tmp_path, monkeypatch, capfd):
    """Of a singular matrix of inertia MuJoCo warns, and writes a file where it runs."""
    monkeypatch.chdir(tmp_path)
    hinge = '<joint type="hinge" axis="1 0 0"/>'
    text = f'<mujoco><worldbody><body>{hinge}{hinge}<geom size="0.1"/></body></worldbody></mujoco>'
    assert_refused(tmp_path, "bad.xml", text, "a platform with at least 3 chains")
    assert [x.name for x in tmp_path.iterdir()] == ["bad.xml"]
    assert capfd.readouterr() == ("", "")


# Files of packages.


@pytest.mark.parametrize(("text", "value"), [("0o10", 8.0), ("0x1F", 31.0), ("-7", -7.0)])
def test_integers_of_yaml(text, value, tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text(POINTS.replace("3.5]", f"{text}]", 1))
    assert read_model(path).base_points[0, 2] == value


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.yaml", POINTS.replace("[-3.5,", "[[-3.5],", 1), r"points\[0\].frame\[0\]: expected"),
        ("a.json", '{"actuator": [' + ",".join(['{"active": 0}'] * 6) + "]}", "at least 6 active"),
        ("a.json", '{"actuator": [' + ",".join(['{"active": "no"}'] * 6) + "]}", "true or false"),
        ("a.json", json.dumps(PLATES).replace('"Basic SP"', "3"), "key Name: expected a name"),
        ("a.yaml", "a: &a {k: 1, l: 2}\n" + "".join(
            f"{new}: &{new} {{<<: [{', '.join([f'*{old}'] * 9)}]}}\n"
            for old, new in zip("abcdefgh", "bcdefghi", strict=True)), "at most 100000 keys"),
        ("a.yaml", "a: &a [x, x, x]\n" + "".join(
            f"{new}: &{new} [{', '.join([f'*{old}'] * 9)}]\n"
            for old, new in zip("abcdefghijkl", "bcdefghijklm", strict=True)) + "points: *m\n",
         r"key points\[0\]: expected a mapping of keys, received \[\[\[\[\["),
    ],
)  # fmt: skip
def test_wrong_files_of_packages(name, text, message, tmp_path):
    assert_refused(tmp_path, name, text, message)


def test_names_and_bodies_of_packages(tmp_path):
    path = tmp_path / "sp.json"
    path.write_text(json.dumps(PLATES))
    assert read_model(path).name == "Basic SP"
    path.write_text(json.dumps(PLATES).replace("Basic SP", ""))
    assert read_model(path).name == "sp"
    with pytest.raises(InvalidInput, match=r"base: expected .* a file of a package"):
        read_model(path, base="q")
