"""Forward kinematics of planar platforms."""

from gsp.kinematics.planar.modes import PlanarModes, planar_forward, planar_modes

__all__ = ["PlanarModes", "planar_forward", "planar_modes"]
