"""Expected changes of the public quantities under the changes of `tests.metamorphic`.

A quantity is a function of a case, and for each fact the rule that gives the expected value from
the value before; without a rule it is unchanged. Rules of indices are made from their records.

A tolerance is ROUNDINGS · eps · distance · scale. The distance is that of an origin from its body,
in sizes of the design: d = p + R b − a loses as many digits. The scale is that of the terms whose
rounding the value has: 1 for reciprocals of condition numbers, whose errors are absolute; the
product of the norms of the rows for a determinant; the condition number for a direction.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

import gsp
from gsp.indices import INDICES
from tests import campaign
from tests import statics_metamorphic as statics
from tests import workspaces_metamorphic as sets
from tests.metamorphic import FACTS, MIRROR, Case, angles

# Products and sums that a value passes through, one after the other: some ten for a row, six times
# six for a factorisation. The largest seen is 60.
ROUNDINGS = 200.0
EPS = np.finfo(float).eps

CHANGES, NOT_STATED = "changes", "not stated"
Rule = Callable[[np.ndarray, Case, Case], np.ndarray | None]


def _ones(expected, *_):
    return np.ones(expected.shape)


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A quantity, what changes do to it by fact, and the size of its terms.

    A rule that returns None means that the values of this design change; NOT_STATED, that nothing
    is said: the search of forward kinematics takes another way, and may end elsewhere. `words`
    are the rules in the table of docs/conventions.md.
    """

    name: str
    of: Callable[[Case], np.ndarray]
    rules: Mapping[str, Rule | str] = field(default_factory=dict)
    scale: Callable[[np.ndarray, Case, Case], np.ndarray] = _ones
    applies: Callable[[gsp.Design], bool] = lambda _: True
    words: Mapping[str, str] = field(default_factory=dict)
    most: int | None = None  # of the designs, for slow quantities


def expected(quantity, fact, value, given, other):
    """The value that the changed case should have; None if it should be another one."""
    rule = quantity.rules.get(fact)
    if rule == CHANGES:
        return None
    return value if rule is None else rule(value, given, other)


def tolerance(quantity, wanted, given, other):
    """How far the value of the changed case may be from the wanted one."""
    return ROUNDINGS * EPS * other.distance * quantity.scale(wanted, given, other)


# --- indices --------------------------------------------------------------------------------------


def _exponent(index, design):
    """The power of the unit that values grow with, None for none."""
    if index.unit(design) == "mixed":
        return None
    return {"1": 0, "length": 1}.get(index.unit_power, 3 - angles(design))


def _rules(index):
    def unit(value, given, other):
        power = _exponent(index, given.design)
        return None if power is None else value * other.unit**power

    facts = {fact: getattr(index.invariance, fact) for fact in FACTS if fact != "unit"}
    rules = {fact: CHANGES for fact, word in facts.items() if word == CHANGES}
    return {**rules, "unit": CHANGES if index.unit_power == "no power" else unit}


def _condition(given):
    """Condition number of the rows, with the size of the design as length."""
    return gsp.indices.condition_number(given.posture, given.design.rms_radius)


def _index_scale(index):
    """The size of the terms of an index."""

    def scale(_, given, other):
        size, posture = given.design.rms_radius, given.posture
        rows = np.linalg.norm(posture.homogeneous(size), axis=-1).prod(axis=-1)
        volume = (size * other.unit) ** (3 - angles(given.design)) * rows
        one = np.ones(rows.shape)
        return {
            "manipulability": volume,
            "quality_index": volume / other.maximum,
            "minimum_singular_value": one * size / given.length,
            "complex_deviation_rotation": one * size * other.unit,
            "rigidity_rate": _condition(given),
            **dict.fromkeys(
                ("stiffness_x", "stiffness_y", "stiffness_z"),
                # At most the number of actuators; as φ it can be large up to a singular posture.
                _condition(given) * len(given.rows),
            ),
            # Its margins for rounding are 256 units of every term.
            "singularity_distance": 256.0 * _condition(given) * size * other.unit,
        }.get(index.name, one)

    return scale


def _of_index(index):
    def of(given):
        return index.merit(index.function(given.posture, **given.parameters(index.parameters)))

    return of


def _compiled(index):
    def of(given):
        table = gsp.evaluate(
            given.design,
            given.pose,
            index.name,
            backend="compiled",
            workers=1,
            **given.parameters(index.parameters),
        )
        return index.merit(table[index.name].to_numpy())

    return of


def _defined_for(index):
    return lambda design: not index.missing(design, ("length", "ellipsoid", "maximum"))


