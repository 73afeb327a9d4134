"""From a name or a path to a case, to its result, and to a result that was saved."""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.cases.catalogue import all_files
from tribodyn.errors import InputError, Problem
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.store import MOTIONS, as_computed, read_stored, readable

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase


#: Endings of gearbox models of other programs.
_REXS = (".rexs", ".rexsj", ".rexsz", ".rexs.zip", ".rexsj.zip")


def load_case(name_or_path: str | os.PathLike[str]) -> Any:
    """Load a built-in case, a case file, or a gearbox model of another program.

    Parameters
    ----------
    name_or_path : str or path
        Name from :func:`tribodyn.cases`, or path of a TOML file or of a REXS model (``.rexs``,
        ``.rexsj``, ``.rexsz``). A file that has the name of a built-in case is reached as
        ``./name``.

    Returns
    -------
    Case
        A machine, where the file has ``[meshes.NAME]`` or ``[planets.NAME]``; a REXS model of
        another program is one of both.

    Raises
    ------
    InputError
        If there is no such case, or listing every fault of the file.

    Examples
    --------
    >>> load_case("fzg-roughness").operation.torque
    90.0
    """
    return load_changed_case(name_or_path, {})


def load_changed_case(
    name_or_path: str | os.PathLike[str], changes: Mapping[str, object], by: str = ""
) -> Any:
    """Load a case with values changed by dotted key; a REXS model may need some to be a case."""
    path = Path(os.fspath(name_or_path))
    if path.name.lower().endswith(_REXS) and path.is_file():
        from tribodyn.exchange.gearbox import read_rexs
        from tribodyn.exchange.to_machine import case_from_model

        return case_from_model(read_rexs(path), dict(changes), by)
    try:
        case = _load_toml(name_or_path, {})
    except InputError:
        if not changes:
            raise
        return _load_toml(name_or_path, changes, by)  # which may mend the file
    return case.replace(changes, by=by) if changes else case


def _load_toml(
    name_or_path: str | os.PathLike[str], changes: Mapping[str, object], by: str = ""
) -> Any:
    from tribodyn.cases.catalogue import with_known_reasons
    from tribodyn.study.case.read import read_text
    from tribodyn.study.machine.read import read_case
    from tribodyn.validated_files import file_kind

    paths = all_files()
    name = os.fspath(name_or_path)
    path = paths.get(name, Path(name))
    kind = file_kind(path)
    if not name:
        why, remedy = "A case has a name, or is a file", "See: tribodyn cases"
        raise InputError("the name of the case is empty", "argument name_or_path", why, remedy)
    if kind == "directory":
        inner = path / "case.toml"
        remedy = f"Use {inner}" if inner.is_file() else "Give the path of a TOML file"
        raise InputError("this is a directory, not a case file", name, "", remedy)
    if not kind:
        raise InputError(_not_found(name, path, list(paths)))
    if name in paths:
        return read_case(read_text(path), path.name, path.parent, changes, by)
    return with_known_reasons(read_case(read_text(path), name, None, changes, by))


def _not_found(name: str, path: Path, names: list[str]) -> Problem:
    """Name similar built-in cases, and TOML files in the same directory."""
    folder = path.parent
    files = sorted(p.name for p in folder.glob("*.toml")) if folder.is_dir() else []
    similar = difflib.get_close_matches(name, names, n=1)
    similar += [str(folder / n) for n in difflib.get_close_matches(path.name, files, n=1)]
    why = f"Built-in cases: {', '.join(names)}"
    remedy = f'Did you mean "{similar[0]}"?' if similar else "See: tribodyn cases"
    return Problem("no built-in case and no file has this name", name, why, remedy)


def run(case: AnyCase | str | os.PathLike[str], progress: Progress = SILENT) -> Any:
    """Compute a case: a gear pair, a machine of several shafts, or a planetary stage.

    Parameters
    ----------
    case : Case, str or path
        From :func:`tribodyn.load_case`, or what that function takes.
    progress : Progress
        Reports the steps of the run; silent by default.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        If there is no such case, or it cannot be computed.
    ComputationError
        If no steady motion is found.

    Warns
    -----
    ModelWarning
        Everything that the models report, once each; also stored in ``Result.warnings``.

    Examples
    --------
    >>> result = run("fzg-roughness")  # doctest: +SKIP
    """
    from tribodyn.study import run as compute

    ready: Any = load_case(case) if isinstance(case, (str, os.PathLike)) else case
    return compute(ready, progress, stacklevel=3)


def load_result(directory: str | os.PathLike[str]) -> Any:
    """Read a saved result; only the forces along its motion are computed again.

    A planetary stage that an earlier version stored is computed again from its case file.

    Parameters
    ----------
    directory : str or path
        What :meth:`tribodyn.Result.save` or ``tribodyn run`` wrote, of a gear pair or a machine.

    Returns
    -------
    Result
        With the same case, summary, warnings and figures. Of a long transient it has the mesh
        cycles that were stored; the summary is that of the whole run.

    Raises
    ------
    InputError
        If the directory holds no result, or a file is damaged or was changed.

    Examples
    --------
    >>> import tribodyn
    >>> tribodyn.load_result("no-such-result")
    Traceback (most recent call last):
        ...
    tribodyn.errors.InputError: no-such-result: this is no result. There is no such directory. \
Give the directory that tribodyn run or the save method of a result wrote.
    """
    from tribodyn.study.machine.run import restored as restored_machine
    from tribodyn.study.pipeline.run import restored

    folder = Path(directory)
    with readable(folder):
        stored = read_stored(folder)
        case: Any = as_computed(load_case(folder / "case.toml"), stored)
        if "planet" in stored.loads[0].data.coords:  # an earlier version wrote it
            result = run(case)
        elif stored.motion == MOTIONS[0]:
            result = restored_machine(case, stored)
        else:
            result = restored(case, stored)
    vars(result)["_summary"] = stored.summary
    return result
