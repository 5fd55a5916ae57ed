"""Quantities that are recomputed: for each paper a table from the name to the function."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

from gsp import arguments
from gsp.published.quantities import (
    basic_robotics,
    common,
    dehaeze_2020,
    dimensions,
    lee_2000,
    nawratil,
    toz_kucuk_2016,
    viso,
    workspace,
)

Quantities = Mapping[str, Callable[..., ArrayLike]]

PAPERS: Mapping[str, Quantities] = MappingProxyType(
    {
        "TozKucuk2016": toz_kucuk_2016.QUANTITIES,
        "Nawratil": nawratil.QUANTITIES,
        "Workspace-3": workspace.QUANTITIES,
        "Workspace-A": workspace.QUANTITIES,
        "Lee2000": lee_2000.QUANTITIES,
        "Dehaeze2020": dehaeze_2020.QUANTITIES,
        "Viso": viso.QUANTITIES,
        "BasicRobotics": basic_robotics.QUANTITIES,
    }
)


@arguments.validated(paper=arguments.text)
def quantities_of(paper: str) -> Quantities:
    """Return the quantities of a paper: the common ones, and its own if it has a module.

    Parameters
    ----------
    paper : str
        Key of the paper.

    Returns
    -------
    mapping from str to function

    Raises
    ------
    InvalidInput
        If `paper` is not a text.

    Examples
    --------
    >>> "joint" in quantities_of("a paper that only needs common ones")
    True
    """
    shared = {**common.QUANTITIES, **dimensions.QUANTITIES}
    return MappingProxyType({**shared, **PAPERS.get(paper, {})})
