"""The page of the 6–3 in a real browser: one server and one browser for the tests of a process."""

import asyncio

import pytest

from tests.app import chromium
from tests.app.serving import server
from tests.app.visiting import FACTS, SIX_THREE


@pytest.fixture(scope="session")
def served(tmp_path_factory):
    """The address of a server."""
    with server(tmp_path_factory.mktemp("server"), SIX_THREE) as address:
        yield address


@pytest.fixture(scope="session")
def browsed(tmp_path_factory):
    """The port of a browser."""
    with chromium.launched(tmp_path_factory.mktemp("browser") / "profile") as port:
        yield port


@pytest.fixture
def visit(served, browsed, tmp_path):
    """A function that runs an async function with a tab that shows the 6–3.

    Tabs of other tests have nothing in common with it but the server. It saves files in `tmp_path`.
    """

    async def run(work):
        async with chromium.tabs(browsed, tmp_path) as opened:
            tab = await opened(served, 1366, 768)
            await tab.until(FACTS)
            await work(tab)
            assert tab.errors == []

    return lambda work: asyncio.run(run(work))
