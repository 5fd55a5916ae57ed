"""Models on disk: complete, never over something else, and an error of one line when impossible."""

import json
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import export, to_mjcf, to_pinocchio, to_sdf, to_urdf
from gsp.bridges.exports import default_file
from gsp.cli import main
from gsp.errors import InvalidInput, UndefinedPosture, UnknownName, UnwritableOutput

NAME = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
TWO = gsp.catalogue.design(NAME)


def gsp_command(capsys, *arguments):
    """Exit status and output of the command line."""
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in arguments])
    written = capsys.readouterr()
    return end.value.code or 0, written.out, written.err


def test_pinocchio_reads_its_model_back(tmp_path):
    model_file, beside = export(TWO, TWO.home, "pinocchio", tmp_path / "two.xml")
    assert beside == tmp_path / "two.pinocchio.loops.json"
    model = pin.Model()
    model.loadFromXML(str(model_file), "model")
    machine = to_pinocchio(TWO, TWO.home)
    assert model == machine.model
    listed = json.loads(beside.read_text())
    np.testing.assert_allclose(listed["configuration"], machine.configuration)
    assert [loop["joint_1"] for loop in listed["loops"]] == [
        f"leg{i}_platform" for i in range(1, 6)
    ]


def test_mjcf_and_urdf_are_written(tmp_path):
    assert export(TWO, TWO.home, "mjcf", tmp_path / "two.xml") == (tmp_path / "two.xml",)
    assert (tmp_path / "two.xml").read_text().startswith("<mujoco")
    files = export(TWO, TWO.home, "urdf", tmp_path / "two.urdf")
    assert files == (tmp_path / "two.urdf", tmp_path / "two.urdf.loops.json")
    assert pin.buildModelFromUrdf(str(files[0])).nv > 6


def test_nothing_is_overwritten_by_default(tmp_path):
    (tmp_path / "two.urdf.loops.json").write_text("precious")
    with pytest.raises(UnwritableOutput, match=r"two\.urdf\.loops\.json"):
        export(TWO, TWO.home, "urdf", tmp_path / "two.urdf")
    assert [p.name for p in tmp_path.iterdir()] == ["two.urdf.loops.json"]
    assert (tmp_path / "two.urdf.loops.json").read_text() == "precious"
    export(TWO, TWO.home, "urdf", tmp_path / "two.urdf", overwrite=True)
    assert json.loads((tmp_path / "two.urdf.loops.json").read_text())["loops"]


def test_an_impossible_model_leaves_no_file(tmp_path):
    flat = gsp.Design(["D1"] * 6, TWO_POINTS, TWO_POINTS)
    with pytest.raises(UndefinedPosture):
        export(flat, gsp.Pose([0, 0, 0]), "urdf", tmp_path / "flat.urdf")
    with pytest.raises(UnknownName, match="unknown form 'mjfc'; nearest: mjcf"):
        export(TWO, TWO.home, "mjfc", tmp_path / "two.xml")
    assert not list(tmp_path.iterdir())


TWO_POINTS = np.arange(18.0).reshape(6, 3) ** 2


@pytest.mark.parametrize(
    ("form", "names"),
    [
        ("mjcf", [f"{NAME}.xml"]),
        ("urdf", [f"{NAME}.urdf", f"{NAME}.urdf.loops.json"]),
        ("sdf", [f"{NAME}.sdf", f"{NAME}.sdf.joints.json"]),
        ("pinocchio", [f"{NAME}.pinocchio.loops.json", f"{NAME}.pinocchio.xml"]),
    ],
)
def test_command_line_exports(tmp_path, monkeypatch, capsys, form, names):
    monkeypatch.chdir(tmp_path)
    status, out, _ = gsp_command(capsys, "export", NAME, "--to", form)
    assert status == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(out.split()) == names
    status, _, err = gsp_command(capsys, "export", NAME, "--to", form)
    assert status == 2
    assert "exists already" in err
    assert gsp_command(capsys, "export", NAME, "--to", form, "--force")[0] == 0


