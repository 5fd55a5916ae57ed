"""The inverse Jacobian of a state in several forms, and as text to copy."""

from __future__ import annotations

import numpy as np

from gsp.app.state.session import Session
from gsp.errors import InvalidInput, expected
from gsp.geometry.frames.changes import TWIST_NAMES, about_point
from gsp.geometry.vectors import Array

PLAIN, HOMOGENEOUS, LINES = "unit", "homogeneous", "lines"
FORMS = (PLAIN, HOMOGENEOUS, LINES)
FORMATS = ("numpy", "CSV", "LaTeX")


def matrix(state: Session, form: str = PLAIN) -> Array:
    """Return the inverse Jacobian of a state.

    Parameters
    ----------
    state : Session
    form : "unit", "homogeneous" or "lines"
        "unit": rows (v, ω) in the unit of the design. "homogeneous": dimensionless, by the
        characteristic length. "lines": one column per leg, the unit vector of its line and below
        it the moment about the base origin with the other sign, as figure 42 of the dissertation
        has it; for designs of SPS legs.

    Returns
    -------
    (n, 6) array, or (6, n) for "lines"

    Raises
    ------
    InvalidInput
        On another form, without a length for "homogeneous", or other legs than SPS for "lines".

    *Source: TozKucuk2016, eqs. (8), (12)–(16) and §4.3; Lee2000, figure 42.*
    """
    posture = state.design.at(state.pose)
    if form == PLAIN:
        return posture.jacobian
    if form == HOMOGENEOUS:
        if state.length is None:
            raise InvalidInput(expected("homogeneous", "a characteristic length", "none"))
        return posture.homogeneous(state.length)
    if form != LINES:
        raise InvalidInput(expected("form", " or ".join(FORMS), repr(form)))
    if not state.design.between_points:
        raise InvalidInput(expected("lines", "SPS legs", state.design.mechanism.name))
    # From the platform origin to the base origin: the point moves by −p.
    rows = about_point(posture.jacobian, -state.pose.position)
    return np.concatenate((rows[:, :3], -rows[:, 3:]), axis=1).T


def as_text(state: Session, form: str, kind: str) -> str:
    """Return the matrix as text: "numpy", "CSV" or "LaTeX"; floats read back bit by bit.

    LaTeX has six significant digits.

    Raises
    ------
    InvalidInput
        On another format; and as `matrix`.
    """
    rows = matrix(state, form)
    if kind == "numpy":
        body = ",\n    ".join(str(row.tolist()) for row in rows)
        return f"J = np.array([\n    {body},\n])\n".replace("nan", "np.nan")
    if kind == "CSV":
        heads = state.design.joint_names if form == LINES else TWIST_NAMES
        lines = [",".join(heads), *(",".join(map(repr, row.tolist())) for row in rows)]
        return "\n".join(lines) + "\n"
    if kind == "LaTeX":
        body = " \\\\\n".join(" & ".join(_latex(x) for x in row) for row in rows.tolist())
        return f"\\begin{{bmatrix}}\n{body}\n\\end{{bmatrix}}\n"
    raise InvalidInput(expected("format", " or ".join(FORMATS), repr(kind)))


def _latex(value: float) -> str:
    """Return a number with six digits, powers of ten as LaTeX sets them."""
    stem, _, power = f"{value + 0.0:.6g}".partition("e")
    return stem if not power else f"{stem} \\times 10^{{{int(power)}}}"
