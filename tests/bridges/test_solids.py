"""Masses and inertias of links, the same for all exports, compared with three programs."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import Solids, to_mjcf, to_pinocchio, to_urdf
from gsp.bridges.links.shapes import Body, Capsule

TWO = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
SOLIDS = Solids(radius=9.0)


@pytest.mark.parametrize(("length", "radius"), [(3.0, 0.2), (0.5, 2.0), (0.0, 1.5), (1e-9, 1.0)])
def test_inertia_of_a_capsule_against_an_integral(length, radius):
    """Discs of which it is a pile, integrated over its axis."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    cuts = [(-length / 2 - radius, -length / 2), (-length / 2, length / 2),
            (length / 2, length / 2 + radius)]  # fmt: skip
    mass = axial = across = 0.0
    for low, high in cuts:
        z = (low + high) / 2 + nodes * (high - low) / 2
        beyond = np.maximum(np.abs(z) - length / 2, 0.0)
        square = radius**2 - beyond**2
        disc = weights * (high - low) / 2 * np.pi * square
        mass += disc.sum()
        axial += (disc * square / 2).sum()
        across += (disc * (square / 4 + z**2)).sum()
    start = np.array([1.0, 2.0, 3.0])
    capsule = Capsule(start, start + [length, 0, 0], radius, 2.5)
    found = np.linalg.eigvalsh(capsule.inertia)
    expected = np.sort([axial, across, across]) * 2.5 / mass
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    if length:
        assert capsule.inertia[0, 0] == pytest.approx(axial * 2.5 / mass, rel=1e-6)


def test_parts_together_against_pinocchio():
    rng = np.random.default_rng(4)
    parts = [Capsule(*rng.normal(size=(2, 3)), 0.3, m) for m in (1.0, 0.2, 3.0)]
    body = Body.of(parts)
    total = sum(
        (
            part.frame.to_se3().act(pin.Inertia.FromCapsule(part.mass, part.radius, part.length))
            for part in parts
        ),
        pin.Inertia.Zero(),
    )
    assert body.mass == pytest.approx(total.mass, rel=1e-15)
    np.testing.assert_allclose(body.centre, total.lever, rtol=1e-13)
    np.testing.assert_allclose(body.inertia, total.inertia, rtol=1e-12, atol=1e-14)


def spatial(mass, centre, inertia):
    """The 6 × 6 inertia at the origin of a link."""
    return pin.Inertia(mass, np.asarray(centre), np.asarray(inertia)).matrix()


def test_all_exports_have_the_same_inertias():
    """Pinocchio's own model, the URDF that it reads, and MuJoCo, which computes its own."""
    metres = 1e-3
    ours = to_pinocchio(TWO, TWO.home, SOLIDS).model
    tree = pin.buildModelFromXML(to_urdf(TWO, TWO.home, SOLIDS).text)
    theirs = mujoco.MjModel.from_xml_string(to_mjcf(TWO, TWO.home, SOLIDS))
    unit = np.outer(*[np.repeat([1.0, metres], 3)] * 2)  # lengths of the design are millimetres
    compared = 0
    for name in ours.names[1:]:
        inertia = ours.inertias[ours.getJointId(name)].matrix() * unit
        if not inertia.any():
            continue
        body = {"platform": "platform"}.get(name) or _link(ours, name)
        link = body.replace("rail", "platform").replace("ball", "platform")
        frame = tree.frames[tree.getFrameId(link, pin.BODY)]
        joint = tree.inertias[frame.parentJoint].matrix()
        np.testing.assert_allclose(joint, inertia, rtol=1e-9, atol=1e-12 * np.abs(inertia).max())
        number = mujoco.mj_name2id(theirs, mujoco.mjtObj.mjOBJ_BODY, body)
        turn = pin.Quaternion(*theirs.body_iquat[number]).matrix()
        moments = turn @ np.diag(theirs.body_inertia[number]) @ turn.T
        other = spatial(theirs.body_mass[number], theirs.body_ipos[number], moments)
        np.testing.assert_allclose(other, inertia, rtol=1e-9, atol=1e-9 * np.abs(inertia).max())
        compared += 1
    assert compared == 1 + 3 * TWO.n_legs


def _link(model, joint):
    """Which link of a leg follows a joint."""
    if joint.endswith("_base"):
        return joint.replace("_base", "_lower")
    if joint.endswith("_platform"):
        number = int(joint.removeprefix("leg").removesuffix("_platform"))
        line = TWO.legs[number - 1].platform_line
        return joint.replace("_platform", "_rail" if line else "_ball")
    chain = next(
        n
        for n in model.names
        if n.endswith("_platform") and model.parents[model.getJointId(n)] == model.getJointId(joint)
    )
    return chain.replace("_platform", "_upper")


def test_numbers_of_numpy_are_plain_numbers():
    assert repr(Solids(density=np.float64(5.0), radius=np.array(2)).density) == "5.0"
