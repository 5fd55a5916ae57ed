"""Models and files of other programs become the designs that they are."""

import json
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

import gsp
from gsp.bridges import Solids, export, read_model
from gsp.bridges.exports import SUFFIXES
from gsp.bridges.proof import BOX, random_design
from gsp.errors import GspError, MalformedFile
from gsp.geometry.pose import Pose
from gsp.model.units import METRES_PER_UNIT
from tests import campaign

FORMS = ("mjcf", "urdf", "sdf")
CLASSES = gsp.catalogue.mechanisms()[::17]
LIFT = gsp.hexapod(2, 20, 1, 30, 1.5, degrees=True, unit="m", name="lift")


def assert_same(found, design, tolerance=1e-12):
    """Same legs, drives, anchors, lines, home pose; the strokes of `found` are some of those."""
    metres = METRES_PER_UNIT.get(design.unit, 1.0)
    design = design.scaled(metres)
    size = design.rms_radius * tolerance
    assert [leg.name for leg in found.legs] == [leg.name for leg in design.legs]
    for ours, theirs in zip(found.drives, design.drives, strict=True):
        assert type(ours) is type(theirs)
        if ours is not None:
            assert ours.branch == theirs.branch
            np.testing.assert_allclose(ours.numbers, theirs.numbers, rtol=0, atol=size)
    np.testing.assert_allclose(found.base_points, design.base_points, rtol=0, atol=size)
    np.testing.assert_allclose(found.platform_points, design.platform_points, rtol=0, atol=size)
    for side in ("base_directions", "platform_directions"):
        np.testing.assert_allclose(
            getattr(found, side), getattr(design, side), rtol=0, atol=tolerance
        )
    np.testing.assert_allclose(found.home.position, design.home.position, rtol=0, atol=size)
    np.testing.assert_allclose(found.home.rotation, design.home.rotation, rtol=0, atol=tolerance)
    if design.strokes is not None:
        known = np.isfinite(design.strokes).all(axis=1)
        np.testing.assert_allclose(found.strokes[known], design.strokes[known], rtol=1e-12)


def round_trip(design, form, folder, solids=None):
    path = folder / f"model{SUFFIXES[form]}"
    export(design, design.home, form, path, solids, overwrite=True)
    return read_model(path)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", campaign.some(gsp.catalogue.design_names(), 7))
def test_published_designs_come_back(name, form, tmp_path):
    design = gsp.catalogue.design(name)
    found = round_trip(design, form, tmp_path)
    assert_same(found, design)
    assert (found.name, found.unit) == (name, "m")


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("mechanism", campaign.some(CLASSES, 5), ids=str)
def test_designs_of_each_class_come_back(mechanism, form, tmp_path):
    rng = np.random.default_rng(4)
    pose = BOX.sample(1, rng=rng)[0]
    design = random_design(mechanism, rng).replace(home=pose)
    assert_same(round_trip(design, form, tmp_path), design)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("scale", [1e-3, 1e4])
def test_other_sizes_frames_redundant_legs_and_strokes(form, scale, tmp_path):
    rng = np.random.default_rng(8)
    legs = ["D1", "D2", "D3", "D4 A1", "A1", "D1", "D1", "D4"]
    design = gsp.Design(
        legs,
        rng.normal(size=(8, 3)) * [2, 2, 0.1] + [40, 0, -3],
        rng.normal(size=(8, 3)) + [0, 20, 0],
        *rng.normal(size=(2, 8, 3)),
        home=Pose.from_rpy([38, -20, 3], [0.3, -0.8, 2.0]),
    )
    values = design.at(design.home).joints
    design = design.replace(strokes=np.stack((0.9 * values, 1.05 * values), axis=1)).scaled(scale)
    solids = Solids(metres=1.0, density=2700.0 / scale**3)
    found = round_trip(design, form, tmp_path, solids)
    assert_same(found, design, 1e-11)  # the origin is twenty sizes away
    np.testing.assert_allclose(
        found.at(found.home).joints, design.at(design.home).joints, rtol=1e-11
    )


