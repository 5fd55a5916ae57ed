from types import SimpleNamespace

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.text import Text

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput
from gsp.plots import workspace as figures
from gsp.plots.workspace import notes
from gsp.plots.workspace.curves import CHORDS_PER_STEP, smooth
from gsp.workspace import exact_shells, section, surface
from gsp.workspace.exact.shells import Arc
from tests import campaign
from tests.plots.ink import crossing, overlaps, struck_texts, unseen


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
    places = mapped.curves[0].pose.position[:, 2]
    assert x[::CHORDS_PER_STEP] == pytest.approx(places, rel=0.0, abs=1e-9)
    assert figure is ax.figure


def test_arcs_and_shells(platform):
    shells = exact_shells(platform)
    arcs = shells.section([0, 0, 0], [[0.6, 0.8, 0], [0, 0, 1]])
    ax = figures.arcs(arcs, axes=[[0.6, 0.8, 0], [0, 0, 1]])
    assert ax.get_xlabel() == "along (0.6, 0.8, 0)"
    assert len(ax.lines) == 2 * len(arcs)
    space = figures.shells(shells, planes=3)
    assert len(space.lines) > len(shells.edges())


def test_a_whole_circle_has_no_dot_at_its_end():
    ring = gsp.families.lee.octahedral_3_3(1.0, 1.0)
    wide = [(0.1, 9.0)] * 5 + [(0.5, 1.0)]
    arcs = exact_shells(ring.replace(strokes=wide)).section([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    circles = [arc for arc in arcs if np.allclose(arc.first, arc.last, atol=1e-9)]
    assert circles
    ax = figures.arcs(arcs)
    dots = [line for line in ax.lines if line.get_marker() == "o"]
    assert len(dots) == len(arcs) - len(circles)


def test_a_surface_closes_around_its_axis(platform):
    mapped = surface(platform, [0.0, 0.0, 8.5], rotation=np.eye(3), counts=(6, 5))
    space = figures.surface(mapped)
    (mesh,) = space.collections
    space.figure.canvas.draw()
    assert len(mesh.get_facecolor()) == 6 * (5 - 1)
    limits = np.array([space.get_xlim(), space.get_ylim(), space.get_zlim()])
    points = mapped.points[mapped.maximal]
    assert (points >= limits[:, 0]).all()
    assert (points <= limits[:, 1]).all()


def test_a_section_is_drawn_in_its_own_plane(platform):
    mapped = section(platform, axes=[[0, 1, 0], [0, 0, 1]], rotation=np.eye(3), rays=6)
    ax = figures.section(mapped, unit="mm")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("y [mm]", "z [mm]")
    flat = mapped.curves[0].pose.position[:, 1:]
    drawn = np.transpose(ax.lines[0].get_data())[::CHORDS_PER_STEP]
    assert np.allclose(drawn, flat, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("origin", "plane", "names"),
    [
        ([0, 0, 8.5], [[0, 1, 0], [1, 0, 0]], ("x", "y")),
        ([0, 0, 0], [[0, 0, 1], [0, 1, 0]], ("y", "z")),
        ([0, 0, 0], [[-1, 0, 0], [0, 0, 1]], ("x", "z")),
        ([0, 0, 0], [[0.6, 0.8, 0], [0, 0, 1]], ("along (0.6, 0.8, 0)", "z")),
    ],
)
def test_arcs_are_drawn_in_their_plane(platform, origin, plane, names):
    arcs = exact_shells(platform).section(origin, plane)
    ax = figures.arcs(arcs)
    assert (ax.get_xlabel(), ax.get_ylabel()) == names
    drawn = np.concatenate([np.transpose(line.get_data()) for line in ax.lines[::2]])
    across = np.concatenate([arc.points for arc in arcs]) - np.asarray(origin, dtype=float)
    # Distances in the plane are those in space.
    shift = np.asarray(origin)[[0, 1]] if names == ("x", "y") else 0.0
    lengths = np.linalg.norm(drawn - shift, axis=1)
    assert np.allclose(lengths, np.linalg.norm(across, axis=1), rtol=0.0, atol=1e-9)


def test_labels_of_near_points_do_not_overlap(platform):
    _, ax = plt.subplots(figsize=(6, 6))
    places = np.array([[0.0, 0.0], [0.01, 0.0], [0.0, 0.01], [1.0, 1.0], [1.0, 0.99], [0.5, 0.5]])
    ax.plot(*places.T, "o")
    notes.write(ax, [notes.Note(f"1 0 {i} - 0 1", p[None], "k") for i, p in enumerate(places)])
    assert len(ax.texts) == len(places)
    assert not overlaps(ax)
    assert not struck_texts(ax)


def test_one_text_at_one_place_is_written_once():
    _, ax = plt.subplots(figsize=(6, 6))
    places = np.array([[0.0, 0.0], [1e-9, 0.0], [1.0, 1.0]])
    ax.plot(*places.T, "o")
    notes.write(ax, [notes.Note(text, p[None], "k") for p in places for text in ("1 0", "0 1")])
    assert sorted(text.get_text() for text in ax.texts) == ["0 1", "0 1", "1 0", "1 0"]


def test_labels_are_beside_curves_and_joined_to_far_points():
    """Curves all around a point: its label is beyond them, with a thin line from the point."""
    _, ax = plt.subplots(figsize=(6, 6))
    turns = np.linspace(0.0, 2.0 * np.pi, 200)
    for size in (0.05, 0.1):
        ax.plot(size * np.cos(turns), size * np.sin(turns), color="k")
    ax.set(xlim=(-1.0, 1.0), ylim=(-1.0, 1.0))
    notes.write(ax, [notes.Note("1 0 – – 0 1", np.zeros((1, 2)), "k")])
    (written,) = ax.texts
    ax.figure.canvas.draw()
    box = Text.get_window_extent(written).transformed(ax.transData.inverted())
    corner = np.clip(0.0, [box.x0, box.y0], [box.x1, box.y1])
    assert np.hypot(*corner) > 0.1
    assert written.arrow_patch is not None


def test_labels_of_points_have_the_spaces_of_the_legend(mapped):
    written = {text.get_text() for text in figures.section(mapped).texts}
    assert written == {point.label.replace("-", "–") for point in mapped.bifurcations}


def test_labels_stay_within_the_axes(platform):
    _, ax = plt.subplots(figsize=(5, 5))
    places = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.5, 1.0]])
    ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    notes.write(ax, [notes.Note("10--01", place[None], "k") for place in places])
    assert len(ax.texts) == len(places)
    assert not crossing(ax)


