"""Texts of poses and boxes, and warnings about postures."""

from __future__ import annotations

import numpy as np

from gsp.cli.outputs.console import warn
from gsp.geometry.pose import PoseBox
from gsp.geometry.pose.texts import rounded
from gsp.limits import feasible
from gsp.model.posture import Posture

# What marks a joint beyond its stroke.
BEYOND = "(beyond)"
# Digits that distinguish all numbers of double precision.
DOUBLE_DIGITS = 17


def box_text(box: PoseBox, unit: str) -> str:
    """Return a box as one line, angles in degrees."""
    low, high = np.concatenate(
        (
            rounded(np.array([box.low[:3], box.high[:3]])),
            np.round(np.rad2deg([box.low[3:], box.high[3:]]), 9) + 0.0,
        ),
        axis=1,
    )
    names = ("x", "y", "z", "α", "β", "γ")
    parts = [
        f"{n} {a:.4g}…{b:.4g}" if b > a else f"{n} {a:.4g}"
        for n, a, b in zip(names, low, high, strict=True)
    ]
    return f"{', '.join(parts[:3])} {unit}; ".replace(" ;", ";") + f"{', '.join(parts[3:])}°"


def in_degrees(angle: float) -> str:
    """Return the shortest number of degrees that is read as an angle [rad] to the last bit.

    Some angles have no such number; theirs is the nearest one.

    >>> import numpy as np
    >>> in_degrees(np.deg2rad(1.5)), float(np.rad2deg(np.deg2rad(1.5)))
    ('1.5', 1.5000000000000002)
    """
    degrees = float(np.rad2deg(angle))
    texts = (f"{degrees:.{digits}g}" for digits in range(1, DOUBLE_DIGITS + 1))
    exact = (text for text in texts if np.deg2rad(float(text)) == angle)
    return repr(float(next(exact, repr(degrees))))


def warn_of(posture: Posture, where: str = "") -> None:
    """Print the joints of a posture that are undefined, singular or beyond strokes, and where."""
    for element in posture.undefined:
        warn(f"{where}{element.joint} is undefined: {element.reason}")
    for drive in posture.singular_drives:
        warn(f"{where}the drive {drive.joint} is singular: {drive.reason}")
    beyond = [
        name
        for name, mark in zip(posture.joint_names, strokes(posture), strict=True)
        if mark.endswith(BEYOND)
    ]
    if beyond:
        warn(f"{where}beyond the stroke: {', '.join(beyond)}")


def strokes(posture: Posture) -> list[str]:
    """Return the stroke of each joint as text, marked where the joint is beyond it; "" for none."""
    if posture.design.strokes is None:
        return [""] * len(posture.joint_names)
    bounds = posture.design.strokes
    checked = feasible(posture.design, posture.pose) if np.isfinite(bounds).any() else None
    texts = []
    for i, (low, high) in enumerate(bounds):
        known = [f"{end:.6g}" if np.isfinite(end) else "" for end in (low, high)]
        mark = f" {BEYOND}" if checked is not None and checked.violated[i].any() else ""
        texts.append("" if known == ["", ""] else " … ".join(known) + mark)
    return texts