def test_without_the_file_beside_it_sdf_gives_the_same_mechanism(tmp_path):
    """The anchors on lines lie at the joints: the same joint values and Jacobian."""
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2").scaled(1e-3)
    path = tmp_path / "model.sdf"
    export(design, design.home, "sdf", path, Solids(metres=1.0))
    (tmp_path / "model.sdf.joints.json").unlink()
    found = read_model(path)
    one, other = found.at(found.home), design.at(design.home)
    np.testing.assert_allclose(one.joints, other.joints, rtol=1e-12)
    np.testing.assert_allclose(one.jacobian, other.jacobian, atol=1e-11)


# Models as other people write them: universal joints, cylinders, sites, covers, another order.


def ring(points):
    return [" ".join(map(repr, map(float, p))) for p in points]


def foreign_mjcf(design, *, lift=0.0, site=False):
    """UPS legs of hinges, the platform first, with a cover on each leg."""
    p = design.home.position + [0, 0, lift]
    bodies, loops, sites = "", "", ""
    for i, (a, b) in enumerate(zip(design.base_points, design.platform_points, strict=True)):
        d = design.home.position + b - a
        length = float(np.linalg.norm(d))
        u = d / length
        side = np.cross(u, [0.6, 0.0, 0.8])
        side /= np.linalg.norm(side)
        x, y = ring([side, np.cross(u, side)])
        end = ring([0.3 * length * u])[0]
        tip = ring([0.7 * length * u])[0]
        bodies += f"""
        <body name="tube{i}" pos="{ring([a])[0]}">
          <joint type="hinge" axis="{x}"/><joint type="hinge" axis="{y}"/>
          <geom type="sphere" size="0.01"/>
          <body name="cover{i}"><joint type="hinge" axis="1 0 0"/>
            <geom type="sphere" size="0.01"/></body>
          <body name="rod{i}" pos="{end}">
            <joint name="ram{i}" type="slide" axis="{ring([-u])[0]}" range="-0.2 0.1"/>
            <geom type="sphere" size="0.01"/><site name="tip{i}" pos="{tip}"/></body>
        </body>"""
        sites += f'<site name="ball{i}" pos="{ring([b])[0]}"/>'
        if site:
            loops += f'<connect site1="ball{i}" site2="tip{i}"/>'
        else:
            loops += f'<connect body1="rod{i}" body2="top" anchor="{tip}"/>'
    return f"""<mujoco model="foreign"><compiler autolimits="true" angle="radian"/><worldbody>
      <body name="top" pos="{ring([p])[0]}"><freejoint/><geom type="box" size="1 1 0.1"/>{sites}
      </body>{bodies}</worldbody><equality>{loops}</equality></mujoco>"""


@pytest.mark.parametrize(("lift", "site"), [(0.0, False), (0.0, True), (0.4, True)])
def test_ups_legs_in_mjcf(lift, site, tmp_path):
    """Also with loops that are open in the file: anchors are those of the bodies."""
    design = LIFT.with_origin([0.1, 0.2, 0.0]).replace(home=Pose([0.2, -0.1, 1.6]))
    path = tmp_path / "foreign.xml"
    path.write_text(foreign_mjcf(design, lift=lift, site=site))
    found = read_model(path)
    moved = design.replace(home=Pose(design.home.position + [0, 0, lift]))
    assert_same(found, moved.replace(strokes=None), 1e-9)
    lengths = design.at(design.home).joints  # the axis points to the base: the signs change
    np.testing.assert_allclose(found.strokes[:, 0], lengths - 0.1, rtol=1e-9)
    np.testing.assert_allclose(found.strokes[:, 1], lengths + 0.2, rtol=1e-9)
    assert read_model(path, platform="top", base="world", name="x").name == "x"


