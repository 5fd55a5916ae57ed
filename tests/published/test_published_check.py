"""Verdicts are recomputed: the right ones hold, and wrong ones are detected."""

import ast
import dataclasses
import functools
import itertools

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp import published
from gsp.errors import InvalidInput, UnknownName
from gsp.files.knowledge import knowledge
from gsp.published.checking import judge
from gsp.published.computing import compute
from gsp.published.record import record_files
from tests.published import independent
from tests.published.records import RECORDS

# Records by their files: one test of each takes longer to start than to run.
FILES = {
    file: tuple(records)
    for file, records in itertools.groupby(RECORDS, lambda r: r.origin.partition(":")[0])
}


def holds(record, computed=None):
    return all(
        row["holds"] for row in judge(record, compute(record) if computed is None else computed)
    )


@functools.cache
def rows_of(file):
    """The records of a file recomputed, once for the tests that read or change the record only."""
    (path,) = (path for path in record_files() if path.name == file)
    return published.check(files=[path])


def table():
    """All records recomputed."""
    return pd.concat(map(rows_of, FILES), ignore_index=True)


@functools.cache
def value(origin):
    """What a record computes, in the places that it has a value for; NaN elsewhere."""
    table = rows_of(origin.partition(":")[0])
    rows = table[table["record"] == origin]
    computed = np.full(next(r for r in RECORDS if r.origin == origin).printed.shape, np.nan)
    for entry, number in zip(rows["entry"], rows["computed"], strict=True):
        computed[tuple(i - 1 for i in ast.literal_eval(entry)) if entry else ()] = number
    computed.flags.writeable = False
    return computed


@pytest.fixture
def checked():
    return table()


@pytest.mark.parametrize("file", FILES)
def test_all_verdicts_hold(file):
    rows = rows_of(file)
    assert rows["holds"].all(), rows.loc[~rows["holds"], ["record", "printed", "computed"]]


@pytest.mark.parametrize("file", FILES)
def test_the_verdict_holds_for_the_values_that_are_kept(file):
    for record in FILES[file]:
        assert holds(record, value(record.origin)), record.origin


def test_all_records_are_checked(checked):
    assert list(dict.fromkeys(checked["record"])) == [record.origin for record in RECORDS]
    assert len(published.summary(checked)) == len(RECORDS)


@pytest.mark.parametrize("file", FILES)
def test_a_wrong_verdict_is_detected(file):
    for record in FILES[file]:
        others = {"reproduced", "misprint", "unreadable"} - {record.verdict}
        computed = value(record.origin)
        for verdict in others:
            wrong = dataclasses.replace(record, verdict=verdict, correct=None)
            assert not holds(wrong, computed), record.origin


@pytest.mark.parametrize("file", FILES)
def test_every_entry_counts(file):
    """A change of one unit in the last digit of any entry breaks "reproduced"."""
    for record in FILES[file]:
        if record.verdict == "reproduced":
            every_entry_counts(record)


def every_entry_counts(record):
    computed = value(record.origin)
    for at in np.ndindex(record.printed.shape):
        text = str(record.printed[at])
        if not text:
            continue
        changed = record.printed.astype(object)
        changed[at] = (
            f"({text}) * (1 + 1e-11) + ({away(computed[at])})"
            if record.rounding == "exact"
            else bump(text, record)
        )
        mutant = dataclasses.replace(record, printed=changed.astype(np.str_))
        assert not holds(mutant, computed), (record.origin, at)


def away(value):
    """Return 1e-11 with the sign of a value, so that a change away from zero adds up."""
    return float(np.copysign(1e-11, value))


def bump(text, record):
    """Return the printed number a unit of its last digit away from zero."""
    places = len(text.partition(".")[2]) if record.decimals is None else record.decimals
    sign = -1.0 if text.startswith("-") else 1.0
    return f"{float(text) + sign * 10.0**-places:.{places}f}"