def test_more_labels_than_colours_are_numbered(platform):
    """The number beside each curve is that of the entry of its label, whatever the style."""
    labels = [f"{i:06b}" for i in range(40)]
    turns = np.linspace(0.0, 6.0, 40)
    arcs = [
        Arc(text, np.array([[i, 0.0, 0.0], [i + 0.5, 0.0, 1.0 + t]]))
        for i, (text, t) in enumerate(zip(labels, turns, strict=True))
    ]
    ax = figures.arcs(arcs, axes=[[1, 0, 0], [0, 0, 1]])
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    assert entries == [f"{i + 1}  [{text}]" for i, text in enumerate(labels)]
    middle = {text.get_text(): text.xy for text in ax.texts}
    assert len(middle) == 40
    for i, arc in enumerate(arcs):
        first, last = arc.points[:, [0, 2]]
        share = (np.array(middle[str(i + 1)]) - first) / (last - first)
        assert np.isclose(*share, rtol=0.0, atol=1e-9)
        assert 0.1 < share[0] < 0.9
    few = figures.arcs(arcs[:7], axes=[[1, 0, 0], [0, 0, 1]])
    assert not few.texts


def test_an_empty_workspace_is_an_error_and_no_blank_picture(platform, mapped):
    shells = exact_shells(platform, limits=gsp.Limits(strokes=[(0.01, 0.02)] * 6))
    for draw in (
        lambda: figures.shells(shells),
        lambda: figures.arcs(shells.section([0, 0, 0], [[1, 0, 0], [0, 0, 1]])),
        lambda: figures.arcs([]),
    ):
        with pytest.raises(EmptyWorkspace):
            draw()
    assert not plt.get_fignums()


