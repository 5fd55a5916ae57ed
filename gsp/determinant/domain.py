"""The poses over which the maximum of |det J| is taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_memory, check_positive, check_type, is_a, plain_text
from gsp.determinant.bounds import is_bounded
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import exp3
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.rotations import angle_of
from gsp.geometry.vectors import Array, Mask, frozen, norm
from gsp.model.design import Design, check_undriven
from gsp.model.posture.evaluated import arm_of_centre

# Greatest angle of rotation about home in the default neighbourhood.
DEFAULT_TURN_DEG = 30.0
# Sine of the angle between the lines of a D4 leg below which they count as parallel.
PARALLEL_SINE = 1e-5
# Share of its displacement and angle by which a pose may exceed a neighbourhood by rounding.
EDGE_TOLERANCE = 1e-9


class UnboundedDeterminant(InvalidInput):
    """|det J| grows without bound in the domain over which its maximum is searched."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Neighbourhood(ReadOnly):
    """The poses near a home pose, defined without reference to the origin of either frame.

    A pose differs from home by a motion of the platform. It belongs to the neighbourhood if the
    motion displaces the point `centre` by no more than `displacement`, and turns the platform by no
    more than `angle`. With the centre midway between the centroids of base and platform anchors
    at home, as `default_neighbourhood` takes it, the set of relative positions of the two bodies
    does not change with rigid motions of either frame, the unit, the order of the legs, a mirror,
    or the exchange of base and platform.

    Parameters
    ----------
    home : Pose
        A single pose.
    centre : (3,) array_like [unit]
        The point whose displacement is bounded, in base axes at home.
    displacement : float [unit]
        > 0.
    angle : float [rad]
        In (0, π].

    Raises
    ------
    InvalidInput

    Examples
    --------
    >>> near = Neighbourhood(home=Pose([0, 0, 1]), centre=[0, 0, 0.5], displacement=0.2, angle=0.5)
    >>> near.contains(Pose([[0, 0, 1.1], [0, 0, 1.3]]))
    array([ True, False])
    """

    home: Pose
    centre: Array
    displacement: float
    angle: float

    def __post_init__(self) -> None:
        check_type("home", self.home, Pose)
        if self.home.shape:
            raise InvalidInput(expected("home", "a single pose", f"shape {self.home.shape}"))
        centre = check_array("centre", self.centre, (3,))
        if centre.ndim != 1:
            raise InvalidInput(expected("centre", "one point", f"shape {centre.shape}"))
        angle = check_positive("angle", self.angle)
        if angle > np.pi:
            raise InvalidInput(expected("angle", "at most π", angle))
        object.__setattr__(self, "centre", frozen(centre))
        object.__setattr__(self, "displacement", check_positive("displacement", self.displacement))
        object.__setattr__(self, "angle", angle)

    @arguments.validated(displacement=arguments.array(3), rotation_vector=arguments.array(3))
    def pose(self, displacement: ArrayLike, rotation_vector: ArrayLike) -> Pose:
        """Return home displaced by a displacement of the centre and turned about the centre.

        Parameters
        ----------
        displacement : (..., 3) array_like [unit]
        rotation_vector : (..., 3) array_like [rad]

        Returns
        -------
        Pose, batch shape (...)

        Raises
        ------
        InvalidInput
            On wrong shapes, or numbers that are not finite.
        """
        turn = exp3(rotation_vector)
        arm = turn @ (self.home.position - self.centre)
        return Pose(self.centre + np.asarray(displacement) + arm, turn @ self.home.rotation)

    @arguments.validated(pose=arguments.kind(Pose))
    def contains(self, pose: Pose) -> Mask:
        """Return which poses belong to the neighbourhood, those on its border included.

        Parameters
        ----------
        pose : Pose, batch shape (...)

        Returns
        -------
        (...) array of bool

        Raises
        ------
        InvalidInput
            If `pose` is not a Pose.

        *Source: ours*
        """
        turn = pose.rotation @ self.home.rotation.T
        away = pose.position - self.centre - turn @ (self.home.position - self.centre)
        reach = float(np.abs(self.home.position).max() + np.abs(self.centre).max())
        near = norm(away) <= self.displacement * (1.0 + EDGE_TOLERANCE) + 1e-14 * reach
        return np.asarray(near & (angle_of(turn) <= self.angle * (1.0 + EDGE_TOLERANCE)))

    @arguments.validated(n=arguments.integer(1), rng=arguments.rng)
    def sample(self, n: int, rng: np.random.Generator) -> Pose:
        """Return n random poses of the neighbourhood, shape (n,).

        Displacement and rotation vector are uniform in their balls.

        Parameters
        ----------
        n : int
            ≥ 1.
        rng : numpy.random.Generator

        Returns
        -------
        Pose, batch shape (n,)

        Raises
        ------
        InvalidInput
            If `n` is not an integer ≥ 1, or `rng` is not a Generator.
        """
        check_memory("n", n, POSE_BYTES, "poses")
        ball = rng.normal(size=(2, n, 3))
        ball *= (rng.random((2, n)) ** (1.0 / 3.0) / norm(ball))[..., None]
        return self.pose(self.displacement * ball[0], self.angle * ball[1])

    def facts(self) -> dict[str, Any]:
        """Return the neighbourhood as tables record it: plain numbers and texts."""
        home = self.home
        return {
            "near_home": {"position": home.position.tolist(), "rotation": home.rotation.tolist()},
            "centre": self.centre.tolist(),
            "displacement": self.displacement,
            "angle_deg": float(np.rad2deg(self.angle)),
        }