def foreign_sdf(design, kinds=("universal", "universal"), cylinder=True):
    """UCU legs in the old and the new way to write frames."""
    text, joints = "", ""
    for i, (a, b) in enumerate(zip(design.base_points, design.platform_points, strict=True)):
        d = design.home.position + b - a
        length = float(np.linalg.norm(d))
        u = d / length
        x = np.cross(u, [0.6, 0.0, 0.8])
        x /= np.linalg.norm(x)
        place = Pose(a, np.stack((x, np.cross(u, x), u), axis=-1))
        rpy = " ".join(map(repr, map(float, place.angles())))
        pose = f"{ring([a])[0]} {rpy}"
        turning = '<link name="turning{i}"><pose relative_to="tube{i}">0 0 0.2 0 0 0</pose></link>'
        text += f'<link name="tube{i}"><pose>{pose}</pose></link>'
        text += (
            f'<link name="rod{i}"><pose relative_to="tube{i}">0 0 {length!r} 0 0 0</pose></link>'
        )
        text += turning.format(i=i) if cylinder else ""
        two = "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>"
        joints += f"""<joint name="low{i}" type="{kinds[0]}"><parent>frame</parent>
          <child>tube{i}</child>{two if kinds[0] == "universal" else ""}</joint>"""
        middle = f"turning{i}" if cylinder else f"tube{i}"
        if cylinder:
            joints += f"""<joint name="spin{i}" type="revolute"><parent>tube{i}</parent>
              <child>turning{i}</child><axis><xyz>0 0 1</xyz></axis></joint>"""
        joints += f"""<joint name="ram{i}" type="prismatic"><parent>{middle}</parent>
          <child>rod{i}</child><axis><xyz>0 0 1</xyz><limit><lower>-0.5</lower></limit></axis>
          </joint>
          <joint name="high{i}" type="{kinds[1]}"><pose relative_to="rod{i}">0 0 0 0 0 0</pose>
          <parent>rod{i}</parent><child>disc</child>{two if kinds[1] == "universal" else ""}
          </joint>"""
    home = ring([design.home.position])[0]
    return f"""<?xml version="1.0"?><sdf version="1.7"><world name="w"><model name="other">
      <frame name="up"><pose>0 0 1 0 0 0</pose></frame><link name="frame"/>
      <joint name="ground" type="fixed"><parent>world</parent><child>frame</child></joint>
      <link name="disc"><pose>{home} 0 0 0</pose></link>{text}{joints}</model></world></sdf>"""


@pytest.mark.parametrize("kinds", [("universal", "universal"), ("ball", "universal")])
def test_universal_joints_and_cylinders_in_sdf(kinds, tmp_path):
    path = tmp_path / "other.sdf"
    path.write_text(foreign_sdf(LIFT, kinds, cylinder=kinds[0] == "universal"))
    found = read_model(path)
    assert_same(found, LIFT)
    lengths = LIFT.at(LIFT.home).joints
    np.testing.assert_allclose(found.strokes[:, 0], lengths - 0.5, rtol=1e-12)
    assert np.isnan(found.strokes[:, 1]).all()


@pytest.mark.parametrize("floating", [True, False])
def test_loops_in_gazebo_elements_of_urdf(floating, tmp_path):
    path = tmp_path / "lift.urdf"
    export(LIFT, LIFT.home, "urdf", path, floating=floating)
    (tmp_path / "lift.urdf.loops.json").unlink()
    assert_same(read_model(path), LIFT)
    root = ElementTree.fromstring(path.read_text())
    for extension in root.findall("gazebo"):
        root.remove(extension)
    path.write_text(ElementTree.tostring(root, encoding="unicode"))
    with pytest.raises(MalformedFile, match="the legs are open"):
        read_model(path)


# What is wrong in a file is named.


def spoiled(form, old, new, folder):
    path = folder / f"bad{SUFFIXES[form]}"
    export(LIFT, LIFT.home, form, path, overwrite=True)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    return path


