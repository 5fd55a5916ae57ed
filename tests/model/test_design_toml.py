"""Design files: exact round trips, and errors that name line and key."""

from unicodedata import category

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gsp
from gsp.errors import MalformedFile, UnwritableOutput
from gsp.model.design import design_from_toml
from gsp.model.design.toml import toml_from_design
from gsp.model.legs import LEGS
from tests.support import LEG_NAMES, turn

numbers = st.floats(-1e100, 1e100) | st.floats(-1.0, 1.0)
lines = numbers.filter(lambda x: abs(x) > 1e-90)
SEEN = st.characters(exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"])
texts = st.text(SEEN | st.sampled_from("\t\n\r"), max_size=20)
names = st.text(SEEN, max_size=20)  # of one line
lengths = st.floats(1e-100, 1e100)


@st.composite
def designs(draw):
    legs = draw(st.lists(st.sampled_from(LEG_NAMES), min_size=6, max_size=8))
    n = len(legs)
    points, directions = (
        arrays(float, (n, 3), elements=numbers).filter(lambda x: not 0 < np.abs(x).max() < 1e-100),
        arrays(float, (n, 3), elements=lines),
    )
    joints = sum(len(leg.constraints) for leg in LEGS for name in legs if name == leg.name)
    rotation = turn(draw(arrays(float, 3, elements=st.floats(-3, 3))))
    ellipsoids = st.builds(
        gsp.Ellipsoid,
        arrays(float, 3, elements=lengths),
        arrays(float, 3, elements=numbers),
        st.just(rotation),
    )
    homes = st.builds(gsp.Pose, arrays(float, 3, elements=numbers), st.just(rotation))
    limits = arrays(float, (joints, 2), elements=numbers.map(abs) | st.just(np.nan)).map(np.sort)
    return gsp.Design(
        legs,
        draw(points),
        draw(points),
        draw(directions),
        draw(directions),
        unit=draw(names.map(str.strip)),
        name=draw(names),
        source=draw(texts),
        strokes=draw(st.none() | limits),
        characteristic_length=draw(st.none() | lengths),
        ellipsoid=draw(st.none() | ellipsoids),
        home=draw(st.none() | homes),
    )


def assert_equal(one, two):
    """Bit by bit, the sign of zero too."""
    assert [leg.name for leg in one.legs] == [leg.name for leg in two.legs]
    for name in ("unit", "name", "source", "characteristic_length"):
        assert getattr(one, name) == getattr(two, name)
    pairs = [
        (getattr(one, name), getattr(two, name))
        for name in (
            "base_points",
            "platform_points",
            "base_directions",
            "platform_directions",
            "strokes",
        )
    ]
    for part, names in (
        ("ellipsoid", ("semi_axes", "center", "rotation")),
        ("home", ("position", "rotation")),
    ):
        assert (getattr(one, part) is None) == (getattr(two, part) is None)
        if getattr(one, part) is not None:
            pairs += [
                (getattr(getattr(one, part), n), getattr(getattr(two, part), n)) for n in names
            ]
    for x, y in pairs:
        assert (x is None) == (y is None)
        if x is not None:
            np.testing.assert_array_equal(x, y)
            np.testing.assert_array_equal(
                np.signbit(x) & ~np.isnan(x), np.signbit(y) & ~np.isnan(y)
            )


@given(designs())
def test_round_trip_is_exact(design):
    text = toml_from_design(design)
    again = design_from_toml(text, "text")
    assert_equal(again, design)
    assert toml_from_design(again) == text


@given(SEEN | st.sampled_from("\t\n\r"))
def test_every_character(character):
    name = "a" if category(character) == "Cc" else f"a{character}b"
    design = SIX.replace(name=name, source=character)
    again = design_from_toml(toml_from_design(design), "text")
    assert (again.name, again.source) == (design.name, design.source)


SIX = gsp.catalogue.design("toz-kucuk-2016-d3-6")


@pytest.mark.parametrize("name", gsp.catalogue.design_names())
def test_published_designs_round_trip(tmp_path, name):
    design = gsp.catalogue.design(name)
    path = tmp_path / "design.toml"
    design.write(path)
    assert_equal(gsp.read_design(path), design)
    assert_equal(gsp.read_design(str(path)), design)
    with pytest.raises(UnwritableOutput, match="exists already"):
        design.write(path)
    design.write(path, overwrite=True)


HEXAPOD = (
    """\
name = "six"  # a comment
unit = "mm"

[home]
position = [0, 0, 1]

[ellipsoid]
semi_axes = [1, 2, 3]
"""
    + "".join(
        f"""
[[legs]]
constraints = "D1"
base_point = [{i}, {i * i}, 0]
platform_point = [{i * i}, 1, 1]
"""
        for i in range(4)
    )
    + """
[[legs]]
constraints = "D3"
base_point = [1.0, 2.0, 3.0]
base_second_point = [2.0, 2.0, 3.0]
platform_point = [0, 1, 1]
strokes = [1, 2]

[[legs]]
constraints = ["D4"]
base_point = [1, 2, 3]
base_direction = [0, 0, 2]
platform_point = [0, 1, 1]
platform_direction = [0, 3, 0]
strokes = [[1, nan]]
"""
)


def test_a_file_written_by_hand():
    design = design_from_toml(HEXAPOD, "hand")
    assert design.mechanism.name == "D1^4 D3 D4"
    np.testing.assert_array_equal(design.base_directions[4], [1, 0, 0])
    np.testing.assert_array_equal(design.base_directions[5], [0, 0, 1])
    np.testing.assert_array_equal(design.strokes[4:], [[1, 2], [1, np.nan]])
    assert np.isnan(design.strokes[:4]).all()
    np.testing.assert_array_equal(design.home.position, [0, 0, 1])


CHANGES = {
    # what is replaced, by what, key in the message, the text of the message
    "unknown key": ("unit = ", "units = ", "units", "expected one of name, source, unit"),
    "name": ('"six"', "6", "name", "expected a text, received 6"),
    "home key": ("position = [0, 0, 1]", "place = [0, 0, 1]", "place", "one of position"),
    "home of two": ("position = [0, 0, 1]", "position = [0, 0]", "position", "three numbers"),
    "home text": ("position = [0, 0, 1]", 'position = "here"', "position", "expected real numbers"),
    "two angles": (
        "position = [0, 0, 1]", "position = [0, 0, 1]\nrpy_deg = [0, 0, 0]\nangles_deg = [0, 0, 0]",
        "angles_deg", "only one of rpy_deg, angles_deg, rotation",
    ),
    "axes": ("semi_axes = [1, 2, 3]", "semi_axes = [1, 2]", "semi_axes", "expected three numbers"),
    "axes nan": ("semi_axes = [1, 2, 3]", "semi_axes = [1, 2, nan]", "semi_axes", "finite"),
    "axes negative": ("semi_axes = [1, 2, 3]", "semi_axes = [1, 2, -3]", "ellipsoid", "positive"),
    "axes missing": ("semi_axes = [1, 2, 3]", "", "semi_axes", "expected this key, received none"),
    "leg": ('"D3"', '"D7"', "constraints", "expected one of 'D1'"),
    "leg number": ('"D3"', "3", "constraints", "expected one of 'D1'"),
    "leg key": ("base_second_point", "base_secondpoint", "base_secondpoint", "expected one of"),
    "same point": ("[2.0, 2.0, 3.0]", "[1.0, 2.0, 3.0]", "base_second_point", "different points"),
    "zero direction": ("[0, 0, 2]", "[0, 0, 0]", "base_direction", "two different points"),
    "inf direction": ("[0, 0, 2]", "[0, 0, inf]", "base_direction", "expected finite"),
    "both lines": (
        "base_direction = [0, 0, 2]", "base_direction = [0, 0, 2]\nbase_second_point = [1, 1, 1]",
        "base_second_point", "only one of base_direction, base_second_point",
    ),
    "no direction": ("base_direction = [0, 0, 2]", "", "base_direction", "expected this key"),
    "text numbers": ("[9, 1, 1]", '["9", "1", "1"]', "platform_point", "expected real numbers"),
    "booleans": ("[9, 1, 1]", "[true, true, false]", "platform_point", "expected real numbers"),
    "a boolean": ("[9, 1, 1]", "[9, true, 1]", "platform_point", "expected real numbers"),
    "a boolean in pairs": ("strokes = [[1, nan]]", "strokes = [[1, true]]", "strokes", "real numb"),
    "a boolean at home": (
        "position = [0, 0, 1]", "position = [0, false, 1]", "position", "expected real numbers",
    ),
    "date": ("[9, 1, 1]", "[2020-01-01, 1, 1]", "platform_point", "expected real numbers"),
    "great": ("[9, 1, 1]", f"[{10**400}, 1, 1]", "platform_point", "expected real numbers"),
    "nan": ("[9, 1, 1]", "[nan, 1, 1]", "platform_point", "expected finite"),
    "table": ("[9, 1, 1]", "{x = 1}", "platform_point", "expected real numbers"),
    "strokes": ("strokes = [1, 2]", "strokes = [2, 1]", "strokes", "least ≤ greatest"),
    "strokes in pairs": (
        "strokes = [1, 2]", "strokes = [[2, 1]]", "strokes",
        r"least ≤ greatest, received \[2.0, 1.0\]",
    ),
    "strokes of a distance": ("strokes = [1, 2]", "strokes = [-1, 2]", "strokes", "numbers ≥ 0"),
    "strokes ragged": ("strokes = [1, 2]", "strokes = [[1, 2], [3]]", "strokes", "real numbers"),
    "strokes of two": (
        "strokes = [[1, nan]]", "strokes = [[1, 2], [3, 4]]", "strokes",
        "expected two numbers, least and greatest",
    ),
    "strokes text": ("strokes = [1, 2]", 'strokes = "long"', "strokes", "expected real numbers"),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_line_and_key_of_a_mistake(tmp_path, name):
    old, new, key, message = CHANGES[name]
    assert HEXAPOD.count(old) == 1
    text = HEXAPOD.replace(old, new)
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(MalformedFile, match=message) as info:
        gsp.read_design(path)
    found = int(str(info.value).split("line ")[1].split(",")[0])
    assert str(info.value).startswith(f"{path}, line {found}, key {key!r}: ")
    here = 1 + HEXAPOD[: HEXAPOD.index(old)].count("\n") + new.count("\n")
    if not new:  # the head of the table without it
        assert text.split("\n")[found - 1] in ("[ellipsoid]", "[[legs]]")
        assert 0 < here - found <= 3
    else:
        assert found == here - (key == "ellipsoid")


@pytest.mark.parametrize("bad", ["-1", "0", "nan", '"95"', "true", "[95]"])
def test_bad_characteristic_length(bad):
    with pytest.raises(
        MalformedFile, match=r"hand, line 1, key 'characteristic_length': .*positive"
    ):
        design_from_toml(f"characteristic_length = {bad}\n{HEXAPOD}", "hand")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"file: expected tables \[\[legs\]\], received none"),
        ("legs = []\n\n[a.a]", "line 3, key 'a': key: expected one of name"),
        ("legs = []\n\na.b = 1", "line 3, key 'a': key: expected one of name"),
        ("legs = 5", r"line 1, key 'legs': value: expected tables"),
        ("[legs]\na = 1", "line 1, key 'legs': value: expected tables"),
        ("legs = []", "line 1, key 'legs': legs: expected at least six constraints, received 0"),
        ("name = ", "not TOML: .*line 1"),
        ('name = "a"\nname = "b"', "not TOML: .*line 2"),
        ("\x00", "not TOML"),
        ("ellipsoid = 3\nlegs = []", r"line 1, key 'ellipsoid': value: expected a table"),
        ("[[home]]\nposition = [0, 0, 0]", r"line 1, key 'home': value: expected a table"),
        ('home = {position = [0,0,0], angles_deg = [0,0,0], order = "up"}', "key 'home': order"),
        ("home = {position = [0,0,0], angles_deg = [0,0,0], order = 5}", "key 'home': order"),
        ("home = {position=[0,0,0], rotation=[[1,0,0],[0,1,0],[0,0,2]]}", "key 'home'.*a rotation"),
    ],
)
def test_malformed(text, message):
    with pytest.raises(MalformedFile, match=message):
        design_from_toml(text, "file")


