"""The side of a plane base on which the home pose is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gsp.errors import InvalidInput, brief, expected
from gsp.model.design import Design
from gsp.workspace.sides import Side, side_of


def side_of_home(design: Design, both: bool) -> Side:
    """Return the side of a plane base on which the home pose is; with `both` there is none.

    A plane platform has the same lengths of legs at mirror images in the plane of the base, which
    are assembled in another way. The plane is that of the base anchors, in any position.

    Raises
    ------
    InvalidInput
        For `both`, if all positions count anyway.
    """
    side = Side() if design.home is None else side_of(design, np.ravel(design.home.position))
    if side.half_space is None:
        if not both:
            return side
        wanted = "a home pose on one side of a plane of the base anchors, else it has no effect"
        place = f"of design {brief(design.name)}" if design.name else ""
        got = "no home pose" if design.home is None else "no such side"
        raise InvalidInput(expected("--both", wanted, got, place))
    if both:
        return Side(name="both sides of the base")
    along_axis = not side.name.startswith("on ")
    end = ", the side of the home pose" if along_axis else " on which the home pose is"
    return replace(side, name=side.name + end)
