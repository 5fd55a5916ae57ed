"""Films: a design that moves along a path, beside its indices."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

import gsp
from gsp.errors import InvalidInput, MissingSoftware, UnwritableOutput
from tests.plots.ink import assert_ink

LIFT = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
TURN = gsp.sweeps.turn(LIFT.home, "z", np.linspace(-90.0, 90.0, 7))


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def rods(figure) -> np.ndarray:
    """Lengths of the thin rods of the legs."""
    lines = [line for line in figure.axes[0].lines if line.get_linewidth() == 2.0]
    ends = np.array([np.array(line.get_data_3d()) for line in lines])
    return np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=1)


def test_each_picture_shows_the_design_and_the_index_at_its_pose():
    film = gsp.plots.animate(LIFT, TURN, ["CTN"])
    postures = LIFT.at(TURN.pose)
    values = gsp.indices.control_number(postures)
    for k in range(7):
        film.show(k)
        np.testing.assert_allclose(rods(film.figure), postures.joints[k], rtol=1e-12)
        *_, (x, y) = (line.get_data() for line in film.figure.axes[1].lines)
        np.testing.assert_allclose((x[0], y[0]), (TURN.coordinates["turn_deg"][k], values[k]))
    assert_ink(film.figure)


def test_box_and_scale_are_those_of_all_pictures():
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    path = gsp.sweeps.translation(design.home, "x", [-30.0, 0.0, 30.0])
    film = gsp.plots.animate(design, path)
    (space,) = film.figure.axes

    def box():
        limits = (space.get_xlim(), space.get_ylim(), space.get_zlim())
        return np.array(limits), space.get_position().bounds

    before = box()
    for k in range(3):
        film.show(k)
        for old, new in zip(before, box(), strict=True):
            np.testing.assert_array_equal(old, new)
        places = np.concatenate([np.array(line.get_data_3d()).T for line in space.lines])
        low, high = before[0].T
        assert (places > low).all(), "outside of the box"
        assert (places < high).all(), "outside of the box"


def test_a_longer_path_shows_poses_equally_spaced_with_both_ends():
    film = gsp.plots.animate(LIFT, TURN, frames=4)
    assert film.frames == 4
    for k, pose in enumerate((0, 2, 4, 6)):
        film.show(k)
        joints = LIFT.at(TURN.pose[pose]).joints
        np.testing.assert_allclose(rods(film.figure), joints, rtol=1e-12)


def test_poses_of_a_motion_are_numbered():
    film = gsp.plots.animate(LIFT, TURN.pose, "CTN")
    assert film.frames == 7
    assert film.figure.axes[1].get_xlabel() == "sample"
    assert film.figure.axes[1].get_xlim() == (0.0, 6.0)


def test_axes_of_few_numbered_poses_have_whole_numbers_and_labels_stay_apart():
    film = gsp.plots.animate(LIFT.replace(unit="mm"), TURN.pose[:3], ["CTN", "|det J|"])
    space, *panels = film.figure.axes
    film.figure.draw_without_rendering()
    for ax in panels:
        ticks = ax.get_xticks()
        assert len(ticks) >= 2
        assert (ticks == ticks.round()).all()
        assert space.zaxis.label.get_window_extent().x1 + 10.0 < ax.get_tightbbox().x0


def test_an_index_without_a_value_is_named():
    """λ is undefined, as the design is singular in every pose."""
    design = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    path = gsp.sweeps.translation(gsp.Pose([0.0, 0.0, 1.0]), "z", [0.0, 0.5])
    film = gsp.plots.animate(design, path, "CDN_OE", ellipsoid=gsp.Ellipsoid(1.0))
    film.show(1)
    assert film.figure.axes[1].get_ylabel().startswith("CDN")


def test_files_have_all_pictures_and_last_as_long_as_asked(tmp_path):
    film = gsp.plots.animate(LIFT, TURN, frames=3, seconds=1.5)
    heard = []
    film.save(tmp_path / "a.gif", progress=lambda *at: heard.append(at))
    assert heard == [(1, 3), (2, 3), (3, 3)]
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 3
        shown = []
        for k in range(3):
            picture.seek(k)
            assert picture.info["duration"] == 500
            shown.append(np.array(picture.convert("RGB")).astype(int))
    assert np.abs(shown[0] - shown[1]).max() > 50
    film.save(tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text()
    assert text.count("data:image/png;base64") == 3
    assert not (tmp_path / "a_frames").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.html"]


@pytest.mark.parametrize("number", [7, -1, 1.5, True, None, "0", slice(0, 2), [0, 1]])
def test_numbers_of_no_picture_are_refused(number):
    with pytest.raises(InvalidInput, match="frame: expected"):
        gsp.plots.animate(LIFT, TURN).show(number)


@pytest.mark.parametrize(("seconds", "frames"), [(0.33, 14), (1.15, 7)])
def test_a_gif_lasts_as_long_as_the_film(seconds, frames, tmp_path):
    """Times of pictures are hundredths of a second, and not all equal."""
    path = gsp.sweeps.turn(LIFT.home, "z", np.linspace(0.0, 30.0, frames))
    gsp.plots.animate(LIFT, path, frames=frames, seconds=seconds).save(tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as picture:
        times = []
        for k in range(picture.n_frames):
            picture.seek(k)
            times.append(picture.info["duration"])
    assert len(times) == frames
    assert sum(times) == pytest.approx(1000.0 * seconds)
    assert max(times) - min(times) <= 10


@pytest.mark.parametrize(("seconds", "frames"), [(1e9, 3), (700.0, 3), (0.03, 3), (0.5, 60)])
def test_times_that_a_gif_cannot_state(seconds, frames, tmp_path):
    path = gsp.sweeps.turn(LIFT.home, "z", np.linspace(0.0, 30.0, frames))
    film = gsp.plots.animate(LIFT, path, frames=frames, seconds=seconds)
    with pytest.raises(InvalidInput, match=f"seconds: expected .* for a GIF of {frames} pictures"):
        film.save(tmp_path / "a.gif")
    assert not list(tmp_path.iterdir())


def test_equal_pictures_last_together(tmp_path):
    """They are one picture of the file."""
    film = gsp.plots.animate(LIFT, gsp.Pose([LIFT.home.position] * 3), seconds=655.35)
    film.save(tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 1
        assert picture.info["duration"] == 655350


def test_what_only_indices_use_is_refused_without_them():
    for name, value in (("length", 1.0), ("ellipsoid", gsp.Ellipsoid(1.0)), ("maximum", 3.0)):
        with pytest.raises(InvalidInput, match=f"{name}: expected None for a film without ind"):
            gsp.plots.animate(LIFT, TURN, **{name: value})


def test_a_film_is_not_overwritten_and_needs_a_known_suffix(tmp_path, monkeypatch):
    film = gsp.plots.animate(LIFT, TURN, frames=2)
    (tmp_path / "a.gif").write_text("mine")
    with pytest.raises(UnwritableOutput, match=r"a\.gif"):
        film.save(tmp_path / "a.gif")
    assert (tmp_path / "a.gif").read_text() == "mine"
    with pytest.raises(InvalidInput, match=r"a name ending in \.gif, \.html, \.mp4"):
        film.save(tmp_path / "a.png")
    monkeypatch.setattr("matplotlib.animation.writers.is_available", lambda name: name != "ffmpeg")
    with pytest.raises(MissingSoftware, match=r"ffmpeg.*write \.gif or \.html"):
        film.save(tmp_path / "a.mp4")


def test_jupyter_shows_the_player_and_not_its_figure_besides():
    film = gsp.plots.animate(LIFT, TURN, frames=2)
    assert plt.fignum_exists(film.figure.number)
    assert film._repr_html_().count("data:image/png;base64") == 2
    assert not plt.get_fignums()


@pytest.mark.parametrize(
    ("path", "message"),
    [
        (gsp.sweeps.plane(LIFT.home, [0.0, 0.1], [0.0, 0.1]), "along one line"),
        (LIFT.home, "along one line"),
        (TURN.pose[:1], "along one line"),
        ("turn", r"a path of gsp\.sweeps, or a batch of poses"),
    ],
)
def test_what_is_no_motion_is_refused(path, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.plots.animate(LIFT, path)