WRONG = {
    "not xml": ("urdf", "</robot>", "", r"line \d+: not XML: no element found"),
    "root": ("sdf", "<sdf ", "<sdg ", r"line \d+: not XML: mismatched"),
    "kind": ("urdf", 'name="d1" type="prismatic"', 'name="d1" type="slide"',
             'line \\d+, <joint name=.d1.>, type: expected one of fixed, .*received \'slide\''),
    "parent": ("urdf", '<parent link="leg1_lower"', '<parent link="nobody"',
               r"line \d+, <joint name=.d1.>, <parent> link: expected the name of a link"),
    "number": ("urdf", '<axis xyz="0.0 0.0 1.0"', '<axis xyz="0.0 zero 1.0"',
               "<axis> xyz: expected 3 finite numbers"),
    "axis": ("urdf", '<axis xyz="0.0 0.0 1.0"', '<axis xyz="0 0 0"',
             "<axis> xyz: expected a direction other than zero"),
    "sdf child": ("sdf", "<child>leg2_upper</child>", "<child>nobody</child>",
                  r"line \d+, <joint name=.d2.>, <child>: expected a link of the model"),
    "sdf kind": ("sdf", 'name="d1" type="prismatic"', 'name="d1" type="screw"',
                 r"line \d+, <joint name=.d1.>, type: expected one of"),
    "sdf axis": ("sdf", "<xyz>0.0 0.0 1.0</xyz>", "<xyz>0 0</xyz>",
                 r"line \d+, <axis>, <xyz>: expected 3 finite numbers, received '0 0'"),
    "sdf leg": ("sdf", 'name="d1" type="prismatic"', 'name="d1" type="revolute"',
                "leg 1 \\(joints leg1_base, d1, leg1_platform\\): expected one slide"),
    "mjcf": ("mjcf", 'joint="d1"', 'joint="d9"', "expected a model that MuJoCo reads.*line \\d+"),
    "mjcf leg": ("mjcf", 'class="slide" type="slide"', 'type="hinge"',
                 "leg 1 \\(joints .*: expected one slide, or a slide and a turn"),
    "entities": ("urdf", '<?xml version="1.0"?>',
                 '<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a "b">]>', "declarations of ent"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_file_line_element_and_key(case, tmp_path):
    form, old, new, message = WRONG[case]
    path = spoiled(form, old, new, tmp_path)
    with pytest.raises(MalformedFile, match=message) as error:
        read_model(path)
    assert str(error.value).startswith(str(path))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"loops"', "'loops'", r"line \d+: not JSON"),
        ("leg3_platform", "nobody", "loop 'leg3', link_1: expected a link of lift.urdf"),
        ('"link_2": "platform"', '"link_2": 3', "loops\\[0\\].link_2: expected a name"),
        ('"position": [', '"position": [1, ', "loops\\[0\\].position: expected 3 numbers"),
        ('"d1": ', '"d1": [], "x": ', "joints_at_zero.d1: expected a finite number"),
    ],
)
def test_errors_of_the_file_beside(old, new, message, tmp_path):
    path = tmp_path / "lift.urdf"
    export(LIFT, LIFT.home, "urdf", path)
    beside = tmp_path / "lift.urdf.loops.json"
    text = beside.read_text()
    assert old in text
    beside.write_text(text.replace(old, new, 1))
    with pytest.raises(MalformedFile, match=message):
        read_model(path)


@pytest.mark.parametrize("form", FORMS)
def test_bodies_that_are_not_there_are_named(form, tmp_path):
    path = tmp_path / f"lift{SUFFIXES[form]}"
    export(LIFT, LIFT.home, form, path)
    with pytest.raises(GspError, match=r"unknown platform 'platfrom'.*platform"):
        read_model(path, platform="platfrom")
    with pytest.raises(MalformedFile, match=r"lift\..*expected"):
        read_model(path, base="leg1_lower")


