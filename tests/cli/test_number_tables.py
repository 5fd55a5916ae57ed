"""Tables of numbers that commands read."""

import math

import pandas as pd
import pytest

from gsp.cli.inputs.numbers import read_rows
from gsp.errors import InvalidInput, MalformedFile

HEADER = "x,y,z\n"
NAMES = ["x", "y", "z"]


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (HEADER + "1,2,3,4\n5,6,7,8\n", "line 2: expected 3 cells, as in the header, received 4"),
        (HEADER + "1,2,3\n\n1,2,3,4\n", "line 4: expected 3 cells"),
        (HEADER + "1,2,3\n1,2\n", "line 3: expected 3 cells, as in the header, received 2"),
        (HEADER + "1,2,True\n", "line 2, column 'z': expected a finite number, received 'True'"),
        (HEADER + "1,2,1\n1,True,3\n", "line 3, column 'y': .* received 'True'"),
        (HEADER + "1,2,3\n1,,3\n", "line 3, column 'y': expected a finite number.*nothing"),
        (HEADER + "1,2,inf\n", "line 2, column 'z': .* received 'inf'"),
        (HEADER + "1,2,1_000\n", "line 2, column 'z': .* received '1_000'"),
        (HEADER, "expected rows of numbers, received a header only"),
        ("x,y,z,x\n1,2,3,4\n", "expected one column 'x' .* received 2 of that name"),
        ("x,y\n1,2\n", "expected one column 'z' .* received 'x, y'"),
        ("", "expected a header and rows, received an empty table"),
        ("\0\0", "received"),
    ],
)
def test_mistakes_are_named_by_line_and_column(tmp_path, text, match):
    (tmp_path / "poses.csv").write_text(text)
    with pytest.raises(MalformedFile, match=f"poses.csv.*{match}"):
        read_rows("--poses", str(tmp_path / "poses.csv"), NAMES)


@pytest.mark.parametrize(
    "content",
    [
        "\ufeffx,y,z\n1,2,3\n4,5,6\n".encode(),
        b"x,y,z\r\n1,2,3\r\n4,5,6\r\n",
        b"# a path\n\n x ; y;z\n 1;2; 3\n4;5;6\n",
        b"x\ty\tz\n1\t2\t3\n4\t5\t6",
        b'"x","y","z"\n"1","2","3"\n"4","5","6"\n',
    ],
)
def test_common_forms_of_csv_are_read(tmp_path, content):
    (tmp_path / "poses.csv").write_bytes(content)
    found = read_rows("--poses", str(tmp_path / "poses.csv"), NAMES)
    assert found.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


@pytest.mark.parametrize(
    "content", ["x,y,z\n1,2,3\n".encode("utf-16"), "x,y,z,ä\n1,2,3,4\n".encode("latin-1")]
)
def test_other_encodings_are_named(tmp_path, content):
    (tmp_path / "poses.csv").write_bytes(content)
    with pytest.raises(MalformedFile, match=r"expected a readable text file.* not in UTF-8"):
        read_rows("--poses", str(tmp_path / "poses.csv"), NAMES)


@pytest.mark.parametrize("suffix", ["parquet", "xlsx"])
def test_stored_tables_are_checked_as_texts_are(tmp_path, suffix):
    path = str(tmp_path / f"poses.{suffix}")
    frame = pd.DataFrame({"x": [1.0, 2.0], "y": [3, 4], "z": [5.0, math.nan], "a": ["b", None]})
    getattr(frame, {"parquet": "to_parquet", "xlsx": "to_excel"}[suffix])(path, index=False)
    found = read_rows("--joints", path, NAMES, gaps=True)
    assert found[0].tolist() == [1.0, 3.0, 5.0]
    assert math.isnan(found[1, 2])
    row = {"parquet": 2, "xlsx": 3}[suffix]
    with pytest.raises(MalformedFile, match=f"row {row}, column 'z': .* received nothing"):
        read_rows("--poses", path, NAMES)
    with pytest.raises(MalformedFile, match=r"column 'a': .* received 'b'"):
        read_rows("--poses", path, ["x", "a"])


def test_equal_columns_in_excel_are_refused(tmp_path):
    path = str(tmp_path / "poses.xlsx")
    pd.DataFrame([[1.0, 2.0, 3.0]], columns=["x", "y", "x"]).to_excel(path, index=False)
    with pytest.raises(MalformedFile, match="received 2 of that name"):
        read_rows("--poses", path, ["x", "y"])


@pytest.mark.parametrize("text", ["", "1 2", "1 2 nan", "1 2 inf", "1 2 1_0", "a b c", "1;2;3"])
def test_an_option_is_as_many_finite_numbers(text):
    with pytest.raises(InvalidInput, match=r"--poses: expected 3 numbers \(x y z\)"):
        read_rows("--poses", text, NAMES)


def test_columns_are_found_by_their_names(tmp_path):
    (tmp_path / "poses.csv").write_text("name,z,x,y\na,3,1,2\nb,6,4,5\n")
    found = read_rows("--poses", str(tmp_path / "poses.csv"), NAMES)
    assert found.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


def test_a_comma_at_the_end_of_each_row_shifts_no_column(tmp_path):
    (tmp_path / "poses.csv").write_text(HEADER + "1,2,3,\n4,5,6,\n")
    found = read_rows("--poses", str(tmp_path / "poses.csv"), NAMES)
    assert found.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
