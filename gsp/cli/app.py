"""The `gsp` command: its list of subcommands, and how errors are told."""

from __future__ import annotations

import sys

import typer

from gsp.cli.check import check
from gsp.cli.export import export
from gsp.cli.jacobian import jacobian
from gsp.cli.prove import prove
from gsp.errors import GspError

app = typer.Typer(
    name="gsp",
    help="Generalized Stewart–Gough mechanisms, catalogued and ranked.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

for command in (jacobian, check, export, prove):
    app.command()(command)


def main() -> None:
    """Run the command line; an error of the library is one line and exit status 2."""
    try:
        app()
    except GspError as error:
        print(f"gsp: {error}", file=sys.stderr)
        sys.exit(2)