def test_other_suffixes_and_missing_files(tmp_path):
    with pytest.raises(MalformedFile, match=r"a model ending in \.xml"):
        read_model(tmp_path / "a.txt")
    with pytest.raises(MalformedFile, match=r"none\.urdf"):
        read_model(tmp_path / "none.urdf")


# Files of public packages, in the forms that their repositories have.

POINTS = """# a cable robot
platform:
  mass: 150
  position: {rpy: [0, 0, 0.5], xyz: [0.9, 0.9, 0.2]}
points:
""" + "".join(
    f"- frame: [{x}, {y}, 3.5]\n  platform: [{a}, {b}, {c}]\n"
    for x, y, a, b, c in [
        (-3.5, -2.0, 0.6, -0.3, -0.2), (-3.5, -2.0, -0.6, 0.3, 0.2), (3.5, -2.0, -0.6, -0.3, 0.2),
        (3.5, -2.0, 0.6, 0.3, -0.2), (-3.5, 2.0, -0.6, -0.3, -0.2), (-3.5, 2.0, 0.6, 0.3, 0.2),
        (3.5, 2.0, 0.6, -0.3, 0.2), (3.5, 2.0, -0.6, 0.3, -0.2),
    ]
)  # fmt: skip


def test_cable_robots_in_yaml(tmp_path):
    """The form of oKermorgant/cdpr; the eight cables of caroca.yaml."""
    path = tmp_path / "caroca.yaml"
    path.write_text(POINTS)
    found = read_model(path)
    assert (found.name, found.n_legs, found.unit) == ("caroca", 8, "m")
    published = gsp.catalogue.design("cdpr-caroca")
    np.testing.assert_array_equal(found.base_points, published.base_points)
    np.testing.assert_array_equal(found.platform_points, published.platform_points)
    expected = Pose.from_rpy([0.9, 0.9, 0.2], [0, 0, 0.5])
    np.testing.assert_allclose(found.home.rotation, expected.rotation, atol=1e-15)


def test_aliases_in_yaml_are_not_written_out(tmp_path):
    """Each level has ten aliases of the one before: ten to the thirtieth entries in all."""
    levels = [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 30)]
    path = tmp_path / "aliases.yaml"
    path.write_text("a0: &a0 [0]\n" + "".join(levels) + POINTS)
    assert read_model(path).n_legs == 8


def test_cable_robots_in_json(tmp_path):
    """The form of IRMA-LAB/cdpr_matlab, with vectors as columns."""
    actuators = [
        {
            "active": True,
            "pulley": {"pos_OD_glob": [[x] for x in a], "radius": 0},
            "winch": {"pos_PA_loc": b.tolist()},
        }
        for a, b in zip(LIFT.base_points, LIFT.platform_points, strict=True)
    ]
    path = tmp_path / "cables.json"
    path.write_text(json.dumps({"actuator": [*actuators, {"active": False}]}))
    found = read_model(path, name="mine")
    np.testing.assert_array_equal(found.base_points, LIFT.base_points)
    np.testing.assert_array_equal(found.platform_points, LIFT.platform_points)
    assert (found.name, found.home) == ("mine", None)


PLATES = {
    "Name": "Basic SP",
    "Type": "SP",
    "BottomPlate": {"Thickness": 0.1, "JointRadius": 0.9, "JointSpacing": 9, "Mass": 6},
    "TopPlate": {"Thickness": 0.16, "JointRadius": 0.3, "JointSpacing": 25, "Mass": 1},
    "Actuators": {"MinExtension": 0.75, "MaxExtension": 1.5},
    "Settings": {"MaxAngleDev": 55, "IgnoreRestHeight": 0},
    "Params": {"RestHeight": 1.2, "Spin": 30},
}


def test_plates_in_json(tmp_path):
    """The form of 64-B1T/basic_robotics, whose tests have the published design."""
    path = tmp_path / "sp.json"
    path.write_text(json.dumps(PLATES))
    assert_same(read_model(path), gsp.catalogue.design("basic-robotics-large"))


