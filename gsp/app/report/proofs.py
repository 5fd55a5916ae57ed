"""Sections of a report about many poses: workspace, certificates, forces, comparison."""

from __future__ import annotations

from html import escape

import numpy as np

from gsp.app.page.tables import number, table
from gsp.app.report import pictures
from gsp.app.report.parts import cells, listed, wide
from gsp.app.report.study import PLANES, REPORT_BOXES, Study, attempted
from gsp.app.report.summary import bracket, measured, place_text
from gsp.app.report.tasks import at_each
from gsp.geometry.pose import Pose, PoseBox
from gsp.indices import INDICES
from gsp.model.units import power_base
from gsp.proof.certificate import Certificate
from gsp.rounding import digits_within, rounded_down, rounded_up


def workspace(study: Study) -> str:
    """Return sections and volume of the positions at which the rotation of the pose is feasible."""
    if study.limits is None or (study.strokes is None and study.limits.position is None):
        return (
            "<p class=note>Nothing bounds the workspace: the design has no strokes, and no task "
            "with strokes or bounds of the position was given.</p>"
        )
    base, parts = power_base(study.state.design.unit), []
    squared, cubed = (base and f"{base}{power}" for power in "²³")
    for name, _ in PLANES:
        low, high = study.sections[name].area
        area = escape(f"area {bracket(low, high)} {squared}".rstrip())
        shown, why = attempted(lambda n=name: pictures.of_section(study, n))
        if not high:
            why = "No position in this plane is within the limits."
        parts.append(f"<figure>{shown or escape(why)}<figcaption>{area}</figcaption></figure>")
    low, high = study.space.volume
    facts = [("volume", f"{bracket(low, high)} {cubed}".rstrip())]
    part, _ = attempted(lambda: study.space.part_of(study.state.pose.position))
    if part is not None and len(study.space.parts) > 1:
        facts.append(("part around the pose", f"{bracket(*part.volume)} {cubed}".rstrip()))
    return (
        listed(facts)
        + f'<div class="trio">{"".join(parts)}</div>'
        + "<p class=note>At the rotation of the pose. The ends of each bracket are proven: the "
        "exact value is between them. Hatched: not decided.</p>"
    )


def certificates(study: Study) -> str:
    """Return what is proven over boxes of poses."""
    claims = "no motion of the platform is uncontrolled"
    claims += "" if study.limits is None else ", and all limits are satisfied"
    text = f"<p>Regular: at every pose of a set, {claims}.</p>" + _around(study)
    if study.task is not None:
        text += "<h3>The poses of the task</h3>"
        text += at_each(study) if isinstance(study.task.poses, Pose) else _of_task(study)
    return text


def _of_task(study: Study) -> str:
    found, why = attempted(lambda: study.certificate)
    return f"<p class=note>{escape(why)}</p>" if found is None else _status(found)


def _around(study: Study) -> str:
    """Return the largest box around the pose that is proven, and what ends it."""
    found = study.around
    if found.box is None:
        return "<p>Of no box around the pose this is proven.</p>" + _end(study)
    rows = cells(_intervals(found.box, study.state.design.unit, study.state.size))
    n = found.certificate.n_boxes if found.certificate is not None else 0
    cover = "1 small box covers" if n == 1 else f"{n} small boxes cover"
    return (
        f"<p>This is proven for the box below, which {cover}:</p>"
        + wide(table(("coordinate", "from", "to"), rows))
        + _end(study)
    )


def _end(study: Study) -> str:
    """Return why no larger box is proven."""
    refuted = study.around.refuted
    if refuted is None:
        return ""
    share = rounded_up(study.around.above / (study.around.factor or study.around.above), 3)
    if refuted.status == "refuted" and study.around.box is None:
        what = f"It is refuted at a pose in every box that was tried: {refuted.reason}."
    elif refuted.status == "refuted":
        what = f"A box {number(share)} times as wide is refuted: {refuted.reason}."
    else:
        what = (
            f"Of a box {number(share)} times as wide it is not decided within {REPORT_BOXES} "
            "boxes; a larger budget may prove it."
        )
    return f"<p class=note>{escape(what)}</p>"


def _intervals(box: PoseBox, unit: str, size: float) -> list[tuple[str, str, str]]:
    """Return name, least and greatest value of each coordinate of a box.

    Positions have six digits of a size, or of the width of the box where that is less.
    """
    angles = ["roll", "pitch", "yaw"]
    if box.order != "rpy":
        angles = [f"angle {k} ({box.order})" for k in (1, 2, 3)]
    turned = np.rad2deg([box.low[3:], box.high[3:]]).T.tolist()
    rows = []
    for name, a, b in zip("xyz", box.low[:3].tolist(), box.high[:3].tolist(), strict=True):
        digits = digits_within(max(abs(a), abs(b)), min(size, b - a) or size)
        ends = rounded_up(a, digits), rounded_down(b, digits)
        rows.append((name, *(measured(end, unit, digits) for end in ends)))
    rows += [
        (n, f"{number(rounded_up(a, 5))}°", f"{number(rounded_down(b, 5))}°")
        for n, (a, b) in zip(angles, turned, strict=True)
    ]
    return [(escape(name), escape(low), escape(high)) for name, low, high in rows]


