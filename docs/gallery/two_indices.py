"""Two indices that disagree over a family of hexapods."""

import matplotlib.pyplot as plt
import numpy as np

import gsp
from gsp.families import nawratil

alpha = np.linspace(0.0, np.pi / 6, 61)[:-1]
height = np.linspace(0.01, 1.2, 80)
figure, panels = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
for ax, title, index in (
    (panels[0], "CTN", gsp.indices.control_number),
    (panels[1], "|det J|", gsp.indices.manipulability),
):
    values = nawratil.over_example_set(index, alpha, height)
    gsp.plots.contours(values, np.rad2deg(alpha), height, ax, title=title)
figure.savefig("two_indices.png", dpi=120)
