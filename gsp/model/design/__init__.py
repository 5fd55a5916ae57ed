"""Designs: legs and where they are anchored, and their TOML form."""

from gsp.model.design.anchored import SETTINGS, AnchoredDesign, check_keywords
from gsp.model.design.designs import Design, check_undriven, design_from_toml, read_design
from gsp.model.design.toml import toml_from_design

__all__ = [
    "SETTINGS",
    "AnchoredDesign",
    "Design",
    "check_keywords",
    "check_undriven",
    "design_from_toml",
    "read_design",
    "toml_from_design",
]
