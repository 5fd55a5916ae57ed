"""Known maxima as files."""

from __future__ import annotations

import json
import shutil

import pytest

import gsp
from gsp.determinant import Store, maximum
from gsp.determinant.record import METHOD
from gsp.determinant.store.exchange import export_maxima, import_maxima
from gsp.errors import InvalidInput, MalformedFile, UnwritableOutput
from gsp.families import lee


@pytest.fixture(scope="module")
def searched(tmp_path_factory):
    """A store of four maxima, which are searched once; tests get copies."""
    path = tmp_path_factory.mktemp("searched") / "maxima.sqlite"
    octahedron, d3 = lee.octahedral_3_3(1.0, 1.0), gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GSP_STORE", str(path))
        maximum(octahedron)
        maximum(lee.platform_3_6(1.0, 2.0, 0.5))
        maximum(octahedron, gsp.PoseBox([(0, 0.1)] * 2 + [(0.3, 0.5)], [(0, 0.1)] * 3))
        maximum(d3, gsp.PoseBox.around(d3.home, [10.0] * 3 + [0.1] * 3))
    return path


@pytest.fixture
def filled(searched, sqlite_store):
    sqlite_store.parent.mkdir()
    shutil.copy(searched, sqlite_store)
    return Store(f"sqlite:///{sqlite_store}")


@pytest.mark.parametrize("suffix", [".csv", ".json"])
def test_round_trip_is_exact(filled, tmp_path, suffix):
    path = tmp_path / f"maxima{suffix}"
    assert export_maxima(filled, path) == (4, 0)
    other = Store(f"sqlite:///{tmp_path / 'other.sqlite'}")
    assert import_maxima(other, path) == (4, 4, 0)
    assert import_maxima(other, path) == (4, 0, 0)
    assert import_maxima(filled, path) == (4, 0, 0)
    before, after = filled.entries(), other.entries()
    assert (before["key"] == after["key"]).all()
    assert (before["value"] - after["value"]).abs().max() <= 1e-15 * before["value"].max()
    for column in ("position", "rotation", "seed", "starts", "found", "domain"):
        assert before[column].equals(after[column]), column


def test_a_false_value_or_key_is_an_error_and_nothing_is_stored(filled, tmp_path):
    path = tmp_path / "maxima.json"
    export_maxima(filled, path)
    data = json.loads(path.read_text())
    other = Store(f"sqlite:///{tmp_path / 'other.sqlite'}")
    for change, message in (
        ({"value": 99.0}, "maximum 1: value: expected .* received 99"),
        ({"key": "f" * 64}, "maximum 1: key"),
        ({"design": None}, "maximum 1"),
        (
            {"value": 0.0, "position": None, "rotation": None},
            "maximum 1: position: expected a pose",
        ),
        ({"starts": None}, "maximum 1: starts"),
        ({"evaluations": 1e400}, "maximum 1: evaluations"),
        ({"converged": 2}, "maximum 1: converged"),
    ):
        bad = {"maxima": [{**data["maxima"][0], **change}, *data["maxima"][1:]]}
        path.write_text(json.dumps(bad))
        with pytest.raises(MalformedFile, match=message):
            import_maxima(other, path)
    assert other.entries().empty


def test_a_byte_order_mark_is_not_part_of_a_file(filled, tmp_path):
    other = Store(f"sqlite:///{tmp_path / 'other.sqlite'}")
    for number, suffix in enumerate((".json", ".csv")):
        path = tmp_path / f"maxima{suffix}"
        export_maxima(filled, path)
        path.write_text("\ufeff" + path.read_text())
        assert import_maxima(other, path) == (4, 0 if number else 4, 0)


def test_bad_files(filled, tmp_path):
    with pytest.raises(InvalidInput, match=r"\.csv or \.json"):
        export_maxima(filled, tmp_path / "maxima.xlsx")
    path = tmp_path / "maxima.json"
    path.write_text("[]")
    with pytest.raises(UnwritableOutput):
        export_maxima(filled, path)
    with pytest.raises(MalformedFile, match="maxima"):
        import_maxima(filled, path)
    with pytest.raises(MalformedFile):
        import_maxima(filled, tmp_path / "none.json")
    (tmp_path / "empty.csv").write_text("")
    with pytest.raises(MalformedFile, match="an empty table"):
        import_maxima(filled, tmp_path / "empty.csv")


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "null", 'an object with a list "maxima" of objects, received null'),
        ("a.json", '"abc"', "received 'abc'"),
        ("a.json", '{"maxima": [', "line 1, column 13: not JSON"),
        ("a.json", '{"maxima": ' + "[" * 100_000, "nested too deeply"),
        ("a.json", '{"maxima": ' + "9" * 5000 + "}", "an integer is too long"),
        ("a.json", '{"maxima": [{}]}', "maximum 1: entry: expected a key, received none"),
        ("a.json", '{"maxima": [{"key": "", "version": "x"}]}', "version: expected a number"),
        ("a.csv", f"key,version,design\n1,{METHOD},x\n", "maximum 1: design: expected JSON"),
        (
            "a.csv",
            f'key,version,design\n1,{METHOD},"[1]"\n',
            "maximum 1: design: expected an object",
        ),
        ("a.csv", "key,key\n1,2\n", "columns of different names"),
        ("a.csv", "a\nb\n", "expected the columns of maxima, such as key, received 'a'"),
    ],
)
def test_files_that_are_none_of_maxima_are_named_without_texts_of_python(
    tmp_path, name, text, message
):
    (tmp_path / name).write_text(text)
    with pytest.raises(MalformedFile) as caught:
        import_maxima(Store("sqlite://"), tmp_path / name)
    assert message in str(caught.value)
    assert not any(word in str(caught.value) for word in ("subscriptable", "indices", "codec"))


def test_a_file_that_is_not_there_is_said_to_be_missing(tmp_path):
    with pytest.raises(MalformedFile, match="No such file"):
        import_maxima(Store("sqlite://"), tmp_path / "none.json")
