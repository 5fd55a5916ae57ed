"""Make placements.png: the control number of all placements of the 195 mechanisms.

On the template of TozKucuk2016, over 500 poses around the home pose of its first example.
"""

from pathlib import Path

import numpy as np

import gsp


def main() -> None:
    """Write the picture beside this file."""
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    designs = [
        design
        for mechanism in gsp.catalogue.mechanisms()
        for design in gsp.catalogue.placements(mechanism, template)
    ]
    box = gsp.PoseBox.around(template.home, [20.0] * 3 + [np.deg2rad(10.0)] * 3)
    table = gsp.rank(designs, box.sample(500, rng=0), ["CTN"])
    axes = gsp.plots.ranges(table)
    gsp.plots.save(axes.figure, Path(__file__).with_name("placements.png"), overwrite=True)


if __name__ == "__main__":
    main()
