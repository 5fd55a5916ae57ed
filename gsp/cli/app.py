"""The `gsp` command: its list of subcommands, and how errors are printed."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, NoReturn, cast, get_args

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from gsp.cli import interrupts
from gsp.cli.outputs import pipes, waiting
from gsp.cli.outputs.messages import (
    clear_environment,
    fail_on_output,
    notices,
    one_line,
    printable,
)
from gsp.errors import GspError, InvalidInput, brief, expected
from gsp.version import __version__

# Command: module in gsp.cli and object there, and the line of help that `gsp --help` prints.
# A module is imported when its command is called, so that the list imports no other module.
_COMMANDS = {
    "rank": (
        "ranking.rank:rank",
        "Rank designs, or the 195 mechanisms of the catalogue, over a sample of poses.",
    ),
    "explore": (
        "ranking.explore:explore_command",
        "Evaluate a sample of a space of designs for a task.",
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
    "planar": (
        "design.planar:planar",
        "Map the workspace of a planar platform: boundary, bifurcation points, connecting curves.",
    ),
    "export": ("design.export:export", "Write a design as a multibody model, assembled at a pose."),
    "import": (
        "design.importing:import_file",
        "Write a design file from a table of anchor points, or from a model of another program.",
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
    "tolerance": (
        "design.tolerance:tolerance",
        "Compute what manufacturing errors do to the pose, or to what a task wants.",
    ),
    "calibrate": (
        "design.calibrate:calibrate_command",
        "Find the dimensions and joint zero points of a machine from measurements.",
    ),
    "report": (
        "design.report:report",
        "Write a report of a design: one HTML page that opens offline and can be printed.",
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
}
COMMANDS: Mapping[str, tuple[str, str]] = MappingProxyType(_COMMANDS)


# Exit status where the reader of the output is gone.
OUTPUT_CLOSED = 1

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
    for one in (command, *getattr(command, "commands", {}).values()):
        for parameter in one.params:
            _check_words(parameter)
        _check_files(one)
    return command


def _check_files(command: Any) -> None:
    """Make a command refuse a file that two of its parameters name, before any work is done."""
    from gsp.cli.inputs.files import refuse_same_file

    invoke = command.invoke

    def checked(context: Any) -> Any:
        refuse_same_file(context)
        return invoke(context)

    command.invoke = checked


def _check_words(parameter: Any) -> None:
    """Make a parameter reject what typer takes: numbers such as 1_000, and "" as a path."""
    from gsp.cli.inputs.files import shown_name
    from gsp.files.cells import is_ascii_number

    kind = parameter.type_descriptor.annotation
    kinds = {kind, *get_args(kind)}
    if not {int, float, Path} & kinds:
        return
    process = parameter.process_value
    name = shown_name(parameter)

    def checked(context: Any, value: Any) -> Any:
        for word in value if isinstance(value, list | tuple) else [value]:
            if Path in kinds and word == "":
                raise InvalidInput(expected(name, "the path of a file", brief(word)))
            if Path not in kinds and isinstance(word, str) and not is_ascii_number(word):
                wanted = "a number in ASCII digits, without underscores"
                raise InvalidInput(expected(name, wanted, brief(word)))
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


def _command_of(words: Sequence[str]) -> Any:
    """Return the command that words call, None if they call none."""
    if not words or words[0] not in COMMANDS:
        return None
    command = load(words[0])
    parts = getattr(command, "commands", {})
    return next((parts[word] for word in words[1:] if word in parts), command)


def run(arguments: Sequence[str] | None) -> NoReturn:
    """Run the command line and exit: see `gsp.cli.main`.

    Raises
    ------
    KeyboardInterrupt
    """
    pipes.open_streams(own=arguments is None)
    if arguments is None:
        clear_environment()
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        # The server of the browser tool works until it is stopped.
        waits = arguments is None and words[:1] != ["app"]
        command = words[0] if words and words[0] in COMMANDS else ""
        lines = waiting.lines(command=command) if waits else nullcontext()
        with warnings.catch_warnings(), notices(), lines:
            status = app(args=words, prog_name="gsp", standalone_mode=False)
    except (GspError, typer.TyperException) as error:
        line = one_line(error, words, _command_of(words))
        print(f"gsp: {printable(line)}", file=sys.stderr)
        sys.exit(2)
    except typer.Abort:
        raise KeyboardInterrupt from None
    except BrokenPipeError:
        pipes.drop(sys.stdout)
        status = OUTPUT_CLOSED
    except OSError as error:
        fail_on_output(error)
    except MemoryError as error:
        print(f"gsp: not enough memory: {' '.join(str(error).split())}", file=sys.stderr)
        sys.exit(2)
    try:  # the rest of the buffer: a full disk is an error, a closed pipe is not
        sys.stdout.flush()
    except BrokenPipeError:
        pipes.drop(sys.stdout)
    except OSError as error:
        fail_on_output(error)
    sys.exit((status if isinstance(status, int) else 0) or (OUTPUT_CLOSED if pipes.closed() else 0))
