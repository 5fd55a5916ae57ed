"""A workspace with fixed orientation: spherical shells."""

import numpy as np

import gsp
from gsp.plots import workspace as figures

design = gsp.catalogue.design("workspace-6-3")
shells = gsp.workspace.exact_shells(design, np.eye(3))
ax = figures.shells(shells)
ax.figure.savefig("fixed_orientation.png", dpi=120)
