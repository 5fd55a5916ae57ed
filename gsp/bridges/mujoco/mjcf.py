"""A design as a MuJoCo model (MJCF)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.bridges.formats.markup import Node, joined, title_of
from gsp.bridges.links.drives import NO_STROKE, Drives, JointLimit, joint_limits
from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, Motion, Z, displacements
from gsp.bridges.links.shapes import Body, Capsule
from gsp.bridges.links.solids import Solids, capsules, check_solids
from gsp.bridges.mujoco.elements import (
    LARGEST_PICTURE,
    add_body,
    add_geoms,
    configuration,
    frame_of,
    metric,
    moved,
)
from gsp.checks import check_array, check_positive
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm
from gsp.geometry.vectors import unit as unit_vector
from gsp.model.design import Design
from gsp.statics.weights import GRAVITY

TIMESTEP = 1e-3  # s
SERVO_FREQUENCY = 300.0  # rad/s
# Armature of passive joints, as a share of the moving mass or inertia. The stiffness of a
# constraint scales with the masses that it connects; this share keeps loops closed to micrometres.
ARMATURE_SHARE = 1e-2
DAMPING_RATE = 0.5  # of passive joints, in 1/s times the mass or inertia that they carry at most
# MuJoCo (mjMINVAL) accepts no smaller masses [kg] of moving bodies.
LEAST_MASS = 1e-15
# Nor moments of inertia [kg m²] below 1e-15; for turned axes it refused some up to 9e-15.
LEAST_INERTIA = 1e-13
# Of moments of inertia that are further apart than this share the least is lost to rounding.
ROUNDED_SHARE = 1e-14
# Largest distance of a common normal from the anchors, over the size of the design, where the
# lines of a leg are nearly parallel. Rates by MuJoCo were right to 4e-7 up to 1.8e4 sizes, and
# wrong from 1.9e4 sizes on.
LARGEST_REACH = 1e4
# Half the range of a locked joint, as a share of its value: MuJoCo takes no empty range.
LOCKED = 1e-12
# Bodies that do not move, or are not in the model.
FIXED = ("base", "split")


def to_mjcf(
    design: Design,
    pose: Pose,
    solids: Solids | None = None,
    drives: Drives | None = None,
    *,
    gravity: ArrayLike = GRAVITY,
    servo_frequency: float = SERVO_FREQUENCY,
) -> str:
    """Return a design as the text of a MuJoCo model.

    The model is assembled at the pose. Its lengths are in metres, for every unit of the
    design. Spherical joints at the platform are `connect` constraints, cylindrical ones are links
    with a `weld` to the platform. Actuated joints have their names of `Posture.joint_names`
    ("d1", "theta4"), their values are the joint variables [m, rad], and each has a position servo
    of the same name, and sensors "d1_position" and "d1_force"; those of the platform are
    "platform_position" and "platform_rotation" (w, x, y, z). The control of a servo is the change
    of its joint variable from that at the pose, so that zero, as programs start, holds the pose.
    The keyframe "pose" is the same state.

    Parameters
    ----------
    design : Design
        Any mechanism, redundant ones and drives at the base included.
    pose : Pose
        A single pose, at which all legs are defined.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.
    drives : Drives or None
        Greatest forces of the servos. MuJoCo has no limits of speed.
    gravity : (3,) array_like [m/s²]
        In base axes.
    servo_frequency : float [rad/s]
        Stiffness of a servo is the moving mass (for angles, the mass times `design.rms_radius`²)
        times this squared; they are critically damped. The step is 1 ms, above 300 rad/s as much
        shorter as the servos are faster.

    Returns
    -------
    str

    Raises
    ------
    UndefinedPosture
        If a leg is not defined at the pose, or one of its joint axes has no direction.
    MissingParameter
        If the unit of the design is unknown: give `solids.metres`.
    InvalidInput
        If `pose` is a batch or beyond a stroke, or a number is not usable, or a mass or an inertia
        of a link is smaller than MuJoCo accepts, or a link is so long that its least moment of
        inertia is lost to rounding, or the lines of a leg are so nearly parallel that its rail is
        longer than 10,000 sizes of the design.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> to_mjcf(design, design.home).splitlines()[0]
    '<mujoco model="toz-kucuk-2016-d3-6">'
    """
    chains = linkage(design, pose)
    unit = check_solids(solids).unit(design)
    bodies = capsules(design, chains, solids)
    _check_masses(bodies, unit)
    _check_reach(chains, design.rms_radius)
    down = check_array("gravity", gravity, (3,), axes=1)
    frequency = check_positive("servo_frequency", servo_frequency)
    frequency = arguments.number("servo_frequency", frequency)  # its square is finite
    mass = sum(c.mass for name, parts in bodies.items() if name not in FIXED for c in parts)
    inertia = mass * (unit * design.rms_radius) ** 2
    root = ElementTree.Element("mujoco", model=title_of(design))
    _settings(root, down, mass, inertia, TIMESTEP * min(1.0, SERVO_FREQUENCY / frequency))
    world = ElementTree.SubElement(root, "worldbody")
    _scenery(root, world, design, pose, unit)
    add_geoms(world, bodies["base"], "base", unit)
    for chain in chains:
        _add_leg(world, chain, bodies, unit)
    _add_platform(world, chains, pose, bodies, unit)
    _close(root, chains, unit)
    _actuate(root, chains, frequency, {"slide": mass, "turn": inertia}, unit)
    _limit(root, chains, joint_limits(design, pose, drives, unit), unit)
    _add_sensors(root, chains)
    _add_key(root, chains, pose, unit)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _check_masses(bodies: Mapping[str, tuple[Capsule, ...]], unit: float) -> None:
    for name in [name for name in bodies if name not in FIXED]:
        body = Body.of(bodies[name])
        moments = np.linalg.eigvalsh(body.inertia) * unit**2
        least = float(moments[0])
        if least <= ROUNDED_SHARE * moments[2]:
            long = max(bodies[name], key=lambda part: part.length)
            wanted = f"moments of inertia of {name} within a factor of {1.0 / ROUNDED_SHARE:.0e}"
            got = f"{long.length * unit:.3g} m of length and {long.radius * unit:.3g} m of radius"
            raise InvalidInput(expected("pose", wanted, got, "or radius of solids"))
        if not (body.mass > LEAST_MASS and least > LEAST_INERTIA):
            least_values = f"{LEAST_MASS:g} kg and {LEAST_INERTIA:g} kg m²"
            wanted = f"a mass and moments of inertia above {least_values} of {name}"
            got = f"{body.mass:.3g} kg and {least:.3g} kg m²"
            which = "link_mass, platform_mass, radius"
            raise InvalidInput(expected("solids", f"{wanted}, which MuJoCo needs", got, which))


def _check_reach(chains: Iterable[Chain], size: float) -> None:
    for chain in chains:
        joints = (motion for motion in chain.base + chain.platform if not motion.active)
        reach = max(map(abs, displacements(joints)), default=0.0)
        if not reach <= LARGEST_REACH * size:
            wanted = f"a foot within {LARGEST_REACH:g} sizes of the anchors, which MuJoCo needs"
            got = f"one at {reach / size:.3g} sizes (lines that are nearly parallel)"
            raise InvalidInput(expected(chain.name, wanted, got))


def _settings(root: Node, gravity: Array, mass: float, inertia: float, step: float) -> None:
    add = ElementTree.SubElement
    add(root, "compiler", angle="radian", autolimits="true")
    add(root, "option", timestep=repr(step), integrator="implicitfast", gravity=joined(gravity))
    visual = add(root, "visual")
    high, wide = map(str, LARGEST_PICTURE)
    add(visual, "global", offwidth=wide, offheight=high)
    add(visual, "headlight", ambient="0.4 0.4 0.4", diffuse="0.5 0.5 0.5")
    sky = add(
        add(root, "asset"), "texture", type="skybox", builtin="flat", rgb1="1 1 1", rgb2="1 1 1"
    )
    sky.attrib |= {"width": "8", "height": "48"}
    defaults = add(root, "default")
    add(defaults, "geom", type="capsule", contype="0", conaffinity="0")
    add(defaults, "equality", solref=joined([2 * step, 1.0]), solimp="0.9999 0.9999 0.001")
    for name, size in (("slide", mass), ("turn", inertia)):
        kind = add(defaults, "default", {"class": name})
        add(kind, "joint", damping=repr(DAMPING_RATE * size), armature=repr(ARMATURE_SHARE * size))


def _scenery(root: Node, world: Node, design: Design, pose: Pose, unit: float) -> None:
    """Light, a camera "side" and the view of viewers, all of the box of the anchors."""
    ends = pose.position + design.platform_points @ pose.rotation.T
    anchors = unit * np.concatenate((design.base_points, ends))
    low, high = anchors.min(axis=0), anchors.max(axis=0)
    middle, reach = 0.5 * (low + high), max(float(norm(high - low)), 1e-9)
    add = ElementTree.SubElement
    add(root, "statistic", center=joined(middle), extent=repr(reach))
    above = joined(middle + np.array([0.0, 0.0, 2.0 * reach]))
    add(world, "light", pos=above, dir="0 0 -1", castshadow="false")
    aside = np.array([0.7, -0.8, 0.35])
    right = unit_vector(cross(Z, aside))
    axes = joined([*right, *unit_vector(cross(aside, right))])
    add(world, "camera", name="side", pos=joined(middle + 1.3 * reach * aside), xyaxes=axes)


def _add_leg(
    world: Node, chain: Chain, bodies: Mapping[str, tuple[Capsule, ...]], unit: float
) -> None:
    name, kind = chain.name, chain.leg.name
    lower = add_body(world, f"{name}_lower", moved(chain.foot, chain.base), chain.base, unit)
    add_geoms(lower, bodies[f"{name}_lower"], kind, unit)
    middle = moved(Pose(np.zeros(3)), chain.middle)
    upper = add_body(lower, f"{name}_upper", middle, chain.middle, unit)
    add_geoms(upper, bodies[f"{name}_upper"], "rod", unit)
    if chain.leg.platform_line:
        end = moved(Pose(np.zeros(3)), chain.platform)
        rail = add_body(upper, f"{name}_rail", end, chain.platform, unit)
        add_geoms(rail, bodies[f"{name}_rail"], "platform", unit)


def _add_platform(
    world: Node,
    chains: Iterable[Chain],
    pose: Pose,
    bodies: Mapping[str, tuple[Capsule, ...]],
    unit: float,
) -> None:
    body = ElementTree.SubElement(world, "body", {"name": "platform"} | frame_of(pose, unit))
    ElementTree.SubElement(body, "freejoint", name="platform")
    small = 0.05 * bodies["platform"][0].radius * unit
    ElementTree.SubElement(body, "site", name="platform", size=repr(small))
    add_geoms(body, bodies["platform"], "platform", unit)
    for chain in chains:  # the balls of spherical joints are fixed to the platform
        if not chain.leg.platform_line:
            name = {"name": f"{chain.name}_ball"}
            ball = ElementTree.SubElement(body, "body", name | frame_of(chain.head, unit))
            add_geoms(ball, bodies[f"{chain.name}_ball"], "platform", unit)


def _close(root: Node, chains: Iterable[Chain], unit: float) -> None:
    equality = ElementTree.SubElement(root, "equality")
    for chain in chains:
        ends = {"name": chain.name, "body2": "platform"}
        if chain.leg.platform_line:
            # Without an anchor the weld is at the platform origin, wherever that is.
            anchor = joined(chain.head.position * unit)
            ends |= {"body1": f"{chain.name}_rail", "anchor": anchor}
            ElementTree.SubElement(equality, "weld", ends)
        else:
            anchor = " ".join(f"{x:.17g}" for x in chain.platform[0].offset * unit)
            ends |= {"body1": f"{chain.name}_upper", "anchor": anchor}
            ElementTree.SubElement(equality, "connect", ends)


def _actuate(
    root: Node, chains: Iterable[Chain], frequency: float, loads: Mapping[str, float], unit: float
) -> None:
    """Servos in the order of `Posture.joint_names`, whose control zero holds the pose.

    With the value q₀ at the pose the force is kp (control + q₀ - q) - kv q̇.
    The armature inertia of a drive is the moving mass: without it, a light leg on a stiff servo
    oscillates faster than MuJoCo's constraints can follow.
    """
    joints = {joint.get("name", ""): joint for joint in root.iter("joint")}
    actuators = ElementTree.SubElement(root, "actuator")
    for motion in _active(chains):
        load = loads[motion.kind]
        joints[motion.name].set("armature", repr(load))
        stiffness, damping = frequency**2 * load, 2.0 * frequency * load
        force = [stiffness * metric(motion, unit), -stiffness, -damping]
        ElementTree.SubElement(
            actuators,
            "general",
            name=motion.name,
            joint=motion.name,
            gainprm=repr(stiffness),
            biastype="affine",
            biasprm=joined(force),
        )


def _limit(
    root: Node, chains: Iterable[Chain], limits: Mapping[str, JointLimit], unit: float
) -> None:
    """Write strokes as ranges of joints and controls, and greatest forces of servos."""
    joints = {joint.get("name", ""): joint for joint in root.iter("joint")}
    servos = {servo.get("name", ""): servo for servo in root.iter("general")}
    for motion in _active(chains):
        limit, servo = limits[motion.name], servos[motion.name]
        stroke = np.array([limit.least, limit.greatest])
        if np.isfinite(stroke).any():
            stroke = np.clip(stroke, -NO_STROKE, NO_STROKE)
            if limit.least == limit.greatest:
                stroke += LOCKED * max(abs(limit.least), LOCKED) * np.array([-1.0, 1.0])
            joints[motion.name].set("range", joined(stroke))
            servo.set("ctrlrange", joined(stroke - metric(motion, unit)))
        if np.isfinite(limit.effort):
            servo.set("forcerange", joined((-limit.effort, limit.effort)))


def _add_sensors(root: Node, chains: Iterable[Chain]) -> None:
    """Add sensors of joint variables and forces of the actuators, and of the platform's pose."""
    sensors = ElementTree.SubElement(root, "sensor")
    for name in [motion.name for motion in _active(chains)]:
        ElementTree.SubElement(sensors, "jointpos", name=f"{name}_position", joint=name)
        ElementTree.SubElement(sensors, "actuatorfrc", name=f"{name}_force", actuator=name)
    site = {"objtype": "site", "objname": "platform"}
    for kind, what in (("framepos", "position"), ("framequat", "rotation")):
        ElementTree.SubElement(sensors, kind, {"name": f"platform_{what}"} | site)


def _add_key(root: Node, chains: Sequence[Chain], pose: Pose, unit: float) -> None:
    values = configuration(chains, chains, pose, unit)
    keyframe = ElementTree.SubElement(root, "keyframe")
    ElementTree.SubElement(keyframe, "key", name="pose", qpos=joined(values))


def _active(chains: Iterable[Chain]) -> list[Motion]:
    return [motion for chain in chains for motion in chain.motions if motion.active]
