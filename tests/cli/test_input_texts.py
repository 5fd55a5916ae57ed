"""Command line: numbers and files in forms that only Python accepts, or that are damaged."""

import pytest

from gsp.cli.app import COMMANDS, load
from gsp.cli.outputs.messages import OPTIONS

NAME = "toz-kucuk-2016-d3-6"
SIX = "workspace-6-3"
PLANAR, REACH = "lee-2000-planar", ("--stroke", "0.3", "0.9")
SIZES = ("--base-radius", 2, "--base-angle", 20, "--platform-radius", 1, "--platform-angle", 20)
BOX = ("--box", "-1:1 -1:1 137:139 0 0 0")


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (("show", NAME, "--length", "1_0"), "--length"),
        (("show", NAME, "--length", "\u0661\u0662"), "--length"),
        (("sweep", NAME, "--rotate", "z", "--steps", "1_0"), "--steps"),
        (("jacobian", NAME, "--position", 0, "1_0", 1), "--position"),
        (("new", *SIZES, "--height", "1_0"), "--height"),
    ],
)
def test_numbers_have_ascii_digits(gsp, tmp_path, words, option):
    error = gsp(*words).error
    assert error.startswith(f"gsp: {option}: expected a number in ASCII digits"), error
    assert list(tmp_path.iterdir()) == []


def test_infinite_strokes(gsp):
    error = gsp("new", *SIZES, "--height", 1, "--strokes", "inf", "inf").error
    assert error == "gsp: --strokes: expected 0 ≤ LOW ≤ HIGH, both finite, received inf inf"
    error = gsp("new", *SIZES, "--height", 1, "--strokes", "1", "1e101").error
    assert error.startswith("gsp: --strokes: expected one number of at most 1e+100 in size")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("show", NAME, "--position", 1, 2, "nan"), "--position: expected finite numbers"),
        (("jacobian", NAME, "--angles", "nan", 0, 0), "--angles: expected finite numbers"),
        (("new", *SIZES, "--height", -1), "--height: expected"),
        (("new", "--base-radius", 0, *SIZES[2:], "--height", 1), "--base-radius: expected"),
        (("export", NAME, "--to", "mjcf", "--density", -1), "--density: expected a positive"),
        (("export", NAME, "--to", "mjcf", "--platform-mass", 0), "--platform-mass: expected a"),
        (("export", NAME, "--to", "urdf", "--effort", -3), "--effort: expected positive"),
        (
            ("sweep", NAME, "--translate", "z", "--indices", "CDN_OE", "--ellipsoid", 1, 0, 1),
            "--ellipsoid: expected three positive numbers",
        ),
        (("certify", NAME, *BOX, "--require", "nope >= 1"), "--require: unknown index 'nope'"),
        (("certify", NAME, *BOX, "--require", "SD >= 1"), "--require: expected one of minimum"),
    ],
)
def test_errors_name_options_and_not_arguments_of_python(gsp, words, message):
    error = gsp(*words).error
    assert error.startswith(f"gsp: {message}"), error


def test_a_model_with_masses_too_small_for_mujoco_names_the_options(gsp):
    small = ("--base-radius", 0.02, "--platform-radius", 0.01, "--height", 0.015, *SIZES[2:4])
    options = ("--platform-angle", 20, "--unit", "mm", "--name", "small")
    assert gsp("new", *small, *options).status == 0
    error = gsp("export", "small.toml", "--to", "mjcf").error
    assert error.startswith("gsp: --platform-mass, --radius: expected a mass and moments"), error


def test_every_argument_of_a_message_is_an_option_of_a_command():
    options = {
        option for name in COMMANDS for parameter in load(name).params for option in parameter.opts
    }
    assert set(", ".join(OPTIONS.values()).split(", ")) <= options


