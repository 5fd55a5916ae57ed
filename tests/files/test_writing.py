"""Files: nothing is lost, nothing is left half written, and errors are named."""

import itertools
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from gsp.errors import MalformedFile, UnwritableOutput
from gsp.files.writing import check_writable, read_text, write_file, write_text


def test_write_and_read(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "größer\nλ\n")
    assert read_text(path) == read_text(str(path)) == "größer\nλ\n"
    assert os.listdir(tmp_path) == ["a.txt"]
    umask = os.umask(0)
    os.umask(umask)
    assert path.stat().st_mode & 0o777 == 0o666 & ~umask


def test_never_overwrites_unless_asked_to(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "one")
    with pytest.raises(UnwritableOutput, match="exists already"):
        write_text(path, "two")
    assert read_text(path) == "one"
    write_text(path, "two", overwrite=True)
    assert read_text(path) == "two"


def test_a_symbolic_link_stays_and_its_file_is_overwritten(tmp_path):
    link, file = tmp_path / "link.txt", tmp_path / "elsewhere" / "a.txt"
    file.parent.mkdir()
    file.write_text("old")
    link.symlink_to(file)
    with pytest.raises(UnwritableOutput, match="exists already"):
        write_text(link, "new")
    assert file.read_text() == "old"
    write_text(link, "new", overwrite=True)
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["a.txt", "elsewhere", "link.txt"]


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("leads_to", ["link.txt", "other.txt"])
def test_a_link_that_leads_to_itself_is_refused_before_the_work_and_stays(
    tmp_path, overwrite, leads_to
):
    link, other = tmp_path / "link.txt", tmp_path / "other.txt"
    link.symlink_to(leads_to)
    other.symlink_to("link.txt")
    for write in (check_writable, lambda p, **given: write_text(p, "x", **given)):
        with pytest.raises(UnwritableOutput, match="received a link that leads to itself"):
            write(link, overwrite=overwrite)
    assert link.is_symlink()
    assert os.readlink(link) == leads_to


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_not_replaced(tmp_path):
    pipe, link = tmp_path / "pipe.txt", tmp_path / "link.txt"
    os.mkfifo(pipe)
    link.symlink_to(pipe)
    for path, overwrite in itertools.product((pipe, link), (False, True)):
        for write in (check_writable, lambda p, **given: write_text(p, "x", **given)):
            with pytest.raises(UnwritableOutput, match="expected a regular file, received a pipe"):
                write(path, overwrite=overwrite)
    assert pipe.is_fifo()
    assert link.is_symlink()


def test_a_link_into_no_folder_is_named_as_it_was_given(tmp_path):
    link = tmp_path / "link.txt"
    link.symlink_to(tmp_path / "none" / "file.txt")
    for write in (check_writable, lambda p, **given: write_text(p, "x", **given)):
        with pytest.raises(UnwritableOutput, match=rf"^{re.escape(str(link))}: "):
            write(link, overwrite=True)


def test_a_link_to_no_file_is_one_that_exists(tmp_path):
    """Else the work would be done before the name is refused."""
    link = tmp_path / "link.txt"
    link.symlink_to("file.txt")
    with pytest.raises(UnwritableOutput, match="exists already"):
        check_writable(link)
    write_text(link, "new", overwrite=True)
    assert link.is_symlink()
    assert (tmp_path / "file.txt").read_text() == "new"


@pytest.mark.parametrize("failure", [KeyboardInterrupt, MemoryError, ValueError])
def test_a_failure_while_writing_loses_nothing(tmp_path, failure):
    path = tmp_path / "a.txt"
    write_text(path, "precious")

    def fill(temporary):
        temporary.write_text("half")
        raise failure

    with pytest.raises(failure):
        write_file(path, fill, overwrite=True)
    assert read_text(path) == "precious"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_an_os_error_while_writing_is_named(tmp_path):
    def fill(temporary):
        raise OSError(28, "No space left on device")

    with pytest.raises(UnwritableOutput, match="No space left on device"):
        write_file(tmp_path / "a.txt", fill)
    assert os.listdir(tmp_path) == []


def test_who_reads_the_old_file_reads_all_of_it(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "one")
    with path.open() as reader:
        write_text(path, "two", overwrite=True)
        assert reader.read() == "one"
    assert read_text(path) == "two"


def test_a_file_that_appears_while_writing_is_not_replaced(tmp_path):
    """Check and naming are one step, so that no file of others is lost between them."""
    path = tmp_path / "a.txt"

    def fill(temporary):
        temporary.write_text("ours")
        path.write_text("theirs")

    with pytest.raises(UnwritableOutput, match="exists already"):
        write_file(path, fill)
    assert read_text(path) == "theirs"
    assert os.listdir(tmp_path) == ["a.txt"]
    write_file(path, fill, overwrite=True)
    assert read_text(path) == "ours"


@pytest.mark.parametrize("taken", [False, True])
def test_file_systems_without_hard_links(tmp_path, monkeypatch, taken):
    def no_link(source, target):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", no_link)
    path = tmp_path / "a.txt"

    def fill(temporary):
        temporary.write_text("ours")
        if taken:
            path.write_text("theirs")

    if taken:
        with pytest.raises(UnwritableOutput, match="exists already"):
            write_file(path, fill)
    else:
        write_file(path, fill)
    assert read_text(path) == ("theirs" if taken else "ours")
    assert os.listdir(tmp_path) == ["a.txt"]


