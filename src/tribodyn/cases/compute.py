"""From a case, its name or its path to a result."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from tribodyn.cases.load import load_case
from tribodyn.progress import SILENT, Progress

if TYPE_CHECKING:
    from tribodyn.study import Case, Result


def run(case: Case | str | os.PathLike[str], progress: Progress = SILENT) -> Result:
    """Compute a case.

    Parameters
    ----------
    case : Case, str or path
        From :func:`tribodyn.load_case`, or what that function takes.
    progress : Progress
        Told how far the run has come; silent by default.

    Raises
    ------
    InputError
        If there is no such case, or it cannot be computed as it stands.
    ComputationError
        If no steady motion is found.

    Warns
    -----
    ModelWarning
        Everything that the models said, once each; also kept in ``Result.warnings``.

    Examples
    --------
    >>> result = run("fzg-roughness")  # doctest: +SKIP
    """
    from tribodyn.study import run as compute

    ready = load_case(case) if isinstance(case, (str, os.PathLike)) else case
    return compute(ready, progress, stacklevel=3)
