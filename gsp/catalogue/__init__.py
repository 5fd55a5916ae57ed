"""The catalogue: the 195 mechanisms, published designs, and mechanisms on templates."""

from gsp.catalogue.arrangements import placements
from gsp.catalogue.enumeration import mechanism, mechanisms, table
from gsp.catalogue.placement import instantiate, place
from gsp.catalogue.published import design, design_names, designs
from gsp.catalogue.symmetry import symmetries
from gsp.catalogue.topology import independent_loops, kinematic_graph, mobility

__all__ = [
    "design",
    "design_names",
    "designs",
    "independent_loops",
    "instantiate",
    "kinematic_graph",
    "mechanism",
    "mechanisms",
    "mobility",
    "place",
    "placements",
    "symmetries",
    "table",
]