def _from_record(index, of, name):
    return Quantity(
        name=name,
        of=of(index),
        rules=_rules(index),
        scale=_index_scale(index),
        applies=_defined_for(index),
        most=campaign.count(2, 1000) if index.name == "singularity_distance" else None,
    )


# --- rows -----------------------------------------------------------------------------------------


def _reordered(value, _, other):
    return value[:, other.rows]


def _joint_unit(value, given, other):
    return np.where(given.design.angular, value, value * other.unit)


def _joint_reversal(value, _, other):
    return np.where(other.reversed, np.pi - value, value)


def _halves(rows):
    return rows[..., :3], rows[..., 3:]


def _joined(force, moment):
    return np.concatenate((force, moment), axis=-1)


def _rows_base_turn(value, _, other):
    force, moment = _halves(value)
    turn = other.base.rotation.T
    return _joined(force @ turn, moment @ turn)


def _rows_shift(value, given, other):
    """Moments about the new platform origin, which is at −position in the old axes."""
    force, moment = _halves(value)
    arm = -(given.pose.rotation @ other.platform.position)
    return _joined(force, moment - np.cross(arm[:, None, :], force))


def _rows_unit(value, given, other):
    """Rows of distances are [1, unit], rows of angles [1/unit, 1]."""
    angular = given.design.angular[:, None]
    force, moment = _halves(value)
    k = other.unit
    return _joined(np.where(angular, force / k, force), np.where(angular, moment, moment * k))


def _rows_exchange(value, given, _):
    """The base moves against the platform: in platform axes, moments about the base origin."""
    force, moment = _halves(value)
    turn, position = given.pose.rotation, given.pose.position[:, None, :]
    return -_joined(force @ turn, (moment + np.cross(position, force)) @ turn)


def _rows_mirror(value, _, other):
    """A mirror keeps rates: velocities are vectors, angular velocities pseudovectors."""
    force, moment = _halves(value)
    return _joined(force @ MIRROR, -moment @ MIRROR)


def _rows_reversal(value, _, other):
    return np.where(other.reversed[:, None], -value, value)


def _forces_reversal(value, _, other):
    return np.where(other.reversed, -value, value)


def _row_size(expected, _, other):
    """The largest entry among those of one unit: forces and moments of distances, of angles."""
    size = np.zeros(expected.shape)
    for half in (slice(3), slice(3, 6)):
        for kind in (other.design.angular, ~other.design.angular):
            entries = np.abs(expected[:, kind, half])
            size[:, kind, half] = np.nanmax(entries, initial=0.0)
    return size


def _twists(rule):
    """The matrices M of a rule of rows, r' = r M, and so of old twists M t' from new ones."""

    def matrices(given, other):
        return rule(np.broadcast_to(np.eye(6), (given.pose.size, 6, 6)), given, other)

    return matrices


def _unit_twists(given, other):
    return np.diag(np.repeat([1.0, other.unit], 3))


TWISTS = {
    "base_turn": _twists(_rows_base_turn), "platform_shift": _twists(_rows_shift),
    "exchange": _twists(_rows_exchange), "mirror": _twists(_rows_mirror), "unit": _unit_twists,
}  # fmt: skip


def _wrench_rules(power):
    """Rules of matrices of wrenches per twist, Mᵀ K M, times a power of the unit."""

    def rule(twists):
        def of(value, given, other):
            m = twists(given, other)
            return np.swapaxes(m, -1, -2) @ value @ m * other.unit**power

        return of

    return {fact: rule(twists) for fact, twists in TWISTS.items()}


def _twist_rules(power):
    """Rules of matrices of twists per wrench and of covariances, M⁻¹ C M⁻ᵀ."""

    def rule(twists):
        def of(value, given, other):
            m = np.linalg.inv(twists(given, other))
            return m @ value @ np.swapaxes(m, -1, -2) * other.unit**power

        return of

    return {fact: rule(twists) for fact, twists in TWISTS.items()}


MATRIX_WORDS = {
    "base_turn": "turned", "platform_shift": "about the new origin", "unit": "by the powers of k",
    "exchange": "in platform axes, about the base origin", "mirror": "mirrored",
}  # fmt: skip


# --- motions --------------------------------------------------------------------------------------


def _motion(given):
    return gsp.instantaneous_motion(given.posture, length=given.length)


def _separation(given):
    """How well rounding determines the worst motion: best rate over the gap to the next motion."""
    rates = _motion(given).rates
    with np.errstate(divide="ignore", invalid="ignore"):
        return rates[:, -1] / (rates[:, 1] - rates[:, 0])