SIZED = (*SIZES, "--height", 1)
BASES = {
    "rank": (NAME,),
    "show": (NAME,),
    "jacobian": (NAME,),
    "forward": (NAME,),
    "inverse": (NAME,),
    "check": (),
    "workspace": ("workspace-6-3",),
    "planar": ("lee-2000-planar",),
    "export": (NAME,),
    "import": ("a.csv",),
    "prove": (),
    "certify": (NAME,),
    "maximum": (NAME,),
    "sweep": (NAME,),
    "app": ("D1^6",),
    "catalogue": (),
    "new": SIZED,
    "explore": ("space.toml", "--task", "task.toml"),
    "report": (NAME,),
}
# Options that take any text.
ANY_TEXT = {("new", "--unit"), ("new", "--name"), ("import", "--unit"), ("import", "--name")}
# What an option needs before its value is looked at.
BESIDE = {
    ("certify", "--require"): ("--box", "0 0 0 0 0 0"),
    ("certify", "--times"): ("--path", "nodes.csv", "--speeds", 1),
    ("certify", "--speeds"): ("--path", "nodes.csv", "--times", "0 1"),
    ("certify", "--accelerations"): (
        *("--path", "nodes.csv", "--motion", "spline"),
        *("--times", "0 1"),
    ),
    ("certify", "--order"): ("--box", "0 0 0 0 0 0"),
    ("export", "--out"): ("--to", "mjcf"),
    ("export", "--order"): ("--to", "mjcf", "--angles", 0, 0, 0),
    ("jacobian", "--order"): ("--angles", 0, 0, 0),
    ("show", "--order"): ("--angles", 0, 0, 0),
    ("report", "--order"): ("--angles", 0, 0, 0),
    ("sweep", "--order"): ("--angles", 0, 0, 0),
    ("show", "--template"): ("--plot", "a.png"),
    ("forward", "--plot"): ("--all", "--joints", "1 1 1 1 1 1"),
}
SPACE = 'make = "lee-3-3"\n[ranges]\na = [1, 2]\n[fixed]\nb = 2\n'
TASK = "[[wanted]]\nindex = 'CTN'\n[poses]\nposition = [[0, 0, 1]]\n"
NODES = "x,y,z,angle_1,angle_2,angle_3\n0,0,138,0,0,0\n1,0,138,0,0,0\n"


@pytest.mark.parametrize("name", BASES)
def test_the_message_on_a_value_begins_with_its_option(gsp, tmp_path, name):
    """Every option of every command, with a value that nothing reads."""
    (tmp_path / "nodes.csv").write_text(NODES)
    (tmp_path / "space.toml").write_text(SPACE)
    (tmp_path / "task.toml").write_text(TASK)
    for parameter in load(name).params:
        option = parameter.opts[0]
        skipped = not option.startswith("--") or parameter.is_flag or (name, option) in ANY_TEXT
        if skipped or option == "--help":
            continue
        value = ["no such thing"] * parameter.nargs
        beside = BESIDE.get((name, option), ())
        if name == "forward" and option != "--joints" and "--joints" not in beside:
            beside = ("--joints", "146 120 151 128 126 135")
        if name == "export" and option != "--to" and not beside:
            beside = ("--to", "mjcf")
        if name == "sweep" and option not in ("--translate", "--rotate", "--over"):
            beside = ("--rotate", "z", *beside)
        error = gsp(name, *BASES[name], *beside, option, *value).error
        assert error.startswith(f"gsp: {option}: "), error


def test_names_and_paths_that_are_not_known_follow_their_option(gsp):
    for words, message in (
        (("rank", NAME, "--by", "ctm"), "--by: unknown index 'ctm'"),
        (("rank", NAME, "--by", " "), "--by: unknown index ' '"),
        (("rank", NAME, "--by", "  x"), "--by: unknown index ' x'"),
        (("show", NAME, "--indices", " , x"), "--indices: expected no empty item between commas"),
        (("rank", NAME, "--columns", "rank,"), "--columns: expected no empty item"),
        (("rank", NAME, "--box", "0 0,,0 0 0 0"), "--box: expected no empty item"),
        (("workspace", SIX, "--angles", ",0 0 0"), "--angles: expected no empty item"),
        (("workspace", SIX, "--region", "plane", "--index", "CTN,"), "--index: expected no empty"),
        (("workspace", SIX, "--box", "1:2,1:2,1:2,"), "--box: expected no empty item"),
        (("sweep", NAME, "--rotate", "1,,0 1"), "--rotate: expected no empty item"),
        (("forward", NAME, "--joints", "1,2,3,4,5,6,"), "--joints: expected no empty item"),
        (("catalogue", "--class", " "), "--class: unknown class ' '"),
        (("planar", PLANAR, *REACH, "--position", "9", "9"), "--position: expected a radiating"),
        (("planar", PLANAR, *REACH, "--guess", "1e99", "9"), "--guess: expected a point near"),
        (("planar", PLANAR, *REACH, "--angle", "170"), "--angle: expected an angle at which"),
        (("workspace", SIX, "--position", "50", "50", "50"), "--position: expected a radiating"),
        (("rank", NAME, "--indices=CTN,ctm"), "--indices: unknown index 'ctm'"),
        (("rank", NAME, "--template", "no.toml"), "--template: "),
        (("show", "--order", "ZYX", "nope"), "unknown design or mechanism 'nope'"),
        (("show", NAME, "--plot"), "--plot: expected a path, received none"),
        (("maximum", NAME, "--box", "0:1e300 0 0 0 0 0"), "--box: expected one number"),
        (("rank", NAME, "--samples", 0), "--samples: expected a number greater than"),
    ):
        error = gsp(*words).error
        assert error.startswith(f"gsp: {message}"), error


