"""Read a saved result from its directory."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from tribodyn.cases.load import load_case, run
from tribodyn.study.pipeline.store import MOTIONS, read_stored, readable


def load_result(directory: str | os.PathLike[str]) -> Any:
    """Read a saved result; only the forces along its motion are computed again.

    A planetary stage that an earlier version stored is computed again from its case file.

    Parameters
    ----------
    directory : str or path
        What :meth:`tribodyn.Result.save` or ``tribodyn run`` wrote, of a gear pair or a machine.

    Returns
    -------
    Result or MachineResult
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
        stored, case = read_stored(folder), load_case(folder / "case.toml")
        if "planet" in stored.loads[0].data.coords:  # an earlier version wrote it
            result = run(case)
        elif stored.motion == MOTIONS[0]:
            result = restored_machine(case, stored)
        else:
            result = restored(case, stored)
    vars(result)["_summary"] = stored.summary
    return result
