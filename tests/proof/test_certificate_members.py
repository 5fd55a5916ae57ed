"""Members of a certificate of another form: clear errors, and nothing holds."""

import json

import pytest

import gsp
from gsp.errors import MalformedFile
from gsp.proof import read_certificate
from gsp.proof.verification import verify

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox.around(DESIGN.home, [1e-3] * 3 + [1e-5] * 3)
PYTHON = ("int too large", "subscriptable", "has no len", "not supported", "object", "float()")


@pytest.fixture(scope="module")
def good():
    record = gsp.certify(DESIGN, BOX, workers=1).record()
    assert verify(record)
    return record


@pytest.mark.parametrize(
    ("member", "value"),
    [
        ("points", 10**400),
        ("points", [[[]]]),
        ("points", [[1.0]]),
        ("n_boxes", "x"),
        ("n_boxes", -1),
        ("n_boxes", True),
        ("tree", 3),
        ("box", None),
        ("counterexample", [1]),
    ],
)
def test_a_file_is_refused(good, tmp_path, member, value):
    path = tmp_path / "a.json"
    path.write_text(json.dumps({**good, member: value}))
    with pytest.raises(MalformedFile) as error:
        read_certificate(path)
    assert not any(word in str(error.value) for word in PYTHON), error.value


def test_what_is_not_a_certificate(tmp_path):
    path = tmp_path / "a.json"
    for text, words in (
        ("3", "received 3"),
        ("{", r"not JSON \(line 1, column 2\)"),
        ("{}", "without 'format'"),
    ):
        path.write_text(text)
        with pytest.raises(MalformedFile, match=words):
            read_certificate(path)


@pytest.mark.parametrize(
    "axes",
    [0, None, [[[2.0, 0, 0], [0, 0, 0]], *[[[0, 0, 0]] * 2] * 5], [[0, 0, 0]] * 6, [[[]]] * 6],
)
def test_axes_of_cones(good, axes):
    found = verify({**good, "claims": {**good["claims"], "axes": axes}})
    assert not found.holds
    assert "ax" in found.reason


def test_other_claims_without_a_sense(good):
    for member, value in (("tolerances", 0), ("tolerances", [0] * 6), ("length", "a")):
        assert not verify({**good, "claims": {**good["claims"], member: value}}).holds
    for value in ("x", None, float("nan")):
        assert not verify({**good, "n_boxes": value}).holds
