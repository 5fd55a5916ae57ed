"""The compiled backend against numpy, element by element."""

import numpy as np
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms

EPS = np.finfo(float).eps
NAMES = (
    "condition_number",
    "minimum_singular_value",
    "manipulability",
    "quality_index",
    "condition_number_ellipsoid",
    "control_number",
)
TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
GIVEN = {"length": 95.0, "maximum": 1e6, "ellipsoid": gsp.Ellipsoid([50, 40, 30], [3, 2, 10])}


def both(design, pose, names=NAMES, **given):
    given = {**GIVEN, "workers": 1, **given}
    return tuple(
        gsp.evaluate(design, pose, names, backend=backend, **given)
        for backend in ("compiled", "numpy")
    )


def conditions(frame):
    """Condition of the problem that each index belongs to."""
    with np.errstate(divide="ignore"):
        own = {
            "condition_number_ellipsoid": frame["condition_number_ellipsoid"],
            "control_number": 1 / frame["control_number"],
        }
    return np.array([own.get(name, frame["condition_number"]) for name in frame])


def check_agreement(fast, plain, factor=10.0):
    assert (fast.isna() == plain.isna()).all(axis=None)
    a, b, condition = fast.to_numpy().T, plain.to_numpy().T, conditions(plain)
    with np.errstate(invalid="ignore"):
        allowed = np.maximum(1e-13, factor * EPS * condition) * np.abs(b)
        close = (a == b) | np.isnan(a) | (np.abs(a - b) <= allowed)
    assert close.all(), np.argwhere(~close)


@pytest.mark.parametrize("mechanism", mechanisms()[::7], ids=str)
def test_backends_agree_on_the_catalogue(mechanism):
    check_agreement(*both(instantiate(mechanism, TEMPLATE), BOX.sample(60, rng=1)))


def test_backends_agree_where_postures_are_nearly_singular():
    design = instantiate(gsp.catalogue.mechanism("D1^6"), TEMPLATE)
    flat = design.replace(base_points=design.base_points * [1, 1, 0])
    heights = np.geomspace(1e-13, 100, 60)  # singular where the platform lies in the base
    position = np.stack((3 + 0 * heights, 2 + 0 * heights, heights), axis=1)
    fast, plain = both(flat, gsp.Pose(position))
    assert plain["condition_number"].max() > 1e12
    check_agreement(fast, plain)


def test_backends_agree_on_singular_and_undefined_postures():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, 2 * ring, ring)
    coincident = gsp.Design(["D1"] * 6, ring, ring)
    poses = gsp.Pose([[0, 0, 1.0], [0, 0, 0.0]])
    fast, plain = both(design, poses, length=1.0)
    check_agreement(fast, plain)
    assert (fast["manipulability"] == 0).all()
    assert np.isinf(fast["condition_number"]).all()
    fast, plain = both(coincident, poses, length=1.0)
    check_agreement(fast, plain)
    assert fast.iloc[1].isna().all()


def test_parallel_lines_are_undefined_in_both():
    design = instantiate(gsp.catalogue.mechanism("D4^3 A1^3"), TEMPLATE)
    aligned = design.replace(platform_directions=design.base_directions)
    poses = gsp.Pose(
        [[1, 2, 100.0]] * 2, gsp.Pose.from_rpy([0, 0, 0], [[0, 0, 0], [0.1, 0.2, 0.3]]).rotation
    )
    fast, plain = both(aligned, poses)
    check_agreement(fast, plain)
    assert fast.iloc[0].isna().all()
    assert fast.iloc[1].notna().all()


def test_symmetric_postures_agree():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, 2 * ring, np.roll(ring, 1, axis=0))
    turns = gsp.Pose.from_rpy([0, 0, 1.5], np.outer(np.linspace(-1.5, 1.5, 41), [0, 0, 1]))
    check_agreement(*both(design, turns, length=1.0))


@pytest.mark.parametrize("legs", [["D1"] * 8, ["D1", "D2", "D3", "D4", "D1", "D2", "A1"]])
@pytest.mark.parametrize("length", [None, 2.0])
def test_redundant_designs_agree(legs, length):
    rng = np.random.default_rng(7)
    a, b, s, t = rng.normal(size=(4, len(legs), 3))
    design = gsp.Design(legs, 3 * a, b, s, t)
    poses = gsp.Pose.from_rpy(rng.normal((0, 0, 5), size=(50, 3)), rng.normal(size=(50, 3)) / 5)
    names = ("manipulability",) if length is None else NAMES
    fast, plain = both(design, poses, names, length=length)
    if length is None:
        np.testing.assert_allclose(fast, plain, rtol=1e-12)
    else:
        check_agreement(fast, plain, factor=20.0)


def test_an_index_alone_has_the_bits_that_it_has_among_all():
    design, pose = instantiate(mechanisms()[100], TEMPLATE), BOX.sample(100, rng=2)
    together = gsp.evaluate(design, pose, NAMES, **GIVEN)
    for name in NAMES:
        assert gsp.evaluate(design, pose, [name], **GIVEN)[name].equals(together[name])


def test_bits_depend_neither_on_workers_nor_on_neighbours(monkeypatch):
    monkeypatch.setattr("gsp.evaluation.request.POSES_PER_BLOCK", 64)
    design, pose = instantiate(mechanisms()[50], TEMPLATE), BOX.sample(500, rng=3)
    alone = gsp.evaluate(design, pose, NAMES, workers=1, **GIVEN)
    assert gsp.evaluate(design, pose, NAMES, workers=3, **GIVEN).equals(alone)
    backward = gsp.evaluate(design, pose[::-1], NAMES, workers=2, **GIVEN)
    assert (backward.to_numpy()[::-1] == alone.to_numpy()).all()
    assert (
        gsp.evaluate(design, pose[77], NAMES, **GIVEN).to_numpy() == alone.loc[77].to_numpy()
    ).all()


def test_all_indices_can_be_asked_for_with_the_compiled_backend():
    design, pose = instantiate(mechanisms()[0], TEMPLATE), BOX.sample(20, rng=4)
    fast, plain = (gsp.evaluate(design, pose, backend=b, **GIVEN) for b in ("compiled", "numpy"))
    assert list(fast) == list(plain)
    np.testing.assert_allclose(fast, plain, rtol=1e-10, atol=1e-14)


def test_an_unknown_backend_is_an_error():
    with pytest.raises(gsp.GspError, match="backend: expected 'compiled' or 'numpy'"):
        gsp.evaluate(TEMPLATE, TEMPLATE.home, backend="fortran")
