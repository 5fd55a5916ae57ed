"""Without Pinocchio the error states how to install it."""

from __future__ import annotations

import pickle

import pytest

import gsp
from gsp.errors import MissingSoftware


@pytest.mark.parametrize(
    "use",
    [
        lambda design: design.home.to_se3(),
        lambda design: gsp.bridges.to_pinocchio(design, design.home),
        lambda design: gsp.bridges.pinocchio_rates(design, design.home),
    ],
)
def test_missing_pinocchio_is_named_with_its_installation(use, monkeypatch):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    monkeypatch.setattr("gsp.installed.is_installed", lambda module: False)
    with pytest.raises(MissingSoftware, match=r"pinocchio.*conda install -c conda-forge") as error:
        use(design)
    assert str(pickle.loads(pickle.dumps(error.value))) == str(error.value)
