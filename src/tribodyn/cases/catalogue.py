"""The built-in cases by name, and those that other packages bring along.

Another package adds a case through the entry-point group ``tribodyn.cases``: the entry point's
name is the case's name, and it loads to the path of a case file.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from importlib.resources import files
from pathlib import Path


def case_files() -> dict[str, Path]:
    """Files of all named cases.

    Returns
    -------
    dict of str to Path
        Built-in cases first.

    Examples
    --------
    >>> case_files()["fzg-roughness"].name
    'fzg-roughness.toml'
    """
    folder = Path(str(files("tribodyn.cases")))
    found = {path.stem: path for path in sorted(folder.glob("*.toml"), key=_name)}
    for entry in entry_points(group="tribodyn.cases"):
        if entry.name not in found:
            found[entry.name] = Path(str(entry.load()))
    return found


def _name(path: Path) -> str:
    return path.stem


def cases() -> dict[str, str]:
    """Names and one-line descriptions of all named cases.

    Returns
    -------
    dict of str to str
        Name to the title of the case.

    Examples
    --------
    >>> "fzg-roughness" in cases()
    True
    """
    import tomllib

    return {
        name: tomllib.loads(path.read_text(encoding="utf-8")).get("title", "")
        for name, path in case_files().items()
    }
