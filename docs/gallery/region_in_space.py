"""The positions above the base at which the platform turns by ±20° about the vertical."""

import gsp

design = gsp.catalogue.design("workspace-6-3")
turns = gsp.PoseBox([0, 0, 0], [0, 0, (-20, 20)], degrees=True)
region = gsp.workspace.dextrous(design, turns, half_space=[0, 0, 1, 0], resolution=0.6)
ax = region.plot()
ax.figure.savefig("region_in_space.png", dpi=120, bbox_inches="tight")
