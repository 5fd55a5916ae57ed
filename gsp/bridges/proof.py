"""The proof: every mechanism of the catalogue against Pinocchio, at random dimensions and poses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from gsp.bridges.agreement import Agreement, agreement
from gsp.bridges.simulation import actuator_jacobian
from gsp.catalogue import mechanisms
from gsp.design import Design
from gsp.mechanism import Mechanism
from gsp.pose import PoseBox
from gsp.vectors import check_positive
from gsp.version import __version__

TOLERANCE = 1e-9
BOX = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (1.0, 2.0)], [(-0.6, 0.6)] * 3)
Progress = Callable[[int, int], object] | None


@dataclass(frozen=True)
class Proof:
    """Results of `prove`.

    Attributes
    ----------
    table : pandas.DataFrame
        A row a mechanism: mechanism, class, legs, poses, and the largest differences
        (`Agreement`): closure, actuators, passive.
    seed : int
    """

    table: pd.DataFrame
    seed: int

    @property
    def holds(self) -> bool:
        """Whether all differences are within the tolerance of 1e-9."""
        return bool((self.table[list(Agreement._fields)] <= TOLERANCE).all(axis=None))

    def markdown(self) -> str:
        """Return the page that states the proof."""
        return "\n".join(_page(self)) + "\n"


def random_design(mechanism: Mechanism, rng: np.random.Generator) -> Design:
    """Return a mechanism with anchor points in a cube of edge 2 and lines in all directions."""
    n = len(mechanism.legs)
    return Design(
        [leg.name for leg in mechanism.legs],
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
    progress: Progress = None,
) -> Proof:
    """Compare mechanisms with Pinocchio, each at new dimensions for every pose.

    Parameters
    ----------
    chosen : mechanisms, default the 195
    poses : int
        Per mechanism, ≥ 1.
    seed : int
        With the place of a mechanism in `chosen`, it settles its dimensions and poses.
    progress : function (done, total) or None
        Called after each mechanism.

    Raises
    ------
    InvalidInput
        If `poses` is not positive.

    Examples
    --------
    >>> import gsp
    >>> prove([gsp.catalogue.mechanism("D4^3 A1^3")], poses=2).holds
    True
    """
    number = int(check_positive("poses", poses))
    todo = tuple(mechanisms() if chosen is None else chosen)
    rows = []
    for i, mechanism in enumerate(todo):
        worst = np.max(list(_differences(mechanism, number, np.random.default_rng([seed, i]))), 0)
        rows.append(
            {
                "mechanism": mechanism.name,
                "class": mechanism.group,
                "legs": len(mechanism.legs),
                "poses": number,
                **dict(zip(Agreement._fields, map(float, worst), strict=True)),
            }
        )
        if progress is not None:
            progress(i + 1, len(todo))
    return Proof(pd.DataFrame(rows), seed)


def _differences(mechanism: Mechanism, poses: int, rng: np.random.Generator) -> Iterator[Agreement]:
    sample = BOX.sample(poses, rng=rng)
    for i in range(poses):
        yield agreement(random_design(mechanism, rng), sample[i])


def mujoco_difference(design: Design, rng: np.random.Generator) -> float:
    """Largest difference of `actuator_jacobian` and ours at a random pose, relative by rows."""
    pose = BOX.sample(1, rng=rng)[0]
    ours = design.at(pose).jacobian
    theirs = actuator_jacobian(design, pose)
    return float((np.abs(theirs - ours).max(axis=1) / np.abs(ours).max(axis=1)).max())


def _page(proof: Proof) -> Iterator[str]:
    table = proof.table
    worst = {name: table[name].max() for name in Agreement._fields}
    yield "# Proof by a second computation"
    yield ""
    yield (
        "Every mechanism is built as a multibody model of Pinocchio: base, platform, both links "
        "of every leg, and all joints, with one closed loop a leg. Pinocchio is told where joints "
        "are and what values they have, nothing else. That the loops close shows that the "
        "posture is right. The null space of the Jacobian of its loop constraints gives the "
        "rates of all joints for the six unit twists of the platform, which are compared with our "
        "inverse Jacobian and with the passive rates that the control number is made of."
    )
    yield ""
    yield (
        f"gsp {__version__}, seed {proof.seed}: {len(table)} mechanisms, "
        f"{int(table['poses'].sum())} postures, each at its own random dimensions and pose. "
        f"Differences are relative (see `gsp.bridges.Agreement`), and the largest of each "
        f"mechanism is shown. `make proof` writes this page; the last digits depend on the machine."
    )
    yield ""
    verdict = "All are" if proof.holds else "**Not all are**"
    yield f"{verdict} below {TOLERANCE:.0e}. The largest of all: " + ", ".join(
        f"{name} {value:.1e}" for name, value in worst.items()
    ) + "."  # fmt: skip
    yield ""
    columns = list(table.columns)
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "".join(" --- |" if c in ("mechanism", "class") else " ---: |" for c in columns)
    for row in table.to_dict("records"):
        yield "| " + " | ".join(
            f"{value:.0e}" if isinstance(value, float) else str(value) for value in row.values()
        ) + " |"  # fmt: skip
