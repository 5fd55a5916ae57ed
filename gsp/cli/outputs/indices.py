"""The indices and the determinant of one posture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gsp.cli.inputs.defaults import own_ellipsoid
from gsp.cli.outputs.console import Table, number, plain_table, say, show_table
from gsp.determinant.maxima import known_maximum
from gsp.errors import GspError
from gsp.evaluation.request import NOT_OF_DRIVES, choose_indices
from gsp.evaluation.settings import Job, Settings, settings_of
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.matrices import determinant_sign
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.model.posture import Posture

# Legs up to which all indices take a moment; of more legs the routine ones are shown.
LEGS_FOR_ALL = 24


def indices_table(
    posture: Posture, names: tuple[str, ...] | None, length: float | None
) -> tuple[Table, list[str]]:
    """Return the table of indices at one pose, and what those need that are left out, in words.

    Without names these are all that need nothing more; λ, if its maximum is known without a search.
    It takes the functions themselves, as tables and compiled code take longer to load.
    """
    design = posture.design
    settings = settings_of(design, length, own_ellipsoid(design), None)
    if names is None:
        if design.n_legs <= LEGS_FOR_ALL:
            settings = _with_known_maximum(design, settings)
        chosen = _ready(design, settings)
    else:
        chosen, _ = choose_indices(names, [Job(design, settings)])
    table = plain_table("index", "symbol", "value", "unit", "better", right=("value",))
    for name in chosen:
        index = INDICES[name]
        value = float(index.function(posture, **settings.for_index(index)))
        cells = (number(value, 6), index.unit(design), index.better)
        table.add_row(index.name, index.symbol, *cells)
    left = [name for name in INDICES if names is None and name not in chosen]
    return table, _left_out(design, settings, left)


def print_indices(posture: Posture, table: Table, left: list[str]) -> None:
    """Print the determinant, the table, the ellipsoid if it is used, and what is left out."""
    _print_determinant(posture)
    show_table(table)
    ellipsoid = own_ellipsoid(posture.design)
    used = any("ellipsoid" in INDICES[name].parameters for name, *_ in table.rows)
    if ellipsoid is not None and used:
        say(ellipsoid_text(ellipsoid, posture.design), "dim")
    for text in left:
        say(text, "dim")


def ellipsoid_text(ellipsoid: Ellipsoid, design: Design) -> str:
    """Return the line that states the ellipsoid of indices."""
    axes = " × ".join(f"{axis:.4g}" for axis in ellipsoid.semi_axes)
    return f"ellipsoid {axes} {design.unit}".rstrip()


def _ready(design: Design, settings: Settings) -> tuple[str, ...]:
    return tuple(
        name
        for name, index in INDICES.items()
        if not index.slow
        and (index.routine or design.n_legs <= LEGS_FOR_ALL)
        and not index.missing(design, settings.given())
    )


def _with_known_maximum(design: Design, settings: Settings) -> Settings:
    """Return the settings with the maximum of |det J| if it is known, and not zero."""
    try:
        found = known_maximum(design)
    except GspError:  # no domain without a home pose, or no bound
        return settings
    return settings if found is None else replace(settings, maximum=found.value or None)


def _left_out(design: Design, settings: Settings, names: list[str]) -> list[str]:
    with_length, by_name = [], []
    for name in names:
        index = INDICES[name]
        if design.driven and name in NOT_OF_DRIVES:
            continue
        needs = index.missing(design, (*settings.given(), "maximum"))
        if "length" in needs:
            with_length.append(index.symbol)
        elif not needs and index.actuators in (None, len(design.joint_names)):
            by_name.append(index.symbol)
    # All indices need what one of them needs.
    how = f"--indices {','.join(by_name)}" if with_length else "--indices all"
    groups = {"--length": with_length, how: by_name}
    return [f"{', '.join(symbols)}: with {how}" for how, symbols in groups.items() if symbols]


def _print_determinant(posture: Posture) -> None:
    """Print det J with its sign, of redundant designs |det J|, and whether the pose is singular."""
    index = INDICES["manipulability"]
    value, name = float(index.function(posture)), index.symbol
    if posture.jacobian.shape == (6, 6) and np.isfinite(value):
        value, name = value * float(determinant_sign(posture.about_centre)), "det J"
    text = f"{number(value, 7)} {index.unit(posture.design)}".removesuffix(" 1").rstrip()
    say(f"{name}  {text}{', singular' if posture.singular().any() else ''}")
