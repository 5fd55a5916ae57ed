"""Plan views: joints at their places with their names, legs with their numbers."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.families import lee

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")

POSES = {
    "lee-3-3": (lee.octahedral_3_3(1.0, 2.0), 1.0),
    "lee-3-6": (lee.platform_3_6(1.0, 2.0, 0.2), 0.6),
    "lee-6-6": (lee.platform_6_6(1.0, 1.0, 0.25, 1 / 6), 7**0.5 / 12),
    "lee-centre": (lee.separated_to_centre(1.0, 2.0, 0.1), 0.95),
    "lee-side": (lee.separated_along_side(1.0, 2.0, 0.1), 0.86),
}


def texts(ax):
    return {t.get_text(): np.array(t.get_position()) for t in ax.texts}


def marks(ax):
    found = [line.get_xydata()[0] for line in ax.lines if line.get_marker() == "o"]
    return np.array(found)


@pytest.mark.parametrize("family", POSES)
def test_joints_and_legs_of_the_families_are_named_and_numbered(family):
    design, h = POSES[family]
    base, platform = lee.joint_names(family)
    pose = gsp.Pose([0.0, 0.0, h])
    ax = gsp.plots.plan_view(design, pose, base_names=base, platform_names=platform)
    shown = texts(ax)
    assert set("123456") <= set(shown)
    assert len(shown) == 6 + len(set(base)) + len(set(platform))
    points = np.concatenate((design.base_points, design.platform_points))[:, :2]
    drawn = marks(ax)
    assert len(drawn) == len(set(base)) + len(set(platform))
    for point in points:
        assert np.abs(drawn - point).sum(axis=1).min() < 1e-12


@pytest.mark.parametrize("family", POSES)
def test_each_name_is_nearest_to_its_own_joint(family):
    design, h = POSES[family]
    base, platform = lee.joint_names(family)
    ax = gsp.plots.plan_view(
        design, gsp.Pose([0.0, 0.0, h]), base_names=base, platform_names=platform
    )
    shown = texts(ax)
    for names, points in ((base, design.base_points), (platform, design.platform_points)):
        for name, point in zip(names, points[:, :2], strict=True):
            label = name if "_" not in name else rf"{name[0]}$_{{\mathrm{{{name[2:]}}}}}$"
            distances = np.linalg.norm(points[:, :2] - shown[label], axis=1)
            assert distances.min() == pytest.approx(np.linalg.norm(point - shown[label]))


def circle(radius, turns):
    angles = np.deg2rad(turns)
    return np.stack((radius * np.cos(angles), radius * np.sin(angles), 0.0 * angles), axis=1)


HEXAGON, EIGHT = np.arange(6) * 60.0, np.arange(8) * 45.0
PAIRS = np.array([-5.0, 5.0, 115.0, 125.0, 235.0, 245.0])
CROWDED = {
    "parallel legs": (circle(1.0, HEXAGON), circle(1.0, HEXAGON)),
    "similar hexagons": (circle(1.0, HEXAGON), circle(0.6, HEXAGON)),
    "one point": (circle(1.0, HEXAGON), np.tile([0.1, 0.0, 0.0], (6, 1))),
    "eight legs": (circle(1.0, EIGHT), circle(0.7, EIGHT + 20.0)),
    "tiny": (circle(1e-6, PAIRS), circle(6e-7, PAIRS[::-1] + 60.0)),
    "huge": (circle(1e6, PAIRS), circle(6e5, PAIRS[::-1] + 60.0)),
}


@pytest.mark.parametrize("name", CROWDED)
def test_names_and_numbers_do_not_cover_each_other(name):
    base, platform = CROWDED[name]
    design = gsp.Design(["D1"] * len(base), base, platform)
    ax = gsp.plots.plan_view(design, gsp.Pose([0.0, 0.0, np.abs(base).max()]))
    ax.figure.canvas.draw()
    renderer = ax.figure.canvas.get_renderer()
    boxes = [text.get_window_extent(renderer) for text in ax.texts]
    assert len(boxes) >= 2 * len(base) + 1
    for i, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:i]), ax.texts[i].get_text()
        assert all(ax.bbox.containsx(x) for x in (box.x0, box.x1))


@pytest.mark.parametrize("name", ["workspace-6-3", "rubin-m2-hexapod", "nawratil-k-plus"])
def test_lines_of_legs_do_not_run_through_names(name):
    design = gsp.catalogue.design(name)
    ax = gsp.plots.plan_view(design)
    ax.figure.canvas.draw()
    legs = [line for line in ax.lines if line.get_linewidth() == 2.0]
    assert len(legs) == design.n_legs
    names = [text for text in ax.texts if not text.get_text().isdigit()]
    assert names
    for line in legs:
        ends = ax.transData.transform(line.get_xydata())
        way = ends[0] + np.linspace(0.0, 1.0, 500)[:, None] * (ends[1] - ends[0])
        for text in names:
            box = text.get_window_extent().padded(-1.0)
            assert not any(box.contains(*point) for point in way), text.get_text()
    plt.close(ax.figure)


def test_joints_close_to_each_other_have_their_own_names():
    platform = circle(0.6, HEXAGON)
    platform[1] = platform[0] + [0.008, 0.0, 0.0]
    design = gsp.Design(["D1"] * 6, circle(1.0, PAIRS), platform)
    assert not any("=" in text for text in texts(gsp.plots.plan_view(design, gsp.Pose([0, 0, 1]))))


def test_joints_at_one_place_share_a_label():
    design = lee.platform_6_6(1.0, 2.0, 0.5, 0.1)
    base, platform = lee.joint_names("lee-6-6")
    ax = gsp.plots.plan_view(
        design, gsp.Pose([0.0, 0.0, 0.5]), base_names=base, platform_names=platform
    )
    joined = [text for text in texts(ax) if "=" in text]
    assert len(joined) == 3
    assert any("A$_" in text and "C$_" in text for text in joined)


def test_legs_run_from_base_to_platform_as_seen_from_above():
    design, h = POSES["lee-3-6"]
    pose = gsp.Pose.from_rpy([0.1, -0.2, h], [0.1, 0.2, 0.5])
    ax = gsp.plots.plan_view(design, pose)
    tops = (pose.position + design.platform_points @ pose.rotation.T)[:, :2]
    legs = [line.get_xydata() for line in ax.lines if line.get_linewidth() == 2.0]
    np.testing.assert_allclose([leg[0] for leg in legs], design.base_points[:, :2], atol=1e-12)
    np.testing.assert_allclose([leg[1] for leg in legs], tops, atol=1e-12)


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, np.pi / 2])
def test_names_of_common_joints_are_inside_of_small_axes(turn):
    base = np.repeat([[np.cos(turn), np.sin(turn), 0.0]], 3, axis=0)
    angles = np.arange(6) * np.pi / 3
    top = np.stack((np.cos(angles), np.sin(angles), 0.0 * angles), axis=1)
    design = gsp.Design(["D1"] * 6, np.concatenate((2.0 * base, -2.0 * base)), top)
    figure, ax = plt.subplots(figsize=(2.4, 2.4))
    gsp.plots.plan_view(design, gsp.Pose([0.0, 0.0, 1.0]), ax)
    figure.canvas.draw()
    for text in ax.texts:
        if "=" in text.get_text():
            seen = text.get_window_extent()
            assert ax.bbox.x0 <= seen.x0
            assert seen.x1 <= ax.bbox.x1
            assert ax.bbox.y0 <= seen.y0
            assert seen.y1 <= ax.bbox.y1
    plt.close(figure)


def test_other_legs_are_drawn_between_their_feet():
    ax = gsp.plots.plan_view(gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2"))
    assert set("12345") <= set(texts(ax))


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ({"design": None}, "design"),
        ({"pose": None}, "pose"),
        ({"pose": gsp.Pose([[0.0, 0.0, 1.0]])}, "pose"),
        ({"pose": 3}, "pose"),
        ({"base_names": ["A"]}, "base_names"),
        ({"platform_names": "ABCDEF"}, "platform_names"),
        ({"platform_names": [1] * 6}, "platform_names"),
        ({"ax": 3}, "ax"),
    ],
)
def test_invalid_arguments_are_errors(arguments, what):
    known = {"design": POSES["lee-3-3"][0], "pose": gsp.Pose([0.0, 0.0, 1.0]), **arguments}
    with pytest.raises(InvalidInput, match=what):
        gsp.plots.plan_view(**known)
