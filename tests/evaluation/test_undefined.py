"""A pose without a value does not change the other poses of a batch."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.indices import INDICES

# The first leg has the length 0 at the first pose.
HEXAPOD = gsp.hexapod(2.0, 0.3, 1.0, 0.5, 1.5)
AT = HEXAPOD.base_points[0] - HEXAPOD.platform_points[0]
POSES = gsp.Pose([AT, [0.0, 0.0, 1.5], [0.1, 0.2, 1.4]], np.tile(np.eye(3), (3, 1, 1)))
GIVEN = {"length": 1.0, "ellipsoid": gsp.Ellipsoid([1.0, 1.0, 0.5])}


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
@pytest.mark.parametrize("name", INDICES)
def test_every_index_in_every_table(name, backend):
    how = {"backend": backend, "workers": 1, "progress": False, **GIVEN}
    alone = gsp.evaluate(HEXAPOD, POSES[1:], name, **how)[name]
    table = gsp.evaluate(HEXAPOD, POSES, name, **how)[name]
    assert np.isnan(table.iloc[0])
    np.testing.assert_allclose(table.iloc[1:], alone, rtol=1e-12)
    ranked = gsp.rank([HEXAPOD], POSES, [name], **how)
    assert ranked.loc[0, "undefined"] == pytest.approx(1 / 3)
    assert ranked.loc[0, f"{name}_min"] == pytest.approx(alone.min(), rel=1e-12)
    path = gsp.sweeps.translation(POSES[0], [0.0, 0.0, 1.0], [0.0, 0.1])
    np.testing.assert_array_equal(
        np.isnan(gsp.sweep(HEXAPOD, path, [name], **GIVEN)[name]), [True, False]
    )