def test_exports_of_one_design_do_not_collide(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for form in ("mjcf", "urdf", "sdf", "pinocchio"):
        assert gsp_command(capsys, "export", NAME, "--to", form)[0] == 0
    assert len(list(tmp_path.iterdir())) == 7
    both = [export(TWO, TWO.home, form, tmp_path / f"two{end}", overwrite=True)
            for form, end in (("urdf", ".urdf"), ("pinocchio", ".xml"))]  # fmt: skip
    assert len({*both[0], *both[1]}) == 4


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("../evil/x", "evil-x.xml"),
        ("/etc/passwd", "etc-passwd.xml"),
        ("..", "design.xml"),
        ("", "design.xml"),
        (".hidden", "hidden.xml"),
        ("--force", "force.xml"),
        ("a\\b:c*?", "a-b-c.xml"),
        ("Presse für Öl (a=1, b=2)", "Presse-für-Öl-a-1-b-2.xml"),
        ("ö" * 300, "ö" * 60 + ".xml"),
    ],
)
def test_a_name_of_a_design_gives_a_safe_name_of_a_file(tmp_path, name, file):
    assert default_file(name, "mjcf") == file
    (tmp_path / file).write_text("")
    assert [p.name for p in tmp_path.iterdir()] == [file]


def test_command_line_prints_errors_in_one_line(tmp_path, monkeypatch, capsys):
    out = tmp_path / "x.xml"
    design = TWO.replace(home=None)
    design.write(tmp_path / "mine.toml")
    arguments = ("export", tmp_path / "mine.toml", "--to", "mjcf", "--out", out)
    status, _, err = gsp_command(capsys, *arguments)
    assert (status, err.count("\n")) == (2, 1)
    assert "--position" in err
    where = design.base_points[0] - design.platform_points[0]
    status, _, err = gsp_command(capsys, *arguments, "--position", *where)
    assert (status, err.count("\n")) == (2, 1)
    assert "anchor points coincide" in err
    assert not out.exists()
    assert gsp_command(capsys, *arguments, "--position", 7, -8, 124)[0] == 0
    assert out.exists()


def test_command_line_proves(tmp_path, monkeypatch, capsys):
    page = tmp_path / "proof.md"
    arguments = ("prove", "D1^6", "D4^3 A1^3", "--poses", 2, "--out", page)
    status, out, _ = gsp_command(capsys, *arguments)
    assert status == 0
    assert "2 mechanisms, 4 postures: all agree to 1e-9" in out
    assert "| D4^3 A1^3 | 3D3A | 3 | 2 |" in page.read_text()
    status, _, err = gsp_command(capsys, "prove", "D5^6")
    assert status == 2
    assert "D5^6" in err


def test_the_platform_of_a_urdf_is_on_leg_1_where_asked(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert gsp_command(capsys, "export", NAME, "--to", "urdf", "--on-leg")[0] == 0
    assert (tmp_path / f"{NAME}.urdf").read_text() == to_urdf(TWO, TWO.home, floating=False).text
    status, _, err = gsp_command(capsys, "export", NAME, "--to", "sdf", "--on-leg")
    assert status == 2
    assert "--on-leg: not used beside --to sdf" in err
    with pytest.raises(InvalidInput, match="floating: expected True for mjcf, received False"):
        export(TWO, TWO.home, "mjcf", tmp_path / "two.xml", floating=False)
    assert not (tmp_path / "two.xml").exists()


@pytest.mark.parametrize("name", ["world", "__root__", "a::b", "x\ufffey", " "])
def test_names_that_formats_refuse_are_changed(name):
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, unit="m", name=name)
    for text in (
        to_mjcf(design, design.home),
        to_urdf(design, design.home).text,
        to_sdf(design, design.home).text,
    ):
        root = ElementTree.fromstring(text)
        title = root.get("model") or root.get("name") or root.find("model").get("name")
        assert title in ("model world", "model __root__", "a_b", "xy", "D1^6")
