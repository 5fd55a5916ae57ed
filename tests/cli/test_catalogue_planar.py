import pandas as pd

import gsp as library


def test_planar_platforms(gsp, tmp_path):
    out = gsp("catalogue", "--planar", "--out", "p.csv").out
    assert "16 planar platforms" in out
    assert list(pd.read_csv(tmp_path / "p.csv")["name"]) == list(library.planar.table()["name"])
