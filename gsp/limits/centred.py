"""A design and its limits in units of the size of the design, about the centres of its anchors.

A search that works on this form takes the same steps in every unit and for all origins of frames.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.pose.centring import centred_pose, original_pose
from gsp.geometry.vectors import Array
from gsp.indices import Index
from gsp.limits.limits import Limits
from gsp.model.design import Design
from gsp.model.drives import Crank, Drive


@dataclass(frozen=True, eq=False, kw_only=True)
class CentredLimits:
    """A design and limits in units of the size of the design, about its centres.

    Attributes
    ----------
    design : Design
        Of size 1, with the frames at the centres of the anchors, unless the limits depend on their
        origins.
    limits : Limits
        The limits in these frames and this unit.
    size : float [unit of the given design]
    base, platform : (3,) arrays [unit of the given design]
        Origins of the frames, in the axes of the given ones.
    """

    design: Design
    limits: Limits
    size: float
    base: Array
    platform: Array

    def pose_from(self, pose: Pose) -> Pose:
        """Return poses of the centred frames."""
        return centred_pose(pose, self.size, self.base, self.platform)

    def pose_to(self, pose: Pose) -> Pose:
        """Return poses of the given frames: the inverse of `pose_from`."""
        return original_pose(pose, self.size, self.base, self.platform)

    def rounded(self) -> CentredLimits:
        """Return the design and limits with lengths of nine digits.

        They are the same, bit by bit, in (almost) every unit and for all origins: the rounding
        errors of the change of unit are far below the last digit that is kept.
        """
        d, e = self.design, self.design.ellipsoid
        design = d.replace(
            legs=[leg if leg.drive is None else _rounded_drive(leg.drive) for leg in d.legs],
            base_points=rounded(d.base_points),
            platform_points=rounded(d.platform_points),
            strokes=None if d.strokes is None else rounded(d.strokes),
            home=None if d.home is None else Pose(rounded(d.home.position), d.home.rotation),
            characteristic_length=_rounded_number(d.characteristic_length),
            ellipsoid=None if e is None else _rounded_ellipsoid(e),
        )
        return replace(self, design=design, limits=_rounded_limits(self.limits))


# The last bit that `rounded` keeps, as a share of the largest number: nine digits.
LAST_BIT = -30


def rounded(array: Array) -> Array:
    """Return numbers rounded to a share of 1e-9 of the largest one that is finite."""
    sizes = np.abs(array[np.isfinite(array)])
    if not sizes.any():
        return array
    # The fraction keeps the exponent of common sizes, such as 1, from changing with a rounding.
    bit = 2.0 ** (np.floor(np.log2(sizes.max()) + 0.271) + LAST_BIT)
    return np.asarray(np.round(array / bit) * bit)


def _rounded_number(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.9g}")


def _rounded_drive(drive: Drive) -> Drive:
    changes: dict[str, Any] = {"rod": _rounded_number(drive.rod)}
    if isinstance(drive, Crank):
        changes["arm"] = rounded(np.array(drive.arm))
    return replace(drive, **changes)


def _rounded_ellipsoid(e: Ellipsoid) -> Ellipsoid:
    return Ellipsoid(rounded(e.semi_axes), rounded(e.center), e.rotation)


def _rounded_limits(limits: Limits) -> Limits:
    changes: dict[str, Any] = {
        name: _rounded_number(getattr(limits, name)) for name in ("leg_radius", "length", "maximum")
    }
    for name in ("strokes", "position"):
        if getattr(limits, name) is not None:
            changes[name] = rounded(getattr(limits, name))
    if limits.ellipsoid is not None:
        changes["ellipsoid"] = _rounded_ellipsoid(limits.ellipsoid)
    changes["indices"] = [
        f"{index.name} >= {low:.9g}" if np.isfinite(low) else f"{index.name} <= {high:.9g}"
        for index, low, high in limits.thresholds
    ]
    return replace(limits, **changes)


def centred_limits(design: Design, limits: Limits) -> CentredLimits:
    """Return a design and its limits in units of its size, about its centres.

    What a limit depends on stays: the unit where an index of a threshold changes with it by no
    power ("mixed"), and the origins where an index changes with them.

    Parameters
    ----------
    design : Design
    limits : Limits
        Whose arrays fit the design.

    Returns
    -------
    CentredLimits
    """
    mixed = any(index.unit(design) == "mixed" for index, _, _ in limits.thresholds)
    size = 1.0 if mixed else design.rms_radius
    effects = [index.invariance for index, _, _ in limits.thresholds]
    kept = any(effect.base_shift == "changes" for effect in effects)
    base = design.base_points.mean(axis=0) * (not kept)
    # Limits of the position are those of the platform origin, which has to stay.
    kept = any(effect.platform_shift == "changes" for effect in effects)
    platform = design.platform_points.mean(axis=0) * (limits.position is None and not kept)
    home = design.home
    if home is not None:
        home = Pose(home.position - base, home.rotation)
    moved = design.replace(base_points=design.base_points - base, home=home)
    return CentredLimits(
        design=moved.with_origin(platform).scaled(1.0 / size),
        limits=_scaled(limits, design, 1.0 / size, base, platform),
        size=size,
        base=base,
        platform=platform,
    )


def _scaled(limits: Limits, design: Design, k: float, base: Array, platform: Array) -> Limits:
    changes: dict[str, Any] = {
        name: getattr(limits, name) * k
        for name in ("leg_radius", "length")
        if getattr(limits, name) is not None
    }
    if limits.strokes is not None:
        changes["strokes"] = limits.strokes * np.where(design.angular, 1.0, k)[:, None]
    if limits.position is not None:
        changes["position"] = (np.asarray(limits.position) - base[:, None]) * k
    if limits.ellipsoid is not None:
        e = limits.ellipsoid
        changes["ellipsoid"] = Ellipsoid(e.semi_axes, e.center - platform, e.rotation).scaled(k)
    if limits.maximum is not None:
        changes["maximum"] = limits.maximum * k**design.determinant_power
    if limits.thresholds:
        changes["indices"] = [_threshold(*one, design, k) for one in limits.thresholds]
    return replace(limits, **changes)


def _threshold(index: Index, low: float, high: float, design: Design, k: float) -> str:
    """Return the text of a threshold, with its value in the new unit."""
    powers = {"1": 0, "length": 1, "no power": 0}
    power = powers.get(index.unit_power, design.determinant_power)
    sign, value = (">=", low) if np.isfinite(low) else ("<=", high)
    return f"{index.name} {sign} {float(value) * k**power!r}"
