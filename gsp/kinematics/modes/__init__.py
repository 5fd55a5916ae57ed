"""All assembly modes of designs in space."""

from gsp.kinematics.modes.modes import AssemblyModes, assembly_modes

__all__ = ["AssemblyModes", "assembly_modes"]
