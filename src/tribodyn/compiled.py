"""How compiled kernels are kept on disk: by the content of all their sources."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

__all__ = ["source_digest"]


def source_digest(folder: str | Path, names: Sequence[str]) -> str:
    """Hash of the source files of a kernel and of everything that it calls.

    Numba looks at the file of the cached function alone, and would load a stale one after a
    change in a file that it calls. As a closure variable the hash is part of the cache key.

    Parameters
    ----------
    folder : str or Path
        Directory of the sources.
    names : sequence of str
        Modules in it, without suffix.

    Returns
    -------
    str

    Examples
    --------
    >>> from pathlib import Path
    >>> len(source_digest(Path(__file__).parent, ["compiled"]))
    64
    """
    content = [(Path(folder) / f"{name}.py").read_bytes() for name in names]
    return hashlib.sha256(b"".join(content)).hexdigest()
