"""Every number of a design file of the catalogue is held by a record of what is printed.

Each number is changed in its file, by a little and, unless it is 0, by its sign; the verdict of a
record of that design must fall. So must one if the unit is another one, or legs are exchanged. The
only component of a direction that is not 0 is its size, and changed by its sign only.
"""

import re
import shutil

import numpy as np
import pytest

import gsp
from gsp import catalogue, published
from gsp.errors import FailedComputation
from gsp.files.knowledge import knowledge
from gsp.published.checking import judge
from gsp.published.computing import compute
from gsp.published.quantities import PAPERS, common, dimensions
from tests import campaign
from tests.published.records import RECORDS as EVERY

NAMES = catalogue.design_names()
RECORDS = {
    # Those of dimensions first, as they are fast.
    name: sorted(
        (r for r in EVERY if r.arguments.get("design") == name),
        key=lambda record: record.quantity not in dimensions.QUANTITIES,
    )
    for name in NAMES
}
KEYS = re.compile(
    r"^(base_point|platform_point|base_second_point|platform_second_point|base_direction|"
    r"platform_direction|position|rpy_deg|strokes|semi_axes|characteristic_length) = ([^#\n]*)",
    re.MULTILINE,
)
NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")


def text_of(name):
    return knowledge("catalogue", "designs", f"{name}.toml").read_text(encoding="utf-8")


def numbers_of(text):
    """Return the places of all numbers of a design file."""
    return [
        (line.start(2) + found.start(), line.start(2) + found.end())
        for line in KEYS.finditer(text)
        for found in NUMBER.finditer(line[2])
    ]


@pytest.fixture
def damaged(tmp_path, monkeypatch):
    """Put a copy of the design files in their place; return what changes one of them."""
    folder = tmp_path / "catalogue" / "designs"
    shutil.copytree(knowledge("catalogue", "designs"), folder)
    own = lambda *parts: tmp_path.joinpath(*parts)  # noqa: E731
    monkeypatch.setattr("gsp.files.knowledge.knowledge", own)

    def change(name, text):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")

    return change


def fallen(name):
    """Return whether the verdict of a record of a design falls."""
    for record in RECORDS[name]:
        try:
            if not judge(record, compute(record))[0]["holds"]:
                return True
        except FailedComputation:
            return True
    return False


@pytest.mark.parametrize("name", NAMES)
def test_every_number_of_a_design_file_makes_a_verdict_fall(name, damaged):
    text = text_of(name)
    places = numbers_of(text)
    assert len(places) >= 6 * gsp.catalogue.design(name).n_legs + 3
    assert not fallen(name)
    order = np.random.default_rng(5).permutation(len(places))
    for i in order[: campaign.count(8, len(places))]:
        start, end = places[i]
        value = float(text[start:end])
        step = 1e-3 * max(abs(value), 1.0)
        key, _, line = text[text.rfind("\n", 0, start) + 1 : text.find("\n", end)].partition(" = ")
        size_only = "direction" in key and value and line.count("0.0") == 2
        for other in {-value} if size_only else {value + step, -value or value - step}:
            damaged(name, f"{text[:start]}{other!r}{text[end:]}")
            assert fallen(name), text[text.rfind("\n", 0, start) + 1 : end]


@pytest.mark.parametrize("name", NAMES)
def test_another_unit_and_another_order_of_legs_make_a_verdict_fall(name, damaged):
    text = text_of(name)
    head, first, second, *rest = text.split("[[legs]]")
    damaged(name, "[[legs]]".join([head, second, first, *rest]))
    assert fallen(name)
    unit = catalogue.design(name).unit
    if unit:
        damaged(name, text.replace(f'unit = "{unit}"', f'unit = "{"m" if unit != "m" else "mm"}"'))
        assert fallen(name)


@pytest.mark.parametrize(
    ("name", "paper", "quantity"),
    [("nawratil-k-plus", "Nawratil", ""), ("workspace-6-3", "Workspace-3", "position")],
)
def test_a_damaged_design_file_lets_verdicts_fall_and_is_named(name, paper, quantity, damaged):
    """Base and platform of legs with other coordinates exchanged: some computations fail."""
    text = re.sub(r"(platform_point = )\[(.*?), (.*?), ", r"\1[\3, \2, ", text_of(name))
    damaged(name, text)
    places = (
        "Theorem 3$|eq. \\(25\\), figure" if paper == "Nawratil" else "point A|all legs shortest"
    )
    table = published.check(paper, places=places, progress=False)
    failures = [failure for failure in table["failure"] if failure]
    assert failures
    assert not table.loc[table["failure"] != "", "holds"].any()
    for failure in failures:
        assert f"design {name!r}" in failure
        assert f"({paper}, " in failure
        assert "factorization" not in failure  # the words of another library
    assert (table["failure"] == "").any()


def test_quantities_of_a_paper_have_other_names_than_common_ones():
    shared = set(common.QUANTITIES) | set(dimensions.QUANTITIES)
    assert not [name for table in PAPERS.values() for name in table if name in shared]
