"""Every equation, figure and table of each paper is recorded, or a reason is given."""

import dataclasses

import pytest

from gsp import published
from gsp.errors import MalformedFile
from gsp.published.ledger import items_of
from tests.published.records import RECORDS

LEDGERS = {ledger.paper: ledger for ledger in map(published.read_ledger, published.ledger_files())}

# Counted in the papers: equations, figures (by their parts, where they have some), tables.
COUNTS = {
    **dict.fromkeys(
        (
            "BasicRobotics",
            "CDPR2018",
            "CDSL2006",
            "Cheers2021",
            "Dehaeze2020",
            "LaneMachinekit",
            "LinuxCNC",
            "MCL745",
            "Martyushev2025",
            "MdxMotion",
            "MirrorCtrl",
            "Rubin",
            "Viso",
            "WolframSystemModeler",
        ),
        (0, 0, 0),
    ),
    "Lee2000": (77, 42, 0),
    "Nawratil": (36, 17, 0),
    "TozKucuk2016": (25, 7, 1),
    "Workspace-3": (18, 4, 0),
    "Workspace-A": (17, 10, 0),
}


def test_each_paper_has_a_ledger():
    assert set(LEDGERS) == {record.paper for record in RECORDS} == set(COUNTS)


@pytest.mark.parametrize("paper", COUNTS)
def test_a_ledger_has_every_equation_figure_and_table(paper):
    items = LEDGERS[paper].items
    kinds = [
        sum(item.lower().startswith(kind) for item in items) for kind in ("eq.", "figure", "table")
    ]
    assert tuple(kinds) == COUNTS[paper]
    assert len(set(items)) == len(items)


@pytest.mark.parametrize("paper", COUNTS)
def test_every_item_is_recorded_or_has_a_reason(paper):
    assert published.unaccounted(LEDGERS[paper], RECORDS) == ()


def test_what_is_missing_is_said():
    ledger = LEDGERS["Lee2000"]
    fewer = [r for r in RECORDS if "(14)" not in r.place]
    assert published.unaccounted(ledger, fewer) == ("eq. (14): no record, and no reason",)
    both = dataclasses.replace(ledger, without_record={**ledger.without_record, "eq. (14)": "x"})
    assert "eq. (14): a record, and a reason for none" in published.unaccounted(both, RECORDS)
    items = tuple(item for item in ledger.items if item != "eq. (14)")
    assert published.unaccounted(dataclasses.replace(ledger, items=items), RECORDS) == (
        "eq. (14): not in the ledger",
    )
    stale = dataclasses.replace(ledger, statements={"x": "record: nowhere"})
    assert published.unaccounted(stale, RECORDS) == ("x: no record at 'nowhere'",)


@pytest.mark.parametrize(
    ("place", "items"),
    [
        ("eqs. (8)-(10)", {"eq. (8)", "eq. (9)", "eq. (10)"}),
        ("eqs. (A.6), (A.9)", {"eq. (A.6)", "eq. (A.9)"}),
        ("eqs. (28) and (29), all but n66", {"eq. (28)", "eq. (29)"}),
        ("above eq. (37), legs 1, 3, 5", {"eq. (37)"}),
        ("figure 42, rows 4 and 5", {"figure 42"}),
        ("§3.4, figures 6 and 7 (a), the pitch", {"figure 6", "figure 7 (a)"}),
        ("§4.3.1, second example, d4", set()),
        ("Theorem 3", set()),
        ("Table", {"Table"}),
        ("the Table and eq. (3)", {"Table", "eq. (3)"}),
        ("table 2", {"table 2"}),
        ("Table 2, row 4", {"table 2"}),
        ("Tables 1 and 2", {"table 1", "table 2"}),
        ("§3, tables 1-3, eq. (4)", {"table 1", "table 2", "table 3", "eq. (4)"}),
        ("§A.2.1, truth table", set()),
    ],
)
def test_what_a_place_names(place, items):
    assert items_of(place) == items


def test_numbered_tables_are_items(tmp_path):
    """The form of the example in CONTRIBUTING.md."""
    path = tmp_path / "p.toml"
    path.write_text(
        'paper = "P"\nequations = ["1"]\nfigures = []\ntables = ["1-2"]\n'
        '[without_record]\n"eq. (1)" = "x"\n"table 1" = "x"\n[statements]\n'
    )
    ledger = published.read_ledger(path)
    assert ledger.items == ("eq. (1)", "table 1", "table 2")
    record = dataclasses.replace(RECORDS[0], paper="P", place="table 2")
    assert published.unaccounted(ledger, [record]) == ()
    assert published.unaccounted(ledger, []) == ("table 2: no record, and no reason",)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('paper = "P"', ""),
        ('equations = ["1-3"]', "equations = 3"),
        ('equations = ["1-3"]', 'equations = ["3-1"]'),
        ('equations = ["1-3"]', 'equations = ["x-y"]'),
        ("[statements]", "[statement]"),
        ('"x" = "y"', '"x" = 3'),
        ('"x" = "y"', '"x" = ' + "[" * 5000 + "]" * 5000),
        ('"x" = "y"', '"x" = ' + "9" * 5000),
    ],
)
def test_a_damaged_ledger_is_an_error(tmp_path, old, new):
    good = (
        'paper = "P"\nequations = ["1-3"]\nfigures = []\ntables = []\n'
        '[without_record]\n"x" = "y"\n[statements]\n'
    )
    path = tmp_path / "p.toml"
    path.write_text(good, encoding="utf-8")
    assert published.read_ledger(path).items == ("eq. (1)", "eq. (2)", "eq. (3)")
    path.write_text(good.replace(old, new), encoding="utf-8")
    with pytest.raises(MalformedFile):
        published.read_ledger(path)
