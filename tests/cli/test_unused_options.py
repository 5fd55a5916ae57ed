"""An option that a command would not use is an error, and is not ignored."""

from __future__ import annotations

import pytest

NAME = "toz-kucuk-2016-d3-6"
SPS = ("workspace", "workspace-6-3", "--angles")
BOX = ("--box", "9:10 -10:-9 137:138 0 0 0")
PLANAR = ("planar", "lee-2000-planar", "--stroke", 0.3, 0.9)


@pytest.mark.parametrize(
    ("words", "option"),
    [
        ((*SPS, "0 0 -5:5", "--position", 0, 0, 1), "--position"),
        ((*SPS, "0 0 -5:5", "--theta", 15), "--theta"),
        ((*SPS, "0 0 -5:5", "--rays", 5), "--rays"),
        ((*SPS, "0 0 0", "--resolution", 1), "--resolution"),
        ((*SPS, "0 0 0", "--rays", 5, "--no-connecting"), "--rays, --no-connecting"),
        ((*SPS, "0 0 0", "--seed", 0), "--seed"),
        (("inverse", NAME, "--order", "ZYX"), "--order"),
        (("show", "D1^6", "--position", 0, 0, 1), "--position"),
        (("show", "D1^6", "--template", NAME), "--template"),
        (("show", "D1^6", "--indices", "CTN"), "--indices"),
        (("show", NAME, "--template", NAME), "--template"),
        (("export", NAME, "--to", "urdf", "--template", NAME), "--template"),
        (("sweep", NAME, "--translate", "z", "--through", "base"), "--through"),
        (("sweep", NAME, "--over", "xy", "--through", "base"), "--through"),
        (("forward", NAME, "--joints", "1 1 1 1 1 1", "--certify"), "--certify"),
        (("rank", NAME, "--template", NAME), "--template"),
        (("rank", NAME, "--indices", "λ", "--length", 5), "--length"),
        (("rank", NAME, "--indices", "CTN", "--ellipsoid", 1, 1, 1), "--ellipsoid"),
        (("sweep", NAME, "--rotate", "z", "--length", 5), "--length"),
        (("sweep", NAME, "--rotate", "z", "--ellipsoid", 1, 1, 1), "--ellipsoid"),
        (("sweep", NAME, "--rotate", "z", "--order", "ZYX"), "--order"),
        (("show", NAME, "--indices", "λ", "--length", 5), "--length"),
        (("show", NAME, "--order", "ZYX"), "--order"),
        (("jacobian", NAME, "--order", "ZYX"), "--order"),
        (("export", NAME, "--to", "urdf", "--order", "ZYX"), "--order"),
        (("export", NAME, "--to", "mjcf", "--speed", 1), "--speed"),
        (("certify", NAME, *BOX, "--length", 5), "--length"),
        (("certify", NAME, *BOX, "--length", 5, "--require", "|det J| >= 1"), "--length"),
        (("workspace", NAME, "--length", 5, "--require", "|det J| >= 1"), "--length"),
        (("workspace", NAME, "--region", "space", "--order", "ZYX"), "--order"),
        (("workspace", NAME, "--angles", "0 0 0", "--stroke", 50, 200, "--seed", 1), "--seed"),
        ((*PLANAR, "--angle", 10, "--starts", 5, "--seed", 1), "--starts, --seed"),
        ((*PLANAR, "--position", 0, 0, "--guess", 0, 0), "--guess"),
        (("catalogue", "--planar", "--class", "6D"), "--class"),
        (("catalogue", "--designs", "--symmetric"), "--symmetric"),
        (("catalogue", "--designs", "--constraint", "D1"), "--constraint"),
        (("catalogue", "--check", "--out", "a.csv"), "--out"),
        (("catalogue", "--write", "--designs"), "--designs"),
    ],
)
def test_an_option_without_use_is_an_error(gsp, tmp_path, words, option):
    assert gsp(*words).error.startswith(f"gsp: {option}: ")
    assert list(tmp_path.iterdir()) == []


def test_the_message_states_what_is_expected_and_what_came(gsp):
    swept = gsp("sweep", NAME, "--over", "xy", "--through", "base").error
    assert (
        swept == "gsp: --through: not used beside --over: expected --rotate, whose axis it places"
    )
    found = gsp("forward", NAME, "--joints", "1 1 1 1 1 1", "--certify").error
    assert found.startswith("gsp: --certify: not used beside a guess: expected --all")
    turned = gsp("show", NAME, "--order", "xxx").error
    assert turned.endswith("a pose without --angles: expected both or neither")


def test_options_that_exclude_each_other(gsp):
    assert "received both" in gsp("catalogue", "--planar", "--designs").error
    assert "received both" in gsp("catalogue", "--check", "--write").error


def test_the_plane_of_exact_arcs_contains_the_position(gsp):
    """Planes y = 0 and y = 1e3: the second is outside of the workspace."""
    words = (*SPS, "0 0 -30")
    here, same, far = (
        gsp(*words, *at) for at in ((), ("--position", 5, 0, 7), ("--position", 0, 1e3, 0))
    )
    assert here.out == same.out
    assert "; 0 arcs" not in here.out
    assert "; 0 arcs" in far.out


def test_radii_whose_squares_overflow_are_refused(gsp):
    assert gsp("workspace", "workspace-6-3", "--radius", 1e300).error.startswith("gsp: --radius: ")


def test_the_order_of_a_section_is_that_of_its_angles(gsp):
    """Of any orientation: the angles of its bifurcation points, so that it is not refused."""
    words = ("workspace", "workspace-6-3", "--rays", 1, "--starts", 1, "--no-connecting")
    assert gsp(*words).out != gsp(*words, "--order", "ZYX").out
