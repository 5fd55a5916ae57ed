"""`gsp app`: the browser tool."""

from __future__ import annotations

from typing import Annotated

import typer

from gsp.catalogue import instantiate
from gsp.catalogue.placement import TEMPLATE
from gsp.cli.inputs.designs import find_design, find_mechanism_or_design
from gsp.cli.inputs.options import Template, refuse_unused
from gsp.cli.outputs.console import say
from gsp.errors import InvalidInput, expected
from gsp.installed import check_installed
from gsp.model.design import Design
from gsp.version import __version__


def app(
    context: typer.Context,
    design: Annotated[
        str,
        typer.Argument(
            help="A mechanism, a published design, or a design file (.toml), shown at first.",
        ),
    ] = TEMPLATE,
    host: Annotated[
        str, typer.Option(help="Address to listen at. Others than 127.0.0.1 are open to a network.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to listen at.", min=1, max=65535)] = 8080,
    template: Template = TEMPLATE,
) -> None:
    """Serve a page that draws, moves and analyses platforms, until Ctrl-C.

    The page is for a browser on the same machine. It loads nothing from the internet. Maxima of
    |det J| that it searches are stored as those of `gsp maximum`.

    **Examples**

    - `gsp app`

    - `gsp app lee-2000-3-3 --port 8090`

    - `gsp app "D1^3 D2^3"`
    """
    found = find_mechanism_or_design(design)
    if isinstance(found, Design):
        refuse_unused(context, ["template"], "a design, which has its own anchors")
    else:
        found = instantiate(found, find_design(template))
    if not host or any(letter.isspace() for letter in host):
        raise InvalidInput(expected("--host", "an address", repr(host)))
    check_installed("nicegui", "the browser tool", "app")
    from gsp.app.server import serve

    say(f"gsp {__version__}", "dim")
    serve(found, host, port, say)
