"""The independent check confirms certificates, and finds those that were changed."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MalformedFile
from gsp.limits.bounds import bounded_quantities
from gsp.proof import Tolerances, certify, read_certificate
from gsp.proof.verification import verify
from gsp.variation.layout import OPEN, PROVEN
from tests.campaign import count
from tests.proof.proofs import KINDS, around, claimed, hexapod, singular_design
from tests.support import random_design, random_pose

pytest.importorskip("flint")


@pytest.mark.parametrize("kind", KINDS)
def test_proven_boxes_of_every_kind_are_confirmed(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    pose = random_pose(rng)
    design = random_design(rng, [kind] * 3 + ["D1"] * 3)
    values = design.at(pose).joints
    box = gsp.PoseBox.around(pose, [0.003] * 6)
    near = Tolerances(1e-4, 1e-4, 1e-4, 1e-4, 1e-4)
    limits = gsp.Limits(
        strokes=np.stack((np.maximum(values - 0.4, 0.0), values + 0.4), axis=1),
        base_cone=0.5,
        platform_cone=0.5,
        indices=["CDN_CL <= 1e4"],
        length=1.0,
    )
    design = design.replace(home=pose)
    done = certify(design, box, limits, tolerances=near, budget=20_000)
    assert len(done.boxes("proven")[0]) > 0
    check = done.verify(limit=count(1, 50))
    assert check, check.reason
    assert check.checked > 0


OBJECT = gsp.Ellipsoid([0.3, 0.5, 0.9], [0.1, -0.2, 0.3])


@pytest.mark.parametrize("kind", KINDS)
def test_indices_and_clearances_are_confirmed_and_stricter_claims_are_not(kind):
    rng = np.random.default_rng([5, KINDS.index(kind)])
    pose = random_pose(rng)
    design = random_design(rng, [kind] * 3 + ["D1"] * 3, ellipsoid=OBJECT)
    posture = design.at(pose)
    values = {
        "condition_number_ellipsoid": gsp.indices.condition_number_ellipsoid(posture, OBJECT, 1.0),
        "control_number": gsp.indices.control_number(posture, 1.0),
        "manipulability": gsp.indices.manipulability(posture),
    }
    if len(design.joint_names) > 6 and design.angular.any():
        del values["manipulability"]  # it has no unit
    least = {name: 1.1 * x if name.startswith("cond") else 0.9 * x for name, x in values.items()}
    texts = [f"{n} {'<=' if n.startswith('cond') else '>='} {x}" for n, x in least.items()]
    box = gsp.PoseBox.around(pose, [1e-4] * 6)
    pairs = bounded_quantities(design, gsp.Limits(leg_radius=1e-9))
    gaps = pairs.quantities.values(pose.position, pose.rotation)
    gaps = dict(zip(pairs.names, gaps, strict=True))
    least_gap = min(gap for name, gap in gaps.items() if name.startswith("clearance"))
    limits = gsp.Limits(indices=texts, length=1.0, leg_radius=0.45 * least_gap)
    done = certify(design, box, limits, budget=20_000)
    assert done.status == "proven"
    check = done.verify(limit=1)
    assert check, check.reason
    claimed = done.claims["bounds"]
    names = [*values, next(name for name in claimed if name not in values)]
    # Every name in the campaign, else one per kind of leg: what fails is halved many times.
    for name in (names[KINDS.index(kind) % len(names) :])[: count(1, len(names))]:
        low = claimed[name][0]
        value = float({**values, **gaps}[name])
        stricter = [None, 0.9 * value] if low is None else [1.1 * value, None]
        claims = {**done.claims, "bounds": {name: stricter}}
        assert not dataclasses.replace(done, claims=claims).verify(limit=1), name


def test_what_a_reader_sees_is_checked():
    done = certify(hexapod(), around(1.5, 0.1, 5.0), gsp.Limits(strokes=[[1.0, 2.2]] * 6))
    assert done.verify(limit=1)
    elsewhere = gsp.Pose([9.0, 9.0, 9.0])
    for change in (
        {"counterexample": elsewhere},
        {"reason": "x = 7 > 3"},
        {"status": "sure"},
        {"points": done.points[:0]},
    ):
        assert not dataclasses.replace(done, **change).verify(limit=1), change
    singular = certify(hexapod(), around(1.5, 0.5, 30.0))
    assert not dataclasses.replace(singular, counterexample=elsewhere).verify(limit=1)
    assert not dataclasses.replace(singular, bracket=elsewhere.reshape(1)[[0, 0]]).verify(limit=1)


def test_regularity_is_claimed_by_itself():
    """A box with a singular pose in the middle; nothing else is claimed."""
    design, pose = singular_design(np.random.default_rng(1), ["D1"] * 6)
    done = certify(design, gsp.PoseBox.around(pose, [1e-6] * 6), budget=50, workers=1)
    assert done.claims["bounds"] == {}
    assert "could not be confirmed" in claimed(done).verify().reason


@pytest.mark.parametrize(
    "change",
    [
        {"claims": None},
        {"claims": {}},
        {"tree": "????"},
        {"points": [["a"] * 6]},
        {"design": None},
        {"box": {}},
    ],
    ids=lambda change: next(iter(change)),
)
def test_records_that_are_not_certificates_are_errors(change):
    done = certify(hexapod(), around(1.5, 0.5, 30.0), budget=100, workers=1)
    with pytest.raises(MalformedFile):
        verify({**done.record(), **change})


@pytest.mark.parametrize("change", [{"points": [[10**400] * 6]}, {"reason": {}}], ids=["0", "1"])
def test_files_with_meaningless_entries_are_not_certificates(change, tmp_path):
    done = certify(hexapod(), around(1.5, 0.5, 30.0), budget=100, workers=1)
    (tmp_path / "c.json").write_text(json.dumps({**done.record(), **change}))
    with pytest.raises(MalformedFile):
        read_certificate(tmp_path / "c.json")


def test_a_whole_certificate_is_confirmed():
    done = certify(hexapod(), around(1.5, 0.1, 6.0))
    assert done.status == "proven"
    check = done.verify()
    assert check
    assert check.checked == check.boxes
    assert check.share == 1.0


def test_refutations_are_confirmed():
    design = hexapod()
    for box, limits in (
        (around(1.5, 0.5, 30.0), None),
        (around(1.5, 0.1, 5.0), gsp.Limits(indices=["CDN_CL <= 1.5"], length=1.0)),
        (around(1.5, 0.1, 5.0), gsp.Limits(strokes=[[1.0, 2.2]] * 6)),
    ):
        done = certify(design, box, limits)
        assert done.status == "refuted"
        assert done.verify(limit=1)
        for points in (done.points[[0, 0]] if limits is None else done.points + 10.0,):
            assert not dataclasses.replace(done, points=points).verify(limit=1)


def test_changed_certificates_are_found():
    done = certify(hexapod(), around(1.5, 0.4, 20.0), budget=2000, workers=1)
    assert done.status == "undecided"
    whole = np.array([PROVEN], dtype=np.int8)
    changes = {
        "claimed as one box": {"tree": whole},
        "open boxes claimed as proven": {"status": "proven"},
        "half of the boxes is missing": {"tree": done.tree[: len(done.tree) // 2]},
        "a box too many": {"tree": np.concatenate((done.tree, whole))},
    }
    for name, change in changes.items():
        assert not dataclasses.replace(done, **change).verify(limit=3), name
    marks = np.where(done.tree == OPEN, PROVEN, done.tree).astype(np.int8)
    stricter = {**done.claims, "bounds": {"condition_number": [None, 1.5]}}
    assert not dataclasses.replace(done, claims=stricter).verify(limit=3)
    assert (marks != done.tree).any()


def test_a_box_with_a_singular_pose_is_not_confirmed():
    rng = np.random.default_rng(1)
    design, pose = singular_design(rng, ["D1", "D2", "D3", "D4", "A1", "D1"])
    box = gsp.PoseBox.around(pose, [1e-6] * 6)
    done = certify(design, box, budget=50, workers=1)
    assert "could not be confirmed" in claimed(done).verify().reason


def stated(**changes):
    """A record with other claims."""
    design = hexapod().replace(home=gsp.Pose([0.0, 0.0, 1.5]))
    done = certify(design, around(1.5, 0.01, 0.5), gsp.Limits(base_cone=1.5), workers=1)
    record = done.record()
    return {**record, "claims": {**record["claims"], **changes}}


@pytest.mark.parametrize(
    "name",
    [
        "CTN",
        "CONTROL_NUMBER",
        "quality_index",
        "foo",
        "d7",
        "base cone 0",
        "clearance 0-1",
        "clearance 1-1",
        " clearance 1-2",
    ],
)
def test_bounds_of_what_is_not_checked_do_not_hold(name):
    assert verify(stated())
    for status in ("proven", "undecided"):
        check = verify({**stated(bounds={name: [0.99, None]}), "status": status})
        assert not check
        assert name in check.reason


def test_axes_of_cones_are_unit_vectors():
    record = stated(bounds={"base cone 1": [None, 1.5]})
    assert verify(record)
    axes = np.array(record["claims"]["axes"])
    for scale in (100.0, 0.0, 1.0 + 1e-9):
        check = verify(stated(bounds={"base cone 1": [None, 1.5]}, axes=(scale * axes).tolist()))
        assert "unit vector" in check.reason


@pytest.mark.parametrize(
    "claims",
    [
        {"bounds": {}, "regular": False},
        {"bounds": {"x": [None, None]}},
        {"bounds": {"x": []}},
        {"bounds": {"x": [float("nan"), 1.0]}},
        {"regular": 0},
        {"axes": [[[float("nan")] * 3] * 2] * 6},
        {"length": -1.0},
        {"length": "1"},
        {"tolerances": [[0.0] * 4] * 12},
        {"tolerances": [[-1.0] * 4] * 6},
        {"ellipsoid": {"semi_axes": [-1.0] * 3, "center": [0.0] * 3, "rotation": np.eye(3)}},
        {"ellipsoid": {"semi_axes": [1.0] * 3, "center": [0.0] * 3, "rotation": 2 * np.eye(3)}},
    ],
    ids=range(12),
)
def test_claims_without_a_sense_do_not_hold(claims):
    check = verify(stated(**claims))
    assert not check
    assert check.checked == 0


def test_a_box_with_low_above_high_does_not_hold():
    record = stated()
    box = record["box"]
    turned = {**box, "low": box["high"], "high": box["low"]}
    assert "low above high" in verify({**record, "box": turned}).reason


def test_the_whole_reason_of_a_refutation_is_checked():
    limits = gsp.Limits(indices=["CDN_CL <= 1.5"], length=1.0)
    done = certify(hexapod(), around(1.5, 0.1, 5.0), limits, workers=1)
    assert done.verify()
    value = done.reason.split(" ")[2]
    for reason in (
        "condition_number",
        "condition_numberfoo",
        "condition_number = 1e9 > 1.5",
        f"condition_number = {value} > 1.4",
        f"condition_number = {value} < 1.5",
        f"condition_number = {value} > 1.5 or not",
    ):
        assert not dataclasses.replace(done, reason=reason).verify(), reason
    singular = certify(hexapod(), around(1.5, 0.5, 30.0), workers=1)
    assert singular.verify(limit=1)
    changed = singular.reason + ", it seems"
    assert not dataclasses.replace(singular, reason=changed).verify(limit=1)


def test_refutations_with_tolerances_are_confirmed_for_the_design_itself():
    near = Tolerances(1e-4, 1e-4, 1e-4, 1e-4, 1e-4)
    design = hexapod().replace(home=gsp.Pose([0.0, 0.0, 1.5]))
    for limits in (
        gsp.Limits(indices=["CDN_CL <= 1.5"], length=1.0),
        gsp.Limits(strokes=[[1.0, 2.2]] * 6),
        gsp.Limits(base_cone=0.1),
        gsp.Limits(leg_radius=5.0),
    ):
        done = certify(design, around(1.5, 0.1, 5.0), limits, tolerances=near, workers=1)
        assert done.status == "refuted"
        check = done.verify(limit=1)
        assert check, (done.reason, check.reason)


def test_a_check_states_its_progress_and_ends_when_it_is_to():
    limits = gsp.Limits(indices=["CDN_CL <= 5.5"], length=1.0)
    done = certify(hexapod(), around(1.5, 0.1, 6.0), limits)
    assert done.status == "proven"
    seen = []
    check = done.verify(progress=lambda done, total: seen.append((done, total)))
    assert check.complete
    assert seen == [(i + 1, check.boxes) for i in range(check.boxes)]
    assert 2 < check.boxes < 30

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    check = done.verify(progress=stop)
    assert check.holds
    assert not check.complete
    assert check.checked == 2
    assert 0.0 < check.share < 1.0
    check = done.verify(seconds=1e-9)
    assert not check.holds
    assert "ended before" in check.reason
    for bad in ({"seconds": 0.0}, {"seconds": "1"}, {"progress": 3}):
        with pytest.raises(InvalidInput):
            done.verify(**bad)


def test_refutations_hold_whatever_was_proven_before():
    """Boxes that are proven nearly up to their bound, with tolerances, are hard to confirm."""
    rng = np.random.default_rng(58)
    design = random_design(rng, ["A1"] * 3 + ["D1"] * 3)
    pose = random_pose(rng)
    near = Tolerances(1e-4, 1e-4, 5e-3, 5e-3)
    box = gsp.PoseBox.around(pose, [0.03] * 6)
    limits = gsp.Limits(base_cone=0.4, base_axes=rng.standard_normal((6, 3)))
    done = certify(design, box, limits, tolerances=near, regular=False, budget=200, workers=1)
    assert done.status == "refuted"
    check = done.verify()
    assert check, check.reason
    assert check.boxes == 0
    moved = dataclasses.replace(done, points=done.points + 10.0)
    assert not moved.verify()


def test_the_number_of_boxes_is_that_of_the_tree():
    for half, angle in ((0.1, 6.0), (0.4, 20.0)):
        done = certify(hexapod(), around(1.5, half, angle), budget=300, workers=1)
        assert done.verify(limit=1)
        for n_boxes in (0, len(done.tree) + 1):
            check = dataclasses.replace(done, n_boxes=n_boxes).verify(limit=1)
            assert not check
            assert "n_boxes" in check.reason
