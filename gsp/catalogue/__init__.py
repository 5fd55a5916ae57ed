"""The catalogue: the 195 mechanisms, published designs, and mechanisms on templates."""

from gsp.catalogue.enumeration import mechanism, mechanisms, table
from gsp.catalogue.placement import instantiate
from gsp.catalogue.published import design, design_names, designs
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
    "table",
]