def test_a_path_of_many_short_words_is_cut(gsp):
    error = gsp("inverse", NAME, "--out", "a b " * 25_000 + ".ods").error
    assert error.startswith("gsp: --out: a b a b")
    assert error.endswith(
        "a b .ods: expected a name ending in .csv, .parquet, .xlsx, .md, .tex, received .ods"
    )
    assert len(error) < 500
    error = gsp("inverse", NAME, "--poses", "a b " * 25_000 + ".csv").error
    assert len(error) < 500


def test_a_design_file_that_is_too_long_is_not_read(gsp, tmp_path):
    with (tmp_path / "long.toml").open("wb") as file:
        file.truncate(3 * 2**30)  # sparse
    error = gsp("show", "long.toml").error
    assert error.endswith("a text file of at most 67108864 bytes, received one of 3221225472")


def test_import_of_a_folder_and_of_nan(gsp, tmp_path):
    assert gsp("import", ".").error.endswith("received a folder, or an empty text")
    header = "base_x,base_y,base_z,platform_x,platform_y,platform_z"
    (tmp_path / "a.csv").write_text(header + "\nnan,0,0,0,0,0\n")
    assert "expected a finite number, received nothing or NaN" in gsp("import", "a.csv").error


def test_the_papers_are_named_once(gsp):
    assert gsp("check", "--paper", "x").error.count("TozKucuk2016") == 1


def test_the_store_alone_prints_its_help(gsp):
    done = gsp("store")
    assert (done.status, done.err) == (0, "")
    assert "export" in done.out


def test_a_damaged_part_of_a_ranking(gsp, tmp_path, monkeypatch):
    from gsp.evaluation import parts as stored

    whole = ("rank", NAME, "toz-kucuk-2016-d1-d2-d3-d4-a1-2", "--samples", 20, "--no-plot")
    words = (*whole, "--indices", "CTN", "--workers", 1, "--out", "a.csv")
    write = stored.Parts.write_row

    def write_one(self, number, row):
        write(self, number, row)
        raise KeyboardInterrupt

    monkeypatch.setattr(stored.Parts, "write_row", write_one)
    assert gsp(*words).status == 130
    monkeypatch.setattr(stored.Parts, "write_row", write)
    part = next((tmp_path / "a.csv.parts").glob("part-*"))
    content = part.read_text()
    for damage in ("", "garbage"):
        part.write_text(damage)
        error = gsp(*words, "--resume").error
        assert error.endswith("received a damaged file; delete it, and it is computed again"), error
    part.write_text(content)
    # A resumed ranking is that of one run, to the last bit.
    assert gsp(*words, "--resume").status == 0
    again = [*words[:-1], "b.csv"]
    assert gsp(*again).status == 0
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("rank", "--samples", 5, "--out"), "--out"),
        (("check", "--errata"), "--errata"),
        (("show", NAME, "--plot"), "--plot"),
        (("store", "export"), "FILE"),
        (("import",), "FILE"),
    ],
)
def test_an_empty_path_is_an_error_that_names_the_option(gsp, words, name):
    assert gsp(*words, "").error == f"gsp: {name}: expected the path of a file, received ''"


def test_a_missing_file_of_a_subcommand_is_not_an_option(gsp):
    assert gsp("store", "import", "nofile.json").error.startswith("gsp: nofile.json: expected")


def test_a_number_of_thousands_of_digits(gsp, tmp_path):
    (tmp_path / "long.toml").write_text("version = " + "9" * 5000, encoding="utf-8")
    error = gsp("show", "long.toml").error
    assert error == "gsp: long.toml: not TOML that can be read: a number has too many digits"