def _pitch(given):
    """The pitch where the worst motion is one, at singular postures as well."""
    return np.where(_separation(given) < 1e3, _motion(given).pitch, np.nan)


def _pitch_scale(expected, given, other):
    size = given.design.rms_radius * other.unit
    return _separation(given) * size * (1.0 + np.abs(expected) / size) ** 2


def _times_unit(value, _, other):
    return value * other.unit


# --- lengths, poses, sets -------------------------------------------------------------------------


def _length(method):
    def of(given):
        found = gsp.characteristic_length(given.design, given.pose[:1], method)
        return np.array([found.length, found.condition_number or 1.0])

    return of


def _first_times_unit(value, _, other):
    return value * [other.unit, 1.0]


def _length_scale(expected, given, _):
    """A minimum is flat: its place is known to the square root of the rounding of its value."""
    return np.array([2e-6 / EPS / ROUNDINGS, _condition(given)[0]]) * expected


def _general(design):
    return design.name.startswith("general")


def _has_best_length(design):
    """Whether the minimum over lengths is one point."""
    return _general(design) and angles(design) < 3


def _bracket_scale(expected, _, other):
    """Brackets of the same number overlap: their ends differ by less than their widths."""
    low, high = expected
    width = high - low if np.isfinite(high) else low
    return np.full(2, width / EPS / ROUNDINGS / other.distance)


def _feasible(given):
    limits = gsp.Limits(base_cone=0.4, platform_cone=0.4)
    return gsp.feasible(given.design, given.pose, limits).ok.astype(float)


def _volume(given):
    rotation = given.pose.rotation[0]
    return np.array([gsp.workspace.exact_shells(given.design, rotation).volume().value])


def _volume_unit(value, _, other):
    return value * other.unit**3


def _volume_scale(expected, given, other):
    """The volume is an integral with a relative error of about 1e-10 (its own estimate)."""
    return np.full(expected.shape, 1e3 * (3.0 * given.design.rms_radius * other.unit) ** 3)


def _only_points(design):
    return {leg.name for leg in design.legs} == {"D1"}


def _with_spheres(design):
    """General, with a distance of points, whose stroke bounds the positions."""
    return _general(design) and "D1" in {leg.name for leg in design.legs}


def _in_planes(design):
    """Points only, three of which span a plane."""
    return _only_points(design) and "collinear" not in design.name


def _general_points(design):
    return _general(design) and _only_points(design)


def _forward(given):
    """The control number at the poses that forward kinematics finds, a fifth of a way from guesses.

    The way is a screw motion, so guesses and targets are the same in all descriptions.
    """
    ends = given.pose.interpolate(given.pose[::-1], 0.2)
    reach = 1e-12 * given.distance  # joints of frames that are far away are rounded as much
    found = gsp.forward(given.design, given.design.at(ends).joints, given.pose, tolerance=reach)
    known = np.where(found.converged, 1.0, np.nan)
    poses = gsp.Pose(
        np.where(found.converged[:, None], found.pose.position, ends.position),
        np.where(found.converged[:, None, None], found.pose.rotation, ends.rotation),
    )
    return known * gsp.indices.control_number(given.design.at(poses), given.length)


def _forward_scale(expected, given, _):
    """Solutions reproduce joints to 1e-12 of the size."""
    return np.full(expected.shape, 1e-12 / EPS)


def _six_rows(design):
    return _general(design) and len(design.rows) == 6


def _tracked(given):
    """The control number along a track of joint values, on a tenth of a screw motion."""
    way = given.pose[0].interpolate(given.pose[1], np.linspace(0.0, 0.1, 6))
    found = gsp.track(given.design, given.design.at(way).joints, given.pose[0])
    return gsp.indices.control_number(given.design.at(found.pose), given.length)


def _certified(given):
    """Whether bounds 10 % below and above the control number are proven or refuted at a pose."""
    pose, strokes = given.pose[0], np.full((len(given.design.joint_names), 2), np.nan)
    value = float(gsp.indices.control_number(given.design.at(pose), given.length))
    box = gsp.PoseBox(pose.position, pose.angles("rpy"))
    verdicts = []
    for share, wanted in ((0.9, 1.0), (1.1, 0.0)):
        limits = gsp.Limits(
            strokes=strokes, indices=[f"CTN >= {share * value!r}"], length=given.length
        )
        status = gsp.certify(given.design, box, limits, workers=1).status
        # Turns about a distant origin are enclosed in wide intervals: nothing is claimed then.
        silent = wanted if given.distance > 1e3 else np.nan
        verdicts.append({"proven": 1.0, "refuted": 0.0, "undecided": silent}[status])
    return np.array(verdicts)


