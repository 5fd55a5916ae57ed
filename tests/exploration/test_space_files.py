"""Spaces of designs as files: the same designs after writing and reading, and bad files."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MalformedFile, UnwritableOutput
from gsp.exploration import read_space
from gsp.families.texts import function_of_family
from gsp.model.design import toml_from_design

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
NUMBERS = {"base_radius": 2.0, "base_angle": 0.3, "platform_radius": 1.0, "platform_angle": 0.3}
HEXAPODS = gsp.Space(
    gsp.hexapod,
    {"platform_radius": (0.1, 1 / 3), "platform_angle": (1e-300, 1.0)},
    {"arrangement": ["pairs", "zigzag"], "height": [1, 2.5]},
    {"base_radius": 2.0, "base_angle": np.float64(0.3), "unit": "mm", "name": 'a "b" ä',
     "strokes": np.array([0.5, 3.0]), "degrees": False},
)  # fmt: skip
LEE = gsp.Space(function_of_family("lee-3-6"), {"beta": (0.1, 0.2)}, fixed={"a": 1, "b": 2.0})
PLACED = gsp.Space(
    gsp.catalogue.place,
    choices={"legs": ["D1-D1-D1-D1-D1-D1", "D1-D2-0-D4A1-D1-D2"]},
    fixed={"template": TEMPLATE},
)


@pytest.mark.parametrize("space", [HEXAPODS, LEE, PLACED], ids=["hexapod", "lee", "place"])
def test_a_space_that_is_written_and_read_has_the_same_designs(space, tmp_path):
    path = tmp_path / "space.toml"
    space.write(path)
    again = read_space(path)
    assert again.names == space.names
    assert (again.ranges, again.choices) == (space.ranges, space.choices)
    sample = space.sample(6, seed=1)
    assert sample.equals(again.sample(6, seed=1))
    for row in sample.to_dict("records"):
        one, two = space.design(**row), again.design(**row)
        assert toml_from_design(one) == toml_from_design(two)
    again.write(tmp_path / "again.toml")
    assert (tmp_path / "again.toml").read_bytes() == path.read_bytes()
    with pytest.raises(UnwritableOutput):
        space.write(path)
    space.write(path, overwrite=True)


def test_a_template_may_be_a_file_or_a_design_of_a_family(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    TEMPLATE.replace(name="mine", platform_points=2.0 * TEMPLATE.platform_points).write("t.toml")
    for template in ("t.toml", "hexapod(base_radius=2, base_angle=20, platform_radius=1, "
                     "platform_angle=20, height=1.5)"):  # fmt: skip
        text = 'make = "place"\n[choices]\nlegs = ["D1-D1-D1-D1-D1-D1"]\n[fixed]\n'
        text += f'template = "{template}"'
        (tmp_path / "s.toml").write_text(text)
        space = read_space("s.toml")
        assert space.design(legs="D1-D1-D1-D1-D1-D1").mechanism.name == "D1^6"
        space.write("again.toml", overwrite=True)
        assert f'template = "{template}"' in (tmp_path / "again.toml").read_text()


@pytest.mark.parametrize(
    ("space", "message"),
    [
        (gsp.Space(lambda a: TEMPLATE, {"a": (0, 1)}), r"space\.make: expected a function that"),
        (
            gsp.Space(gsp.hexapod, {"height": (1, 2)}, fixed=NUMBERS | {"strokes": None}),
            r"space\.fixed\.strokes: expected a text, a number, a bool or a list, received None",
        ),
        (
            gsp.Space(
                gsp.catalogue.place,
                choices={"legs": ["D1-D1-D1-D1-D1-D1"]},
                fixed={"template": TEMPLATE.scaled(2.0)},
            ),
            "a published design as the template",
        ),
    ],
    ids=["function", "None", "template"],
)
def test_spaces_that_a_file_cannot_hold_are_refused(space, message, tmp_path):
    with pytest.raises(InvalidInput, match=message):
        space.write(tmp_path / "space.toml")
    assert not (tmp_path / "space.toml").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "expected the key 'make'"),
        ("make = 3", "line 1, key 'make': value: expected a text, received 3"),
        ('make = "hexapood"', "line 1, key 'make': unknown make 'hexapood'"),
        ('make = "hexapod"\nrange = 3', "line 2, key 'range': key: expected one of make, ranges"),
        ('make = "hexapod"\n[ranges]\nheight = [2, 1]', "line 3, key 'ranges.height': "),
        ('make = "hexapod"\n[ranges]\nheight = "x"', "line 3, key 'ranges.height': "),
        ('make = "hexapod"\n[ranges]\nheight = [nan, 2]', "'ranges.height' (at index [0]): "),
        ('make = "hexapod"\n[ranges]\nheight = [1, nan]', "finite numbers"),
        ('make = "hexapod"\n[ranges]\n', "at least one range or choice, received none"),
        ('make = "hexapod"\n[choices]\nheight = []', "line 3, key 'choices.height': "),
        ('make = "hexapod"\n[ranges]\nwidth = [1, 2]', "a function that takes"),
        ("make = [", "TOML"),
    ],
)
def test_bad_files(text, message, tmp_path):
    path = tmp_path / "space.toml"
    path.write_text(text)
    with pytest.raises(MalformedFile, match=r"space\.toml") as error:
        read_space(path)
    assert message in str(error.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(MalformedFile, match=r"nothing\.toml"):
        read_space(tmp_path / "nothing.toml")
