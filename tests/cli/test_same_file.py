"""No two parameters of a command may name one file, of which the first would be lost."""

from __future__ import annotations

from enum import EnumType
from itertools import permutations

import pytest

from gsp.cli.app import COMMANDS
from gsp.cli.inputs.files import FILE_METAVARS, is_path, shown_name
from tests.cli.test_app import loaded


def _commands():
    for name in COMMANDS:
        command = loaded(name)
        parts = getattr(command, "commands", {})
        yield from ([([name, key], part) for key, part in parts.items()] or [([name], command)])


def _named(parameter):
    """Whether a parameter may name a file: a path, a design, or a file of numbers."""
    words = (parameter.metavar or "", type(parameter).__name__)
    return is_path(parameter) or any(f in words[0] for f in FILE_METAVARS) or "Argument" in words[1]


def _pairs():
    for words, command in _commands():
        for one, other in permutations([p for p in command.params if _named(p)], 2):
            if is_path(other):
                yield pytest.param(words, command, one, other, id=f"{words}{one.name}-{other.name}")


PAIRS = list(_pairs())


def _given(command, values):
    """The words of a command with these values, and others for what it requires."""
    words, arguments = [], []
    for parameter in command.params:
        if parameter.name not in values and not parameter.required:
            continue
        kind = parameter.type_descriptor.annotation
        first = next(iter(kind)) if isinstance(kind, EnumType) else "0"
        texts = [values[parameter.name]] if parameter.name in values else [first] * parameter.nargs
        if parameter.opts[0].startswith("-"):
            words += [parameter.opts[0], *texts]
        else:
            arguments += texts
    return [*arguments, *words]


@pytest.mark.parametrize(("words", "command", "one", "other"), PAIRS)
def test_a_file_that_two_parameters_name_is_refused_before_the_work(
    gsp, tmp_path, words, command, one, other
):
    file = tmp_path / "z.csv"
    file.write_text("precious")
    (tmp_path / "link").symlink_to(tmp_path, target_is_directory=True)
    for spelling in ("z.csv", "./z.csv", str(file), "link/z.csv"):
        given = _given(command, {one.name: "z.csv", other.name: spelling})
        error = gsp(*words, *given).error
        assert "expected another file than" in error
        assert all(shown_name(p) in error for p in (one, other))
    assert file.read_text() == "precious"


def test_the_pairs_include_what_is_read_and_what_is_written():
    """Some that are known, so that the tests above are not of fewer."""
    pairs = {(*words, one.name, other.name) for words, _, one, other in (p.values for p in PAIRS)}
    assert pairs >= {
        ("planar", "boundary", "out"),
        ("workspace", "plot", "out"),
        ("sweep", "out", "plot"),
        ("check", "out", "page"),
        ("inverse", "poses", "out"),
        ("forward", "joints", "out"),
        ("certify", "times", "out"),
        ("report", "task", "out"),
        ("rank", "designs", "out"),
    }


def test_two_outputs_that_do_not_exist_yet_are_compared(gsp, tmp_path):
    words = ("planar", "lee-2000-planar", "--stroke", 0.3, 0.9, "--angle", 10)
    error = gsp(*words, "--out", "z.csv", "--boundary", "./z.csv").error
    assert error == "gsp: --out: expected another file than --boundary, received z.csv"
    assert list(tmp_path.iterdir()) == []


def test_a_text_that_names_no_file_may_equal_an_output(gsp):
    words = ("new", "--base-radius", 2, "--base-angle", 20, "--platform-radius", 1)
    rest = ("--platform-angle", 20, "--height", 1.5, "--name", "z.toml", "--out", "z.toml")
    assert gsp(*words, *rest).status == 0
    assert gsp(*words, *rest, "--force").status == 0