@pytest.mark.parametrize("record", [r for r in RECORDS if r.correct is not None])
def test_what_is_given_as_correct_is_checked(record):
    places = [at for at in np.ndindex(record.correct.shape) if record.correct[at]]
    for at in places:
        changed = record.correct.astype(object)
        text = changed[at]
        exact = record.rounding == "exact"
        changed[at] = f"({text}) + 0.01" if exact else str(float(text) + 0.01)
        mutant = dataclasses.replace(record, correct=changed.astype(np.str_))
        assert not holds(mutant, value(record.origin))


def test_an_undefined_value_proves_no_misprint():
    record = next(r for r in RECORDS if r.verdict == "misprint" and r.printed.shape == ())
    record = dataclasses.replace(record, correct=None)
    assert holds(record)
    assert not holds(record, np.array(np.nan))


def test_a_misprint_of_which_one_entry_agrees_does_not_hold():
    record = next(
        r
        for r in RECORDS
        if r.paper == "TozKucuk2016" and r.verdict == "misprint" and r.printed.ndim == 2
    )
    record = dataclasses.replace(record, correct=None)
    computed = compute(record)
    at = next(at for at in np.ndindex(record.printed.shape) if record.printed[at])
    computed[at] = float(record.printed[at])
    assert not holds(record, computed)


def test_papers_are_selected():
    table = published.check("TozKucuk2016")
    assert set(table["paper"]) == {"TozKucuk2016"}
    both = published.select(["Nawratil", "TozKucuk2016"])
    assert {record.paper for record in both} == {"Nawratil", "TozKucuk2016"}


def test_progress_is_reported():
    seen = []
    published.check("TozKucuk2016", progress=lambda done, total: seen.append((done, total)))
    assert seen[-1][0] == seen[-1][1] == len(published.select("TozKucuk2016"))


def test_matrix_24_is_reproduced_in_all_36_entries_and_25_in_all_but_three(checked):
    def entries(place, verdict):
        rows = checked[checked["paper"] == "TozKucuk2016"]
        rows = rows[(rows["place"] == place) & (rows["verdict"] == verdict)]
        return rows["agrees"].sum(), len(rows)

    assert entries("eq. (24)", "reproduced") == (36, 36)
    assert entries("eq. (24)", "misprint") == (0, 36)
    assert entries("eq. (25)", "reproduced") == (33, 33)
    assert entries("eq. (25), row 1, moment part", "misprint") == (0, 3)
    assert entries("eq. (25)", "misprint") == (0, 30)


# What the proofs state, computed independently of the library.


def of(place, verdict, quantity="homogeneous_jacobian"):
    found = [
        r
        for r in RECORDS
        if r.paper == "TozKucuk2016"
        and (r.place, r.verdict, r.quantity) == (place, verdict, quantity)
    ]
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize(
    "record",
    [r for r in RECORDS if r.quantity == "homogeneous_jacobian" and r.verdict == "misprint"],
    ids=lambda r: r.place,
)
def test_correct_matrices_are_40_digit_central_differences(record):
    a = record.arguments
    rows = independent.homogeneous_jacobian(a["design"], a["position"], a["rpy_deg"], a["length"])
    for at in np.ndindex(record.correct.shape):
        if record.correct[at]:
            assert abs(rows[at[0]][at[1]] - float(record.correct[at])) <= 0.0005


# Those at a stated pose; the values of drives at the base are held in tests/model/test_drives.py.
JOINTS = [r for r in RECORDS if r.quantity == "joint" and "position" in r.arguments]


@pytest.mark.parametrize("record", JOINTS)
def test_joints_of_the_records_agree_with_40_digits(record):
    a = record.arguments
    design = gsp.catalogue.design(a["design"])
    exact = independent.joints_at(a["design"], a["position"], a["rpy_deg"])
    value = float(exact[design.joint_names.index(a["joint"])])
    value = np.rad2deg(value) if a["joint"].startswith("theta") else value
    assert float(compute(record)) == pytest.approx(value, rel=1e-14)


def test_no_sign_of_the_rows_makes_matrix_24_right_at_the_stated_pose():
    record = of("eq. (24)", "misprint")
    for negated in ([], [1, 2, 3, 4, 5, 6]):
        values = compute(
            dataclasses.replace(record, arguments={**record.arguments, "negated": negated})
        )
        assert not any(row["agrees"] for row in judge(record, values))