QUANTITIES = (
    *(_from_record(index, _of_index, index.name) for index in INDICES.values()),
    *(
        _from_record(index, _compiled, f"evaluate {index.name}")
        for index in INDICES.values() if index.routine
    ),
    Quantity(
        name="Posture.joints", of=lambda c: c.posture.joints,
        rules={"unit": _joint_unit, "order": _reordered, "reversal": _joint_reversal},
        scale=lambda wanted, _, other: np.where(
            other.design.angular, 1.0, 3.0 * other.design.rms_radius
        ) + 0.0 * wanted,
        words={"unit": "distances × k", "order": "reordered", "reversal": "π − θ"},
    ),
    Quantity(
        name="Posture.jacobian", of=lambda c: c.posture.jacobian,
        rules={
            "base_turn": _rows_base_turn, "platform_shift": _rows_shift, "unit": _rows_unit,
            "order": _reordered, "exchange": _rows_exchange, "mirror": _rows_mirror,
            "reversal": _rows_reversal,
        },
        scale=_row_size,
        words={
            "base_turn": "turned", "platform_shift": "moments about the new origin",
            "unit": "moments × k; rows of angles / k", "order": "reordered",
            "exchange": "negative, in platform axes, about the base origin",
            "mirror": "mirrored; moments with the other sign", "reversal": "sign (angles)",
        },
    ),
    Quantity(
        name="instantaneous_motion: pitch", of=_pitch,
        rules={"unit": _times_unit, "mirror": lambda value, _, __: -value},
        scale=_pitch_scale,
        words={"unit": "× k", "mirror": "other sign"},
    ),
    Quantity(
        name='characteristic_length "condition"', of=_length("condition"),
        rules={"unit": _first_times_unit, "platform_shift": CHANGES, "exchange": CHANGES},
        scale=_length_scale, applies=_has_best_length,
        words={"unit": "× k"},
    ),
    Quantity(
        name='characteristic_length "anchors"', of=_length("anchors"),
        rules={
            "unit": _first_times_unit, "platform_shift": CHANGES, "exchange": CHANGES,
            "slide": CHANGES,
        },
        scale=lambda wanted, *_: wanted, words={"unit": "× k"},
    ),
    Quantity(name="feasible", of=_feasible, scale=lambda wanted, *_: 0.0 * wanted),
    Quantity(
        name="forward", of=_forward, scale=_forward_scale, applies=_general,
        most=campaign.count(2, 1000),
        rules={"exchange": NOT_STATED, "slide": NOT_STATED},
    ),
    Quantity(
        name="track", of=_tracked, scale=_forward_scale, applies=_six_rows,
        rules={"exchange": NOT_STATED, "slide": NOT_STATED},
    ),
    Quantity(
        name="Posture.actuator_forces", of=statics.actuator_forces, scale=statics.force_scale,
        rules={
            "unit": lambda value, given, other: np.where(
                given.design.angular, value * other.unit, value
            ),
            "order": _reordered, "reversal": _forces_reversal,
            "slide": statics.forces_if_anchors_slide,
        },
        words={
            "unit": "torques × k", "order": "reordered", "reversal": "sign (angles)",
            "slide": "changes (redundant, with angles)",
        },
    ),
    Quantity(
        name="stiffness", of=statics.stiffness, rules=_wrench_rules(-1),
        scale=statics.block_scale, words=MATRIX_WORDS,
    ),
    Quantity(
        name="statics.compliance", of=statics.compliance, rules=_twist_rules(1),
        scale=statics.block_scale, words=MATRIX_WORDS,
    ),
    Quantity(
        name="statics.directional_stiffness", of=statics.directional, scale=statics.force_size,
        rules={
            "base_turn": CHANGES, "exchange": CHANGES, "mirror": CHANGES,
            "platform_shift": CHANGES,
            "unit": lambda value, given, other: value / other.unit,
        },
        words={"unit": "/ k"},
    ),
    Quantity(
        name="statics.pose_errors: covariance", of=statics.covariance, rules=_twist_rules(2),
        scale=statics.block_scale, words=MATRIX_WORDS,
    ),
    Quantity(
        name="statics.eigenscrews: values", of=statics.eigenvalues,
        rules={"mirror": lambda value, _, __: -value[..., ::-1]},
        scale=statics.eigenvalue_scale, words={"mirror": "other sign"},
    ),
    Quantity(
        name="bounds over a small box", of=statics.bounded, applies=_general,
        scale=lambda wanted, *_: 0.0 * wanted, most=campaign.count(2, 12),
    ),
    Quantity(
        name="singularity_distance: bracket", of=statics.distance_bracket, applies=_general,
        rules={"unit": _times_unit, "platform_shift": CHANGES, "exchange": CHANGES},
        scale=_bracket_scale, words={"unit": "× k"}, most=campaign.count(1, 12),
    ),
    Quantity(
        name="certify: bounds of the control number", of=_certified, applies=_general,
        scale=lambda wanted, *_: 0.0 * wanted,
    ),
    Quantity(
        name="workspace.exact_shells: volume", of=_volume, rules={"unit": _volume_unit},
        scale=_volume_scale,
        applies=_only_points, words={"unit": "× k³"}, most=campaign.count(1, 12),
    ),
    Quantity(
        name="workspace.Shells: area of a section", of=sets.section_area,
        rules={"unit": sets.times_unit_squared, "exchange": NOT_STATED}, scale=sets.size_of_area,
        applies=_in_planes, words={"unit": "× k²"}, most=campaign.count(2, 12),
    ),
    Quantity(
        name="workspace.section: ends of rays", of=sets.section_ends,
        rules={"unit": sets.times_unit, "exchange": NOT_STATED}, scale=sets.size_of_ends,
        applies=_general_points, words={"unit": "× k"}, most=campaign.count(1, 3),
    ),
    Quantity(
        name="workspace.surface: ends of rays", of=sets.surface_ends,
        rules={
            "unit": sets.times_unit, "exchange": NOT_STATED, "base_turn": NOT_STATED,
            "mirror": NOT_STATED,
        },
        scale=sets.size_of_ends, applies=_general_points, words={"unit": "× k"},
        most=campaign.count(1, 3),
    ),
    Quantity(
        name="workspace.fixed_orientation: contains", of=sets.fixed_contains,
        applies=_with_spheres,
        rules={"exchange": NOT_STATED, "slide": NOT_STATED}, scale=sets.size_of_codes,
        most=campaign.count(2, 12),
    ),
    Quantity(
        name="workspace.fixed_orientation: area holds the exact one", of=sets.fixed_area,
        rules={"exchange": NOT_STATED}, scale=lambda wanted, *_: 0.0 * wanted,
        applies=_general_points, most=campaign.count(1, 12),
    ),
    Quantity(
        name="workspace.reachable: contains", of=sets.reachable_contains,
        rules={"platform_shift": CHANGES, "exchange": NOT_STATED},
        scale=sets.size_of_codes, applies=_in_planes, most=campaign.count(1, 12),
    ),
    Quantity(
        name="workspace.reachable: area", of=sets.reachable_area,
        rules={
            "unit": sets.times_unit_squared, "platform_shift": CHANGES, "exchange": NOT_STATED,
        },
        scale=_bracket_scale, applies=_in_planes, words={"unit": "× k²"},
        most=campaign.count(1, 12),
    ),
    Quantity(name="rank: control number", of=sets.ranked, most=campaign.count(3, 1000)),
    Quantity(name="sweep: control number", of=sets.swept),
)  # fmt: skip


