"""A design as a multibody model of Pinocchio, its loops closed by Pinocchio's constraints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.bridges.formats.markup import title_of
from gsp.bridges.links.drives import Drives, joint_limits
from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, Motion
from gsp.bridges.links.shapes import Body, Capsule
from gsp.bridges.links.solids import Solids, capsules, check_solids
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.frames.software import import_pinocchio
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.statics.weights import GRAVITY

if TYPE_CHECKING:
    import pinocchio


@read_only_tuple
class PinocchioModel(NamedTuple):
    """A mechanism in Pinocchio: `model, constraints, configuration = to_pinocchio(…)`.

    Attributes
    ----------
    model : pinocchio.Model
    constraints : list of pinocchio.RigidConstraintModel
        One 6D constraint per leg, between the end of its chain and the platform.
    configuration : array of shape (model.nq,) [unit of the design, rad]
        The configuration that realises the pose, all loops closed.
    """

    model: pinocchio.Model
    constraints: list[Any]
    configuration: Array


def to_pinocchio(
    design: Design, pose: Pose, solids: Solids | None = None, drives: Drives | None = None
) -> PinocchioModel:
    """Return a design as a Pinocchio model with all links, joints and loops.

    The platform is a free-flyer "platform". The joints of leg i are "leg{i}_base", the actuated
    ones under their names in `Posture.joint_names` ("d1", "theta4"), for CCC legs the passive
    freedom of the middle joint ("leg{i}_turn" or "leg{i}_slide"), and "leg{i}_platform".
    Legs that are driven at the base have the actuated joint at the base, and "leg{i}_tip".
    Spherical joints are spherical; cylindrical ones at base and platform are a composite of slide
    and turn. The value of an actuated joint is the joint variable itself. Lengths keep the unit of
    the design, and so do gravity and inertias (kg · unit²). Forces are in kg · unit/s² then: in
    thousandths of newtons if the unit is mm.

    Parameters
    ----------
    design : Design
        Any mechanism, redundant ones and drives at the base included.
    pose : Pose
        A single pose, at which all legs are defined.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.
    drives : Drives or None
        Greatest forces and speeds, in the units of the model in `Model.effortLimit` and
        `Model.velocityLimit`.

    Returns
    -------
    PinocchioModel
        model, constraints and configuration.

    Raises
    ------
    UndefinedPosture
        If a leg is not defined at the pose, or one of its joint axes has no direction.
    MissingParameter
        If the unit of the design is unknown: give `solids.metres`.
    InvalidInput
        If `pose` is a batch or beyond a stroke, or `drives` does not fit the design.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> model, constraints, q = to_pinocchio(design, design.home)
    >>> d1 = q[model.joints[model.getJointId("d1")].idx_q]
    >>> model.nv, len(constraints), round(float(d1), 3)
    (42, 6, 143.909)
    """
    chains = linkage(design, pose)
    metres = check_solids(solids).unit(design)
    bodies = capsules(design, chains, solids)
    machine = machine_of(design, pose, chains)
    machine.model.gravity.linear = np.array(GRAVITY) / metres
    _limit(machine.model, design, pose, drives, metres)
    _add_inertias(machine.model, chains, bodies)
    return machine


def machine_of(design: Design, pose: Pose, chains: Sequence[Chain]) -> PinocchioModel:
    """Return the joints and loops of `to_pinocchio`, for which no unit needs to be known.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape ()
    chains : sequence of Chain
        Those of `linkage` at the pose.
    """
    pin = import_pinocchio()
    model = pin.Model()
    model.name = title_of(design)
    platform = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "platform")
    model.addJointFrame(platform)
    ends = [_add_chain(model, chain) for chain in chains]
    constraints = [
        pin.RigidConstraintModel(
            pin.ContactType.CONTACT_6D,
            model,
            end,
            pin.SE3.Identity(),
            platform,
            chain.head.to_se3(),
            pin.ReferenceFrame.LOCAL,
        )
        for end, chain in zip(ends, chains, strict=True)
    ]
    for constraint, chain in zip(constraints, chains, strict=True):
        constraint.name = chain.name
    values = [pin.SE3ToXYZQUAT(pose.to_se3())] + [_value(m) for c in chains for m in c.motions]
    return PinocchioModel(model, constraints, np.concatenate(values))


def _add_chain(model: Any, chain: Chain) -> int:
    """Add the joints of a leg, and return the number of the last."""
    joint, place = 0, chain.foot
    for name, motions in _groups(chain):
        place = place.compose(Pose(motions[0].offset))
        joint = model.addJoint(joint, _joint(motions), place.to_se3(), name)
        model.addJointFrame(joint)
        place = Pose(np.zeros(3))
    return joint


def _groups(chain: Chain) -> list[tuple[str, tuple[Motion, ...]]]:
    """Return the joints of a leg with their names."""
    return [
        (_name(chain.base, f"{chain.name}_base"), chain.base),
        *((motion.name, (motion,)) for motion in chain.middle),
        (_name(chain.platform, f"{chain.name}_platform"), chain.platform),
    ]


def _name(motions: tuple[Motion, ...], composite: str) -> str:
    return motions[0].name if len(motions) == 1 else composite


def joint_of_link(chain: Chain, link: str) -> str:
    """Return the name of the joint that carries a link of a leg.

    Parameters
    ----------
    chain : Chain
    link : "lower", "upper", "rail" or "ball"
    """
    names = [name for name, _ in _groups(chain)]
    return {"lower": names[0], "upper": names[-2]}.get(link, names[-1])


def _joint(motions: tuple[Motion, ...]) -> Any:
    pin = import_pinocchio()
    if len(motions) == 1:
        return _simple_joint(motions[0])
    composite = pin.JointModelComposite()
    for motion in motions:
        composite.addJoint(_simple_joint(motion), pin.SE3.Identity())
    return composite


def _simple_joint(motion: Motion) -> Any:
    pin = import_pinocchio()
    if motion.kind == "ball":
        return pin.JointModelSpherical()
    if motion.kind == "slide":
        return pin.JointModelPrismaticUnaligned(motion.axis)
    return pin.JointModelRevoluteUnaligned(motion.axis)


def _value(motion: Motion) -> Array:
    pin = import_pinocchio()
    if motion.kind == "ball":
        return np.array(pin.Quaternion(np.asarray(motion.value)).coeffs())
    return np.array([motion.value])


def _add_inertias(
    model: Any, chains: Sequence[Chain], bodies: Mapping[str, tuple[Capsule, ...]]
) -> None:
    pin = import_pinocchio()
    joints = {"platform": "platform"}
    for chain in chains:
        for link in ("lower", "upper", "rail", "ball"):
            joints[f"{chain.name}_{link}"] = joint_of_link(chain, link)
    for name in [name for name in bodies if name in joints]:
        body = Body.of(bodies[name])
        inertia = pin.Inertia(body.mass, body.centre, body.inertia)
        model.appendBodyToJoint(model.getJointId(joints[name]), inertia, pin.SE3.Identity())


def _limit(model: Any, design: Design, pose: Pose, drives: Drives | None, metres: float) -> None:
    """Write strokes, greatest forces and speeds as limits of joints, in the unit of the design."""
    limits = joint_limits(design, pose, drives, metres)
    angular = dict(zip(design.joint_names, design.angular, strict=True))
    for name, limit in limits.items():
        joint = model.joints[model.getJointId(name)]
        length, force = (1.0, metres**2) if angular[name] else (metres, metres)
        numbers = (
            ("lowerPositionLimit", joint.idx_q, limit.least / length),
            ("upperPositionLimit", joint.idx_q, limit.greatest / length),
            ("effortLimit", joint.idx_v, limit.effort / force),
            ("velocityLimit", joint.idx_v, limit.speed / length),
        )
        for what, at, number in numbers:
            if np.isfinite(number):
                getattr(model, what)[at] = number
