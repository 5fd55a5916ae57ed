"""The 195 mechanisms, enumerated, and found by name."""

from __future__ import annotations

from functools import cache
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

from gsp.catalogue.topology import kinematic_graph, mobility
from gsp.checks import is_a, plain_text
from gsp.errors import InvalidInput, UnknownMechanism, brief
from gsp.model.mechanism import NAMES, Mechanism, read_mechanism

if TYPE_CHECKING:
    import pandas as pd

DISTANCES = NAMES[:4]
MOST_ANGLES = 3


@cache
def mechanisms() -> tuple[Mechanism, ...]:
    """Return the 195 mechanisms in a stable order.

    The classes come as 6D (84), 5D1A (56), 4D2A (35), 3D3A (20). Inside a class the distance
    constraints are sorted words: D1^6, D1^5 D2, …, D4^6.

    *Source: TozKucuk2016, §2: multisets of six constraints, three angular ones at most.*
    """
    return tuple(
        Mechanism.of((*distances, *("A1",) * angles))
        for angles in range(MOST_ANGLES + 1)
        for distances in combinations_with_replacement(DISTANCES, 6 - angles)
    )


def mechanism(name: str | Mechanism) -> Mechanism:
    """Return a mechanism of the catalogue by its name, in any usual spelling.

    Parameters
    ----------
    name : str or Mechanism
        Such as "D1^2 D2 D4 A1^2", in any order; powers, subscripts and LaTeX are understood.
        A Mechanism is returned if it is one of the 195.

    Returns
    -------
    Mechanism

    Raises
    ------
    UnknownMechanism
        With the nearest names, if it is none of the 195.

    Examples
    --------
    >>> mechanism("A1A1D4D2D1D1").name
    'D1^2 D2 D4 A1^2'
    """
    known = tuple(m.name for m in mechanisms())
    text: Any = plain_text(name)
    try:
        found = text if is_a(text, Mechanism) else read_mechanism(text)
    except InvalidInput as error:
        given = text if is_a(text, str) else brief(text)
        raise UnknownMechanism("mechanism", given, known, str(error)) from error
    if found not in mechanisms():
        hint = "A mechanism has six constraints, at most three of them A1"
        raise UnknownMechanism("mechanism", found.name, known, hint)
    return found


def table() -> pd.DataFrame:
    """Return the catalogue as a table of 195 rows, one per mechanism, in the order of `mechanisms`.

    Columns: name, class, n_D1 … n_A1, legs (text), chains (text), n_legs, loops (independent),
    symmetric, mobility, exchanged (the mechanism with base and platform exchanged).
    """
    import pandas as pd

    return pd.DataFrame([_row(m) for m in mechanisms()])


def _row(mechanism: Mechanism) -> dict[str, object]:
    legs = mechanism.legs
    chains = [leg.chain for leg in legs]
    return {
        "name": mechanism.name,
        "class": mechanism.group,
        **{f"n_{name}": n for name, n in zip(NAMES, mechanism.counts, strict=True)},
        "legs": ", ".join(leg.name for leg in legs),
        "chains": " ".join(
            f"{chains.count(c)}-{c}" for c in ("SPS", "SPC", "CPS", "CCC") if c in chains
        ),
        "n_legs": len(legs),
        "loops": len(legs) - 1,
        "symmetric": mechanism.symmetric,
        "mobility": mobility(kinematic_graph(mechanism)),
        "exchanged": mechanism.exchanged().name,
    }