HALF = {key: value for key, value in PLATES.items() if key != "Params"}
IGNORED = PLATES | {"Settings": {"IgnoreRestHeight": 1}}


def yaml_text(plates):
    """Return the file of some plates as YAML, with one key per line."""
    return "".join(
        f"{key}: {value}\n" if isinstance(value, str) else
        f"{key}:\n" + "".join(f"  {name}: {number}\n" for name, number in value.items())
        for key, value in plates.items()
    )  # fmt: skip


@pytest.mark.parametrize("form", ["json", "yaml"])
@pytest.mark.parametrize("plates", [HALF, IGNORED], ids=["none", "ignored"])
def test_plates_without_a_rest_height_start_half_extended(form, plates, tmp_path):
    """As `midHeightEstimate` of the package places them: all legs have their middle length."""
    path = tmp_path / f"sp.{form}"
    text = (json.dumps if form == "json" else yaml_text)(plates)
    path.write_text(text.replace("0.9", "9e-1"))
    found = read_model(path)
    np.testing.assert_allclose(found.at(found.home).joints, 1.125, rtol=1e-14)
    given = gsp.catalogue.design("basic-robotics-large")
    assert_same(found.replace(home=given.home), given)


def test_cable_robots_within_a_model_and_numbers_of_yaml(tmp_path):
    """The form of cdpr3/sdf/cube.yaml; 2e0, +2 and 02 are numbers, as C++ programs read them."""
    path = tmp_path / "cube.yaml"
    lines = POINTS.replace("-2.0", "-2e0").replace(" 2.0,", " +2,").replace("3.5]", "03.5]")
    path.write_text("model:\n" + "".join(f"  {x}\n" for x in lines.splitlines()))
    found = read_model(path)
    path.write_text(POINTS)
    assert_same(found, read_model(path))
    outside, points = re.split(r"(?m)^(?=points:)", POINTS)
    path.write_text(f"{outside}\nmodel:\n" + "".join(f"  {x}\n" for x in points.splitlines()))
    assert found.home is not None
    assert_same(found, read_model(path))


