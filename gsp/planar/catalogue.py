"""The 16 planar generalized platforms: three constraints, one angle at most."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

from gsp.checks import is_a, plain_text
from gsp.errors import InvalidInput, UnknownMechanism, brief
from gsp.model.mechanism import Counted, read_mechanism
from gsp.planar.constraints import PLANAR_CONSTRAINT, PLANAR_CONSTRAINTS

if TYPE_CHECKING:
    import pandas as pd

NAMES = tuple(PLANAR_CONSTRAINT)


@dataclass(frozen=True)
class PlanarMechanism(Counted):
    """A kind of planar platform: how often each constraint occurs.

    Parameters
    ----------
    counts : four integers ≥ 0
        Numbers of D1, D2, D3 and A1.

    Raises
    ------
    InvalidInput
        If `counts` are not four integers ≥ 0.

    Examples
    --------
    >>> PlanarMechanism((3, 0, 0, 0)).chains
    ('RPR', 'RPR', 'RPR')
    """

    _what = "planar mechanism"
    _table = PLANAR_CONSTRAINTS

    @property
    def legs(self) -> tuple[str, ...]:
        """Constraints one by one, one per leg, as `PlanarDesign` takes them."""
        return self.constraints

    @property
    def chains(self) -> tuple[str, ...]:
        """Joints of the legs from base to platform."""
        return tuple(PLANAR_CONSTRAINT[leg].chain for leg in self.legs)

    @property
    def mobility(self) -> int:
        """Mobility by Chebychev–Grübler–Kutzbach in the plane: three joints and two links per leg.

        3 (links − joints − 1) + joints.

        *Source: the mobility formula of Chebychev, Grübler and Kutzbach*
        """
        joints, links = 3 * len(self.legs), 2 * len(self.legs) + 2
        return 3 * (links - joints - 1) + joints


@cache
def mechanisms() -> tuple[PlanarMechanism, ...]:
    """Return the 16 planar generalized platforms: 3D (10), then 2D1A (6), as sorted words.

    All angles of a base line and a platform line change by the one rotation of the plane, so a
    second angle would repeat the first.

    *Source: ours; docs/planar.md*
    """
    return tuple(
        _of((*distances, *("A1",) * angles))
        for angles in (0, 1)
        for distances in combinations_with_replacement(NAMES[:3], 3 - angles)
    )


def _of(constraints: tuple[str, ...]) -> PlanarMechanism:
    return PlanarMechanism(tuple(map(constraints.count, NAMES)))


def mechanism(name: str) -> PlanarMechanism:
    """Return one of the 16 by its name, in any usual spelling.

    Parameters
    ----------
    name : str
        Its constraints in any order, such as "A1 D2 D1" or "D1^3".

    Raises
    ------
    UnknownMechanism
        With the nearest names, if it is none of the 16.

    Examples
    --------
    >>> mechanism("A1 D2 D1").name
    'D1 D2 A1'
    """
    known = {m.name: m for m in mechanisms()}
    try:
        plain = " ".join(sorted(read_mechanism(name).constraints, key=(*NAMES, "D4").index))
    except InvalidInput as error:
        given = plain_text(name) if is_a(name, str) else brief(name)
        raise UnknownMechanism("planar mechanism", given, known, str(error)) from error
    found = {" ".join(m.legs): m for m in mechanisms()}.get(plain)
    if found is None:
        hint = "A planar platform has three constraints D1, D2, D3, A1, at most one of them A1"
        raise UnknownMechanism("planar mechanism", plain_text(name), known, hint)
    return found


def table() -> pd.DataFrame:
    """Return the 16 as a table: name, class, n_D1 … n_A1, chains, mobility, exchanged."""
    import pandas as pd

    return pd.DataFrame(
        [
            {
                "name": m.name,
                "class": m.group,
                **{f"n_{name}": n for name, n in zip(NAMES, m.counts, strict=True)},
                "chains": " ".join(f"{m.chains.count(c)}-{c}" for c in dict.fromkeys(m.chains)),
                "mobility": m.mobility,
                "exchanged": m.exchanged().name,
            }
            for m in mechanisms()
        ]
    )
