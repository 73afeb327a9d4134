"""Public names of pages whose parts are loaded at first use."""

from __future__ import annotations

import ast
from pathlib import Path


def names_of_stub(page: str) -> dict[str, str]:
    """Module of each public name of a page, as the stub of the page imports it.

    The stub ``__init__.pyi`` is the only list of the names: editors and type checkers read it, and
    so does the page when it is imported.

    Parameters
    ----------
    page : str
        Path of the page, its ``__file__``.

    Returns
    -------
    dict of str to str
        Module by name.
    """
    stub = ast.parse(Path(page).with_suffix(".pyi").read_text(encoding="utf-8"))
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    names = ((alias, node.module or "") for node in imports for alias in node.names)
    return {alias.name: module for alias, module in names if alias.asname}
