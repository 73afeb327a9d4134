"""A table of rows with names, units and all that made it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.errors import Argument, InputError
from tribodyn.files import atomic_write, check_new
from tribodyn.record import Parts, Record, fact, record
from tribodyn.types import Array, Mask
from tribodyn.validated_files import read_dataset


@record
class DataSet(Record):
    """Rows of a computed table; ``data["mesh_force"]`` is one column.

    Parameters
    ----------
    columns : dict of str to (rows,) array
        Values in SI by name.
    units : dict of str to str
        Their units.
    case : str
        The case that it was computed from, as a case file.
    settings : str
        Arguments of the function that made it, as JSON.
    version : str
        Version of tribodyn that made it.
    """

    columns: dict[str, Array]
    units: dict[str, str]
    case: str = fact(repr=False)
    settings: str = fact()
    version: str = fact()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(next(iter(self.columns.values())).size)

    def __getitem__(self, name: str) -> Array:
        """Return one column."""
        if name not in self.columns:
            remedy = f"It has {', '.join(self.columns)}"
            raise InputError(f'no column "{name}"', "", "", remedy)
        return self.columns[name]

    @with_old_names
    def where(self, mask: Mask) -> DataSet:
        """Return some of the rows.

        Parameters
        ----------
        mask : (rows,) bool array
        """
        columns = {name: values[mask] for name, values in self.columns.items()}
        return DataSet(columns, self.units, self.case, self.settings, self.version)

    def _parts(self) -> Parts:
        parts = super()._parts()
        for name, values in self.columns.items():
            parts.variables[name] = ("row", values, {"units": self.units.get(name, "1")})
        return parts

    def to_parquet(self, path: str | os.PathLike[str]) -> Path:
        """Write a Parquet file, with the origin among its key-value pairs.

        Parameters
        ----------
        path : str or path
            File to write.

        Raises
        ------
        OutputExistsError
            If the file exists.
        InputError
            If pyarrow is not installed.
        """
        try:
            import pyarrow
            import pyarrow.parquet
        except ImportError:
            why, remedy = "It writes Parquet", 'pip install "tribodyn[learn]", or use save()'
            raise InputError("pyarrow is not installed", "", why, remedy) from None
        target = check_new(path, Argument("path"))
        facts = self._parts().attributes | {f"unit of {n}": u for n, u in self.units.items()}
        table = pyarrow.table(self.columns).replace_schema_metadata(
            {name: str(value) for name, value in facts.items()}
        )
        with atomic_write(target) as partial:
            pyarrow.parquet.write_table(table, partial)
        return target

    def __repr__(self) -> str:
        """One line."""
        return f"DataSet({self.rows} rows of {', '.join(self.columns)})"


def load_data(path: str | os.PathLike[str]) -> DataSet:
    """Read a table that :meth:`DataSet.save` wrote.

    Parameters
    ----------
    path : str or path
        The netCDF file.

    Raises
    ------
    InputError
        If the file cannot be read, was changed, or holds no such table.
    """
    data = read_dataset(path)
    facts = {name: str(data.attrs.get(name, "")) for name in ("case", "settings", "version")}
    if not facts["settings"] or "row" not in data.sizes:
        why = "It was not written by the save method of a data set"
        raise InputError(f"{path} holds no data set", Argument("path"), why, "Give one")
    columns = {str(name): np.asarray(data[name].values) for name in data.data_vars}
    units = {name: str(data[name].attrs.get("units", "1")) for name in columns}
    return DataSet(columns, units, **facts)