WRONG_PLATES = [
    ("0.9", "-0.9", "BottomPlate.JointRadius", "a number > 0"),
    ("0.3", "0", "TopPlate.JointRadius", "a number > 0"),
    ("0.16", "9" * 400, "TopPlate.Thickness", "a finite number"),
    ("0.16", "-0.16", "TopPlate.Thickness", "a number ≥ 0"),
    ("0.9", "9" * 102, "BottomPlate.JointRadius", r"a number of at most 1e\+100 in size"),
    (": 25", ": 200", "TopPlate.JointSpacing", r"an angle in \[0, 120\] degrees"),
    (": 1.5", ": 0.5", "Actuators.MaxExtension", "at least MinExtension, which is 0.75"),
    ("0.75", "-1", "Actuators.MinExtension", "a number ≥ 0"),
    ("1.2", "-1.2", "Params.RestHeight", "a number > 0"),
    (": 0\n", ": 2\n", "Settings.IgnoreRestHeight", "true or false, 1 or 0"),
]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.yaml", POINTS.replace("[3.5, 2.0, 3.5]", "[3.5, x, 3.5]", 1),
         r"a.yaml, line 18, key points\[6\].frame\[1\]: expected a finite number"),
        ("a.yaml", POINTS.replace("  platform: [0.6, -0.3, -0.2]\n", "", 1),
         r"a.yaml, line 6, key points\[0\].platform: expected a value, received none"),
        ("a.yaml", POINTS.replace("xyz:", "yxz:"), "line 4, key platform.position.yxz: expected"),
        ("a.yaml", "points: [1, 2", "a.yaml, line 1: not YAML"),
        ("a.yml", "points: [1, 2]", "line 1, key points: expected a list of at least 6"),
        ("a.json", json.dumps(PLATES).replace('"JointSpacing": 25', '"JointSpacing": "x"'),
         "key TopPlate.JointSpacing: expected a finite number, received 'x'"),
        ("a.json", json.dumps(PLATES, indent=1).replace('"MaxExtension"', '"Max"'),
         "line 16, key Actuators.MaxExtension: expected a value, received none"),
        ("a.json", '{"a": 1,}', "a.json, line 1: not JSON"),
        ("a.json", '{"legs": 6}', "expected a file of oKermorgant/cdpr, .*received legs"),
        ("a.json", "[" * 100000, "not JSON"),
        ("a.json", json.dumps({"actuator": [{"active": False}] * 6}), "at least 6 active"),
        ("a.json", json.dumps(PLATES).replace("0.3", "NaN"), "TopPlate.JointRadius: expected a"),
        ("a.json", json.dumps(HALF).replace("0.75", "0.5").replace("1.5", "0.6"),
         "line 1, key Actuators.MaxExtension: expected a mean with MinExtension above 0.71"),
        ("a.yaml", POINTS.replace("[3.5, 2.0, 3.5]", "[3.5, 1:30, 3.5]", 1),
         r"line 18, key points\[6\].frame\[1\]: expected a finite number, received '1:30'"),
        ("a.yaml", POINTS.replace("[3.5, 2.0, 3.5]", "[3.5, 1_0, 3.5]", 1), "received '1_0'"),
        ("a.yaml", POINTS.replace("[3.5, 2.0, 3.5]", f"[{'9' * 5000}, 2, 3.5]", 1),
         r"line 18, key points\[6\].frame\[0\]: expected a finite number"),
        ("a.yaml", POINTS.replace("  mass: 150", "  mass: 150\n  mass: 15"),
         "a.yaml, line 4, key platform.mass: expected each key once, received it again"),
        ("a.yaml", POINTS + "model: abc\n", "line 22, key model: expected a mapping of keys"),
        ("a.yaml", POINTS + "model: {points: []}\n",
         "line 22, key model.points: expected points beside `model` or in it, not"),
        ("a.yaml", POINTS + "model: {platform: {}}\n", "line 22, key model.platform: expected"),
        ("a.yaml", "platform: [1]\npoints:" + POINTS.split("points:")[1],
         "line 1, key platform: expected a mapping of keys"),
        ("a.yaml", POINTS + "points: []\n", "line 22, key points: expected each key once"),
        ("a.yaml", POINTS.replace("  mass: 150", "  mass: 15\a0"),
         r"a.yaml, line 3: expected no control characters, received '.x07'"),
        ("a.json", '{"a": [{"b": 1, "c": {}},\n {"b": 1,\n "b": 2}]}',
         r"a.json, line 3, key a\[1\].b: expected each key once"),
    ],
)  # fmt: skip
def test_errors_of_packages_name_line_and_key(name, text, message, tmp_path):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(MalformedFile, match=message):
        read_model(path)


@pytest.mark.parametrize("form", ["json", "yaml"])
@pytest.mark.parametrize(("old", "new", "key", "wanted"), WRONG_PLATES)
def test_wrong_plates_are_named_as_in_the_file(form, old, new, key, wanted, tmp_path):
    path = tmp_path / f"sp.{form}"
    text = json.dumps(PLATES, indent=2) + "\n" if form == "json" else yaml_text(PLATES)
    path.write_text(text.replace(old, new, 1))
    line = 1 + text[: text.index(old)].count("\n")
    with pytest.raises(
        MalformedFile, match=f"sp.{form}, line {line}, key {key}: expected {wanted}"
    ):
        read_model(path)


