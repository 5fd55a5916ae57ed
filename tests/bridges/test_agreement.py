"""Pinocchio's loop constraints give the rows of `gsp`, and a wrong row or value fails."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import agreement as agreement_of
from gsp.bridges import to_pinocchio
from gsp.bridges.links.solids import Solids
from gsp.bridges.pinocchio.rates import closure_residual, loop_rates
from gsp.bridges.proof import BOX, DIFFERENCE_TOLERANCE, Proof, prove, random_design
from gsp.errors import UnknownName
from gsp.model.posture import Posture

EXOTIC = gsp.catalogue.mechanism("D1 D2 D3 D4 A1^2")


def test_all_195_mechanisms_agree_with_pinocchio():
    proof = prove(poses=1, seed=2)
    assert len(proof.table) == 195
    assert proof.table["pinocchio actuators"].max() < DIFFERENCE_TOLERANCE
    assert proof.table["pinocchio passive"].max() < DIFFERENCE_TOLERANCE
    assert proof.table["pinocchio closure"].max() < 1e-12
    assert proof.holds


@pytest.mark.parametrize("name", gsp.catalogue.design_names())
def test_the_published_designs_agree(name):
    design = gsp.catalogue.design(name)
    if design.home is None:
        pytest.skip("no home pose")
    pose = design.home.moved(np.repeat([0.01 * design.rms_radius, 0.02], 3))
    assert max(agreement_of(design, pose)) < DIFFERENCE_TOLERANCE


def test_redundant_legs_agree():
    rng = np.random.default_rng(8)
    n = 9
    design = gsp.Design(["D1"] * n, rng.uniform(-1, 1, (n, 3)), rng.uniform(-1, 1, (n, 3)))
    pose = BOX.sample(1, rng=rng)[0]
    model, constraints, _ = to_pinocchio(design, pose)
    assert (model.nv, len(constraints)) == (6 + 7 * n, n)
    assert max(agreement_of(design, pose)) < DIFFERENCE_TOLERANCE


def test_a_wrong_row_would_be_seen(monkeypatch):
    design, pose = a_posture()
    wrong = design.at(pose).homogeneous(design.rms_radius).copy()
    wrong[3, 4] *= 1 + 1e-7
    monkeypatch.setattr(Posture, "homogeneous", lambda self, length: wrong)
    assert agreement_of(design, pose).actuators > DIFFERENCE_TOLERANCE


@pytest.mark.parametrize("row", range(5))
def test_a_wrong_passive_rate_would_be_seen(monkeypatch, row):
    design, pose = a_posture()
    rates = Posture.passive_rates(design.at(pose), design.rms_radius).copy()
    rates[-row - 1] *= 1 + 1e-6
    monkeypatch.setattr(Posture, "passive_rates", lambda self, length: rates)
    assert agreement_of(design, pose).passive > DIFFERENCE_TOLERANCE


def test_a_wrong_configuration_would_be_seen():
    design, pose = a_posture()
    machine = to_pinocchio(design, pose)
    for name in design.joint_names:
        wrong = machine.configuration.copy()
        wrong[machine.model.joints[machine.model.getJointId(name)].idx_q] += 1e-6
        broken = machine._replace(configuration=wrong)
        assert closure_residual(broken, machine.model.createData()) > 1e-7


def test_the_model_belongs_to_the_design_not_to_the_pose():
    """The model made at one pose is closed by the configuration of another."""
    rng = np.random.default_rng(6)
    design = random_design(EXOTIC, rng)
    here = BOX.sample(1, rng=rng)[0]
    there = here.moved([0.05, -0.04, 0.06, 0.1, 0.05, -0.08])
    mixed = to_pinocchio(design, here)._replace(
        configuration=to_pinocchio(design, there).configuration
    )
    assert closure_residual(mixed, mixed.model.createData()) < 1e-12


def test_pinocchio_moves_at_the_rates():
    """Integrating the rates for a small time keeps the loops closed to second order."""
    design, pose = a_posture()
    machine = to_pinocchio(design, pose)
    data = machine.model.createData()
    twist = np.array([0.3, -0.2, 0.1, 0.2, 0.3, -0.1])
    closure_residual(machine, data)
    rates = loop_rates(machine, data, pose) @ twist
    gaps = []
    for time in (1e-3, 1e-4):
        moved = pin.integrate(machine.model, machine.configuration, rates * time)
        gaps.append(closure_residual(machine._replace(configuration=moved), data))
    assert gaps[0] < 1e-4
    assert gaps[1] < gaps[0] / 50


def test_joints_have_their_names_kinds_and_values():
    design, pose = a_posture()
    model, constraints, q = to_pinocchio(design, pose)
    names = list(model.names)
    assert [n for n in names if n in design.joint_names] == list(design.joint_names)
    values = [q[model.joints[model.getJointId(n)].idx_q] for n in design.joint_names]
    np.testing.assert_allclose(values, design.at(pose).joints, rtol=1e-12)
    kinds = {n: model.joints[i].shortname() for i, n in enumerate(names)}
    assert kinds["leg1_base"] == kinds["leg2_base"] == "JointModelSpherical"
    assert "Composite" in kinds["leg2_platform"]
    assert "Composite" in kinds["leg3_base"]
    assert "FreeFlyer" in kinds["platform"]
    assert {c.type for c in constraints} == {pin.ContactType.CONTACT_6D}
    assert [c.name for c in constraints] == [f"leg{i}" for i in range(1, design.n_legs + 1)]
    assert q.shape == (model.nq,)


def test_strokes_become_limits():
    design, pose = a_posture()
    ends = design.at(pose).joints[0] + [-0.1, 2.0]
    strokes = [ends, *[[np.nan, np.nan]] * (len(design.joint_names) - 1)]
    model, _, _ = to_pinocchio(design.replace(strokes=strokes), pose)
    free, _, _ = to_pinocchio(design, pose)
    first, second = (model.joints[model.getJointId(n)].idx_q for n in design.joint_names[:2])
    assert (model.lowerPositionLimit[first], model.upperPositionLimit[first]) == tuple(ends)
    assert model.upperPositionLimit[second] == free.upperPositionLimit[second]


def test_links_have_inertia_also_where_no_solids_are_given():
    design, pose = a_posture()
    thin, _, _ = to_pinocchio(design, pose)
    same, _, _ = to_pinocchio(design, pose, Solids())
    assert pin.computeTotalMass(thin) == pin.computeTotalMass(same) > 0.0
    model, _, q = to_pinocchio(design, pose, Solids(platform_mass=2.0, link_mass=0.25))
    platform = model.inertias[model.getJointId("platform")]
    assert platform.mass == pytest.approx(2.0)
    links = [model.inertias[model.getJointId(f"leg{i}_base")].mass for i in range(1, 6)]
    assert links == pytest.approx([0.25] * 5)
    data = model.createData()
    weight = pin.computeGeneralizedGravity(model, data, q)[:3]
    np.testing.assert_allclose(pose.rotation @ weight, [0, 0, 2.0 * 9.81], atol=1e-12)


def test_the_page_lists_every_mechanism():
    proof = prove([EXOTIC], poses=2)
    page = proof.markdown()
    assert "| D1 D2 D3 D4 A1^2 | 4D2A | 5 | 2 |" in page
    assert "All are below 1e-09" in page
    broken = Proof(proof.table.assign(**{"pinocchio passive": 1e-8}), proof.programs, 1)
    assert not broken.holds
    assert "Not all are" in broken.markdown()


def test_the_committed_page_is_complete_and_holds():
    page = Path(__file__).parents[2].joinpath("docs", "proof.md").read_text(encoding="utf-8")
    rows = [line.split("|") for line in page.splitlines() if line.startswith("| ")][2:]
    assert [row[1].strip() for row in rows] == [m.name for m in gsp.catalogue.mechanisms()]
    assert max(float(cell) for row in rows for cell in row[5:-1]) <= DIFFERENCE_TOLERANCE
    assert {len(row) for row in rows} == {12}  # two ends, four facts, two times three differences
    assert min(int(row[4]) for row in rows) >= 10


def test_an_unknown_program_is_an_error():
    design, pose = a_posture()
    with pytest.raises(UnknownName, match="unknown program 'mujuco'; nearest: mujoco"):
        agreement_of(design, pose, "mujuco")


def test_neither_pinocchio_nor_mujoco_is_imported_by_default():
    code = (
        "import sys, gsp, gsp.bridges; d = gsp.catalogue.design('toz-kucuk-2016-d3-6');"
        "gsp.forward(d, d.at(d.home).joints, d.home); gsp.bridges.to_mjcf(d, d.home);"
        "sys.exit(bool({'pinocchio', 'mujoco'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def a_posture():
    rng = np.random.default_rng(12)
    return random_design(EXOTIC, rng), BOX.sample(1, rng=rng)[0]
