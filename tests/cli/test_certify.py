"""`gsp certify`: exit status, and the pose that refutes."""

from __future__ import annotations

import shlex

import pytest

import gsp as library

NAME = "toz-kucuk-2016-d3-6"
DESIGN = library.catalogue.design(NAME)
SMALL = "5:15 -15:-5 133:143 0:8 -8:0 -12:-8"


def test_proven(gsp, tmp_path):
    done = gsp("certify", NAME, "--box", SMALL, "--require", "CDN_CL <= 100", "--out", "c.json")
    assert done.status == 0
    assert done.out.startswith("proven")
    assert library.proof.read_certificate("c.json").status == "proven"
    again = gsp("certify", NAME, "--box", SMALL, "--out", "c.json")
    assert again.status == 2


def test_refuted_and_the_pose_is_read_by_other_commands(gsp):
    done = gsp("certify", NAME, "--box", SMALL, "--require", "CDN_CL <= 1.5")
    assert done.status == 1
    options = next(x for x in done.out.splitlines() if x.startswith("at ")).split(maxsplit=1)[1]
    words = shlex.split(options)
    shown = gsp("jacobian", NAME, *words)
    assert shown.status == 0
    pose = library.Pose.from_rpy(
        [float(x) for x in words[1:4]], [float(x) for x in words[5:8]], degrees=True
    )
    limits = library.Limits(indices=["CDN_CL <= 1.5"])
    assert not library.feasible(DESIGN, pose, limits)


def test_undecided(gsp):
    wide = "5:15 -15:-5 133:143 -20:20 -20:20 -30:10"
    done = gsp("certify", NAME, "--box", wide, "--budget", 3)
    assert done.status == 3
    assert done.out.startswith("undecided")


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--box", "1:2"], "--box"),
        (["--box", SMALL, "--require", "CDN_CL"], "CDN_CL"),
        (["--box", SMALL, "--strokes"], "--strokes"),
        (["--box", "5 5 133 -200:200 0 0"], "π"),
        (["--box", SMALL, "--singular"], "regular"),
    ],
)
def test_errors(gsp, options, word):
    done = gsp("certify", NAME, *options)
    assert done.status == 2
    assert word in done.err
