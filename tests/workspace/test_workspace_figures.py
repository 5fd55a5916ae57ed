import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pytest

from gsp.plots import workspace as figures
from gsp.workspace import fixed_orientation, section, surface


@pytest.fixture(autouse=True)
def close():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def mapped(platform):
    return section(platform, rotation=np.eye(3), rays=8)


def test_every_curve_is_drawn_and_labelled_once(mapped):
    ax = figures.section(mapped)
    drawn = [line.get_label() for line in ax.lines if line.get_label().startswith("[")]
    assert sorted(drawn) == sorted({f"[{curve.label}]" for curve in mapped.curves})
    written = [text.get_text() for text in ax.texts]
    assert len(written) == len(mapped.bifurcations)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x", "z")


def test_some_curves_on_given_axes_in_another_frame(mapped):
    figure, ax = plt.subplots()
    same = figures.section(mapped, ax, curves=[0], axes=[[0, 0, 1], [1, 0, 0]], labels=False)
    assert same is ax
    assert not ax.texts
    x, _ = ax.lines[0].get_data()
    assert np.array_equal(x, mapped.curves[0].pose.position[:, 2])
    assert figure is ax.figure


def test_arcs_and_shells(platform):
    shells = fixed_orientation(platform)
    arcs = shells.section([0, 0, 0], [[0.6, 0.8, 0], [0, 0, 1]])
    ax = figures.arcs(arcs, axes=[[0.6, 0.8, 0], [0, 0, 1]])
    assert ax.get_xlabel() == "along (0.6, 0.8, 0)"
    assert len(ax.lines) == 2 * len(arcs)
    space = figures.shells(shells, planes=3)
    assert len(space.lines) > len(shells.edges())


def test_a_surface_closes_around_its_axis(platform):
    mapped = surface(platform, [0.0, 0.0, 8.5], rotation=np.eye(3), counts=(6, 5))
    space = figures.surface(mapped)
    (mesh,) = space.collections
    space.figure.canvas.draw()
    assert len(mesh.get_facecolor()) == 6 * (5 - 1)
    limits = np.array([space.get_xlim(), space.get_ylim(), space.get_zlim()])
    points = mapped.points[mapped.certified]
    assert (points >= limits[:, 0]).all()
    assert (points <= limits[:, 1]).all()
