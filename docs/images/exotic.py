"""Make exotic.png: three mechanisms on the anchor lines of TozKucuk2016, drawn by MuJoCo.

MUJOCO_GL must name an offscreen OpenGL (egl or osmesa) before Python starts.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import gsp

SOLIDS = gsp.bridges.Solids(radius=4.0)
NAMES = ("D4^3 A1^3", "D2^3 D3^3", "D1 D2 D3 D4 A1^2")


def main() -> None:
    """Write the picture beside this file."""
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    figure, axes = plt.subplots(1, len(NAMES), figsize=(15, 4.0), layout="constrained")
    for ax, name in zip(axes, NAMES, strict=True):
        mechanism = gsp.catalogue.mechanism(name)
        design = gsp.catalogue.instantiate(mechanism, template)
        ax.imshow(gsp.bridges.render(design, design.home, width=1200, height=1000, solids=SOLIDS))
        ax.set_title(f"${mechanism.latex}$", fontsize=18, y=0.9)
        ax.set_axis_off()
    figure.savefig(Path(__file__).with_name("exotic.png"), dpi=80)


if __name__ == "__main__":
    main()
