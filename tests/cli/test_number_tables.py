"""Tables of numbers that commands read."""

import pytest

from gsp.cli.inputs.numbers import read_rows
from gsp.errors import MalformedFile

HEADER = "x,y,z\n"


@pytest.mark.parametrize(
    ("rows", "match"),
    [
        ("1,2,3,4\n5,6,7,8\n", "as many values in each row as in the header"),
        ("1,2,3\n1,2,3,4\n", "table of numbers"),
        ("1,2,True\n", "column z.*expected numbers"),
    ],
)
def test_tables_that_do_not_fit_their_header_are_refused(tmp_path, rows, match):
    (tmp_path / "poses.csv").write_text(HEADER + rows)
    with pytest.raises(MalformedFile, match=match):
        read_rows("--poses", str(tmp_path / "poses.csv"), ["x", "y", "z"])


def test_columns_are_found_by_their_names(tmp_path):
    (tmp_path / "poses.csv").write_text("name,z,x,y\na,3,1,2\nb,6,4,5\n")
    found = read_rows("--poses", str(tmp_path / "poses.csv"), ["x", "y", "z"])
    assert found.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


def test_a_comma_at_the_end_of_each_row_shifts_no_column(tmp_path):
    (tmp_path / "poses.csv").write_text(HEADER + "1,2,3,\n4,5,6,\n")
    found = read_rows("--poses", str(tmp_path / "poses.csv"), ["x", "y", "z"])
    assert found.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
