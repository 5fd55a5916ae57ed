"""The sentences at the top of a report, for readers who read nothing else."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.app.page.tables import number
from gsp.app.report.study import Study, attempted
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import pose_text
from gsp.rounding import rounded_down, rounded_up


def summary(study: Study) -> list[str]:
    """Return the sentences, the verdict first; what was not computed is left out."""
    parts = (met, usable, proven, forces, compared)
    return [text for part in parts if (text := attempted(lambda p=part: p(study))[0])]


def met(study: Study) -> str:
    """Return which poses of the task the design cannot do; of single poses also that it can all."""
    if study.task is None:
        return ""
    single, n, within = isinstance(study.task.poses, Pose), study.poses.size, study.within
    what = "poses of the task" if single else "sampled poses of the task"
    texts = []
    if within is not None and not within:
        out, left = np.flatnonzero(~within.ok), int(within.ok.sum())
        some = f"Only {left} of the {n} {what} {'is' if left == 1 else 'are'} within the limits"
        none = f"None of the {n} {what} is within the limits"
        head = some if left else none if n > 1 else "The pose of the task is not within the limits"
        first, *more = study.violation(int(out[0])).split("; ")
        more_text = f", and {len(more)} more" if more else ""
        texts.append(f"{head}. At {_at(study, out[0])}: {first}{more_text}.")
    bad = np.flatnonzero(study.unusable != "")
    if bad.size:
        some = f"{bad.size} of the {n} {what}" if n > 1 else "the pose of the task"
        where, why = _at(study, bad[0]), study.unusable[bad[0]]
        texts.append(f"The design cannot be used at {some}. At {where}: {why}.")
    if single and not texts:
        each = f"all {n} poses of the task" if n > 1 else "the pose of the task"
        limits = "" if within is None else ", and all limits are satisfied"
        texts.append(f"At {each} the actuators control all motions of the platform{limits}.")
    return " ".join(texts)


def _at(study: Study, i: Any) -> str:
    return place_text(study.poses[int(i)], study.state.design.unit, study.state.size)


def usable(study: Study) -> str:
    """Return whether the pose can be used at all."""
    reading = study.reading
    if reading.undefined:
        return f"The design cannot be used at this pose: {'; '.join(reading.undefined)}."
    if reading.singular:
        return (
            "The design cannot be used at this pose: it is singular, so the platform has a motion "
            "that no actuator controls."
        )
    passed = [joint.name for joint in reading.joints if joint.left < 0.0]
    if passed:
        return f"The design cannot reach this pose: {', '.join(passed)} would pass the stroke."
    sure = "At this pose the actuators control all motions of the platform"
    near = attempted(lambda: study.distance)[0]
    if near is None or not near.lower > 0.0:
        return f"{sure}."
    least = measured(rounded_down(float(near.lower), 3), study.unit)
    return (
        f"{sure}, and no singular pose is nearer than {least} "
        f"(turns count as the displacement of a point {measured(study.length, study.unit)} away)."
    )


def proven(study: Study) -> str:
    """Return around which box of poses the design is proven."""
    within = "" if study.limits is None else " and within the limits"
    if study.task is not None:
        certificate, _ = attempted(lambda: study.certificate)
        if certificate is not None:
            words = {
                "proven": f"It is proven that all poses of the task are regular{within}.",
                "refuted": f"The task cannot be done: {certificate.reason}.",
                "undecided": "Whether all poses of the task are regular is not decided.",
            }
            return words[certificate.status]
    box = study.around.box
    if box is None:
        return f"No box of poses around it is proven to be regular{within}."
    half = 0.5 * (box.high - box.low)
    side = measured(rounded_down(float(half[0]), 3), study.unit)
    angle = number(rounded_down(float(np.rad2deg(half[3])), 3))
    return (
        f"It is proven that every pose within ±{side} along each axis and ±{angle}° of roll, "
        f"pitch and yaw is regular{within}."
    )


def forces(study: Study) -> str:
    """Return the greatest actuator force under a unit weight."""
    if study.reading.singular or study.state.design.angular.any():
        return ""
    greatest = float(np.abs(study.forces[2]).max())
    if not np.isfinite(greatest):
        return ""
    most = number(rounded_up(100.0 * greatest, 3))
    return f"A load of 100 N downward takes at most {most} N per actuator."


def compared(study: Study) -> str:
    """Return the place by the control number among the mechanisms on the same anchor lines."""
    place = study.places["control_number"]
    if place is None:
        return ""
    return (
        f"By the control number it is {ordinal(place.better + 1)} of {place.total} mechanisms: "
        "itself and those of the catalogue that are not singular on its anchor lines at this pose."
    )


def place_text(pose: Pose, unit: str, size: float) -> str:
    """Return a pose in words, with true minus signs, and six digits of a size."""
    return pose_text(pose, unit, size).replace("-", "−")


def bracket(low: float, high: float) -> str:
    """Return two proven ends."""
    return f"between {number(rounded_down(low, 4))} and {number(rounded_up(high, 4))}"


def measured(value: float, unit: str, digits: int = 3) -> str:
    """Return a number with its unit, if that is known."""
    return f"{number(value, digits)} {unit}".rstrip()


def ordinal(n: int) -> str:
    """Return 1 as "1st", 12 as "12th".

    >>> [ordinal(n) for n in (1, 2, 3, 4, 11, 12, 13, 21, 111, 122)]
    ['1st', '2nd', '3rd', '4th', '11th', '12th', '13th', '21st', '111th', '122nd']
    """
    teens = 10 < n % 100 < 14
    return f"{n}{'th' if teens else {1: 'st', 2: 'nd', 3: 'rd'}.get(n % 10, 'th')}"
