"""The `gsp` command: its list of subcommands, and how errors are printed."""

from __future__ import annotations

import io
import logging
import os
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, NoReturn, cast, get_args

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from gsp.cli import interrupts
from gsp.cli.outputs import pipes
from gsp.errors import GspError, InvalidInput, MissingParameter, UnwritableOutput, brief, expected
from gsp.version import __version__

# Command: module in gsp.cli and object there, and the line of help that `gsp --help` prints.
# A module is imported when its command is called, so that the list imports no other module.
COMMANDS: Mapping[str, tuple[str, str]] = MappingProxyType({
    "rank": (
        "ranking.rank:rank",
        "Rank designs, or the 195 mechanisms of the catalogue, over a sample of poses.",
    ),
    "catalogue": (
        "library.catalogue:catalogue",
        "List the 195 mechanisms, the 16 planar ones, or the published designs.",
    ),
    "show": (
        "design.show:show",
        "Show a mechanism or a design: legs, joints, equations; for a design also its posture.",
    ),
    "jacobian": (
        "design.jacobian:jacobian",
        "Print the joint variables and the inverse Jacobian of a design at a pose.",
    ),
    "forward": (
        "design.kinematics:forward",
        "Find the poses that have given joint values, near a guess, or all of them.",
    ),
    "inverse": ("design.kinematics:inverse", "Print the joint values of poses."),
    "check": (
        "library.check:check",
        "Recompute every published number, and check its verdict.",
    ),
    "workspace": (
        "design.workspace:workspace",
        "Compute a workspace: bifurcation points and boundary curves in a vertical plane.",
    ),
    "export": ("design.export:export", "Write a design as a multibody model, assembled at a pose."),
    "import": (
        "design.tables:import_table",
        "Write a design file from a table of anchor points.",
    ),
    "new": (
        "design.new:new",
        "Write the design file of a hexapod: six legs, anchors in pairs on two circles.",
    ),
    "prove": (
        "library.prove:prove",
        "Compare all joint rates with those of a multibody model, at random dimensions and poses.",
    ),
    "certify": (
        "design.certify:certify",
        "Prove that requirements hold at every pose of a box or a path, or print one that refutes.",
    ),
    "maximum": (
        "design.maximum:maximum",
        "Print the largest |det J| of a design, by which the quality index λ is normalised.",
    ),
    "sweep": (
        "design.sweep:sweep_command",
        "Evaluate indices along a translation or a rotation, or over a plane.",
    ),
    "app": (
        "design.app:app",
        "Serve a page that draws, moves and analyses platforms, until Ctrl-C.",
    ),
    "store": ("library.store:store", "List, export and import the stored maxima of |det J|."),
})  # fmt: skip


# Characters of the longest word of a message, about those of a long path.
LONGEST = 300
# Exit status where the reader of the output is gone.
CLOSED = 1

SETTINGS: Mapping[str, Any] = MappingProxyType(
    {
        "add_completion": False,
        "pretty_exceptions_enable": False,
        "rich_markup_mode": "markdown",
        "context_settings": {"help_option_names": ["-h", "--help"]},
    }
)


