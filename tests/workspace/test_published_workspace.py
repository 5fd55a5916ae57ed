from gsp.published import check


def test_every_printed_number_has_its_verdict():
    table = check(["Workspace-3", "Workspace-A"])
    assert table["holds"].all()
    assert set(table["verdict"]) == {"reproduced", "misprint"}
