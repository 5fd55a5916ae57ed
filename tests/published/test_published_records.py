"""Damaged files of records: errors that state where and what."""

import re

import numpy as np
import pytest

from gsp import published
from gsp.errors import FailedComputation, InvalidInput, MalformedFile, UnknownName
from gsp.published.checking import judge
from gsp.published.computing import compute
from gsp.published.quantities import common, quantities_of

GOOD = """\
# a comment
[[value]]
paper = "Nawratil"
place = "eq. (25)"
quantity = "k_plus"
arguments = { letter = "h" }
printed = "0.4"
verdict = "reproduced"

[[value]]
paper = "TozKucuk2016"
place = "eq. (24)"
quantity = "homogeneous_jacobian"
printed = [
    ["1", "2"],
    ["3", "4"],
]
verdict = "misprint"
proof = "because"
"""


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "paper.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_good_file(file):
    first, second = published.read_records(file(GOOD))
    assert first.printed.shape == ()
    assert (first.rounding, first.decimals, first.unit, first.origin) == (
        "rounded",
        None,
        "",
        "paper.toml:2",
    )
    assert second.printed.tolist() == [["1", "2"], ["3", "4"]]
    assert second.origin == "paper.toml:10"
    assert not second.printed.flags.writeable


@pytest.mark.parametrize(
    ("old", "new", "line", "record", "key"),
    [
        ('place = "eq. (24)"', "", 10, 2, "place"),
        ('verdict = "reproduced"', 'verdict = "right"', 8, 1, "verdict"),
        ('verdict = "misprint"', 'verdict = ["misprint"]', 18, 2, "verdict"),
        ('proof = "because"', "", 10, 2, "proof"),
        ('proof = "because"', 'proof = "because"\nrounding = "up"', 20, 2, "rounding"),
        ('proof = "because"', 'proof = "because"\ndecimals = -1', 20, 2, "decimals"),
        ('proof = "because"', 'proof = "because"\ndecimals = true', 20, 2, "decimals"),
        ('proof = "because"', 'proof = "because"\ndecimals = 99999999', 20, 2, "decimals"),
        ('proof = "because"', 'proof = "because"\ncolour = "red"', 20, 2, "colour"),
        ('proof = "because"', 'proof = "because"\ncorrect = ["1", "2"]', 20, 2, "correct"),
        ('proof = "because"', "proof = 3", 19, 2, "proof"),
        ('verdict = "reproduced"', 'verdict = "reproduced"\ncorrect = "1"', 9, 1, "correct"),
        ('printed = "0.4"', "printed = 0.4", 7, 1, "printed"),
        ('printed = "0.4"', 'printed = ""', 7, 1, "printed"),
        ('printed = "0.4"', "printed = []", 7, 1, "printed"),
        ('["3", "4"]', '["3"]', 14, 2, "printed"),
        ('["3", "4"]', '["3", 4]', 14, 2, "printed"),
        ('{ letter = "h" }', "[1]", 6, 1, "arguments"),
        ('paper = "Nawratil"', 'paper = ""', 3, 1, "paper"),
    ],
)
def test_damage_is_named_with_file_line_record_and_key(file, old, new, line, record, key):
    assert old in GOOD
    with pytest.raises(MalformedFile) as error:
        published.read_records(file(GOOD.replace(old, new)))
    where = f"paper.toml, line {line}, record {record}, key '{key}': expected"
    assert where.replace(": expected", "") in str(error.value)
    assert "expected" in str(error.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[value]\n", "not TOML"),
        ("", "expected tables [[value]]"),
        ("value = 3\n", "expected tables [[value]]"),
        ("[[values]]\nx = 1\n", "line 1, key 'values'"),
        ('title = "x"\n' + GOOD, "line 1, key 'title'"),
    ],
)
def test_files_that_hold_no_records(file, text, says):
    with pytest.raises(MalformedFile) as error:
        published.read_records(file(text))
    assert says in str(error.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(MalformedFile, match="readable text file"):
        published.read_records(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('quantity = "k_plus"', 'quantity = "k_minus"', "key 'quantity'"),
        ('{ letter = "h" }', "{ letters = 1 }", "key 'arguments'"),
        ('{ letter = "h" }', "{}", "key 'arguments'"),
    ],
)
def test_what_cannot_be_recomputed_is_named(file, old, new, says):
    path = file(GOOD.replace(old, new).split("\n\n")[0])
    with pytest.raises(MalformedFile) as error:
        published.check(files=[path])
    assert "paper.toml:2" in str(error.value)
    assert says in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('{ letter = "h" }', '{ letter = "x" }', "letter: expected"),
        ('printed = "0.4"', 'printed = ["0.4"]', "as printed, received shape ()"),
    ],
)
def test_a_computation_that_fails_is_a_verdict_that_does_not_hold(file, old, new, says):
    first, second = GOOD.split("\n\n")[0], GOOD.split("\n\n")[0]
    table = published.check(files=[file(f"{first.replace(old, new)}\n\n{second}")])
    assert table["holds"].tolist() == [False, True]
    assert table["computed"].isna().tolist() == [True, False]
    assert table["failure"][1] == ""
    assert table["failure"][0].startswith("paper.toml:2 (Nawratil, ")
    assert says in table["failure"][0]