# --- the table of docs/conventions.md -------------------------------------------------------------

HEADS = {
    "base_turn": "base axes turned", "base_shift": "base origin shifted",
    "platform_turn": "platform axes turned", "platform_shift": "platform origin shifted",
    "unit": "unit of length × k", "order": "legs reordered", "exchange": "exchange",
    "mirror": "mirror image", "slide": "anchors slid along lines", "reversal": "lines reversed",
}  # fmt: skip


def _word(quantity, fact):
    index = INDICES.get(quantity.name)
    if index is not None and fact == "unit":
        power = index.unit_power
        return {"1": "", "length": "× k", "no power": CHANGES}.get(
            power, power.replace("length", "× k")
        )
    rule = quantity.rules.get(fact)
    return rule if isinstance(rule, str) else quantity.words.get(fact, "")


def table():
    """The table of all quantities; an empty cell means that nothing changes."""
    rows = [("", *HEADS.values()), ("---",) * (len(HEADS) + 1)]
    for quantity in QUANTITIES:
        if not quantity.name.startswith("evaluate "):
            index = INDICES.get(quantity.name)
            symbol = quantity.name if index is None else index.symbol.replace("|", "\\|")
            rows.append((symbol, *(_word(quantity, fact) for fact in HEADS)))
    return "\n".join("| " + " | ".join(row) + " |" for row in rows).replace("|  ", "| ")
