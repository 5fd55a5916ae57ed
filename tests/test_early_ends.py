"""A search that ends early, by its budget or its steps, never contradicts one that ends late."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

import gsp
from gsp.determinant.search import ascent, rounds
from gsp.kinematics.modes import ends as path_ends
from gsp.kinematics.modes import starts
from gsp.proof import distance, largest
from gsp.proof.branching import search
from gsp.proof.paths import search as path_search
from gsp.proof.sextic import region as sextic
from gsp.proof.verification import check
from tests.proof.proofs import around, claimed, hexapod, singular_design, unit

HEXAPOD = hexapod()
UP = gsp.Pose([0.0, 0.0, 1.5])
JOINTS = HEXAPOD.at(UP).joints
STROKES = gsp.Limits(strokes=np.stack((JOINTS - 0.2, JOINTS + 0.2), axis=1))
WIDE = np.array([0.1, 0.1, 0.1, 0.05, 0.05, 0.05])
BUDGETS = (1, 2, 3, 10, 100, 1000)
SLACK = 1.0 + 1e-12


@pytest.mark.parametrize("index", ["CDN_CL", "σ_min", "|det J|", "d1"])
def test_bounds_of_a_quantity_hold_with_every_budget(index):
    box = around(1.5, 0.05, 3.0)
    late = gsp.bounds(HEXAPOD, box, index, 0.1, length=1.0, budget=4000)
    assert late.closed
    for budget in BUDGETS:
        early = gsp.bounds(HEXAPOD, box, index, length=1.0, budget=budget)
        assert early[0] <= late.least * SLACK
        assert early[1] * SLACK >= late.greatest
        assert early.least * SLACK >= late[0]
        assert early.greatest <= late[1] * SLACK


@pytest.mark.parametrize("half", [0.05, 0.2, 1.0])
@pytest.mark.parametrize("open_boxes", [search.MOST_OPEN_BOXES, 40])
def test_a_box_is_undecided_or_as_it_is_with_a_large_budget(monkeypatch, half, open_boxes):
    monkeypatch.setattr(search, "MOST_OPEN_BOXES", open_boxes)
    box = around(1.5, half, 20.0 * half)
    late = gsp.certify(HEXAPOD, box, STROKES, workers=1).status
    assert late == {0.05: "proven", 0.2: "refuted", 1.0: "refuted"}[half]
    for budget in BUDGETS:
        early = gsp.certify(HEXAPOD, box, STROKES, budget=budget, workers=1)
        assert early.status in ("undecided", late)
        assert early.proven_share < 1.0 or late == "proven"


def test_a_box_that_is_not_halved_further_is_not_proven():
    """Its greatest length is the bound of the stroke, and every box there exceeds it."""
    box = gsp.PoseBox([0, 0, (1.4, 1.5)], [0, 0, 0])
    limits = gsp.Limits(strokes=[(np.nan, JOINTS[0] * (1.0 - 1e-15))] * 6)
    for budget in (*BUDGETS, 20_000):
        done = gsp.certify(HEXAPOD, box, limits, regular=False, budget=budget)
        assert done.status == "undecided"


def test_the_largest_bodies_of_early_ends_are_within_those_of_late_ones():
    late = gsp.largest_box(HEXAPOD, UP, WIDE, STROKES, tolerance=0.05, workers=1)
    assert late.refuted is not None
    assert late.refuted.status == "refuted"
    for budget in BUDGETS:
        early = gsp.largest_box(HEXAPOD, UP, WIDE, STROKES, budget=budget, workers=1)
        assert early.factor < late.above
        assert early.above >= early.factor
        assert early.refuted.status == "undecided" or early.above > late.factor
    for shape in ("ball", "cylinder"):
        late = gsp.proof.largest_around(HEXAPOD, UP, WIDE, STROKES, shape=shape, budget=5000)
        assert 0.5 < late.factor < late.above < 1.0 / 0.5
        for budget in BUDGETS:
            early = gsp.proof.largest_around(HEXAPOD, UP, WIDE, STROKES, shape=shape, budget=budget)
            assert early.factor <= late.above
            assert early.above >= late.factor


def test_attempts_of_the_largest_box_that_end_early_leave_valid_factors(monkeypatch):
    late = gsp.largest_box(HEXAPOD, UP, WIDE, STROKES, tolerance=0.05, workers=1)
    for most in (1, 2, 3):
        monkeypatch.setattr(largest, "DOUBLINGS", most)
        early = gsp.largest_box(HEXAPOD, UP, WIDE, STROKES, workers=1)
        assert early.factor < late.above
        assert early.above > late.factor


def test_a_singularity_is_never_nearer_than_an_early_end_states(monkeypatch):
    late = gsp.singularity_distance(HEXAPOD, UP, 1.0, tolerance=0.5, budget=5000)
    assert 0.0 < late.lower <= late.upper < np.inf
    for budget in BUDGETS:
        early = gsp.singularity_distance(HEXAPOD, UP, 1.0, budget=budget)
        assert early.lower <= late.upper
        assert early.upper >= late.lower
    for name in ("RAY_ROUNDS", "RAY_HALVINGS"):
        with monkeypatch.context() as patch:
            patch.setattr(distance, name, 1)
            early = gsp.singularity_distance(HEXAPOD, UP, 1.0, budget=100)
            assert early.lower <= late.upper
            assert early.upper >= late.lower


@pytest.mark.parametrize("far", [0.1, 1.0])
def test_a_path_is_undecided_or_as_it_is_with_a_large_budget(far):
    nodes = gsp.Pose.from_rpy([[0, 0, 1.5], [far, 0, 1.5], [far, 0.1, 1.5]], [[0, 0, 0]] * 3)
    late = gsp.certify_path(HEXAPOD, nodes, STROKES)
    assert late.status == {0.1: "proven", 1.0: "refuted"}[far]
    for budget in BUDGETS:
        early = gsp.certify_path(HEXAPOD, nodes, STROKES, budget=budget)
        assert early.status in ("undecided", late.status)
        assert early.proven_share <= 1.0
        ends = [x for low, high, _ in early.intervals for x in (low, high)]
        assert ends[0] == 0.0
        assert ends[-1] == len(nodes) - 1
        assert ends[1:-1:2] == ends[2::2]


def test_an_interval_with_a_violation_without_a_pose_is_not_proven(monkeypatch):
    """Rounding may leave no pose in the middle that certainly violates what the interval does."""

    def verdicts(charts, problem, rates, chart, low, high):
        no = np.zeros(len(low), dtype=bool)
        return path_search._Verdicts(no, ~no, [""] * len(low), np.zeros(len(low)), no)

    monkeypatch.setattr(path_search, "_verdicts", verdicts)
    nodes = gsp.Pose.from_rpy([[0, 0, 1.5], [0.1, 0, 1.5]], [[0, 0, 0]] * 2)
    done = gsp.certify_path(HEXAPOD, nodes, STROKES)
    assert {mark for *_, mark in done.intervals} == {"violated"}
    assert done.status == "undecided"


@pytest.mark.parametrize("domain", ["all", "box"])
def test_a_bound_of_the_determinant_is_above_the_maximum_with_every_budget(monkeypatch, domain):
    domain = around(1.5, 0.2, 10.0) if domain == "box" else domain
    best = gsp.determinant.maximum(HEXAPOD, domain).value
    monkeypatch.setattr(sextic, "MOST_POSITION_BOXES", 100)
    for budget in BUDGETS[::2]:
        early = gsp.certify_maximum(HEXAPOD, domain, tolerance=0.1, budget=budget)
        assert best <= early.bound * SLACK
        assert early.closed == (early.found.value >= 0.9 * early.bound)


def test_a_search_for_a_maximum_that_ends_early_is_below_it_or_says_so(monkeypatch):
    late = gsp.determinant.maximum(HEXAPOD, "all", seed=5)
    assert late.converged
    for steps, n_rounds in ((ascent.MOST_CLIMB_STEPS, 1), (1, 1), (10, 1), (1, 3)):
        climb = partial(ascent.climb, steps=steps)
        monkeypatch.setattr(rounds, "climb", climb)
        monkeypatch.setattr(rounds, "MOST_ROUNDS", n_rounds)
        early = gsp.determinant.maximum(HEXAPOD, "all", seed=5)
        assert early.value <= late.value * SLACK
        assert not early.converged or early.value == pytest.approx(late.value, rel=1e-9)


def test_steps_of_a_path_that_are_used_up_are_lost_paths(monkeypatch):
    late = gsp.assembly_modes(HEXAPOD, JOINTS)
    assert late.status == "found"
    for most in (1, 10, 20, 40):
        monkeypatch.setattr(path_ends, "PATH_STEPS", most)
        monkeypatch.setattr(path_ends, "RETRACED_PATH_STEPS", most)
        path_ends.other_system.cache_clear()
        early = gsp.assembly_modes(HEXAPOD, JOINTS)
        assert early.n_paths == late.n_paths
        assert early.n_complex + early.n_lost + early.n_infinite + early.n_singular == late.n_paths
        assert early.status == "incomplete" or len(early.residual) == len(late.residual)
        assert len(early.residual) <= len(late.residual)
    path_ends.other_system.cache_clear()


def test_a_general_system_without_all_its_solutions_loses_paths(monkeypatch):
    monkeypatch.setattr(starts, "MOST_LOOPS", 2)
    monkeypatch.setattr(starts, "MOST_SYSTEMS", 1)
    starts.start_of.cache_clear()
    found = gsp.assembly_modes(HEXAPOD, JOINTS)
    starts.start_of.cache_clear()
    assert found.status == "incomplete"
    assert found.n_lost > 0


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_forward_kinematics_without_enough_steps_has_no_pose(backend):
    goal = gsp.Pose.from_rpy([0.2, 0.1, 1.4], [0.1, -0.1, 0.2])
    joints = HEXAPOD.at(goal).joints
    late = gsp.forward(HEXAPOD, joints, UP, backend=backend)
    assert late.converged
    for most in range(int(late.iterations)):
        early = gsp.forward(HEXAPOD, joints, UP, backend=backend, max_iterations=max(most, 1))
        assert early.converged == (early.iterations >= late.iterations)
        assert np.isnan(early.pose.position).all() == (not early.converged)


def test_a_travel_that_is_ended_early_is_no_longer_than_a_late_one():
    way = np.concatenate((unit(np.array([1.0, 0.5, 0.2])), [0.1, 0.2, 0.0]))
    late = gsp.travel(HEXAPOD, UP, way, strokes=STROKES.strokes)
    assert late.limit
    for share in (1e-6, 0.3, 0.999):
        early = gsp.travel(
            HEXAPOD, UP, way, strokes=STROKES.strokes, farthest=share * late.distance
        )
        assert early.limit == ""
        assert early.distance == pytest.approx(share * late.distance, rel=1e-12)


@pytest.mark.parametrize("sound", [True, False])
def test_a_check_that_halves_no_further_does_not_confirm(monkeypatch, sound):
    """One box is claimed to be proven: it is by halving, or not at all."""
    pytest.importorskip("flint")
    design, box = HEXAPOD, around(1.5, 0.1, 10.0)
    if not sound:
        design, pose = singular_design(np.random.default_rng(1), ["D1"] * 6)
        box = gsp.PoseBox.around(pose, [1e-6] * 6)
    done = claimed(gsp.certify(design, box, budget=1, workers=1))
    for most in (0, 2, check.MOST_HALVINGS):
        monkeypatch.setattr(check, "MOST_HALVINGS", most)
        found = done.verify()
        assert found.holds == (sound and most > 2)
        assert found.holds or "could not be confirmed" in found.reason
