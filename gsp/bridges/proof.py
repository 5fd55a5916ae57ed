"""The proof: the catalogue against multibody programs, at random dimensions and poses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from gsp.bridges.agreements import Agreement, agreement
from gsp.catalogue import mechanisms
from gsp.checks import check_integer, check_items, check_memory, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import PoseBox
from gsp.model.design import Design
from gsp.model.mechanism import Mechanism
from gsp.progress import Progress, meter
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

# Relative difference up to which two computations agree: 1e-12 is usual, and random designs may be
# close to singular.
DIFFERENCE_TOLERANCE = 1e-9
# Poses of the comparison, for anchors of `random_design` in cubes of edge 2: the platform is above
# the base and turned about all axes (by up to 0.6 rad), so that no term of a row is zero.
BOX = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (1.0, 2.0)], [(-0.6, 0.6)] * 3)
# Memory for each posture [bytes], with the design that is made for it.
POSTURE_BYTES = 5000
PROGRAM_NAMES: Mapping[str, str] = MappingProxyType({"pinocchio": "Pinocchio", "mujoco": "MuJoCo"})


@dataclass(frozen=True)
class Proof:
    """Results of `prove`.

    Attributes
    ----------
    table : pandas.DataFrame
        One row per mechanism: mechanism, class, legs, poses, and for each program the largest
        differences (`Agreement`): "pinocchio closure", "pinocchio actuators" ….
    programs : tuple of str
        With which mechanisms were compared.
    seed : int
    """

    table: pd.DataFrame
    programs: tuple[str, ...]
    seed: int

    @property
    def differences(self) -> pd.DataFrame:
        """The columns of differences."""
        return self.table.filter(regex=f"^({'|'.join(self.programs)}) ")

    @property
    def holds(self) -> bool:
        """Whether all differences are within the tolerance of 1e-9."""
        return bool((self.differences <= DIFFERENCE_TOLERANCE).all(axis=None))

    def markdown(self) -> str:
        """Return the page that states the proof."""
        return "\n".join(_page(self)) + "\n"


def random_design(mechanism: Mechanism, rng: np.random.Generator) -> Design:
    """Return a mechanism with anchor points in a cube of edge 2 and lines in all directions."""
    n = len(mechanism.legs)
    return Design(
        mechanism.legs,
        base_points=rng.uniform(-1.0, 1.0, (n, 3)),
        platform_points=rng.uniform(-1.0, 1.0, (n, 3)),
        base_directions=rng.normal(size=(n, 3)),
        platform_directions=rng.normal(size=(n, 3)),
        name=mechanism.name,
    )


def prove(
    chosen: Iterable[Mechanism] | None = None,
    poses: int = 20,
    seed: int = 1,
    programs: Sequence[str] = ("pinocchio",),
    progress: Progress = None,
) -> Proof:
    """Compare mechanisms with multibody programs, each at new dimensions for every pose.

    Parameters
    ----------
    chosen : mechanisms, default the 195
    poses : int
        Per mechanism, ≥ 1.
    seed : int
        Together with the place of a mechanism in `chosen` it determines dimensions and poses.
    programs : sequence of "pinocchio", "mujoco"
    progress : function (done, total), bool or None
        Called after each mechanism; False: no output; None or True: a progress bar.

    Returns
    -------
    Proof

    Raises
    ------
    InvalidInput
        If `poses` is not an integer ≥ 1, `seed` none ≥ 0, or `chosen` holds no mechanisms.
    UnknownName, MissingSoftware
        If there is no such program here, or it is not installed.

    Examples
    --------
    >>> import gsp
    >>> prove([gsp.catalogue.mechanism("D4^3 A1^3")], poses=2).holds
    True
    """
    import pandas as pd

    number = check_memory("poses", check_integer("poses", poses), POSTURE_BYTES, "postures")
    todo = mechanisms() if chosen is None else _check_mechanisms(chosen)
    start, rows = check_integer("seed", seed, least=0), []
    with meter(progress, "mechanisms") as report:
        for i, mechanism in enumerate(todo):
            rng = np.random.default_rng([start, i])
            rows.append(_compare(mechanism, number, rng, programs))
            report(i + 1, len(todo))
    return Proof(pd.DataFrame(rows), tuple(programs), start)


def _check_mechanisms(chosen: Iterable[Mechanism]) -> tuple[Mechanism, ...]:
    todo = check_items("chosen", chosen, "mechanisms")
    for mechanism in todo:
        check_type("chosen", mechanism, Mechanism)
    if not todo:
        raise InvalidInput(expected("chosen", "at least one mechanism", "none"))
    return todo


def _compare(
    mechanism: Mechanism, poses: int, rng: np.random.Generator, programs: Sequence[str]
) -> dict[str, object]:
    """Make the row of a mechanism: its largest differences over some postures."""
    sample = BOX.sample(poses, rng=rng)
    postures = [(random_design(mechanism, rng), sample[i]) for i in range(poses)]
    row: dict[str, object] = {
        "mechanism": mechanism.name,
        "class": mechanism.group,
        "legs": len(mechanism.legs),
        "poses": poses,
    }
    for program in programs:
        worst = np.max([agreement(*posture, program=program) for posture in postures], axis=0)
        for name, value in zip(Agreement._fields, worst, strict=True):
            row[f"{program} {name}"] = float(value)
    return row


def _page(proof: Proof) -> Iterator[str]:
    table = proof.table
    programs = " and ".join(PROGRAM_NAMES[program] for program in proof.programs)
    yield "# Proof by a second computation"
    yield ""
    yield (
        f"Every mechanism is built as a multibody model of {programs}: base, platform, both links "
        "of every leg, and all joints, with one closed loop per leg. The program gets only the "
        "positions and the values of the joints. If the loops close, the posture is correct. The "
        "null space of the Jacobian of the loop constraints gives the rates of all joints for the "
        "six unit twists of the platform. They are compared with the inverse Jacobian of `gsp` and "
        "with the passive rates of the control number."
    )
    yield ""
    yield (
        f"gsp {__version__}, seed {proof.seed}: {len(table)} mechanisms, "
        f"{int(table['poses'].sum())} postures, each at its own random dimensions and pose. "
        f"Differences are relative (see `gsp.bridges.Agreement`), and the largest of each "
        f"mechanism is shown. `make proof` writes this page; the last digits depend on the machine."
    )
    yield ""
    worst = ", ".join(f"{name} {value:.1e}" for name, value in proof.differences.max().items())
    verdict = "All are" if proof.holds else "**Not all are**"
    yield f"{verdict} below {DIFFERENCE_TOLERANCE:.0e}. The largest of all: {worst}."
    yield ""
    columns = list(table.columns)
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "".join(" --- |" if c in ("mechanism", "class") else " ---: |" for c in columns)
    for row in table.to_dict("records"):
        cells = (f"{v:.0e}" if isinstance(v, float) else str(v) for v in row.values())
        yield "| " + " | ".join(cells) + " |"