class LazyGroup(TyperGroup):
    """A group that imports a command when it is called; `--help` shows one line of each."""

    def resolve_command(
        self, ctx: Any, args: list[str]
    ) -> tuple[str | None, TyperCommand | TyperGroup | None, list[str]]:
        """Return the name, the command itself, and the arguments that are left for it."""
        name, found, rest = super().resolve_command(ctx, args)
        command = None if name is None or found is None else load(name)
        interrupts.raise_in_command()
        return name, command, rest

    def invoke(self, ctx: Any) -> Any:
        """Run a command; Ctrl-C is an exception here, where typer would end without a line."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise typer.Abort from None
        finally:
            interrupts.end_after_command()


def load(name: str) -> TyperCommand | TyperGroup:
    """Return a command of the table, with its options; its module is imported here."""
    module, _, attribute = COMMANDS[name][0].partition(":")
    value = getattr(import_module(f"gsp.cli.{module}"), attribute)
    if not isinstance(value, typer.Typer):
        alone = typer.Typer(**SETTINGS)
        alone.command(name)(value)
        value = alone
    command = cast(TyperCommand | TyperGroup, get_command(value))
    for parameter in command.params:
        _check_digits(parameter)
    return command


def _check_digits(parameter: Any) -> None:
    """Let an option of numbers refuse what only Python reads, such as 1_000, as tables do."""
    from gsp.files.cells import is_ascii_number

    kind = parameter.type_descriptor.annotation
    if not {int, float} & {kind, *get_args(kind)}:
        return
    process = parameter.process_value

    def checked(context: Any, value: Any) -> Any:
        for word in value if isinstance(value, list | tuple) else [value]:
            if isinstance(word, str) and not is_ascii_number(word):
                wanted = "a number in ASCII digits, without underscores"
                raise InvalidInput(expected(parameter.opts[0], wanted, brief(word)))
        return process(context, value)

    parameter.process_value = checked


app = typer.Typer(name="gsp", cls=LazyGroup, **SETTINGS)

for _name, (_, _help) in COMMANDS.items():
    app.command(_name, help=_help)(lambda: None)


@app.callback(invoke_without_command=True)
def gsp(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Generalized Stewart–Gough mechanisms, catalogued and ranked.

    `gsp rank` without arguments ranks the 195 mechanisms of the catalogue.
    """
    if version:
        typer.echo(f"gsp {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def run(arguments: Sequence[str] | None) -> NoReturn:
    """Run the command line and exit: see `gsp.cli.main`.

    Raises
    ------
    KeyboardInterrupt
    """
    _open_streams()
    if arguments is None:
        _clear_environment()
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        with warnings.catch_warnings(), _notices():
            status = app(args=words, prog_name="gsp", standalone_mode=False)
    except (GspError, typer.TyperException) as error:
        print(f"gsp: {printable(_one_line(error, words))}", file=sys.stderr)
        sys.exit(2)
    except typer.Abort:
        raise KeyboardInterrupt from None
    except BrokenPipeError:
        pipes.drop(sys.stdout)
        status = CLOSED
    except OSError as error:
        _fail_on_output(error)
    except MemoryError as error:
        print(f"gsp: not enough memory: {' '.join(str(error).split())}", file=sys.stderr)
        sys.exit(2)
    try:  # the rest of the buffer: a full disk is an error, a closed pipe is not
        sys.stdout.flush()
    except BrokenPipeError:
        pipes.drop(sys.stdout)
    except OSError as error:
        _fail_on_output(error)
    sys.exit((status if isinstance(status, int) else 0) or (CLOSED if pipes.closed() else 0))


def _open_streams() -> None:
    """Replace standard streams that the caller closed, and those that would fail on "λ"."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))
    for stream in (sys.stdout, sys.stderr):  # an old terminal shows "?" instead
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _clear_environment() -> None:
    """Set aside variables with which a command could not print or draw.

    Pictures are written to files, so that no display is needed; lines of 0 letters show nothing.
    """
    os.environ["MPLBACKEND"] = "agg"
    if not os.environ.get("COLUMNS", "1").lstrip("0"):
        del os.environ["COLUMNS"]


class _OnTerminal(logging.Handler):
    """Prints messages as one line on stderr, where that is a terminal, as bars are drawn."""

    def emit(self, record: logging.LogRecord) -> None:
        if sys.stderr.isatty():
            print(f"gsp: {record.getMessage()}", file=sys.stderr)


class _Warnings(logging.Handler):
    """Prints each warning once, as one line on stderr without the place in the code."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.printed: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        self.show(record.getMessage())

    def show(self, message: Warning | str, *_: Any, **__: Any) -> None:
        text = printable(str(message))
        if "glyph" in text.lower():  # matplotlib has several texts for one cause
            text = "the font of the picture does not have a character of its texts: a box is drawn"
        if text not in self.printed:
            self.printed.add(text)
            print(f"gsp: {text}", file=sys.stderr)


@contextmanager
def _notices() -> Iterator[None]:
    """Print what the library logs, and all warnings, for the time of a command."""
    shown = _Warnings()
    warnings.showwarning = shown.show
    log, others, handler = logging.getLogger("gsp"), logging.getLogger("matplotlib"), _OnTerminal()
    level = log.level
    log.addHandler(handler)
    others.addHandler(shown)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.removeHandler(handler)
        others.removeHandler(shown)
        log.setLevel(level)


def _fail_on_output(error: OSError) -> NoReturn:
    """Print that the output could not be written, and exit."""
    what = error.filename or "standard output cannot be written"
    print(f"gsp: {printable(f'{what}: {error.strerror or error}')}", file=sys.stderr)
    pipes.drop(sys.stdout)
    sys.exit(2)


def printable(text: str) -> str:
    r"""Return a message on one line: what would change a terminal is escaped, long words are cut.

    >>> print(printable("a\x1b[31m\nb"), len(printable("a" * 5000)))
    a\x1b[31m b 201
    """
    words = [w if len(w) <= LONGEST else f"{w[:150]}…{w[-50:]}" for w in text.split()]
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(words)
    )


def _one_line(error: GspError | typer.TyperException, words: Sequence[str]) -> str:
    if isinstance(error, GspError):
        text = " ".join(str(error).split()).replace("limits.indices: ", "--require: ")
        if isinstance(error, MissingParameter):  # an argument in Python is an option here
            text = text.replace("expected length=", "expected --length").replace(
                "expected ellipsoid=", "expected --ellipsoid"
            )
        if isinstance(error, UnwritableOutput):
            text = text.replace("may not be overwritten", "--force replaces it")
        return text
    context = getattr(error, "ctx", None)
    text = error.format_message().replace("Value error, ", "")
    invalid = getattr(error.__cause__, "errors", None)
    if callable(invalid):  # of pydantic, whose message does not contain the value
        text = f"{text.rstrip('.')}, received {brief(invalid()[0].get('input'))}"
    # A missing value of an option has no context: the first word is the command then.
    command = f"gsp {words[0]}" if words and words[0] in COMMANDS else "gsp"
    path = context.command_path if context else command
    return " ".join(f"{text} (see {path} --help)".split())
