"""λ without a maximum: it is found, and the table records how."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.families import lee
from gsp.indices import quality_index


def test_quality_index_finds_its_maximum():
    design = lee.octahedral_3_3(1.0, 1.3)
    h = float(lee.best_height(1.0, 1.3))
    values = quality_index(design.at(gsp.Pose([[0, 0, h], [0, 0, 2 * h], [0.3, 0.1, h]])))
    expected = [1.0, lee.quality_at_height(2.0), lee.translated_quality(1.0, 1.3, 0.3, 0.1, h)]
    np.testing.assert_allclose(values, expected, rtol=1e-10)


def test_a_design_that_is_always_singular_has_no_quality_index():
    design = lee.platform_3_6(1.0, 2.0, 0.5)
    assert np.isnan(quality_index(design.at(gsp.Pose([0.1, 0.2, 1.0]))))
    frame = gsp.evaluate(design, gsp.Pose([0.1, 0.2, 1.0]), ["quality_index"])
    assert np.isnan(frame.loc[0, "quality_index"])


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
@pytest.mark.parametrize(
    ("ratio", "method", "domain"),
    [(2.0, "closed form", "all poses"), (1.3, "search", "all poses")],
)
def test_evaluate_records_how_the_maximum_was_found(backend, ratio, method, domain):
    design = lee.octahedral_3_3(1.0, ratio)
    pose = gsp.Pose([0.1, 0.2, 1.0])
    frame = gsp.evaluate(design, pose, ["quality_index"], backend=backend)
    facts = frame.attrs["maxima"][design.name]
    assert (facts["method"], facts["domain"]) == (method, domain)
    expected = gsp.evaluate(design, pose, ["quality_index"], maximum=facts["value"])
    assert frame.loc[0, "quality_index"] == pytest.approx(expected.loc[0, "quality_index"])
    assert "maxima" not in expected.attrs
    again = gsp.evaluate(design.replace(), pose, ["quality_index"], backend=backend)
    known = again.attrs["maxima"][design.name]["method"]
    assert known == ("store" if method == "search" else method)


def test_rank_finds_a_maximum_for_each_design_and_states_the_box():
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    designs = [
        gsp.catalogue.instantiate(gsp.catalogue.mechanism(name), template)
        for name in ("D1^6", "D2^3 D3^3")
    ]
    table = gsp.rank(designs, template.home, iter(["quality_index"]))
    assert ((table["quality_index_mean"] > 0) & (table["quality_index_mean"] <= 1)).all()
    facts = table.attrs["maxima"]
    assert facts["D1^6"]["domain"] == "all poses"
    assert set(facts["D2^3 D3^3"]["domain"]) == {"near_home", "centre", "displacement", "angle_deg"}
    for fact in facts.values():
        assert fact["starts"] >= 64
        assert fact["agreed"] >= 1


def test_without_a_name_no_maximum_is_searched():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    assert "quality_index" not in gsp.evaluate(design, design.home)
