"""A mechanism with all five constraints."""

import gsp

design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
ax = gsp.plots.mechanism(design, design.home)
ax.figure.savefig("mechanism.png", dpi=120)