def test_too_few_constraints():
    text = HEXAPOD[: HEXAPOD.index('\n[[legs]]\nconstraints = "D3"')]
    with pytest.raises(
        MalformedFile, match=r"key 'legs': legs: expected at least six .*received 4"
    ):
        design_from_toml(text, "file")


@pytest.mark.parametrize("path", ["no-such-file.toml", ".", "a\0b", None, 5, [], b"\xff"], ids=repr)
def test_unreadable(path):
    with pytest.raises(MalformedFile, match="expected a readable text file"):
        gsp.read_design(path)


def test_a_byte_order_mark_is_ignored(tmp_path):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    design.write(tmp_path / "d.toml")
    (tmp_path / "d.toml").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "d.toml").read_bytes())
    again = gsp.read_design(tmp_path / "d.toml")
    assert (again.base_points == design.base_points).all()


def test_deep_nesting_is_an_error_of_the_library(tmp_path):
    (tmp_path / "d.toml").write_text("legs = " + "[" * 3000 + "]" * 3000)
    with pytest.raises(gsp.GspError, match="nested too deeply"):
        gsp.read_design(tmp_path / "d.toml")
    for text in (".".join("a" * 101) + " = 1", "legs = [{" + " . ".join(["'a'"] * 101) + " = 1}]"):
        (tmp_path / "d.toml").write_text(text)
        with pytest.raises(gsp.GspError, match="a key of more than 100 parts"):
            gsp.read_design(tmp_path / "d.toml")
