"""Every picture that a command writes shows something within its axes."""

from __future__ import annotations

from pathlib import Path

import pytest

from gsp.plots.common import style
from tests.plots.ink import assert_ink

SWEEP = ("sweep", "toz-kucuk-2016-d3-6", "--steps", 9)
TWO = ("toz-kucuk-2016-d3-6", "toz-kucuk-2016-d1-d2-d3-d4-a1-2")
COMMANDS = {
    "design": ("show", "nawratil-isotropic-3-mu-0", "--plot"),
    "mechanism": ("show", "D1^2 D2 D4 A1^2", "--plot"),
    "plane of a condition number": (*SWEEP, "--over", "xy", "--indices", "CDN_CL", "--plot"),
    "plane of several": (*SWEEP, "--over", "yz", "--indices", "CTN,CDN_CL,σ_min", "--plot"),
    "turn": (*SWEEP, "--rotate", "z", "--indices", "CTN,CDN_CL", "--plot"),
    "translation": (*SWEEP, "--translate", "1,0,1", "--indices", "CTN", "--plot"),
    "two poses": ("sweep", TWO[0], "--steps", 2, "--rotate", "x", "--indices", "CTN", "--plot"),
    "arcs": ("workspace", "workspace-6-3", "--angles", "0 0 -30", "--theta", 15, "--plot"),
}


@pytest.fixture
def inked(monkeypatch):
    """Check each figure before it is written, and list the files."""
    written = []
    save = style.save_figure

    def checked(figure, path, suffix):
        assert_ink(figure)
        written.append(suffix)
        save(figure, path, suffix)

    monkeypatch.setattr(style, "save_figure", checked)
    return written


@pytest.mark.parametrize("name", COMMANDS)
def test_pictures_have_ink(gsp, inked, name):
    result = gsp(*COMMANDS[name], "a.png")
    assert result.status == 0, result.err
    assert inked == [".png"]
    assert Path("a.png").stat().st_size > 1000
    assert "exists already" in gsp(*COMMANDS[name], "a.png").error


@pytest.mark.parametrize("designs", [TWO[:1], TWO, ("D1^6", "D2^6", "D3^6"), ()])
def test_pictures_of_rankings_have_ink(gsp, inked, designs):
    result = gsp("rank", *designs, "--samples", 8, "--out", "a.csv")
    assert result.status == 0, result.err
    assert inked == [".png"]


@pytest.mark.parametrize("suffix", [".svg", ".pdf", ".PNG"])
def test_formats_follow_the_suffix(gsp, inked, suffix):
    assert gsp("show", "D1^6", "--plot", f"a{suffix}").status == 0
    start = {".svg": b"<?xml", ".pdf": b"%PDF", ".PNG": b"\x89PNG"}[suffix]
    assert Path(f"a{suffix}").read_bytes().startswith(start)


@pytest.mark.parametrize("indices", ["CDN", "|det J|", "CDN,CTN"])
def test_a_sweep_without_values_has_a_picture_that_states_it(gsp, tmp_path, inked, indices):
    from gsp.families import lee

    lee.platform_6_6(1.0, 1.7, 1 / 3, 1 / 3).write(tmp_path / "singular.toml")
    arguments = ("--position", 0.1, 0.2, 1.0, "--rotate", "z", "--steps", 5, "--indices", indices)
    result = gsp("sweep", "singular.toml", *arguments, "--plot", "a.png")
    assert result.status == 0, result.err
    assert inked == [".png"]