def test_the_other_order_of_the_turns_does_not_give_the_printed_joints():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    other = gsp.Pose.from_angles([10.0, -10.0, 138.0], [5.0, -5.0, -10.0], "XYZ", degrees=True)
    assert f"{design.at(other).joints[0]:.3f}" == "142.521"


def test_the_moment_of_row_1_of_25_needs_an_arm_that_the_platform_has_not():
    record = of("eq. (25), row 1, moment part", "misprint")
    moment = record.printed[0, 3:].astype(float)
    # A cut decimal may hide up to 0.001 of each component: the least that the print allows.
    least = np.linalg.norm(moment) * record.arguments["length"]
    design = gsp.catalogue.design(record.arguments["design"])
    reach = np.linalg.norm(design.platform_points[0])
    assert 133.9 < least < 134.0
    assert f"{reach:.3f}" == "94.339"
    assert least > 1.4 * reach


def test_leg_2_has_the_platform_point_that_the_table_prints():
    circle = np.linalg.norm(gsp.catalogue.design("toz-kucuk-2016-d3-6").platform_points, axis=1)
    np.testing.assert_allclose(circle, 94.339, atol=2e-3)
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    points, directions = design.platform_points.copy(), design.platform_directions.copy()
    points[1] = [64.147, 69.174, 0.0]
    directions[1] = -points[1]
    other = design.replace(platform_points=points, platform_directions=directions)
    assert f"{other.at(design.home).joints[1]:.3f}" == "114.665"
    assert f"{design.at(design.home).joints[1]:.4f}" == "87.5579"


def test_the_page_of_errata_is_up_to_date():
    page = knowledge("catalogue").parent / "docs" / "errata.md"
    fresh = published.errata(RECORDS, published.select_slips())
    assert page.read_text(encoding="utf-8") == fresh, (
        "stale: run `gsp check --errata docs/errata.md --force`"
    )


def test_the_page_of_errata_has_every_misprint():
    page = published.errata(RECORDS, published.select_slips())
    for slip in published.select_slips():
        assert slip.proof in page
    for record in RECORDS:
        assert (f"### {record.place}\n" in page) or record.verdict == "reproduced"
        if record.verdict != "reproduced":
            assert record.proof in page


def test_the_record_in_the_docs_holds(tmp_path):
    page = (knowledge("catalogue").parent / "docs" / "published-numbers.md").read_text("utf-8")
    path = tmp_path / "docs.toml"
    path.write_text(page.split("```toml\n")[1].split("```")[0], encoding="utf-8")
    table = published.check(files=[path])
    assert len(table) == 1
    assert table["holds"].all()


def test_the_docs_name_every_key_and_every_common_quantity():
    page = (knowledge("catalogue").parent / "docs" / "published-numbers.md").read_text("utf-8")
    fields = {field.name for field in dataclasses.fields(published.Record)} - {"origin"}
    for name in fields | set(published.quantities_of("")):
        assert f"`{name}`" in page or f"\n{name} = " in page, name


def test_every_paper_is_in_the_references():
    page = (knowledge("catalogue").parent / "docs" / "references.md").read_text("utf-8")
    for paper in {record.paper for record in RECORDS}:
        assert f"| `{paper}` |" in page


def test_the_records_of_some_places_alone():
    checked = table()
    lee = checked[checked["paper"] == "Lee2000"]
    part = published.check("Lee2000", places=r"figure 14")
    wanted = lee[lee["place"].str.contains(r"figure 14")].reset_index(drop=True)
    pd.testing.assert_frame_equal(part.drop(columns="computed"), wanted.drop(columns="computed"))
    assert 0 < len(part) < len(lee)
    assert published.check("Lee2000", places="no such place").empty
    for wrong in ("(", 3):
        with pytest.raises(InvalidInput, match="places: expected a regular expression"):
            published.check(places=wrong)


def test_slips_of_a_paper_that_is_not_known_are_an_error():
    with pytest.raises(UnknownName, match="nonsense"):
        published.select_slips("nonsense")
    assert published.select_slips("Nawratil")
