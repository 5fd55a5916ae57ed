"""The `gsp` command: its list of subcommands, and how errors are told."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from typing import Annotated, NoReturn

import typer

from gsp.cli.catalogue import catalogue
from gsp.cli.check import check
from gsp.cli.export import export
from gsp.cli.jacobian import jacobian
from gsp.cli.maximum import maximum
from gsp.cli.prove import prove
from gsp.cli.rank import rank
from gsp.cli.show import show
from gsp.cli.store import store
from gsp.cli.sweep import sweep_command
from gsp.cli.workspace import workspace
from gsp.errors import GspError
from gsp.version import __version__

app = typer.Typer(
    name="gsp",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)

for command in (rank, catalogue, show, jacobian, check, workspace, export, prove):
    app.command()(command)
app.command("maximum")(maximum)
app.command("sweep")(sweep_command)
app.add_typer(store)


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


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line on `arguments` (default those of the process), and exit.

    An error is one line on stderr and exit status 2, without a traceback.
    """
    for stream in (sys.stdout, sys.stderr):  # an old terminal shows "?" for λ, and goes on
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        status = app(args=arguments, prog_name="gsp", standalone_mode=False)
    except (GspError, typer.TyperException) as error:
        print(f"gsp: {_one_line(error)}", file=sys.stderr)
        sys.exit(2)
    except typer.Abort:
        print("gsp: stopped", file=sys.stderr)
        sys.exit(130)
    sys.exit(status if isinstance(status, int) else 0)


def _one_line(error: GspError | typer.TyperException) -> str:
    if isinstance(error, GspError):
        return " ".join(str(error).split())
    context = getattr(error, "ctx", None)
    path = context.command_path if context else "gsp"
    return " ".join(f"{error.format_message()} (see {path} --help)".split())
