"""The legs SPS, SPC, CPS and CCC: joints, constraints, and rates of their passive joints.

The legs PSS and RSS are driven at the base, and have the dimensions of their drive.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import islice
from types import MappingProxyType
from typing import Any, Literal

from gsp.checks import is_a, is_iterable, reading
from gsp.errors import InvalidDesign, brief, expected
from gsp.geometry.scalars import Scalar
from gsp.model.constraints import BY_CRANK, BY_SLIDER, CONSTRAINT, Constraint
from gsp.model.drives import Crank, Drive, Slider
from gsp.model.formulas import PassiveRate, Placement, Segment, ccc, ccc_angle, cps, spc, sps
from gsp.model.rods import driven_rates

# Texts that name a leg: one for each constraint, more are a mistake.
MOST_WORDS = 4
FREEDOMS = MappingProxyType({"S": 3, "P": 1, "C": 2, "R": 1})


@dataclass(frozen=True)
class Joint:
    """A joint of a leg: its kind, and which of its freedoms an actuator drives.

    Attributes
    ----------
    kind : "S", "P", "C" or "R"
        Spherical, prismatic, cylindrical or revolute.
    active : "", "slide", "turn" or "slide and turn"
        Which freedoms have an actuator.
    """

    kind: Literal["S", "P", "C", "R"]
    active: Literal["", "slide", "turn", "slide and turn"] = ""

    @property
    def freedoms(self) -> int:
        """Number of freedoms: 3 for S, 2 for C, 1 for P and R."""
        return FREEDOMS[self.kind]

    @property
    def passive_slide(self) -> bool:
        """Whether it slides without an actuator."""
        return self.kind == "C" and "slide" not in self.active

    def __str__(self) -> str:
        return f"[{self.kind}: {self.active}]" if self.active else self.kind


@dataclass(frozen=True, kw_only=True)
class Leg:
    """One kind of leg.

    Attributes
    ----------
    name : str
        Its constraints as text: "D1", "D2", "D3", "D4", "A1" or "D4 A1"; the chain of a driven leg.
    chain : str
        Its joints from base to platform: "SPS", "SPC", "CPS" or "CCC"; "PSS" with a slider, "RSS"
        with a crank.
    constraints : tuple of Constraint
        In row order.
    joints : tuple of Joint
        From base to platform.
    idle : int
        Freedoms that move neither platform nor actuator (the turn of an SPS leg about itself).
    passive : Segment, characteristic length -> list of PassiveRate
        Rows that give the rates of the passive joints from a twist.
    drive : Slider, Crank or None
        What drives a leg of fixed length at the base.
    """

    name: str
    chain: str
    constraints: tuple[Constraint, ...]
    joints: tuple[Joint, Joint, Joint]
    idle: int
    passive: Callable[[Segment, Scalar], list[PassiveRate]]
    drive: Drive | None = None

    def __reduce__(self) -> tuple[object, ...]:
        # In another process it is that process's leg of the same name, so that `is` still holds.
        return check_leg, (self.name if self.drive is None else self.drive,)

    @property
    def segment(self) -> Callable[[Placement], Segment]:
        """The formula of its segment, which its constraints share."""
        return self.constraints[0].segment

    @property
    def base_line(self) -> bool:
        """Whether the leg is attached to a line of the base."""
        return self.constraints[0].base == "line"

    @property
    def platform_line(self) -> bool:
        """Whether the leg is attached to a line of the platform."""
        return self.constraints[0].platform == "line"

    @property
    def exchanged(self) -> str:
        """Name of the leg that it becomes where base and platform are exchanged."""
        return " ".join(constraint.exchanged for constraint in self.constraints)

    @property
    def cylindrical(self) -> bool:
        """Whether a passive joint slides."""
        return "C" in self.chain

    @property
    def turns(self) -> tuple[int, int]:
        """Numbers of passive turns seen from the base and from the platform, zero rows included."""
        return 2, 2

    @property
    def slides(self) -> int:
        """Number of passive slides."""
        return sum(joint.passive_slide for joint in self.joints)


_S, _C, _P = Joint("S"), Joint("C"), Joint("P", "slide")
_D1, _D2, _D3, _D4, _A1 = CONSTRAINT.values()

LEGS = (
    Leg(
        name="D1",
        chain="SPS",
        constraints=(_D1,),
        joints=(_S, _P, _S),
        idle=1,
        passive=sps,
    ),
    Leg(
        name="D2",
        chain="SPC",
        constraints=(_D2,),
        joints=(_S, _P, _C),
        idle=0,
        passive=spc,
    ),
    Leg(
        name="D3",
        chain="CPS",
        constraints=(_D3,),
        joints=(_C, _P, _S),
        idle=0,
        passive=cps,
    ),
    Leg(
        name="D4",
        chain="CCC",
        constraints=(_D4,),
        joints=(_C, Joint("C", "slide"), _C),
        idle=0,
        passive=ccc,
    ),
    Leg(
        name="A1",
        chain="CCC",
        constraints=(_A1,),
        joints=(_C, Joint("C", "turn"), _C),
        idle=0,
        passive=ccc_angle,
    ),
    Leg(
        name="D4 A1",
        chain="CCC",
        constraints=(_D4, _A1),
        joints=(_C, Joint("C", "slide and turn"), _C),
        idle=0,
        passive=ccc,
    ),
)

LEG = MappingProxyType({leg.name: leg for leg in LEGS})

# Legs of fixed length that are driven at the base; a design has them with the numbers of a drive.
_R = Joint("R", "turn")
DRIVEN_LEGS = (
    Leg(
        name="PSS",
        chain="PSS",
        constraints=(BY_SLIDER,),
        joints=(_P, _S, _S),
        idle=1,
        passive=driven_rates,
    ),
    Leg(
        name="RSS",
        chain="RSS",
        constraints=(BY_CRANK,),
        joints=(_R, _S, _S),
        idle=1,
        passive=driven_rates,
    ),
)
DRIVEN_LEG: MappingProxyType[type[Drive], Leg] = MappingProxyType(
    dict(zip((Slider, Crank), DRIVEN_LEGS, strict=True))
)


def check_leg(text: str | Leg | Drive | Iterable[str], where: str = "leg") -> Leg:
    """Return a leg as it is, that with a drive, or that with the named constraint(s).

    "A1 D4" and ("D4", "A1") are accepted too.

    Raises
    ------
    InvalidDesign
        If no leg has exactly these constraints.
    """
    if is_a(text, Leg):
        if text.drive is None and text in DRIVEN_LEGS:
            raise InvalidDesign(expected(where, "the numbers of a drive", f"{text.name} alone"))
        return text
    if type(text) is str and text in LEG:  # by far the most calls
        return LEG[text]
    if is_a(text, Slider | Crank):
        return replace(DRIVEN_LEG[type(text)], drive=text)
    wanted = "one of " + ", ".join(map(repr, LEG))
    words: tuple[Any, ...] = (text,)
    if is_iterable(text) and not isinstance(text, str | bytes):
        with reading(where, wanted, text):
            words = tuple(islice(text, MOST_WORDS + 1))
    names = (word if is_a(word, str) else brief(word) for word in words)
    parts = " ".join(names).replace(",", " ").upper().split()
    name = " ".join(sorted(parts, key=lambda part: (part[0] != "D", part)))
    if len(words) > MOST_WORDS or name not in LEG:
        raise InvalidDesign(expected(where, wanted, brief(text)))
    return LEG[name]