def _status(found: object) -> str:
    """Return the result of the proof for a task."""
    status = str(getattr(found, "status", ""))
    text = f"<p><strong>{status}</strong>"
    reason = getattr(found, "reason", "")
    if reason:
        text += f": {escape(reason)}"
    if isinstance(found, Certificate) and found.n_boxes:
        text += f", {found.n_boxes} box{'' if found.n_boxes == 1 else 'es'}"
        if status == "undecided":
            text += f", {rounded_down(100.0 * found.proven_share, 3):.3g} % of the volume proven"
    return text + ".</p>"


def singularity(study: Study) -> str:
    """Return the bracket of the distance to the nearest singular pose."""
    found, unit = study.distance, study.state.design.unit
    if found.upper == 0.0:
        return "<p>The pose itself is singular or undefined.</p>"
    facts = [
        (
            "proven: no singular pose is nearer than",
            measured(rounded_down(float(found.lower), 4), unit, 4),
        ),
    ]
    if np.isfinite(found.upper):
        upper = measured(rounded_up(float(found.upper), 4), unit, 4)
        facts.append(("a singular pose was found at", upper))
        facts.append(("that pose", place_text(found.nearest, unit, study.state.size)))
        v, w = np.split(found.free_motion, 2)
        if np.isfinite(v).all():
            facts.append(("uncontrolled motion there", _motion(v, w)))
    else:
        facts.append(("a singular pose", "none was found"))
    return (
        listed(facts)
        + "<p class=note>The distance of two poses is sqrt(|p − p′|² + (L θ)²), with the angle θ "
        f"between them and L = {escape(measured(study.length, unit, 4))}.</p>"
    )


def _motion(v: np.ndarray, w: np.ndarray) -> str:
    """Return a twist as text: a translation, or a turn with the velocity of the origin."""
    if np.linalg.norm(w) == 0.0:
        return f"translation along ({_three(v)})"
    scale = np.linalg.norm(w)
    return f"turn about ({_three(w / scale)}), with the velocity ({_three(v / scale)}) per radian"


def _three(vector: np.ndarray) -> str:
    return ", ".join(number(float(round(x, 12)), 3) for x in vector)


def statics(study: Study) -> str:
    """Return the actuator forces for unit loads."""
    design, forces = study.state.design, study.forces
    if not np.isfinite(forces).all():
        return "<p>The pose is singular or undefined: no forces balance a load.</p>"
    rows = [
        (escape(name), *(number(float(x), 4) for x in forces[:, i]))
        for i, name in enumerate(design.joint_names)
    ]
    heads = ("actuator", "load along −x", "load along −y", "load along −z")
    greatest = study.reading.index("greatest_force")
    unit = escape(design.unit or "unit of length")
    torque = f" In torques, per {unit}." if design.angular.any() else ""
    text = wide(table(heads, cells(rows)))
    text += (
        "<p class=note>Forces that balance a load of 1 at the platform origin; of 500 N they are "
        f"500 times these, in N. Positive: the actuator pushes its joint value up.{torque} The "
        "weight of the parts is left out.</p>"
    )
    if not greatest.reason:
        text += (
            "<p>The greatest force for the worst direction of a unit load (moments over the "
            f"length): {number(greatest.value, 4)}.</p>"
        )
    return text


def comparison(study: Study) -> str:
    """Return the place of the design among the mechanisms on its anchor lines, by each index."""
    found = {name: place for name, place in study.places.items() if place is not None}
    if study.reading.undefined or study.reading.singular:
        what = "undefined" if study.reading.undefined else "singular"
        return f"<p>Nothing is compared, as the design is {what} at this pose.</p>"
    if not found:
        return "<p>No mechanism of the catalogue can be placed on these anchor lines.</p>"
    rows = [
        (
            escape(INDICES[name].symbol),
            f"{place.better + 1} of {place.total}",
            f'<span class="verdict {place.verdict}">{place.verdict}</span>',
            escape(place.best),
        )
        for name, place in found.items()
    ]
    return wide(table(("index", "place", "", "best mechanism"), cells(rows))) + (
        "<p class=note>The mechanisms of the catalogue on the anchor lines of the design, each at "
        "the same pose, with the same length and ellipsoid. Those that are singular there do not "
        "count.</p>"
    )
