"""Names of 120 letters, in one word or in many, leave axes the size of short names."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest

import gsp
from gsp import plots, sweeps
from gsp.cli.outputs.regions import Files, _save
from tests import campaign

DESIGN = gsp.catalogue.design("workspace-6-3")
LIFT = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
LONG = ("word " * 24)[:120], "x" * 120
MEASURES = {"length": 5.0}


def swept(design, path):
    return gsp.sweep(design, path, ["CTN", "condition_number"], **MEASURES)


def drawn(kind, name):
    """Return the figure of a kind of picture of a design with a name."""
    design = DESIGN.replace(name=name)
    home = design.home
    match kind:
        case "mechanism":
            return plots.mechanism(design).figure
        case "plan view":
            return plots.plan_view(design).figure
        case "line":
            return plots.sweep(swept(design, sweeps.turn(home, "z", [-20.0, 0.0, 20.0])))
        case "plane":
            steps = np.linspace(-1.0, 1.0, 3)
            return plots.sweep(swept(design, sweeps.plane(home, steps, steps)))
        case "arcs":
            arcs = gsp.workspace.exact_shells(design).section([0, 0, 0], np.eye(3)[[0, 2]])
            return plots.workspace.arcs(arcs, title=name).figure
        case "map":
            box = gsp.PoseBox([(-1, 1), 0, (9, 11)], [0, 0, 0])
            found = gsp.workspace.index_map(design, box, (3, 1, 3, 1, 1, 1), ["CTN"], **MEASURES)
            return plots.workspace.index_map(found).figure
        case "modes":
            own = LIFT.replace(name=name)
            return plots.assembly_modes(own, gsp.assembly_modes(own, LIFT.at(LIFT.home).joints))


KINDS = ("mechanism", "plan view", "line", "plane", "arcs", "map", "modes")


def sizes(figure):
    """Return the sizes of all axes of a figure, and of the picture with its margins [inches]."""
    figure.canvas.draw()
    boxes = [ax.get_window_extent().size / figure.dpi for ax in figure.axes]
    picture = figure.get_tightbbox()
    plt.close(figure)
    whole = np.maximum([picture.width, picture.height], figure.get_size_inches())
    return np.array(boxes), whole


@pytest.mark.parametrize("name", LONG, ids=["words", "word"])
@pytest.mark.parametrize("kind", campaign.some(KINDS, 3))
def test_axes_keep_their_size(kind, name):
    axes, picture = sizes(drawn(kind, "short"))
    longer, whole = sizes(drawn(kind, name))
    np.testing.assert_allclose(longer, axes, rtol=0.02)
    assert (whole < 1.1 * picture).all()


def test_the_title_of_a_region_is_wrapped_line_by_line(tmp_path, monkeypatch):
    titles = []
    monkeypatch.setattr(
        "gsp.cli.outputs.regions.save_picture",
        lambda axes, *_, **__: titles.append(axes.get_title()),
    )
    region = gsp.workspace.fixed_orientation(
        DESIGN, plane=([0, 0, 0], np.eye(3)[[0, 2]]), resolution=2.0
    )
    _save(region, Files(plot=tmp_path / "a.png", out=None, force=False), LONG[1] + "\nany", None)
    assert titles[0].split("\n")[:3] == ["x" * 60, "x" * 60, "any"]
