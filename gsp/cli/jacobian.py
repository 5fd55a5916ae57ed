"""`gsp jacobian`: the inverse Jacobian of a design at one pose."""

from __future__ import annotations

from typing import Annotated

import typer

from gsp.cli.designs import find_design
from gsp.pose import Pose


def jacobian(
    design: Annotated[str, typer.Argument(help="Published design, or a design file.")],
    position: Annotated[tuple[float, float, float], typer.Option(help="Platform origin.")],
    angles: Annotated[
        tuple[float, float, float], typer.Option(help="Roll, pitch, yaw in degrees.")
    ] = (0.0, 0.0, 0.0),
) -> None:
    """Print joint variables and inverse Jacobian of a design at a pose."""
    posture = find_design(design).at(Pose.from_rpy(position, angles, degrees=True))
    print(posture.joints)
    print(posture.jacobian)
