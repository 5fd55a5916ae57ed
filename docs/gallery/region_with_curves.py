"""The reachable set in a vertical plane: proven, with the labelled curves on its boundary."""

import gsp
from gsp.plots.workspace import boundary

design = gsp.catalogue.design("workspace-6-3")
region = gsp.workspace.reachable(
    design,
    plane=([0, 0, 0], [[1, 0, 0], [0, 0, 1]]),
    half_space=[0, 0, 1, 0],
    resolution=0.5,
)
ax = boundary(gsp.workspace.boundary_curves(region))
ax.figure.savefig("region_with_curves.png", dpi=120, bbox_inches="tight")
