"""Make driven.png: two published machines with drives at the base, drawn by MuJoCo.

MUJOCO_GL must name an offscreen OpenGL (egl or osmesa) before Python starts.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import gsp

NAMES = ("lane-rotary", "lane-modified-paradex")


def main() -> None:
    """Write the picture beside this file."""
    figure, axes = plt.subplots(1, len(NAMES), figsize=(9, 4.0), layout="constrained")
    for ax, name in zip(axes, NAMES, strict=True):
        design = gsp.catalogue.design(name)
        ax.imshow(gsp.bridges.render(design, design.home, width=900, height=900))
        ax.set_title(name, fontsize=14)
        ax.set_axis_off()
    figure.savefig(Path(__file__).with_name("driven.png"), dpi=100)


if __name__ == "__main__":
    main()