SearchRegion = PoseBox | Neighbourhood | None
Domain = PoseBox | Neighbourhood | Literal["all"] | None


def default_neighbourhood(design: Design) -> Neighbourhood:
    """Return the poses over which the maximum is taken if |det J| has no bound over all poses.

    Around the home pose of the design. The displacement is the longest stroke of the distance
    actuators, or else `design.rms_radius`. The angle is 30°, or half of the least angle between the
    lines of a D4 leg at home if that is less, so that the angle between them is at least that
    everywhere.

    Parameters
    ----------
    design : Design

    Returns
    -------
    Neighbourhood

    Raises
    ------
    MissingParameter
        If the design has no home pose.
    UnboundedDeterminant
        If the lines of a D4 leg are parallel at home.

    *Source: ours; docs/quality-index.md*
    """
    check_undriven("design", design)
    home = design.home
    if home is None:
        raise MissingParameter(
            f"maximum of |det J| of {design.name or 'a design'}: expected a home pose of the "
            "design, or domain=, received neither: with these legs |det J| has no bound over all "
            "poses, and without a home no domain is independent of the choice of frames"
        )
    angle = min(np.deg2rad(DEFAULT_TURN_DEG), _least_angle(design, home) / 2.0)
    if angle < PARALLEL_SINE:
        raise UnboundedDeterminant(
            expected(
                "domain",
                "poses where no D4 leg has parallel lines",
                "none, and the lines of a D4 leg are parallel at the home pose",
            )
        )
    top = home.position + arm_of_centre(design, home)
    centre = (design.base_points.mean(axis=0) + top) / 2.0
    return Neighbourhood(home=home, centre=centre, displacement=_reach(design), angle=angle)


def _least_angle(design: Design, pose: Pose) -> float:
    """Least angle in [0, π/2] between the lines of a D4 leg; π/2 without D4 legs."""
    sines = design.at(pose).segments.sine[two_line_distances(design)]
    return float(np.arcsin(np.clip(sines, 0.0, 1.0)).min(initial=np.pi / 2))


def two_line_distances(design: Design) -> list[int]:
    """Return the legs with a distance of two lines, whose row grows where they become parallel."""
    rows = [row for row in design.rows if row.constraint.quantity == "distance"]
    return [row.leg for row in rows if row.constraint.two_lines]


def _reach(design: Design) -> float:
    if design.strokes is None:
        return design.rms_radius
    spans = (design.strokes[:, 1] - design.strokes[:, 0])[~design.angular]
    spans = spans[np.isfinite(spans) & (spans > 0.0)]
    return float(spans.max()) if spans.size else design.rms_radius


def check_domain(design: Design, domain: Domain) -> SearchRegion:
    """Return the poses to search: a box, a neighbourhood, or None for all poses.

    Raises
    ------
    InvalidInput
        On anything but a PoseBox, a Neighbourhood, "all" or None, on a box without width, and on
        "all" for a design whose |det J| has no bound.
    MissingParameter
        If a default is needed and the design has no home pose.
    """
    bounded = is_bounded(design.mechanism)
    if domain is None:
        return None if bounded else default_neighbourhood(design)
    if is_a(domain, str) and plain_text(domain) == "all":
        if not bounded:
            wanted = "some of the poses, as |det J| is unbounded over all poses with these legs"
            raise InvalidInput(expected("domain", wanted, "'all'"))
        return None
    if is_a(domain, Neighbourhood):
        return domain
    if not is_a(domain, PoseBox):
        wanted = 'a gsp.PoseBox, a Neighbourhood, "all" or None'
        raise InvalidInput(expected("domain", wanted, brief(domain)))
    if not (domain.high > domain.low).any():
        raise InvalidInput(expected("domain", "a box with some width", "a single pose"))
    return domain


def inside(region: SearchRegion, pose: Pose) -> Mask:
    """Return which poses, batch shape (...), belong to a region: a (...) array of bool."""
    if region is None:
        return np.ones(pose.shape, dtype=bool)
    if isinstance(region, Neighbourhood):
        return region.contains(pose)
    values = np.concatenate((pose.position, pose.angles(region.order)), axis=-1)
    slack = EDGE_TOLERANCE * (region.high - region.low) + 1e-12 * np.abs(values)
    return np.asarray(
        ((values >= region.low - slack) & (values <= region.high + slack)).all(axis=-1)
    )
