"""The network of boundary curves and bifurcation points of a plane, from ray ends outward."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from gsp.geometry.rotations import skew_part
from gsp.geometry.vectors import Array, norm
from gsp.limits.labels import Active
from gsp.progress import Steps
from gsp.workspace.boundary.branches import Branch, Trace
from gsp.workspace.boundary.critical import Points, distance, joined
from gsp.workspace.boundary.events import across
from gsp.workspace.boundary.tracing import TRIAL_STEP, Node, Tracer

# A point nearer than this [share of the scale, rad] to a curve lies on it.
CURVE_TOLERANCE = 1e-6
# Steps by which progress counts a curve that is not yet followed: about the median.
STEPS_PER_CURVE_AHEAD = 25
# Steps along the curves of one boundary: twenty times those of a general hexapod.
CURVE_STEPS = 20_000
# Curves of one boundary: five times those of two regular hexagons.
MOST_CURVES = 2000
# How curves end, the more incomplete the later.
ENDS = ("closed", "node", "border", "lost", "budget")


def everywhere(position: Array) -> bool:
    """Return True: follow the branches of every node."""
    return True


@dataclass(eq=False)
class Network:
    """Nodes and branches found so far, and the branches that are not yet followed.

    `wanted` is asked for the position (3,) of each new node whether to follow its branches.
    `budget` is the number of steps along curves that are left. `stopped_by` is what ended the
    search before every known curve was followed: "most", "budget" or None.
    """

    tracer: Tracer
    most: int
    steps: Steps
    wanted: Callable[[Array], bool] = everywhere
    budget: int = CURVE_STEPS
    stopped_by: str | None = None
    nodes: list[Node] = field(default_factory=list)
    branches: list[Branch] = field(default_factory=list)
    _waiting: list[tuple[int, Active, Points, Array]] = field(default_factory=list)
    _left: list[tuple[int, Active, Array]] = field(default_factory=list)  # node, held, direction

    def stops(self) -> bool:
        """Whether a curve that is known cannot be followed any more; notes the reason."""
        if self.budget <= 0:
            self.stopped_by = "budget"
        elif len(self.branches) >= self.most:
            self.stopped_by = "most"
        return self.stopped_by is not None

    @property
    def waiting(self) -> int:
        """Number of branches at known nodes that are not followed."""
        return sum(
            not self._is_left(node, active, start, along)
            for node, active, start, along in self._waiting
        )

    def add_seed(self, point: Points, active: Active) -> bool:
        """Follow the curve through a local maximum both ways, and all connected curves.

        Return whether the point is on a curve then.
        """
        if self._known(point, active):
            return True
        if self.stops():
            return False
        tangent = self.tracer.tangent(point, active, None)
        if not self.tracer.goes_on(point, active, tangent):
            number = self.add_node(point)
            return any(number in (branch.first, branch.last) for branch in self.branches)
        forward, how = self._follow(point, active, tangent)
        if how == "closed":
            self._store(active, forward, None, None, how)
        else:
            back, how_back = self._follow(point, active, -tangent)
            last = self._end(forward[-1], how)
            first = self._end(back[-1], how_back)
            status = max(how, how_back, key=ENDS.index)
            self._store(active, back[::-1] + forward[1:], first, last, status)
        self._run()
        return True

    def _run(self) -> None:
        while self._waiting:
            node, active, start, along = self._waiting[0]
            known = self._is_left(node, active, start, along)
            if not known and self.stops():
                return
            del self._waiting[0]
            if known:
                continue
            points, how = self._follow(start, active, along)
            last = self._end(points[-1], how)
            self._store(active, points, node, last, how)

    def _follow(self, start: Points, active: Active, along: Array) -> tuple[list[Points], str]:
        """Follow a curve from a point, and count its steps."""
        self.steps.ahead = STEPS_PER_CURVE_AHEAD * (1 + len(self._waiting))
        done = self.steps.done
        found = self.tracer.follow(start, active, along, self.steps, self.budget)
        self.budget -= self.steps.done - done
        if found[1] == "budget":
            self.stopped_by = "budget"
        return found

    def add_node(self, point: Points) -> int | None:
        """Follow the boundary curves that leave a bifurcation point; return its number."""
        number = self._end(point, "node")
        self._run()
        return number

    def connect(self) -> None:
        """Follow the curves between complete bifurcation points, maximal or not.

        Complete are the points where every joint is at a bound; along a connecting curve as many
        joints as fix it stay at their bounds.
        """
        joints = self.tracer.chart.bounds.joints
        complete = [
            number
            for number, node in enumerate(self.nodes)
            if {i for i, _ in node.active} >= set(range(joints))
        ]
        for number in complete:
            others = [set(self.nodes[i].active) for i in complete if i != number]
            for active, start, along in self.tracer.outgoing(self.nodes[number], any_sign=True):
                nowhere = not any(set(active) <= other for other in others)
                if nowhere or self._is_left(number, active, start, along):
                    continue
                if self.stops():
                    return
                points, how = self._follow(start, active, along)
                last = self._find(points[-1]) if how == "node" else None
                if last in complete:
                    self._store(active, points, number, last, how, connecting=True)
        self._run()

    def _find(self, point: Points) -> int | None:
        """Return the known node at a point."""
        size = self.tracer.chart.bounds.scale
        return next((i for i, n in enumerate(self.nodes) if n.same_pose(point, size)), None)

    def _end(self, point: Points, how: str) -> int | None:
        """Return the node at the end of a curve, a new one if need be."""
        if how != "node":
            return None
        known = self._find(point)
        if known is not None:
            return known
        self.nodes.append(Node(point, self.tracer.held_along(point)))
        number = len(self.nodes) - 1
        if self.wanted(point.position[0]):
            for active, start, along in self.tracer.outgoing(self.nodes[number]):
                self._waiting.append((number, active, start, along))
        return number

    def _store(
        self,
        active: Active,
        parts: list[Points],
        first: int | None,
        last: int | None,
        how: str,
        *,
        connecting: bool = False,
    ) -> None:
        if len(parts) < 2:  # it ended where it began
            return
        trace = Trace(active, joined(parts), "complete" if how == "node" else how)
        held = self.tracer.held_along(trace.points)
        free = self.tracer.walls.free_along(trace.points, active, trace.status == "closed")
        self.branches.append(Branch(trace, held, first, last, connecting, free))
        for point in self.tracer.turning_points(trace.points, active):
            self._turn(point, active)
        for number, end, inner in ((first, parts[0], parts[1]), (last, parts[-1], parts[-2])):
            if number is not None:
                chord = self._chord(end, inner)
                tangent = self.tracer.tangent(end, active, chord)
                self._left.append((number, held, tangent))

    def _turn(self, point: Points, active: Active) -> None:
        """Continue the boundary with fewer constraints where a weight vanishes."""
        node = Node(point, active)
        branches = [b for b in self.tracer.outgoing(node) if b[0] != active]
        if branches and self._find(point) is None:
            self.nodes.append(node)
            number = len(self.nodes) - 1
            self._waiting += [(number, *branch) for branch in branches]

    def _chord(self, one: Points, other: Points) -> Array:
        """Coordinates of the move from one point to another, to first order."""
        chart = self.tracer.chart
        place = (other.position[0] - one.position[0]) @ chart.axes.T / chart.bounds.scale
        spin = skew_part(other.rotation[0] @ one.rotation[0].T)
        pose = np.concatenate((place, chart.turns @ spin))
        if other.weight.shape != one.weight.shape:  # of other constraints
            return pose
        return np.concatenate((pose, other.weight[0] - one.weight[0]))

    def _is_left(self, node: int, active: Active, start: Points, along: Array) -> bool:
        """Whether a known branch leaves a node in the same direction of the pose.

        Along a wall any orientation will do, so it is known from other nodes as well.
        """
        if active in self.tracer.walls.curves:
            ahead = self.tracer.chart.move(start, TRIAL_STEP * along)
            if self._on_wall(ahead, active):
                return True
        d = self.tracer.chart.freedoms
        way = along[:d] / np.maximum(np.linalg.norm(along[:d]), 1e-300)
        return any(
            n == node and set(active) <= set(held) and t[:d] @ way > 0.9 * np.linalg.norm(t[:d])
            for n, held, t in self._left
        )

    def _known(self, point: Points, active: Active) -> bool:
        """Whether a point lies on a known branch."""
        if self._on_wall(point, active):
            return True
        if active in self.tracer.walls.curves:
            return False
        size = self.tracer.chart.bounds.scale
        for branch in self.branches:
            if not set(active) <= set(branch.held):
                continue
            points = branch.trace.points
            far = norm(points.position - point.position) / size + np.linalg.norm(
                points.rotation - point.rotation, axis=(1, 2)
            )
            near = int(np.argmin(far))
            steps = norm(np.diff(points.position, axis=0)) / size
            apart = max(0.5, float(steps[max(near - 1, 0) : near + 1].max()))
            if far[near] < apart and self._on(points[[near]], point, active, branch.trace.active):
                return True
        return False

    def _on_wall(self, point: Points, active: Active) -> bool:
        """Whether the position of a point is on a known wall, or curve with a free turn."""
        wall = active in self.tracer.walls.curves
        same = [b for b in self.branches if b.trace.active == active and (wall or b.free)]
        return any(self.tracer.walls.passed(branch.trace.points, point) for branch in same)

    def _on(self, guess: Points, point: Points, own: Active, active: Active) -> bool:
        """Whether the curve, followed from a near point to the level of `point`, meets it.

        `own` are the constraints of the point, `active` those of the curve: if they differ, their
        weights cannot be compared, and only the pose counts.
        """
        chart = self.tracer.chart
        d = None if own == active else chart.freedoms

        def ahead(start: Points, along: Array) -> float:
            return float(self._chord(start, point)[:d] @ along[:d] / (along[:d] @ along[:d]))

        tangent = self.tracer.tangent(guess, active, None)
        goal = ahead(guess, tangent)
        here = chart.move(guess, np.zeros_like(tangent))
        for _ in range(4):
            there, solved, _ = chart.solve(
                chart.move(here, goal * tangent), active, across(tangent)
            )
            if not solved[0]:
                return False
            here = there
            tangent = self.tracer.tangent(here, active, tangent)
            goal = ahead(here, tangent)
        return distance(here, point, chart.bounds.scale) < CURVE_TOLERANCE
