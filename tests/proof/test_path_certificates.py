"""Path certificates: written, read and checked again; changed ones do not hold."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest

import gsp
from gsp.errors import MalformedFile, UnwritableOutput
from gsp.proof import Tolerances, read_certificate
from tests.campaign import count
from tests.proof.proofs import KINDS, hexapod
from tests.support import random_design, random_pose, turn

pytest.importorskip("flint")
from gsp.proof.verification import verify
from gsp.proof.verification.model import Model
from gsp.proof.verification.paths import pieces_of

HEXAPOD = hexapod()
NODES = gsp.Pose.from_rpy(
    [[0, 0, 1.5], [0.2, 0.1, 1.6], [0, 0.1, 1.5]],
    [[0, 0, 0], [5, 10, 20], [0, 0, 0]],
    degrees=True,
)
FAST = {"times": [0.0, 0.5, 2.0], "motion": "spline"}


def proven(**changes):
    given = {"speeds": 2.0, "accelerations": 30.0, **FAST, **changes}
    return gsp.certify_path(
        HEXAPOD, NODES, gsp.Limits(indices=["CDN_CL <= 30"], length=1.0), **given
    )


def limited():
    return gsp.certify_path(HEXAPOD, NODES, gsp.Limits(strokes=[[1.0, 2.05]] * 6), regular=False)


def singular():
    far = gsp.Pose.from_rpy([[0, 0, 1.5], [0, 0, 1.6]], [[0, 0, 0], [0, 0, 100]], degrees=True)
    return gsp.certify_path(HEXAPOD, far)


def too_fast():
    return gsp.certify_path(HEXAPOD, NODES, speeds=0.3, regular=False, **FAST)


CASES = (proven, limited, singular, too_fast)


@pytest.mark.parametrize("case", CASES, ids=lambda x: x.__name__)
def test_certificates_are_confirmed_and_read_as_they_were_written(case, tmp_path):
    done = case()
    assert (done.status == "proven") == (case is proven)
    check = done.verify()
    assert check, check.reason
    assert check.complete
    done.write(tmp_path / "c.json")
    again = read_certificate(tmp_path / "c.json")
    assert again.record() == done.record()
    assert (again.proven == done.proven).all()
    with pytest.raises(UnwritableOutput):
        done.write(tmp_path / "c.json")


@pytest.mark.parametrize("motion", ["straight", "screw", "spline"])
@pytest.mark.parametrize("kind", KINDS)
def test_paths_of_every_kind_of_leg_are_confirmed(kind, motion):
    for trial in range(count(1, 20)):
        rng = np.random.default_rng([trial, KINDS.index(kind), len(motion)])
        first = random_pose(rng)
        steps = turn(rng.uniform(-0.3, 0.3, 3)), turn(rng.uniform(-0.3, 0.3, 3))
        places = first.position + rng.uniform(-0.1, 0.1, (3, 3))
        nodes = gsp.Pose(
            places, [first.rotation, steps[0] @ first.rotation, steps[1] @ first.rotation]
        )
        design = random_design(rng, [kind] * 3 + ["D1"] * 3).replace(home=first)
        values = design.at(nodes).joints
        strokes = np.stack((values.min(axis=0) - 0.1, values.max(axis=0) + 0.1), axis=1)
        limits = gsp.Limits(
            strokes=np.maximum(strokes, 0.0), base_cone=1.0, indices=["CDN_CL <= 1e3"], length=1.0
        )
        most = rng.uniform(0.2, 1.0, len(design.joint_names))
        done = gsp.certify_path(
            design,
            nodes,
            limits,
            times=[0.0, 1.0, 3.0],
            motion=motion,
            speeds=most,
            accelerations=most if motion == "spline" else None,
            tolerances=Tolerances(*rng.choice([0.0, 1e-5], 5)),
            budget=400,
        )
        check = done.verify(limit=count(3, 1000))
        assert check, (done.status, done.reason, check.reason)


def test_the_curve_of_the_check_is_that_of_the_path():
    """Compared with poses of `PosePath` and `interpolate`, at shares of each piece."""
    path = gsp.PosePath.through(NODES, [0.0, 0.5, 2.0])
    curves = {
        "straight": lambda i, u: None,
        "screw": lambda i, u: NODES[i].interpolate(NODES[i + 1], u),
        "spline": lambda i, u: path.pose((1 - u) * path.times[i] + u * path.times[i + 1]),
    }
    for motion, pose in curves.items():
        record = gsp.certify_path(HEXAPOD, NODES, times=[0.0, 0.5, 2.0], motion=motion).record()
        model = Model(record)
        for i, (piece, span) in enumerate(pieces_of(model, record["path"])):
            here = model.on(piece, span)
            for u in (0.0, 0.3, 1.0):
                place, rotation = piece.platform([here.constant(u)])
                found = [float(x.value.mid()) for x in place]
                turned = [[float(x.value.mid()) for x in row] for row in rotation]
                exact = pose(i, u) or gsp.Pose(
                    (1 - u) * NODES[i].position + u * NODES[i + 1].position,
                    NODES[i].interpolate(NODES[i + 1], u).rotation,
                )
                np.testing.assert_allclose(found, exact.position, rtol=0, atol=1e-14)
                np.testing.assert_allclose(turned, exact.rotation, rtol=0, atol=1e-14)


def changed(record, place, value):
    """A copy of a record where the entry at a place is a value, or a function of what it was."""
    result = copy.deepcopy(record)
    *above, last = place
    target = result
    for key in above:
        target = target[key]
    target[last] = value(target[last]) if callable(value) else value
    return result


OF_PROVEN = {
    "an interval is missing": (("intervals",), lambda x: x[:-1]),
    "an interval in the middle is missing": (("intervals",), lambda x: x[:1] + x[2:]),
    "an interval begins too late": (("intervals", 1, 0), lambda x: x + 1e-12),
    "an interval is open": (("intervals", 1, 2), "open"),
    "an interval violates": (("intervals", 1, 2), "violated"),
    "a mark is not known": (("intervals", 1, 2), "sure"),
    "one box more": (("n_boxes",), lambda x: x + 1),
    "one box less": (("n_boxes",), lambda x: x - 1),
    "refuted": (("status",), "refuted"),
    "not a status": (("status",), "sure"),
    "a reason of a proof": (("reason",), "d1 = 1 > 0"),
    "a stricter index": (("claims", "bounds", "condition_number"), [None, 1.5]),
    "a lower speed": (("claims", "bounds", "speed of d1"), [-0.1, 0.1]),
    "a lower acceleration": (("claims", "bounds", "acceleration of d1"), [-1.0, 1.0]),
    "a speed of no joint": (("claims", "bounds", "speed of d7"), [-9.0, 9.0]),
    "no joint": (("claims", "bounds", "jerk of d1"), [-9.0, 9.0]),
    "larger tolerances": (("claims", "tolerances", 0), [1.0] * 4),
    "shorter times": (("path", "times"), [0.0, 0.05, 0.2]),
    "times that decrease": (("path", "times"), [0.0, 2.0, 0.5]),
    "a node elsewhere": (("path", "nodes", "position", 1, 0), lambda x: x + 1e-6),
    "a node turned": (("path", "nodes", "rotation", 1), turn(np.array([0, 0, 1e-6])).tolist()),
    "a node too many": (("path", "nodes", "position"), lambda x: [*x, x[0]]),
    "no nodes": (("path", "nodes"), None),
    "another motion": (("path", "motion"), "straight"),
    "a motion that is none": (("path", "motion"), "jump"),
    "another curve": (("path", "position", 0, 1, 0), lambda x: x + 1e-3),
    "a gap": (("path", "position", 1, 0, 2), lambda x: x + 1e-6),
    "another turn": (("path", "turn", 0, 2, 0), lambda x: x + 1e-3),
    "a margin below 0": (("path", "margin", 0), -1.0),
    "a wide margin": (("path", "margin", 0), 1.0),
    "no slack": (("path", "slack"), float("nan")),
    "a piece too many": (("path", "slide"), lambda x: [*x, x[0]]),
    "a spline that slides": (("path", "slide", 0, 0), 1e-3),
}  # fmt: skip
OF_REFUTED = {
    "another point": (("points", 0), lambda x: x - 0.1),
    "no point": (("points",), []),
    "outside": (("points", 0), 7.0),
    "another time": (("bracket", 1), lambda x: x + 1e-3),
    "another pose": (("counterexample", "position", 0), lambda x: x + 1e-6),
    "another turn": (("counterexample", "rotation"), turn(np.array([1.0, 0, 0])).tolist()),
    "proven": (("status",), "proven"),
    "undecided": (("status",), "undecided"),
    "another reason": (("reason",), lambda x: x[:-1]),
}


def marked(mark):
    """All intervals with one mark."""
    return lambda intervals: [[low, high, mark] for low, high, _ in intervals]


VIOLATES = {
    "violated intervals are proven": (("intervals",), marked("proven")),
    "proven intervals are violated": (("intervals",), marked("violated")),
}


@pytest.fixture(scope="module")
def records():
    return {case: case().record() for case in CASES}


@pytest.mark.parametrize(
    ("case", "name"),
    [(proven, name) for name in OF_PROVEN]
    + [(case, name) for case in (limited, singular, too_fast) for name in OF_REFUTED]
    + [(case, name) for case in (limited, too_fast) for name in VIOLATES],
    ids=lambda x: x if isinstance(x, str) else x.__name__,
)
def test_changed_certificates_do_not_hold(records, case, name):
    place, value = {**OF_PROVEN, **(OF_REFUTED if case is not proven else {}), **VIOLATES}[name]
    record = changed(records[case], place, value)
    assert record != records[case]
    check = verify(record)
    assert not check
    assert check.reason


@pytest.mark.parametrize(
    "change",
    [{"claims": None}, {"path": {}}, {"intervals": [[0.0]]}, {"points": ["a"]}, {"design": None}],
    ids=str,
)
def test_records_that_are_not_certificates_are_errors(records, change, tmp_path):
    record = {**records[limited], **change}
    with pytest.raises(MalformedFile):
        verify(record)
    (tmp_path / "c.json").write_text(json.dumps(record))
    with pytest.raises(MalformedFile):
        read_certificate(tmp_path / "c.json")


def test_the_curve_of_a_forged_proof_is_evaluated_between_its_nodes():
    """The nodes are regular, and a pose between them is singular: one interval is claimed."""
    record = singular().record()
    forged = {
        **record,
        "status": "proven",
        "reason": "",
        "points": [],
        "bracket": None,
        "counterexample": None,
        "intervals": [[0.0, 1.0, "proven"]],
        "parts": 1,
        "n_boxes": 1,
    }
    assert "could not be confirmed" in verify(forged).reason


def test_undecided_paths_state_what_is_open():
    done = gsp.certify_path(HEXAPOD, NODES, budget=1)
    assert done.status == "undecided"
    assert 0.0 <= done.proven_share < 1.0
    assert {mark for *_, mark in done.intervals} >= {"open"}
    assert "undecided" in repr(done)
