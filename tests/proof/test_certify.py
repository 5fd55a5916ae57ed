"""Certificates: no false proof, refutations that hold, completeness, bad input."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.optimize import minimize

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.errors import GspError, InvalidInput, MalformedFile, MissingParameter, UnwritableOutput
from gsp.proof import Tolerances, certify, read_certificate
from tests.campaign import count
from tests.proof.proofs import (
    KINDS,
    around,
    box_with,
    circle,
    hexapod,
    poses_in,
    singular_design,
)
from tests.support import LEG_NAMES, random_design, random_pose

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def test_the_box_of_the_hexapod_is_proven_regular():
    done = certify(hexapod(), around(1.5, 0.3, 15.0))
    assert done.status == "proven"
    assert done.proven_share == 1.0
    assert done.counterexample is None
    assert done.n_boxes < 20_000


def test_condition_is_bounded_over_the_box_and_refuted_below_what_occurs():
    box, design = around(1.5, 0.2, 10.0), hexapod()
    sampled = gsp.indices.condition_number(design.at(box.sample(20_000, rng=0)), 1.0).max()
    for factor, status in ((1.3, "proven"), (0.97, "refuted")):
        limits = gsp.Limits(indices=[f"CDN_CL <= {factor * sampled}"], length=1.0)
        done = certify(design, box, limits)
        assert done.status == status
    value = gsp.indices.condition_number(design.at(done.counterexample), 1.0)
    assert value > 0.97 * sampled
    assert not gsp.feasible(design, done.counterexample, limits)


def test_a_limit_that_a_corner_violates_is_refuted_at_once():
    box = around(1.5, 0.3, 15.0)
    for indices in (["CDN_CL <= 4"], ["σ_min >= 0.45"]):
        done = certify(hexapod(), box, gsp.Limits(indices=indices, length=1.0))
        assert (done.status, done.n_boxes) == ("refuted", 0)
        point = done.points[0]
        assert ((point == box.low) | (point == box.high)).all()
        assert done.verify(limit=1).holds


def test_no_box_with_a_singular_pose_is_proven_regular():
    rng = np.random.default_rng(12)
    names = [m.constraints for m in mechanisms()]
    statuses = []
    for i in range(count(60, 10_000)):
        kinds = list(names[i % len(names)]) if i % 2 else list(rng.choice(KINDS, 6))
        design, pose = singular_design(rng, kinds)
        values = design.at(pose).singular_values(1.0)
        # Nearly parallel lines lose digits; the singular pose is still far inside of the box.
        assert values[-1] < 1e-9 * values[0]
        done = certify(design, box_with(rng, pose), budget=2000, workers=1)
        assert done.status != "proven", (kinds, pose)
        statuses.append(done.status)
    # It would prove nothing if no box were ever decided.
    assert statuses.count("refuted") > 0.3 * len(statuses)


def test_no_limit_that_is_violated_in_a_corner_is_proven():
    """The violation fills less than a billionth of the box: it is at one corner.

    Where a linear quantity falls by w_k along the edges from a corner, the part of the box where it
    is within m of the corner's value has at most the share m^n / (n! Π w_k).
    """

    def reach(values, corner):
        falls = np.abs(values[corner] - values[corner ^ (1 << np.arange(6))])
        falls = falls[falls > 1e-9 * np.ptp(values)]
        n = len(falls)
        return float((0.5e-9 * math.factorial(n) * falls.prod()) ** (1.0 / n))

    rng = np.random.default_rng(5)
    for i in range(count(36, 2000)):
        kind = KINDS[i // 3 % len(KINDS)]
        # Six rows of one kind may be singular everywhere, which matters for indices.
        design = random_design(rng, [kind] * 6 if i % 3 == 0 else [kind] * 2 + ["D1"] * 4)
        box = gsp.PoseBox.around(random_pose(rng), 0.05 * rng.random(6))
        shares = np.stack(np.meshgrid(*[[0.0, 1.0]] * 6, indexing="ij"), axis=-1).reshape(-1, 6)
        corners = design.at(box.pose(box.low + shares * (box.high - box.low)))
        strokes = np.tile((np.nan, np.nan), (len(design.joint_names), 1))
        if i % 3 == 0:
            values = corners.joints[:, 0]
            strokes[0, 1] = values.max() - reach(values, values.argmax())
            limits = gsp.Limits(strokes=strokes)
        elif i % 3 == 1:
            values = gsp.indices.condition_number(corners, 1.0)
            bound = float(values.max() - reach(values, values.argmax()))
            limits = gsp.Limits(indices=[f"CDN_CL <= {bound!r}"], length=1.0)
        else:
            values = gsp.indices.minimum_singular_value(corners, 1.0)
            bound = float(values.min() + reach(values, values.argmin()))
            limits = gsp.Limits(indices=[f"σ_min >= {bound!r}"], length=1.0)
        assert np.ptp(values) > 0.0
        done = certify(design, box, limits, regular=False, budget=5_000)
        assert done.status != "proven"
        if done.status == "refuted":
            assert not gsp.feasible(design, done.counterexample, limits)


def test_poses_in_proven_boxes_satisfy_what_is_proven():
    rng = np.random.default_rng(8)
    poses = 0
    for i in range(count(8, 400)):
        design = random_design(rng, rng.choice(LEG_NAMES, 6))
        box = gsp.PoseBox.around(random_pose(rng), [0.1] * 3 + [0.1] * 3)
        limits = gsp.Limits(indices=["CDN_CL <= 60"], length=1.0)
        done = certify(design, box, limits, budget=20_000, workers=1)
        low, high, _ = done.boxes("proven")
        if not len(low):
            continue
        some = rng.integers(0, len(low), count(2000, 25_000))
        pose = box.pose(low[some] + rng.random((len(some), 6)) * (high - low)[some])
        posture = design.at(pose)
        assert posture.defined.all(), i
        assert (gsp.indices.condition_number(posture, 1.0) <= 60.0 * (1 + 1e-9)).all(), i
        poses += len(some)
    assert poses > 2_000


def test_a_change_of_sign_brackets_a_singular_pose():
    design = hexapod()
    done = certify(design, around(1.5, 0.5, 30.0))
    assert done.status == "refuted"
    assert "det J" in done.reason
    one, other = np.linalg.det(design.at(done.bracket).jacobian)
    assert one * other < 0.0
    assert np.abs(done.points[0] - done.points[1]).max() < 1e-6
    values = design.at(done.counterexample).singular_values(1.0)
    assert values[-1] < 1e-12 * values[0]
    assert ((done.points >= done.box.low) & (done.points <= done.box.high)).all()


def undecided():
    """A design and a box that many boxes do not decide."""
    box = gsp.PoseBox.around(TEMPLATE.home, [10.0] * 3 + [np.deg2rad(5.0)] * 3)
    return instantiate(gsp.catalogue.mechanism("D1^2 D3 A1^3"), TEMPLATE), box


def test_results_do_not_depend_on_the_number_of_threads():
    design, box = undecided()
    one, three = (certify(design, box, workers=n, budget=40_000) for n in (1, 3))
    assert one.status == three.status
    assert one.n_boxes == three.n_boxes > 20_000
    assert (one.tree == three.tree).all()


def test_a_budget_that_ends_leaves_what_was_proven():
    box = around(1.5, 0.4, 20.0)
    done = certify(hexapod(), box, budget=5000, workers=1)
    assert done.status == "undecided"
    assert 5000 <= done.n_boxes <= 5112
    assert 0.0 < done.proven_share < 1.0
    low, high, shares = done.boxes("proven")
    _, _, open_shares = done.boxes("open")
    assert shares.sum() == pytest.approx(done.proven_share)
    assert shares.sum() + open_shares.sum() == pytest.approx(1.0)
    volumes = np.prod((high - low) / (box.high - box.low), axis=1)
    np.testing.assert_allclose(volumes, shares, rtol=1e-12)
    assert certify(hexapod(), box, budget=200_000).status == "proven"


@pytest.mark.parametrize("sizes", [299, 301])
def test_an_undecided_certificate_states_that_the_platform_origin_is_far_away(sizes):
    """From 300 sizes of the platform on, and not with the origin that it names."""
    points = TEMPLATE.platform_points
    centre = points.mean(axis=0)
    size = np.linalg.norm(points - centre, axis=1).max()
    moved = TEMPLATE.with_origin(centre + sizes * size * np.array([0.48, -0.64, 0.6]))
    # Distances are greatest at corners, which a bound of one box exceeds by its remainder.
    corners = TEMPLATE.home.position + np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), -1).reshape(-1, 3)
    joints = TEMPLATE.at(gsp.Pose(corners, [TEMPLATE.home.rotation] * 8)).joints.max(axis=0)
    limits = gsp.Limits(strokes=np.stack((0.0 * joints, joints + 1e-6), axis=1))

    def reason(design):
        box = gsp.PoseBox.around(design.home, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
        done = certify(design, box, limits, regular=False, budget=1)
        assert done.status == "undecided"
        return done.reason

    stated = f"the platform origin is {sizes:.2g} sizes of the platform from its anchors"
    assert (stated in reason(moved)) == ("design.with_origin" in reason(moved)) == (sizes > 300)
    near = moved.with_origin(moved.platform_points.mean(axis=0))
    assert "origin" not in reason(near)


def test_an_undecided_certificate_is_continued(tmp_path):
    box, limits = around(1.5, 0.4, 20.0), gsp.Limits(indices=["CDN_CL <= 60"], length=1.0)
    first = certify(hexapod(), box, limits, budget=3000, workers=1)
    assert first.status == "undecided"
    path = tmp_path / "c.json"
    first.write(path)
    done = certify(hexapod(), box, limits, resume=read_certificate(path))
    assert done.status == "proven"
    assert done.n_boxes > first.n_boxes
    assert done.verify(limit=3)
    for other in (
        {"limits": None},
        {"box": around(1.5, 0.4, 22.0)},
        {"resume": done},
        {"resume": 3},
    ):
        given = {"box": box, "limits": limits, "resume": first, **other}
        with pytest.raises(InvalidInput, match="resume"):
            certify(hexapod(), **given)


def test_an_interrupt_leaves_what_was_proven():
    (design, box), rounds = undecided(), []

    def stop(done, total):
        rounds.append(done)
        if len(rounds) == 2:
            raise KeyboardInterrupt

    done = certify(design, box, workers=1, budget=80_000, progress=stop)
    assert done.status == "undecided"
    assert 0.0 < done.proven_share < 1.0
    assert done.n_boxes == rounds[-1]


def test_an_executor_gives_the_same_certificate():
    design, box = undecided()
    with ThreadPoolExecutor(2) as pool:
        one = certify(design, box, budget=25_000, executor=pool)
    other = certify(design, box, budget=25_000, workers=1)
    assert one.record() == other.record()
    with pytest.raises(InvalidInput, match="executor"):
        certify(hexapod(), box, executor=3)


def test_coordinates_of_no_width_are_fixed():
    design = hexapod()
    one = certify(design, gsp.PoseBox([0, 0, 1.5], [0, 0, 0]))
    assert (one.status, one.n_boxes) == ("proven", 1)
    plane = gsp.PoseBox([(-0.6, 0.6), (-0.6, 0.6), 1.5], [0, 0, (-0.6, 0.6)])
    done = certify(design, plane)
    assert done.status == "proven"
    assert set(done.tree) <= {0, 1, 5, 6}


def test_a_design_that_is_singular_everywhere_is_never_proven():
    ring = circle(np.arange(6) * 60.0, 1.0)
    design = gsp.Design(["D1"] * 6, 2.0 * ring, ring)
    done = certify(design, around(1.5, 0.1, 5.0), budget=20_000)
    assert done.status == "undecided"
    assert done.proven_share < 1.0


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_the_unit_of_length_does_not_matter(scale):
    design, box = hexapod().scaled(scale), around(1.5, 0.2, 10.0)
    pairs = np.stack((box.low, box.high), axis=1)
    scaled = gsp.PoseBox((scale * pairs[:3]).tolist(), pairs[3:].tolist())
    wanted = certify(hexapod(), box)
    done = certify(design, scaled)
    assert done.status == "proven"
    assert abs(done.n_boxes - wanted.n_boxes) <= 0.05 * wanted.n_boxes


def test_most_mechanisms_are_decided_on_the_template():
    box = gsp.PoseBox.around(TEMPLATE.home, [10.0] * 3 + [np.deg2rad(5.0)] * 3)
    found = [
        certify(instantiate(m, TEMPLATE), box, budget=30_000, workers=1).status
        for m in list(mechanisms())[:: 195 // count(24, 195)]
    ]
    assert found.count("undecided") < 0.4 * len(found)
    assert found.count("proven") >= 0.2 * len(found)


def test_tolerances_hold_for_copies():
    rng = np.random.default_rng(2)
    design, box = hexapod(), around(1.5, 0.1, 5.0)
    limits = gsp.Limits(indices=["CDN_CL <= 6"], length=1.0)
    near = Tolerances(base_points=0.02, platform_points=0.02)
    done = certify(design, box, limits, tolerances=near)
    assert done.status == "proven"
    assert done.n_boxes >= certify(design, box, limits).n_boxes
    for _ in range(50):
        off = rng.standard_normal((2, 6, 3))
        off *= 0.02 / np.linalg.norm(off, axis=-1, keepdims=True)
        copy = design.replace(
            base_points=design.base_points + off[0],
            platform_points=design.platform_points + off[1],
        )
        value = gsp.indices.condition_number(copy.at(poses_in(rng, box, 300)), 1.0)
        assert value.max() <= 6.0


def test_tolerances_of_directions_and_zero_points_hold_for_copies():
    rng = np.random.default_rng(4)
    design = TEMPLATE.replace(strokes=None)
    box = gsp.PoseBox.around(TEMPLATE.home, [2.0] * 3 + [0.02] * 3)
    near = Tolerances(base_directions=0.01, joints=0.5)
    values = []
    for _ in range(10):
        tilt = np.cross(rng.standard_normal((6, 3)), design.base_directions)
        tilt *= np.tan(0.01) / np.linalg.norm(tilt, axis=1, keepdims=True)
        copy = design.replace(base_directions=design.base_directions + tilt)
        values.append(copy.at(poses_in(rng, box, 200)).joints)
    most = np.concatenate(values).max(axis=0)
    strokes = np.stack((np.full(6, np.nan), most + 0.5), axis=1)
    limits = gsp.Limits(strokes=strokes - [0, 0.01])
    inside = certify(design, box, limits, tolerances=near, budget=5_000)
    assert inside.status != "proven"
    outside = certify(design, box, gsp.Limits(strokes=strokes + [0, 4.0]), tolerances=near)
    assert outside.status == "proven"


def test_local_optimisers_miss_what_is_refuted():
    """σ_min has its greatest value at a maximum that about one ascent in fifty reaches."""
    design = random_design(np.random.default_rng(51), ["D1"] * 6)
    box = gsp.PoseBox([(-0.4, 0.4), (-0.4, 0.4), (1.0, 2.0)], [(-45, 45)] * 3, degrees=True)
    half, middle = 0.5 * (box.high - box.low), 0.5 * (box.high + box.low)
    steps = np.concatenate((np.zeros((1, 6)), 1e-6 * np.eye(6)))

    def ascent(x):
        pose = box.pose(middle + np.clip(x, -1.0, 1.0) * half + steps * half)
        values = -design.at(pose).singular_values(1.0)[:, -1]
        return values[0], (values[1:] - values[0]) / 1e-6

    rng = np.random.default_rng(1)
    found = [
        -minimize(
            ascent,
            rng.uniform(-1, 1, 6),
            jac=True,
            method="L-BFGS-B",
            bounds=[(-1, 1)] * 6,
            options={"maxiter": 60},
        ).fun
        for _ in range(8)
    ]
    limits = gsp.Limits(indices=["minimum_singular_value <= 0.32"], length=1.0)
    assert max(found) < 0.32
    done = certify(design, box, limits, regular=False)
    assert done.status == "refuted"
    found = gsp.indices.minimum_singular_value(design.at(done.counterexample), 1.0)
    assert found > 0.32


# --- what is written ---


def test_certificates_are_read_back(tmp_path):
    done = certify(hexapod(), around(1.5, 0.4, 20.0), budget=3000, workers=1)
    path = tmp_path / "c.json"
    done.write(path)
    again = read_certificate(path)
    assert again.record() == done.record()
    assert repr(again) == repr(done)
    with pytest.raises(UnwritableOutput):
        done.write(path)
    path.write_text("{}")
    with pytest.raises(MalformedFile):
        read_certificate(path)
    path.write_text("5")
    with pytest.raises(MalformedFile, match=r"c\.json: expected a gsp certificate, received 5$"):
        read_certificate(path)


# --- bad input ---


def test_bounds_of_angles_beyond_zero_and_pi_hold_always_or_never():
    """An angle between two lines is in [0, π], whatever the limits are."""
    design = random_design(np.random.default_rng(3), ["A1"] + ["D1"] * 5)
    pose = gsp.Pose([0.0, 0.0, 1.5])
    box, angle = gsp.PoseBox.around(pose, [1e-3] * 6), float(design.at(pose).joints[0])
    near = Tolerances(joints=[angle + 0.1, 0, 0, 0, 0, 0])
    for stroke, tolerances, status in (
        ((6.2, 7.0), None, "refuted"),
        ((np.nan, -0.5), None, "refuted"),
        ((np.nan, 3.5), None, "proven"),
        ((-1.0, np.nan), None, "proven"),
        ((0.0, np.pi), None, "proven"),
        # The least zero error of a copy gives an angle below 0, which a copy does not have.
        ((np.nan, angle + 0.05), near, "undecided"),
    ):
        strokes = np.full((6, 2), np.nan)
        strokes[0] = stroke
        limits = gsp.Limits(strokes=strokes)
        done = certify(design, box, limits, regular=False, tolerances=tolerances, budget=500)
        assert done.status == status, stroke
        assert status != "refuted" or not gsp.feasible(design, done.counterexample, limits)


def test_designs_of_extreme_units_are_errors():
    """Squares of their lengths are not numbers of double precision."""
    for scale in (1e-60, 1e50):
        with pytest.raises(InvalidInput, match="lengths"):
            certify(hexapod().scaled(scale), gsp.PoseBox([0, 0, 1.5 * scale], [0, 0, 0]))


def test_bad_input_is_an_error():
    design, box = hexapod(), around(1.5, 0.1, 5.0)
    bad = (
        ((None, box), {}),
        ((design, None), {}),
        ((design, gsp.Pose([0, 0, 1])), {}),
        ((design, box, "CTN"), {}),
        ((design, box), {"budget": 0}),
        ((design, box), {"budget": 1.5}),
        ((design, box), {"workers": 0}),
        ((design, box), {"tolerances": 0.1}),
        ((design, box), {"tolerances": Tolerances(base_points=[1.0, 2.0])}),
        ((design, around(1.5, 0.1, 181.0)), {}),
        ((design, box, gsp.Limits(indices=["rigidity_rate >= 0.1"], length=1.0)), {}),
    )
    for arguments, options in bad:
        with pytest.raises(InvalidInput):
            certify(*arguments, **options)
    with pytest.raises(MissingParameter, match="length"):
        certify(design, box, gsp.Limits(indices=["CDN_CL <= 10"]))
    with pytest.raises(MissingParameter, match="regular"):
        certify(design, box, regular=False)
    with pytest.raises(GspError, match="low"):
        gsp.PoseBox([(1, 0), 0, 0], [0, 0, 0])


@pytest.mark.parametrize(
    "name",
    ["base_points", "platform_points", "base_directions", "platform_directions", "joints"],
)
def test_tolerances_are_checked_and_copied_when_they_are_made(name):
    for wrong in (-1.0, [0.1, -0.1], np.nan, np.inf, "a", None, [[0.1]]):
        with pytest.raises(InvalidInput, match=rf"tolerances\.{name}"):
            Tolerances(**{name: wrong})
    given = np.full(6, 0.1)
    kept = getattr(Tolerances(**{name: given}), name)
    given[0] = -1.0
    assert (kept == 0.1).all()
    assert not kept.flags.writeable


def test_boxes_across_half_a_turn_are_those_of_the_turned_platform():
    """Yaw in [170°, 190°] of a platform whose points are turned back by 180°."""
    design, half = hexapod(), np.diag([-1.0, -1.0, 1.0])
    back = design.replace(platform_points=design.platform_points @ half)
    position = [(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)]
    near = gsp.PoseBox(position, [(-5, 5), (-5, 5), (-10, 10)], degrees=True)
    for low, high in ((170, 190), (-190, -170)):
        across = gsp.PoseBox(position, [(-5, 5), (-5, 5), (low, high)], degrees=True)
        done = gsp.certify(back, across)
        assert done.status == gsp.certify(design, near).status == "proven"
    for low, high in ((-181, 180), (300, 400)):
        with pytest.raises(InvalidInput, match="2π"):
            gsp.certify(design, gsp.PoseBox(position, [0, 0, (low, high)], degrees=True))
    wide = gsp.PoseBox(position, [0, 0, (-180, 180)], degrees=True)
    assert gsp.certify(design, wide).status == "refuted"


@pytest.mark.parametrize("shift", [0.0, 1e3, 1e6])
def test_the_reason_of_a_refutation_is_the_value_of_the_index(shift):
    """Far from the anchors the bounds of an index at one pose are wide."""
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    moved = design.with_origin(np.array([-0.2, 0.7, 0.4]) * shift)
    value = gsp.indices.control_number(design.at(design.home), 95.0)
    limits = gsp.Limits(indices=[f"CTN >= {2.0 * value}"], length=95.0)
    here = gsp.PoseBox.around(moved.home, [0.0] * 6)
    found = gsp.certify(moved, here, limits, regular=False)
    assert found.status == "refuted"
    assert found.reason.startswith(f"control_number = {value:.6g} <")
    assert found.verify().holds
