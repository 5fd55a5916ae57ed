"""Tables whose `attrs` were changed: figures are drawn, or errors are those of the library."""

from __future__ import annotations

from contextlib import suppress

import matplotlib.pyplot as plt
import numpy as np
import pytest

import gsp
from gsp import plots, sweeps
from gsp.errors import GspError, InvalidInput
from tests import campaign

DESIGN = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
STEPS = np.array([0.0, 0.1, 0.2])
WRONG = (5, "x", [None], {"x": None}, {"control_number": 5}, np.ones((2, 2)), object())


def line():
    return gsp.sweep(DESIGN, sweeps.translation(DESIGN.home, "x", STEPS), ["CTN"])


def plane():
    return gsp.sweep(DESIGN, sweeps.plane(DESIGN.home, STEPS, STEPS), ["CTN"])


def ranking():
    return gsp.rank([DESIGN, DESIGN.scaled(2.0)], DESIGN.home, ["CTN", "CDN_CL"], length=1.0)


CALLS = {
    "sweep": (line, plots.sweep),
    "check_sweep": (line, lambda table: sweeps.check_sweep(table, 1)),
    "over_plane": (plane, plots.over_plane),
    "against": (ranking, lambda table: plots.against(table, "CTN", "CDN_CL")),
}


@pytest.mark.parametrize("name", CALLS)
def test_only_errors_of_the_library_are_raised(name):
    make, call = CALLS[name]
    table = make()
    call(table)
    plt.close("all")
    rng = np.random.default_rng(len(name))
    for key in list(table.attrs):
        for i in rng.permutation(len(WRONG))[: campaign.count(3, len(WRONG))]:
            changed = table.copy()
            changed.attrs = {**table.attrs, key: WRONG[i]}
            with suppress(GspError):
                call(changed)
            plt.close("all")


def test_the_error_names_the_entry():
    table = line()
    table.attrs["labels"] = 5
    with pytest.raises(InvalidInput, match=r"attrs\['labels'\] of the table: expected a mapping"):
        plots.sweep(table)
