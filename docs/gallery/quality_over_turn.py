"""The quality index while the platform turns about its vertical axis."""

import numpy as np

import gsp

design = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
best = gsp.determinant.maximum(design, store=False)
path = gsp.sweeps.turn(best.pose, "z", np.linspace(-180.0, 180.0, 721))
ax = gsp.plots.along(gsp.sweep(design, path, maximum=best))
ax.figure.savefig("quality_over_turn.png", dpi=120)
