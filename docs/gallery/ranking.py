"""The 195 mechanisms ranked on one base and platform."""

import numpy as np

import gsp

template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
designs = [gsp.catalogue.instantiate(m, template) for m in gsp.catalogue.mechanisms()]
box = gsp.PoseBox.around(template.home, [20.0] * 3 + [np.deg2rad(10.0)] * 3)
indices = ["condition_number", "control_number", "manipulability"]
table = gsp.rank(designs, box.sample(200, rng=1), indices, length=95.0)
gsp.plots.ranking(table).savefig("ranking.png", dpi=120)
