"""The quality index over translations of an octahedral platform."""

import numpy as np

import gsp

design = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
best = gsp.determinant.maximum(design, store=False)
reach = np.linspace(-2.5, 2.5, 101)
path = gsp.sweeps.plane(best.pose, reach, reach)
ax = gsp.plots.over_plane(gsp.sweep(design, path, maximum=best))
ax.figure.savefig("quality_over_plane.png", dpi=120)
