"""Mechanisms as graphs of links and joints; mobility."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gsp import arguments
from gsp.checks import is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.model.mechanism import Mechanism

if TYPE_CHECKING:
    import networkx as nx


@arguments.validated(mechanism=arguments.kind(Mechanism))
def kinematic_graph(mechanism: Mechanism) -> nx.Graph:
    """Return the kinematic chain: links are nodes, joints are edges.

    The nodes are "base", "platform", and two per leg: ("leg", i, "base") and
    ("leg", i, "platform"), with i from 1. An edge has `kind` ("S", "P" or "C"), `freedoms`,
    `active` (what its actuator drives, "" for none) and `leg`. The graph has `idle`, the freedoms
    of legs that turn about themselves.

    Parameters
    ----------
    mechanism : Mechanism

    Returns
    -------
    networkx.Graph

    Raises
    ------
    InvalidInput
        If `mechanism` is not a Mechanism.

    *Source: TozKucuk2016, §2 and figure 1.*
    """
    import networkx as nx

    graph = nx.Graph(name=mechanism.name, idle=sum(leg.idle for leg in mechanism.legs))
    graph.add_nodes_from(("base", "platform"))
    for i, leg in enumerate(mechanism.legs, 1):
        links = ("base", ("leg", i, "base"), ("leg", i, "platform"), "platform")
        for below, above, joint in zip(links[:-1], links[1:], leg.joints, strict=True):
            graph.add_edge(
                below, above, kind=joint.kind, freedoms=joint.freedoms, active=joint.active, leg=i
            )
    return graph


def mobility(graph: nx.Graph) -> int:
    """Mobility by Chebychev–Grübler–Kutzbach, less the idle rotations of legs about their axes.

    6 (links − joints − 1) + Σ freedoms − idle.

    Parameters
    ----------
    graph : networkx.Graph
        As `kinematic_graph` makes it.

    Returns
    -------
    int
        Freedoms of the platform.
    """
    _check_graph(graph)
    links, joints = graph.number_of_nodes(), graph.number_of_edges()
    freedoms = sum(f for _, _, f in graph.edges(data="freedoms"))
    return int(6 * (links - joints - 1) + freedoms - graph.graph["idle"])


def independent_loops(graph: nx.Graph) -> int:
    """Return the number of independent loops of the chain (its cyclomatic number).

    Parameters
    ----------
    graph : networkx.Graph
        As `kinematic_graph` makes it.

    Returns
    -------
    int
    """
    import networkx as nx

    _check_graph(graph)
    return len(nx.cycle_basis(graph))


def _check_graph(graph: Any) -> None:
    """Raise InvalidInput if `graph` is not a kinematic graph."""
    import networkx as nx

    if not is_a(graph, nx.Graph) or "idle" not in graph.graph:
        wanted = "a graph of gsp.catalogue.kinematic_graph"
        raise InvalidInput(expected("graph", wanted, brief(graph)))
