"""The reachable set in a vertical plane, with its bifurcation points."""

import numpy as np

import gsp
from gsp.plots import workspace as figures

design = gsp.catalogue.design("workspace-6-3")
upper = gsp.Limits(position=[None, None, (0.0, None)])
rays = np.deg2rad([20.0, 60.0])
mapped = gsp.workspace.section(
    design,
    limits=upper,
    axes=[[0, 0, 1], [1, 0, 0]],
    rays=rays,
    starts=3,
    rng=1,
)
ax = figures.section(mapped)
ax.figure.savefig("section.png", dpi=120)
