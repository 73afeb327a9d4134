"""A store as one lazy data set: values are read on demand, with a check of their checksum."""

from __future__ import annotations

import io
import os
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.interrupt import deferred
from tribodyn.study.pipeline.summary_figures import in_order
from tribodyn.variants.compute import KINDS
from tribodyn.variants.members import Grid
from tribodyn.variants.store import Manifest, chunk_path, read_chunk

if TYPE_CHECKING:
    import xarray

#: Reason of a member that is not stored yet.
_NOT_YET = "not computed yet"


def open_study(path: str | os.PathLike[str]) -> xarray.Dataset:
    """Open the store of a study as one data set, finished or not.

    Parameters
    ----------
    path : str or path
        Directory that :func:`run_study` or ``tribodyn study`` wrote, or writes at the moment.

    Returns
    -------
    xarray.Dataset
        Figures in SI over the keys of a grid, or over ``member`` with the keys as coordinates, and
        ``failed``, the reason why a member has none. Values are read on demand.

    Raises
    ------
    InputError
        If the directory is not a store; later, if a requested chunk is damaged.
    """
    import xarray

    manifest = Manifest(path)
    layout = manifest.plan.layout
    coords: dict[str, Any] = {}
    if isinstance(layout, Grid):
        dims = {axis.key: len(axis.values) for axis in layout.axes}
        for axis in layout.axes:
            values = np.array(axis.values)
            values = values.astype(object) if values.dtype.kind == "U" else values
            coords[axis.key] = (axis.key, values, {"units": axis.unit or "1"})
    else:
        dims = {"member": layout.count}
    names = (name for facts in manifest.chunks.values() for name in facts["figures"])
    kind = KINDS[manifest.kind]

    def lazy(name: str, kind: object, **facts: str) -> Any:
        return (tuple(dims), _lazy(manifest, name, tuple(dims.values()), kind), facts)

    variables = {
        name: lazy(name, float, units=unit, long_name=meaning)
        for name in in_order(names, kind.figures)
        for unit, meaning in (kind.figure(name),)
    }
    variables |= {name: lazy(name, object) for name in ("failed", "warnings")}
    if not isinstance(layout, Grid):
        for key, unit in layout.units.items():
            coords[key] = lazy(key, np.dtype(layout.kinds[key]), units=unit or "1")
    facts = {**manifest.facts, "keep": ", ".join(manifest.facts["keep"])}
    return xarray.Dataset(variables, coords, facts)


def _lazy(manifest: Manifest, name: str, shape: tuple[int, ...], kind: Any) -> Any:
    """One variable that xarray reads on demand."""
    from xarray.backends import BackendArray
    from xarray.core import indexing

    class Stored(BackendArray):
        def __init__(self) -> None:
            self.shape, self.dtype = shape, np.dtype(kind)

        def __getitem__(self, key: Any) -> Any:
            outer = indexing.IndexingSupport.OUTER
            return indexing.explicit_indexing_adapter(key, shape, outer, self.read)

        def read(self, key: tuple[Any, ...]) -> Any:
            places = [np.arange(size)[each] for size, each in zip(shape, key, strict=True)]
            result_shape = tuple(place.size for place in places if place.ndim)
            grid = np.ix_(*(np.atleast_1d(place) for place in places))
            members = np.ravel_multi_index(grid, shape).ravel()
            values = np.full(prod(result_shape), _absent(name, self.dtype), dtype=self.dtype)
            for chunk, where, rows in manifest.plan.locate(members):
                if chunk.name in manifest.chunks:
                    column = _column(manifest, chunk.name, name)
                    if column is not None:
                        values[where] = column[rows]
            return values.reshape(result_shape)

    return indexing.LazilyIndexedArray(Stored())


def _absent(name: str, dtype: np.dtype[Any]) -> Any:
    """Value of members that are not stored."""
    if dtype.kind == "f":
        return np.nan
    return {"failed": _NOT_YET}.get(name, "" if dtype.kind == "O" else 0)


@deferred()
def _column(manifest: Manifest, chunk: str, name: str) -> Any:
    """One variable of a chunk; None if there is none of that name."""
    import h5py

    content = read_chunk(manifest.folder, chunk, manifest.chunks[chunk])
    if content is None:
        what = f"{chunk_path(manifest.folder, chunk)} does not match its checksum"
        why = "It was damaged, changed or removed"
        remedy = "Run the study again, which computes it again"
        raise InputError(what, Argument("path"), why, remedy)
    with h5py.File(io.BytesIO(content)) as file:
        if name in file:
            column = file[name]
            return column.asstr()[()] if h5py.check_string_dtype(column.dtype) else column[()]
        figures = manifest.chunks[chunk]["figures"]
        return file["value"][:, figures.index(name)] if name in figures else None