def test_a_misprint_and_what_is_unreadable_do_not_hold_without_a_computation():
    for record in published.select("TozKucuk2016"):
        computed = np.full(record.printed.shape, np.nan)
        assert not any(row["holds"] for row in judge(record, computed, "reason"))


@pytest.mark.parametrize(
    ("bad", "where"),
    [
        ('design = "none"', ".*design: expected a file in catalogue/designs"),
        ("design = 3", ".*design: expected a file in catalogue/designs"),
        ('joint = "d9"', ".*design 'nawratil-k-plus'"),
        ("rpy_deg = [1.0]", ".*design 'nawratil-k-plus'"),
    ],
)
def test_arguments_that_no_quantity_can_take(file, bad, where):
    arguments = {"design": '"nawratil-k-plus"', "joint": '"d1"'}
    key, value = bad.split(" = ")
    text = ", ".join(f"{k} = {v}" for k, v in {**arguments, key: value}.items())
    if key == "rpy_deg":
        text += ", position = [0.0, 0.0, 1.0]"
    path = file(
        '[[value]]\npaper = "P"\nplace = "p"\nquantity = "joint"\nprinted = "1"\n'
        f'verdict = "reproduced"\narguments = {{ {text} }}\n'
    )
    (record,) = published.read_records(path)
    with pytest.raises((FailedComputation, MalformedFile), match=rf"paper\.toml:1{where}"):
        compute(record)


@pytest.mark.parametrize("leg", [0, 6, -1])
def test_legs_count_from_1(file, leg):
    arguments = (
        f'equation = 2, leg = {leg}, joint = "d1", design = "toz-kucuk-2016-d1-d2-d3-d4-a1-2", '
        "position = [7.0, -8.0, 124.0], rpy_deg = [2.0, 5.0, -5.0]"
    )
    path = file(
        '[[value]]\npaper = "TozKucuk2016"\nplace = "p"\nquantity = "value_error"\nprinted = "0"\n'
        f'verdict = "reproduced"\narguments = {{ {arguments} }}\n'
    )
    (failure,) = published.check(files=[path])["failure"]
    assert re.search(r"paper\.toml:1.*leg", failure)


def test_an_unknown_paper():
    with pytest.raises(UnknownName, match="TozKucuk2016"):
        published.check("TozKucuk2017")


def test_a_paper_without_a_module_needs_no_code(file):
    path = file(
        '[[value]]\npaper = "Somebody1999"\nplace = "p. 3"\nquantity = "index"\n'
        'arguments = { design = "nawratil-k-plus", index = "control_number" }\n'
        'printed = "0.69"\nverdict = "reproduced"\n'
    )
    assert published.check(files=[path])["holds"].all()


@pytest.mark.parametrize("number", [0, 7, -1, 1.0, True])
def test_numbers_of_rows_and_legs_begin_at_1(number):
    """0 would stand for the last one."""
    known = quantities_of("Lee2000")
    family = {"family": "lee-3-3", "a": 1.0, "b": 2.0, "h": 0.5}
    for call in (
        lambda: common.jacobian("lee-2000-3-3", (0.0, 0.0, 1.0), negated=[number]),
        lambda: known["lines"](**family, reversed=[number]),
        lambda: known["ends"](number, 1.0, 2.0, 0.5),
        lambda: known["brackets"](number, 1.0, 2.0, 0.5),
    ):
        with pytest.raises(InvalidInput, match="integers from 1 to"):
            call()
