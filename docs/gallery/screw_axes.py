"""The least controlled screw while a hexapod turns through a singular posture."""

import numpy as np

import gsp
from gsp.families.nawratil.motion import INTERVALS, turned

posture = turned("y", np.linspace(*INTERVALS["y"], 26))
screws = {
    "control number": gsp.instantaneous_motion(posture).axis,
    "linear complex": gsp.instantaneous_motion(posture, "linear_complex").axis,
}
ax = gsp.plots.screw_axes(screws, (0, 2))
ax.figure.savefig("screw_axes.png", dpi=120)
