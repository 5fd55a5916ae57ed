"""Exports in the loaders of other programs: they load, and their loops are closed.

The programs are no dependencies; where one is not installed, its tests are skipped.
"""

import numpy as np
import pytest

import gsp
from gsp.bridges import to_sdf, to_urdf
from gsp.bridges.proof import BOX, random_design

NAMES = (
    "apo-secondary",
    "basic-robotics-small",
    "cheers-hexapod",
    "dehaeze-general",
    "dietmaier-40",
    "lee-2000-3-3",
    "linuxcnc-genhexkins",
    "nawratil-k-plus",
    "rubin-camera-hexapod",
    "toz-kucuk-2016-d1-d2-d3-d4-a1-2",
    "toz-kucuk-2016-d3-6",
    "wolfram-stewart-platform",
)
STEP = 1e-3  # s


def of_class(text):
    """A mechanism of a class, at a pose without any symmetry."""
    rng = np.random.default_rng(6)
    pose = BOX.sample(1, rng=rng)[0]
    return random_design(gsp.catalogue.mechanism(text), rng).replace(home=pose)


CLASSES = ("D1^6", "D1^2 D2^2 D3 A1", "D2 D4^3 A1^2", "D1 D3^2 A1^3")
DESIGNS = {name: gsp.catalogue.design(name) for name in NAMES} | {
    text: of_class(text) for text in CLASSES
}


def written(tmp_path, design):
    tree = to_urdf(design, design.home)
    path = tmp_path / "model.urdf"
    path.write_text(tree.text)
    return tree, str(path)


@pytest.mark.parametrize("name", DESIGNS)
def test_yourdfpy(name, tmp_path):
    program = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed")
    tree, path = written(tmp_path, DESIGNS[name])
    model = program.URDF.load(path)
    assert model.validate()
    for loop in tree.loops:
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = loop.placement.rotation, loop.placement.position
        there = model.get_transform(loop.link_2) @ place
        np.testing.assert_allclose(model.get_transform(loop.link_1), there, atol=1e-9)


def test_drake_refuses_loops_of_sdf_with_its_reason(tmp_path):
    """Why the docs send users of Drake to URDF; a version that reads loops makes this fail."""
    drake = pytest.importorskip("pydrake.all", reason="drake is not installed")
    path = tmp_path / "model.sdf"
    design = DESIGNS["dehaeze-general"]
    path.write_text(to_sdf(design, design.home).text)
    plant = drake.MultibodyPlant(STEP)
    with pytest.raises(RuntimeError, match="loops"):
        read_and_finalized(drake, plant, path)


def read_and_finalized(drake, plant, path):
    drake.Parser(plant).AddModels(str(path))
    plant.Finalize()
