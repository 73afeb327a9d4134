"""``tribodyn app``."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from tribodyn.cli.console import tell
from tribodyn.cli.settings import Flag
from tribodyn.errors import InputError


def app(
    case: str = "",
    /,
    *,
    folder: Path = Path(),
    host: str = "127.0.0.1",
    port: int = 8050,
    no_browser: Flag = False,
) -> None:
    """Serve a page for the whole job, on this machine alone, until Ctrl-C.

    Parameters
    ----------
    case : str
        Built-in case, or path of a case file in the folder; without it a short one to fill in.
    folder : Path
        Folder that the page reads and writes, and nothing beyond it; by default this one.
    host : str
        Address to serve at. Any but 127.0.0.1 lets other machines reach it, who need the token.
    port : int
        Port to serve at; 0 takes one that is free.
    no_browser : bool
        Write the address only, and open no browser.
    """
    import webbrowser
    from importlib.util import find_spec

    if find_spec("dash") is None:
        why, remedy = "The page is drawn by Dash", 'Install it with pip install "tribodyn[app]"'
        raise InputError("Dash is not installed", "tribodyn app", why, remedy)
    if not 0 <= port <= 65535:
        raise InputError(f"port = {port}", "--port", "Ports are 0 to 65535")
    from tribodyn.app.server import Page

    page = Page(folder, case, host, port)
    tell(f"The page is at {page.address}")
    tell("It belongs to whoever has this address. Ctrl-C ends it.")
    if not no_browser and not webbrowser.open(page.address):
        tell("No browser could be opened: open the address in one yourself.")
    with suppress(KeyboardInterrupt):
        page.serve()
    tell("The page has ended.")
