"""Conditions for a comparison of designs, and what a ranking records where they differ."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from typing import Any

from gsp.checks import check_type
from gsp.errors import InvalidInput, UnknownName, brief, expected
from gsp.evaluation.maxima import facts
from gsp.evaluation.request import Request, kind_of, left_out
from gsp.evaluation.settings import Job, Settings, provenance
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.model.units import METRES_PER_UNIT, check_unit


def check_units(designs: Sequence[Design]) -> str:
    """Return the unit of length that the designs share; "" if none of them names one.

    They are evaluated at the same poses, so that one unit has to hold for all. A design that names
    no unit is taken to be in that of the others.

    Raises
    ------
    InvalidInput
        If two designs name different units.
    """
    units = [unit for unit in dict.fromkeys(design.unit for design in designs) if unit]
    if len(units) > 1:
        first = {unit: next(d for d in designs if d.unit == unit) for unit in units[:2]}
        got = " and ".join(
            f"{unit!r} ({design.name or 'unnamed'})" for unit, design in first.items()
        )
        wanted = (
            "one unit of length, as they share poses (convert them: --unit mm in a command, "
            "gsp.ranking.in_unit(design, unit) in Python)"
        )
        raise InvalidInput(expected("designs", wanted, got))
    return units[0] if units else ""


def unitless(designs: Sequence[Design]) -> list[Design]:
    """Return the designs that name no unit of length, where others do."""
    return [design for design in designs if not design.unit] if check_units(designs) else []


def distinct_names(designs: Sequence[Design]) -> list[str]:
    """Return a name for each of several designs, so that no two have the same.

    The first of a name keeps it; the next ones are "name (2)", "name (3)" …. Where there is more
    than one design, those without a name are "unnamed".

    Examples
    --------
    >>> from gsp.catalogue import design
    >>> first = design("toz-kucuk-2016-d3-6")
    >>> distinct_names([first, first.replace(name="press"), first])
    ['toz-kucuk-2016-d3-6', 'press', 'toz-kucuk-2016-d3-6 (2)']
    """
    if len(designs) == 1:
        return [designs[0].name]
    given = [design.name or "unnamed" for design in designs]
    names: list[str] = []
    # A name that a design has of its own is not given to another one.
    taken, used = set(given), set[str]()
    for name in given:
        options = (f"{name} ({i})" for i in count(2))
        new = name if name not in used else next(o for o in options if o not in taken)
        taken.add(new)
        used.add(new)
        names.append(new)
    return names


def in_unit(design: Design, unit: str) -> Design:
    """Return a design with all its lengths converted to another unit.

    Parameters
    ----------
    design : Design
        Its `unit` is one of um (µm), mm, cm, dm, m, in (inch) and ft.
    unit : str
        One of these.

    Raises
    ------
    InvalidInput
        If `design` is not a Design, or names no unit.
    UnknownName
        If a unit is none of these.

    Examples
    --------
    >>> from gsp.catalogue import design
    >>> in_unit(design("toz-kucuk-2016-d3-6"), "m").characteristic_length
    0.095
    """
    check_type("design", design, Design)
    unit = check_unit("unit", unit)
    if not design.unit:
        wanted = f"a unit of length in design {design.name!r}"
        raise InvalidInput(expected("unit", wanted, "none, so that nothing can be converted"))
    for name in (design.unit, unit):
        if name not in METRES_PER_UNIT:
            raise UnknownName("unit of length", str(name), METRES_PER_UNIT)
    if design.unit == unit:
        return design
    # A quotient of 1000 is exact, one of 0.001 is rounded once.
    return design.scaled(METRES_PER_UNIT[design.unit] / METRES_PER_UNIT[unit]).replace(unit=unit)


def units_of(name: str, designs: Sequence[Design]) -> str:
    """Return the unit of an index for all designs; several, separated by commas, if they differ."""
    kinds: dict[tuple[str, ...], Design] = {}
    for design in designs:
        kinds.setdefault(kind_of(design), design)
    return ", ".join(dict.fromkeys(INDICES[name].unit(design) for design in kinds.values()))


def check_by(by: str, names: Sequence[str], designs: Sequence[Design]) -> str:
    """Return the index of the ranking, if its values can be compared over the designs.

    Raises
    ------
    InvalidInput
        If it is not among the indices, or its unit differs from design to design.
    """
    if by not in names:
        raise InvalidInput(expected("by", "one of the indices " + ", ".join(names), brief(by)))
    units = units_of(by, designs)
    # The plain condition number has no unit that could be named: it is compared in one length.
    mixed = units == "mixed" and INDICES[by].unit_power != "no power" and len(designs) > 1
    if "," in units or mixed:
        what = f"{by} in {units}"
        raise InvalidInput(expected("by", "an index that has one unit for all designs", what))
    return by


def differences(jobs: Sequence[Job]) -> dict[str, Any]:
    """Return what a ranking records about designs that differ.

    Returns
    -------
    dict
        "sizes": least and greatest rms radius of the anchor points [unit]; "lengths": the
        characteristic length of each design, only if they differ; "unitless": the names of
        designs without a unit of length, only if others have one.
    """
    sizes = [job.design.rms_radius for job in jobs]
    found: dict[str, Any] = {"sizes": [min(sizes), max(sizes)]}
    if len({job.settings.length for job in jobs}) > 1:
        found["lengths"] = {job.design.name: job.settings.length for job in jobs}
    without = unitless([job.design for job in jobs])
    if without:
        found["unitless"] = [design.name for design in without]
    return found


def attributes(
    request: Request, by: str, given_designs: Sequence[Design], given: Settings
) -> dict[str, Any]:
    """Return what the table records: shared parameters, and where designs differ."""
    designs = [job.design for job in request.jobs]
    pairs = zip(designs, given_designs, strict=True)
    renamed = {new.name: old.name for new, old in pairs if new.name != old.name}
    if all(job.settings.maximum == "sample" for job in request.jobs):
        given = Settings(given.length, given.ellipsoid, "sample")
    shared = len({job.settings for job in request.jobs}) == 1
    return {
        **provenance(request.jobs[0].settings if shared else given),
        "by": by,
        "indices": list(request.names),
        **left_out(request),
        "poses": request.pose.size,
        "unit": check_units(designs),
        "units": {name: units_of(name, designs) for name in request.names},
        **differences(request.jobs),
        **({"renamed": renamed} if renamed else {}),
        **facts(request.jobs, request.pose),
    }
