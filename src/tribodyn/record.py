"""Base class of results: fields with dimensions and units, and the methods derived from them.

A result is a frozen dataclass created by :func:`record`. Each field is a
:func:`quantity` over named dimensions with a unit, a :func:`fact` that belongs to the whole
result, or a plain field that is not exported. ``to_xarray``, equality, the table in a
notebook, ``save`` and ``plot`` are derived from these declarations.

>>> @record
... class Orders(Record):
...     order: Array = quantity("order", unit="1", axis=True)
...     rms: Array = quantity("order", unit="m")
...     teeth: int = fact()
>>> orders = Orders(np.array([1.0, 2.0]), np.array([3e-6, 1e-6]), 24)
>>> orders.to_xarray().rms.units
'm'
>>> orders
Orders(order: 2, teeth 24)
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from html import escape
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar, dataclass_transform

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import Argument, InputError, did_you_mean
from tribodyn.files import atomic_write, check_new
from tribodyn.nomenclature import QUANTITIES
from tribodyn.types import Tree
from tribodyn.validated_files import write_dataset

T = TypeVar("T")
_KEY = "tribodyn"


class Labels(NamedTuple):
    """How a field is exported."""

    dims: tuple[str, ...]  #: dimensions; empty for a fact
    #: Unit; ``"@name"`` for the one in the field ``name``, None for that of the nomenclature.
    unit: str | None = None
    axis: bool = False  #: a coordinate rather than a variable
    name: str = ""  #: name in the data set, if it differs
    of: str = ""  #: its quantity in the nomenclature, if the name differs


def quantity(
    *dims: str,
    unit: str | None = None,
    axis: bool = False,
    name: str = "",
    of: str = "",
    default: object = MISSING,
    repr: bool = True,
) -> Any:
    """Declare an array over the last of named dimensions, a coordinate if it is an axis."""
    return _field(Labels(dims, unit, axis, name, of), default, repr)


def fact(name: str = "", default: object = MISSING, repr: bool = True) -> Any:
    """Declare a number or a text about the whole result, an attribute of the data set."""
    return _field(Labels((), name=name), default, repr)


def _field(labels: Labels, default: object, repr: bool) -> Any:
    return field(default=default, repr=repr, metadata={_KEY: labels})


@dataclass_transform(
    frozen_default=True, eq_default=False, field_specifiers=(quantity, fact, field)
)
def record(cls: type[T]) -> type[T]:
    """Turn a subclass of :class:`Record` into a frozen dataclass."""
    return dataclass(frozen=True, eq=False, repr=False)(cls)


def labels_of(cls: type[Any]) -> dict[str, Labels]:
    """Labels of the exported fields of a record, by name."""
    return {each.name: each.metadata[_KEY] for each in fields(cls) if _KEY in each.metadata}


def from_parts(kind: type[T], /, *parts: object, **values: object) -> T:
    """Record of some values; its other fields are those of the first part that has them."""
    for name in (each.name for each in fields(kind) if each.name not in values):  # type: ignore[arg-type]
        for part in parts:
            if hasattr(part, name):
                values[name] = getattr(part, name)
                break
    return kind(**values)


class Parts(NamedTuple):
    """Variables, coordinates and attributes of a data set."""

    variables: Tree
    coordinates: Tree
    attributes: Tree

    def over(self, names: tuple[str, str], units: tuple[str, str]) -> Parts:
        """Rename the dimensions ``first`` and ``second``, and set their units."""
        new = dict(zip(("first", "second"), names, strict=True))
        variables = {
            name: (tuple(new.get(dim, dim) for dim in dims), values, labels)
            for name, (dims, values, labels) in self.variables.items()
        }
        axes = {
            new[old]: (new[old], self.coordinates[old][1], {"units": unit})
            for old, unit in zip(new, units, strict=True)
        }
        return Parts(variables, axes, self.attributes)


def figure_method(name: str, text: str) -> Callable[[Any], Any]:
    """Method that draws a result with a registered figure; the text is its docstring."""

    def method(self: object) -> Any:
        return draw(self, name)

    method.__doc__ = f"{text}\n\nReturns\n-------\nplotly.graph_objects.Figure\n"
    return method


class Record:
    """Base class of results: export, display, comparison and figures from the declared fields."""

    #: Variable that ``to_xarray`` returns as a DataArray with its coordinates; empty: a Dataset.
    ARRAY: ClassVar[str] = ""
    #: Properties that are exported in addition to the fields.
    DERIVED: ClassVar[Mapping[str, Labels]] = {}

    def _array_name(self) -> str:
        """Name of the DataArray."""
        return self.ARRAY

    def _labelled(self) -> list[tuple[Field[Any], Labels]]:
        labels = labels_of(type(self))
        return [(each, labels[each.name]) for each in fields(self) if each.name in labels]  # type: ignore[arg-type]

    def _parts(self) -> Parts:
        """Variables, coordinates and attributes of the fields; a subclass may add others."""
        parts = Parts({}, {}, {})
        for name, labels in {**labels_of(type(self)), **self.DERIVED}.items():
            value, exported = getattr(self, name), labels.name or name
            if value is None:
                continue
            if not labels.dims:
                # netCDF has no booleans.
                parts.attributes[exported] = int(value) if isinstance(value, bool) else value
            else:
                place = parts.coordinates if labels.axis else parts.variables
                # xarray would read a tuple as one value.
                values = list(value) if isinstance(value, tuple) else value
                dims = labels.dims[len(labels.dims) - np.ndim(values) :]
                place[exported] = (dims, values, self._attributes(name, labels))
        return parts

    def _attributes(self, name: str, labels: Labels) -> dict[str, str]:
        quantity = QUANTITIES.get(labels.of or name) if labels.unit is None else None
        if quantity is None:
            return self._units(labels.unit)
        return {"units": quantity.unit or "1", "long_name": quantity.meaning}

    def _units(self, unit: str | None) -> dict[str, str]:
        if unit is None:
            return {}
        return {"units": (getattr(self, unit[1:]) or "1") if unit.startswith("@") else unit}

    def _stored(self) -> Parts:
        """Parts of the stored data set; global attributes of a single array become its own."""
        parts = self._parts()
        if not self.ARRAY:
            return parts
        dims, values, labels = parts.variables[self.ARRAY]
        array = {self._array_name(): (dims, values, {**labels, **parts.attributes})}
        return Parts(array, parts.coordinates, {})

    def to_xarray(self) -> Any:
        """Return the result as labelled arrays with units.

        Returns
        -------
        xarray.Dataset or xarray.DataArray
            The fields over their dimensions; facts are attributes.
        """
        import xarray

        data = xarray.Dataset(*self._stored())
        return data[self._array_name()] if self.ARRAY else data

    def to_dataframe(self, over: str = "") -> Any:
        """Return the result as a table over time, phase, order, ...

        Parameters
        ----------
        over : str
            Dimension; by default the one that most variables begin with.

        Returns
        -------
        pandas.DataFrame
            A column for each variable that begins with it, or for each of its values over
            further dimensions: ``force[wheel]``. ``attrs`` has the units by column, and
            ``"left_out"``: variables over other dimensions or with more than 100 columns, which
            :meth:`to_xarray` has.

        Raises
        ------
        InputError
            If no variable begins with the dimension.
        """
        return default_table(self.to_xarray(), over)

    def plot(self, *arguments: Any, **options: Any) -> Any:
        """Draw the result by the figure registered for its class.

        Parameters
        ----------
        *arguments, **options
            Of that figure.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "", *arguments, **options)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the result to a netCDF file, atomically.

        Parameters
        ----------
        path : str or path
            File to write.

        Raises
        ------
        OutputExistsError
            If the file exists.
        """
        target = check_new(path, Argument("path"))
        with atomic_write(target) as partial:
            write_dataset(self._stored(), partial)
        return target

    def __eq__(self, other: object) -> bool:
        """Results are equal when they are of one class and all their fields are equal."""
        if type(other) is not type(self):
            return NotImplemented
        return self is other or _same_fields(self, other)

    def __hash__(self) -> int:
        """Hash of the class and the facts, equal for equal results."""
        facts = (getattr(self, each.name) for each, labels in self._labelled() if not labels.dims)
        return hash((type(self), *(value for value in facts if isinstance(value, str | int))))

    def _sizes(self) -> dict[str, int]:
        sizes: dict[str, int] = {}
        for each, labels in self._labelled():
            sizes |= dict(zip(labels.dims, np.shape(getattr(self, each.name)), strict=False))
        return sizes

    def __repr__(self) -> str:
        """One line with the sizes of the dimensions and the facts."""
        sizes = [f"{name}: {size}" for name, size in self._sizes().items()]
        facts = [
            f"{each.name} {_short(getattr(self, each.name))}"
            for each, labels in self._labelled()
            if not labels.dims and each.repr
        ]
        return f"{type(self).__name__}({', '.join([*sizes, *facts])})"

    def _repr_html_(self) -> str:
        """Table of the fields for notebooks."""
        rows = []
        for each, labels in self._labelled():
            value = getattr(self, each.name)
            unit = self._attributes(each.name, labels).get("units", "")
            cells = (each.name, " x ".join(labels.dims), _short(value), unit)
            rows.append(cells)
        return html_table(repr(self), ("field", "over", "value", "unit"), rows)


#: Most columns of one variable in a table.
_COLUMNS = 100


def default_table(data: Any, over: str = "") -> Any:
    """Table of labelled arrays over a dimension, by default the one that most begin with."""
    import pandas

    if not hasattr(data, "data_vars"):
        data = data.to_dataset()
    firsts = [array.dims[0] for array in data.data_vars.values() if array.dims]
    if not firsts:
        return data.to_dataframe() if data.dims else pandas.DataFrame()
    if over and over not in firsts:
        listed = ", ".join(dict.fromkeys(firsts))
        remedy = did_you_mean(over, firsts, "Choose one of these")
        raise InputError(f'no variable over "{over}"', Argument("over"), f"It has {listed}", remedy)
    over = over or max(dict.fromkeys(firsts), key=lambda dim: (firsts.count(dim), data.sizes[dim]))
    columns: Tree = {}
    units: dict[str, str] = {}
    left_out = []
    for name, array in data.data_vars.items():
        if array.dims[:1] != (over,) or array[0].size > _COLUMNS:
            left_out.append(str(name))
            continue
        labels = [[str(label) for label in array[dim].values] for dim in array.dims[1:]]
        for place in np.ndindex(array.shape[1:]):
            inner = ", ".join(names[i] for names, i in zip(labels, place, strict=True))
            column = f"{name}[{inner}]" if inner else str(name)
            columns[column] = array.values[(slice(None), *place)]
            units[column] = array.attrs.get("units", "")
    along = [name for name in data.coords if data[name].dims == (over,)]
    axis = over if over in along or not along else along[0]
    table = pandas.DataFrame(columns, index=pandas.Index(data[axis].values, name=axis))
    table.attrs = {"units": units, "left_out": left_out}
    return table


def html_table(
    title: str, head: Iterable[str], rows: Iterable[Iterable[Any]], *, closed: bool = False
) -> str:
    """HTML table for notebooks, closed up to a click if wanted; all text is escaped."""

    def line(cells: Iterable[Any], tag: str) -> str:
        return f"<tr>{''.join(f'<{tag}>{escape(str(cell))}</{tag}>' for cell in cells)}</tr>"

    lines = [line(head, "th"), *(line(row, "td") for row in rows)]
    table = f"<table>{''.join(lines)}</table>"
    if closed:
        return f"<details><summary>{escape(title)}</summary>{table}</details>"
    return f"<b>{escape(title)}</b>{table}"


def _same_fields(a: Any, b: Any) -> bool:
    return all(_equal(getattr(a, each.name), getattr(b, each.name)) for each in fields(a))


def _equal(first: object, second: object) -> bool:
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        a, b = np.asarray(first), np.asarray(second)
        numeric = a.dtype.kind in "fc" and b.dtype.kind in "fc"
        return bool(np.array_equal(a, b, equal_nan=numeric))
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return first.keys() == second.keys() and all(
            _equal(first[key], second[key]) for key in first
        )
    if isinstance(first, list | tuple) and isinstance(second, list | tuple):
        return len(first) == len(second) and all(map(_equal, first, second))
    if is_dataclass(first) and type(first) is type(second):
        return _same_fields(first, second)
    return bool(first == second) or (first != first and second != second)


def _short(value: object) -> str:
    """Short text of a value; for an array its range."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu" and value.size:
        if value.size == 1:
            return f"{value.item():.6g}"
        return f"{np.nanmin(value):.5g} to {np.nanmax(value):.5g}"
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
