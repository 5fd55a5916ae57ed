"""Forward kinematics, and one pose at a time with little delay."""

from gsp.kinematics.forward import ForwardSolution, forward
from gsp.kinematics.prepared import prepare

__all__ = ["ForwardSolution", "forward", "prepare"]