def test_integers_of_any_length_are_numbers(tmp_path):
    """Beyond 2^63 numpy has them as objects."""
    path = tmp_path / "sp.json"
    path.write_text(json.dumps(PLATES).replace("0.16", str(10**20)))
    assert read_model(path).platform_points[0, 2] == -1e20
    path.with_suffix(".yaml").write_text(POINTS.replace("3.5]", f"{10**20}]", 1))
    assert read_model(path.with_suffix(".yaml")).base_points[0, 2] == 1e20


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('anchor="', 'anchor="" name="', r"line \d+, <connect name=.*>, anchor: expected numbers"),
        ('anchor="', 'anchor=" \t" name="', "<connect name=.*>, anchor: expected numbers, rec"),
        ('pos="', 'pos="nan 0 0" euler="', r"line \d+, <body name=.*>, pos: expected finite num"),
        ('axis="', 'axis="1 inf 0" name="', "axis: expected finite numbers, received '1 inf 0'"),
        ('pos="', 'pos="1e101 0 0" euler="', "pos: expected finite numbers, received '1e101 0 0'"),
    ],
)
def test_numbers_of_mjcf_are_checked_before_mujoco(old, new, message, tmp_path, monkeypatch):
    """MuJoCo loads no further model after an empty anchor: it must not be called."""
    text = foreign_mjcf(LIFT).replace(old, new, 1)
    (tmp_path / "part.xml").write_text(text)
    whole = '<mujoco><include file="part.xml"/></mujoco>'
    (tmp_path / "whole.xml").write_text(whole)
    monkeypatch.setattr("mujoco.MjModel.from_xml_path", lambda _: pytest.fail("called"))
    for name in ("part.xml", "whole.xml"):
        with pytest.raises(MalformedFile, match=f"part.xml, .*{message}"):
            read_model(tmp_path / name)


def test_errors_of_mujoco_of_other_kinds_are_of_the_library(tmp_path, monkeypatch):
    (tmp_path / "a.xml").write_text("<mujoco/>")

    def fail(_):
        raise RuntimeError("Caught an unknown exception!")

    monkeypatch.setattr("mujoco.MjModel.from_xml_path", fail)
    with pytest.raises(MalformedFile, match=r"a\.xml: .*MuJoCo reads, .*unknown exception"):
        read_model(tmp_path / "a.xml")


def test_legs_of_five_freedoms_and_offset_slides_are_refused(tmp_path):
    path = tmp_path / "upu.sdf"
    text = foreign_sdf(LIFT, cylinder=False)
    path.write_text(text)
    with pytest.raises(MalformedFile, match=r"leg 1 .*expected at least 6 freedoms"):
        read_model(path)
    path.write_text(foreign_sdf(LIFT).replace("0 0 0.2 0 0 0", f"0.3 0 0.2 {math.pi / 2} 0 0"))
    with pytest.raises(MalformedFile, match=r"leg 1 .*expected"):
        read_model(path)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.urdf", "<robot name='a'><link name='{0}'/><link name='b'/><joint name='j' "
         "type='fixed'><parent link='{0}'/><child link='{0}1'/></joint></robot>"),
        ("a.urdf", "<robot><link name='a'/><joint name='{0}' type='{0}'><parent link='a'/>"
         "<child link='a'/></joint></robot>"),
        ("a.urdf", "<r{0}/>"),
        ("a.sdf", "<sdf><model name='m'><link name='{0}'/><link name='{0}'/></model></sdf>"),
        ("a.sdf", "<sdf><model name='m'><link name='a'><pose relative_to='{0}'/></link>"
         "</model></sdf>"),
        ("a.sdf", "<sdf><model name='m'><joint name='{0}' type='{0}'/></model></sdf>"),
        ("a.xml", "<m{0}/>"),
        ("a.json", '{{"{0}": 1, "{0}": 2}}'),
        ("a.json", '{{"Actuators": {{"{0}": {{}}}}}}'),
    ],
)  # fmt: skip
def test_names_are_cut_in_messages(name, text, tmp_path):
    path = tmp_path / name
    path.write_text(text.format("9" * 5000))
    with pytest.raises(MalformedFile) as caught:
        read_model(path)
    message = caught.value.args[0].replace(str(path), "")
    assert len(message) < 800
    assert "..." in message or "9" not in message