KILLED = """
import os, sys, signal
from gsp.files.writing import write_file
def fill(temporary):
    temporary.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
write_file(sys.argv[1], fill)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs locks of files")
def test_what_a_killed_run_leaves_is_removed_by_the_next(tmp_path):
    path, other = tmp_path / "a.txt", tmp_path / "a.txt.bak"
    for target in (path, path, other):
        assert subprocess.run([sys.executable, "-c", KILLED, str(target)]).returncode == -9
        names = sorted(os.listdir(tmp_path))
        assert [name for name in names if ".gsp-partial-" not in name] == []
        assert all(name.startswith((".a.txt.gsp", ".a.txt.bak.gsp")) for name in names)
    # The second run removed what the first had left; the target beside is left alone.
    assert len(names) == 2
    mine = tmp_path / ".a.txt.gsp-partial-notes"
    mine.write_text("a file of the user's with a similar name")
    write_text(path, "whole")
    left = sorted(os.listdir(tmp_path))
    assert "a.txt" in left
    assert mine.name in left
    assert len(left) == 3
    write_text(other, "whole")
    assert sorted(os.listdir(tmp_path)) == sorted(["a.txt", "a.txt.bak", mine.name])


@pytest.mark.skipif(sys.platform == "win32", reason="needs locks of files")
def test_a_file_that_is_being_written_is_not_taken_for_stale(tmp_path):
    path = tmp_path / "a.txt"

    def slow(temporary):
        temporary.write_text("slow")
        write_text(path, "quick")
        assert read_text(temporary) == "slow"

    write_file(path, slow, overwrite=True)
    assert read_text(path) == "slow"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_long_names(tmp_path):
    path = tmp_path / ("a" * 245 + ".txt")
    write_text(path, "x")
    assert read_text(path) == "x"


def unwritable(tmp_path):
    (tmp_path / "file").write_text("")
    return {
        "folder": (tmp_path, "a folder"),
        "no parent": (tmp_path / "no" / "a.txt", "does not exist"),
        "file as parent": (tmp_path / "file" / "a.txt", "cannot be written|does not exist"),
        "too long": (tmp_path / ("a" * 300), "cannot be written"),
        "null": (str(tmp_path / "a\0b"), "path of a file"),
        "empty": ("", "path of a file"),
        "none": (None, "path of a file"),
        "number": (5, "path of a file"),
        "bytes": (b"a.txt", "path of a file"),
    }


UNWRITABLE = (
    "folder", "no parent", "file as parent", "too long", "null", "empty", "none", "number", "bytes",
)  # fmt: skip


@pytest.mark.parametrize("name", UNWRITABLE)
def test_unwritable(tmp_path, name):
    path, message = unwritable(tmp_path)[name]
    for write in (check_writable, lambda p: write_text(p, "x")):
        with pytest.raises(UnwritableOutput, match=message):
            write(path)


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs a folder that takes no files")
def test_a_folder_that_takes_no_files():
    with pytest.raises(UnwritableOutput):
        write_text("/proc/self/gsp.txt", "x")


@pytest.mark.parametrize("path", ["no-such-file", ".", "a\0b", None, 5, b"x\xff"], ids=repr)
def test_unreadable(path):
    with pytest.raises(MalformedFile, match="expected a readable text file"):
        read_text(path)


def test_not_utf_8(tmp_path):
    path = tmp_path / "latin"
    path.write_bytes("größer".encode("latin-1"))
    with pytest.raises(MalformedFile, match="latin: expected a readable text file"):
        read_text(path)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs /proc")
def test_a_folder_that_takes_no_files_is_found_before_the_work():
    with pytest.raises(UnwritableOutput, match="/proc is not writable"):
        check_writable("/proc/x.csv")


@pytest.mark.parametrize("name", ["\ud800", "a\0b"], ids=ascii)
def test_a_name_that_no_file_has(name):
    with pytest.raises(UnwritableOutput, match="expected the path of a file"):
        check_writable(name)


def test_a_check_leaves_nothing(tmp_path):
    check_writable(tmp_path / "x.csv")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    pipe = tmp_path / "design.toml"
    os.mkfifo(pipe)
    with pytest.raises(MalformedFile, match="expected a regular file, received a pipe or device"):
        read_text(pipe)


ENDING = """
import os, signal, sys
from gsp.files import writing
def end(path):
    path.write_text("part")
    os.kill(os.getpid(), signal.{name})
{before}
writing.write_file(sys.argv[1], end)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_terminated_process_leaves_nothing_and_ends_by_the_signal(tmp_path, name):
    code = ENDING.format(name=name, before=f"signal.signal(signal.{name}, signal.SIG_DFL)")
    words = [sys.executable, "-c", code, str(tmp_path / "a.txt")]
    done = subprocess.run(words, capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (-getattr(signal, name), b"")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_handlers_of_the_caller_stay(tmp_path):
    caught = []
    before = signal.signal(signal.SIGTERM, lambda *_: caught.append(1))
    try:
        handler = signal.getsignal(signal.SIGTERM)
        write_file(tmp_path / "a.txt", lambda p: os.kill(os.getpid(), signal.SIGTERM))
        assert signal.getsignal(signal.SIGTERM) is handler
    finally:
        signal.signal(signal.SIGTERM, before)
    assert caught == [1]
    write_file(tmp_path / "b.txt", lambda p: None)
    assert signal.getsignal(signal.SIGTERM) is before