@pytest.mark.parametrize("wrong", [None, 0, "x", [], [99], np.zeros((2, 3)), object(), {"a": 1}])
def test_invalid_arguments_are_errors(platform, mapped, wrong):
    shells = exact_shells(platform)
    arcs = shells.section([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    calls = [
        lambda: figures.section(wrong),
        lambda: figures.section(mapped, labels=wrong),
        lambda: figures.section(mapped, unit=5 if isinstance(wrong, str) else wrong),
        lambda: figures.arcs(wrong),
        lambda: figures.arcs(arcs, unit=5 if isinstance(wrong, str) else wrong),
        lambda: figures.shells(wrong),
        lambda: figures.shells(shells, planes=wrong),
        lambda: figures.surface(wrong),
    ]
    if wrong is not None:
        calls += [
            lambda: figures.section(mapped, wrong),
            lambda: figures.section(mapped, axes=wrong),
            lambda: figures.section(mapped, curves=wrong),
            lambda: figures.arcs(arcs, wrong),
            lambda: figures.arcs(arcs, axes=wrong),
            lambda: figures.shells(shells, wrong),
        ]
    for call in calls:
        with pytest.raises(InvalidInput):
            call()
    assert not plt.get_fignums()


def test_plane_axes_are_errors_where_axes_in_space_are_needed(platform, mapped):
    plane, space = plt.figure().add_subplot(), plt.figure().add_subplot(projection="3d")
    with pytest.raises(InvalidInput, match="3d"):
        figures.shells(exact_shells(platform), plane)
    with pytest.raises(InvalidInput, match="plane"):
        figures.section(mapped, space)


def vertical(name, **search):
    design = gsp.catalogue.design(name)
    joints = design.at(design.home).joints
    limits = gsp.Limits(strokes=np.stack((0.8 * joints, 1.2 * joints), axis=1))
    plane = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    search = {"rays": 8, "starts": 4, "rng": 0, **search}
    return figures.section(section(design, axes=plane, limits=limits, **search))


@pytest.mark.parametrize(
    ("name", "search"),
    campaign.some(
        [("csus-cdsl", {}), ("rubin-m2-hexapod", {}), ("lee-2000-3-3", {"rays": 4, "starts": 2})], 1
    ),
)
def test_labels_of_sections_cover_neither_each_other_nor_the_frame(name, search):
    ax = vertical(name, **search)
    assert len(ax.texts) > 12
    assert not overlaps(ax)
    assert not struck_texts(ax)
    assert not crossing(ax)
    assert not unseen(ax)


def test_numbers_of_planar_curves_stand_once_beside_them():
    """Curves of one label that coincide in the plane, with other angles, have one number."""
    design = gsp.planar.planar_design("lee-2000-planar").replace(strokes=[(0.3, 0.9)] * 3)
    ax = figures.section(gsp.planar.planar_section(design, rays=8))
    assert not overlaps(ax)
    assert not struck_texts(ax)
    assert not crossing(ax)
    per_point, numbers = 72.0 / ax.figure.dpi, {}
    for text in ax.texts:
        if text.get_text().isdigit():
            place = ax.transData.transform(text.xy) * per_point + text.xyann
            numbers.setdefault(text.get_text(), []).append(place)
    assert len(numbers) > 7
    for places in numbers.values():
        away = np.linalg.norm(np.subtract.outer(places, places).diagonal(axis1=1, axis2=3), axis=-1)
        assert (away[np.triu_indices(len(places), 1)] > 15.0).all()


def test_a_curve_beneath_others_has_no_entry_and_a_dashed_one_above_hides_none():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
    away = [Arc(f"{i}", line + (0.0, 0.0, 1.0 + i)) for i in range(6)]
    frame = [[1, 0, 0], [0, 0, 1]]
    ax = figures.arcs([Arc("a", line), *away, Arc("b", line[::-1])], axes=frame)
    # Eight labels, and the eighth is dashed.
    assert len(ax.get_legend().get_texts()) == 8
    assert not unseen(ax)
    ax = figures.arcs([Arc("a", line), *away[:5], Arc("b", line[::-1])], axes=frame)
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    assert entries == [*(f"[{i}]" for i in range(5)), "[b], [a]"]
    assert not unseen(ax)
    # The entry has the colour of the curve that is seen.
    assert ax.get_legend().legend_handles[-1].get_color() == ax.lines[-2].get_color()
    assert ax.lines[-2].get_xdata() == pytest.approx([1.0, 0.0])


def test_a_curve_half_beneath_each_of_two_others_is_in_neither_entry():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
    half = np.array([0.5, 0.0, 0.5])
    parts = [Arc("b", np.stack((line[0], half))), Arc("c", np.stack((half, line[1])))]
    names = [Arc("x", line), Arc("a", line), *parts]
    ax = figures.arcs(names, axes=[[1, 0, 0], [0, 0, 1]])
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    assert len(entries) == 2
    assert not unseen(ax)


def test_more_labels_than_an_entry_names_are_counted():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
    ax = figures.arcs([Arc(text, line) for text in "abcdef"], axes=[[1, 0, 0], [0, 0, 1]])
    (entry,) = ax.get_legend().get_texts()
    assert entry.get_text() == "[f], [a], [b], [c] and 2 more"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("width", [1.0, 4.0, 0.25])
def test_axes_keep_half_of_the_room_with_long_legends(width):
    """In the direction in which the scales, which are equal, let them fill it."""
    count, (_, ax) = 60, plt.subplots(figsize=(5.2, 5.2), layout="constrained")
    lines = [
        np.array([[x, 0.0, 0.0], [x + width / 9, 0.0, 1.0]]) for x in np.linspace(0, width, count)
    ]
    labelled = [Arc(" ".join(f"{i:06b}"), line) for i, line in enumerate(lines)]
    figures.arcs(labelled, ax, axes=[[1, 0, 0], [0, 0, 1]])
    ax.figure.canvas.draw()
    assert (ax.get_window_extent().size / ax.figure.bbox.size).max() > 0.5
    legend = ax.get_legend().get_window_extent()
    assert (legend.min >= 0.0).all()
    assert (legend.max <= ax.figure.bbox.max).all()
    assert not legend.overlaps(ax.get_window_extent())
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    named = len(entries) - 1
    assert entries[:named] == [f"{i + 1}  [{arc.label}]" for i, arc in enumerate(labelled[:named])]
    assert entries[named] == f"and {count - named} more"
    assert named > 20


def test_the_title_has_its_room_before_labels_are_placed(mapped):
    ax = figures.section(mapped, title="cost in $\nand more")
    assert ax.get_title() == "cost in \\$\nand more"
    assert not crossing(ax)


def test_curves_are_drawn_without_visible_corners():
    """Between its points an arc of radius 2 in 14 steps is drawn to 1e-4 of the radius."""
    angle = np.linspace(0.1, 1.4, 14) ** 1.2
    flat = 2.0 * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    chosen = angle > 0.5
    line, thick = smooth(still_of(14), flat, chosen)
    assert len(line) > 80
    assert np.abs(np.linalg.norm(line, axis=1) - 2.0).max() < 2e-4
    assert line[[0, -1]] == pytest.approx(flat[[0, -1]])
    seen = ~np.isnan(thick[:, 0])
    assert thick[seen] == pytest.approx(line[seen])
    assert np.arctan2(*thick[seen][0][::-1]) == pytest.approx(angle[chosen][0])


def still_of(number):
    """A curve of so many points whose orientation is constant."""
    return SimpleNamespace(pose=SimpleNamespace(rotation=np.tile(np.eye(3), (number, 1, 1))))


def test_points_of_one_label_are_numbered_and_crowds_have_numbers_only():
    assert notes.point_texts([0, 2, 5], ["1 0", "- 1", "1 0"]) == ["1 0 (0)", "- 1", "1 0 (5)"]
    assert notes.point_texts(range(60), list(map(str, range(60)))) == list(map(str, range(60)))
    assert notes.point_texts(range(61), ["1"] * 61) == [f"({i})" for i in range(61)]
    long = "- - 1 1 - - | base cone 1=1 | base cone 3=1"
    assert notes.point_texts([0, 4], ["0 - - - - 0", long]) == ["0 - - - - 0", "(4)"]
