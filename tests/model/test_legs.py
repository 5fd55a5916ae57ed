"""Legs against their joint screws: active and passive rates of all kinds, and of all the 195."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidDesign, MissingParameter
from gsp.model.legs import LEG, LEGS, check_leg
from tests.screws import CHAINS, feet, legs_at, rates
from tests.support import LEG_NAMES, derivative, random_design, random_pose

LENGTH = 0.8


def test_table():
    assert LEG_NAMES == ("D1", "D2", "D3", "D4", "A1", "D4 A1")
    assert {leg.name: leg.chain for leg in LEGS} == CHAINS
    assert ["".join(joint.kind for joint in leg.joints) for leg in LEGS] == [
        leg.chain for leg in LEGS
    ]
    actuators = {"": 0, "slide": 1, "turn": 1, "slide and turn": 2}
    for leg in LEGS:
        assert sum(actuators[joint.active] for joint in leg.joints) == len(leg.constraints)
        assert sum(joint.freedoms for joint in leg.joints) - leg.idle == 6
        assert leg.base_line == (leg.chain[0] == "C")
        assert leg.platform_line == (leg.chain[2] == "C")
        assert leg.cylindrical == ("C" in leg.chain)


def passive_by_leg(posture, length):
    """Our passive rows leg by leg: turns from base (2, 6), from platform (2, 6), slides (j, 6)."""
    names = [leg.name for leg in posture.design.legs]
    order = sorted(range(len(names)), key=lambda i: LEG_NAMES.index(names[i]))
    rows = posture.passive_rates(length)
    result, start = {}, 0
    for i in order:
        slides = CHAINS[names[i]].replace("CCC", "CC").count("C") + (names[i] == "A1")
        block = rows[start : start + 4 + slides]
        result[i] = block[:2], block[2:4], block[4:] * length
        start += 4 + slides
    assert start == len(rows)
    return result


def assert_rates_are_those_of_the_screws(design, pose):
    posture = design.at(pose)
    ours = passive_by_leg(posture, LENGTH)
    active = []
    for i, leg in enumerate(legs_at(design, pose)):
        screws = rates(leg, pose.position)
        active += [screws.active[c.name] for c in design.legs[i].constraints]
        from_base, from_platform, slides = ours[i]
        size = max(1.0, np.abs(screws.from_base).max(), np.abs(screws.slides).max(initial=0.0)) ** 2
        for rows, turns in ((from_base, screws.from_base), (from_platform, screws.from_platform)):
            # Bases of the plane normal to the leg may differ; |u̇|² as a form may not.
            np.testing.assert_allclose(rows.T @ rows, turns.T @ turns, atol=1e-10 * size)
        assert slides.shape == screws.slides.shape
        for row, slide in zip(slides, screws.slides, strict=True):
            np.testing.assert_allclose(row * np.sign(row @ slide), slide, atol=1e-10 * size)
    scale = max(1.0, np.abs(posture.jacobian).max())
    np.testing.assert_allclose(posture.jacobian, active, atol=1e-10 * scale)


@pytest.mark.parametrize("mechanism", gsp.catalogue.mechanisms(), ids=str)
def test_all_mechanisms_against_joint_screws(mechanism):
    rng = np.random.default_rng(list(mechanism.counts))
    legs = [leg.name for leg in mechanism.legs]
    assert_rates_are_those_of_the_screws(random_design(rng, legs), random_pose(rng))


def test_many_random_legs_of_each_kind_against_joint_screws():
    rng = np.random.default_rng(1)
    for _ in range(20):
        legs = rng.permutation(LEG_NAMES * 2)
        assert_rates_are_those_of_the_screws(random_design(rng, legs), random_pose(rng))


def measured_passives(leg, rotation):
    """Unit vector of the leg in base axes and in platform axes, and its sliding coordinates."""
    name, a, s, b, t = leg
    low, high = feet(leg)
    u = (high - low) / np.linalg.norm(high - low)
    chain = CHAINS[name]
    slides = [s @ (low - a)] if chain[0] == "C" else []
    slides += [t @ (high - b)] if chain[2] == "C" else []
    slides += [np.linalg.norm(high - low)] if name == "A1" else []
    return np.concatenate((u, rotation.T @ u, slides))


@pytest.mark.parametrize("name", LEG_NAMES)
def test_passive_rates_are_derivatives_of_measured_feet(name):
    for seed in range(3):
        rng = np.random.default_rng(seed)
        design, pose = random_design(rng, [name] * 6), random_pose(rng)
        ours = passive_by_leg(design.at(pose), LENGTH)

        def measured(q, design=design):
            return np.array([measured_passives(leg, q.rotation) for leg in legs_at(design, q)])

        for i, slopes in enumerate(derivative(measured, pose)):
            from_base, from_platform, slides = ours[i]
            size = max(1.0, np.abs(slopes).max()) ** 2
            for rows, turns in ((from_base, slopes[:3]), (from_platform, slopes[3:6])):
                np.testing.assert_allclose(rows.T @ rows, turns.T @ turns, atol=1e-7 * size)
            for row, slide in zip(slides, slopes[6:], strict=True):
                np.testing.assert_allclose(row * np.sign(row @ slide), slide, atol=1e-7 * size)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_passive_rates_of_batches(shape):
    rng = np.random.default_rng(0)
    design, pose = random_design(rng, LEG_NAMES), random_pose(rng, shape)
    rows = design.at(pose).passive_rates(LENGTH)
    assert rows.shape == (*shape, 6 * 4 + 1 + 1 + 2 + 3 + 2, 6)
    for index in np.ndindex(shape):
        np.testing.assert_allclose(
            rows[index], design.at(pose[index]).passive_rates(LENGTH), rtol=1e-12
        )


def test_ups_legs_need_no_length_and_others_do():
    rng = np.random.default_rng(0)
    pose = random_pose(rng)
    ups = random_design(rng, ["D1"] * 6).at(pose)
    np.testing.assert_array_equal(ups.passive_rates(None), ups.passive_rates(3.0))
    for name in LEG_NAMES[1:]:
        with pytest.raises(MissingParameter, match="length"):
            random_design(rng, [name] * 6).at(pose).passive_rates(None)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("D1", "D1"),
        ("d2", "D2"),
        (" D3 ", "D3"),
        (["D4"], "D4"),
        (("A1", "D4"), "D4 A1"),
        ("A1 D4", "D4 A1"),
        ("D4,A1", "D4 A1"),
        (["d4 a1"], "D4 A1"),
    ],
)
def test_check_leg_reads(text, name):
    assert check_leg(text) is LEG[name]


@pytest.mark.parametrize(
    "text", ["", "D5", "D1 D2", "A1 A1", ["D4", "D4"], None, 7, 1j, [], [""], [None], b"D1", {}]
)
def test_check_leg_raises(text):
    with pytest.raises(InvalidDesign, match=r"leg: expected one of 'D1', .* received"):
        check_leg(text)
