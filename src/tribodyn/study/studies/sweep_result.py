"""Result of a sweep: the figures of each value, or the reason of its failure."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.aliases import closest, with_old_names
from tribodyn.drawing import draw, write_report_of
from tribodyn.errors import InputError, TribodynError, did_you_mean
from tribodyn.record import Parts, Record, html_table, record
from tribodyn.study.pipeline.save import new_directory
from tribodyn.study.pipeline.summary_figures import figure_of, in_order, in_words
from tribodyn.study.studies.study_axes import Axis
from tribodyn.types import Array, Tree
from tribodyn.validated_files import csv_text, write_dataset

#: Figures in tables and reports, and those added if a key of the film or the oil varies.
_MOTIONS = (
    "rms_mesh_force",
    "peak_mesh_force",
    "peak_to_peak_dynamic_transmission_error",
    "rms_bearing_force_loa_pinion",
    "mean_friction_power",
    "contact_loss_share",
)
_FILMS = ("central_film", "minimum_film_ratio", "mean_friction_coefficient")
#: Figures of the parts of a machine or stage: of all meshes, and of the bearing and the housing
#: node with the largest.
OF_PARTS = (
    "alternating_rms_mesh_force",
    "transmission_error_peak_to_peak",
    "rms_radial_force",
    "rms_acceleration",
    "dynamic_load_factor",
)
_OF_ALL = OF_PARTS[:2]
#: Names of levels in older files.
_OLD_NAMES = {"alternating_rms_mesh_force": "rms_mesh_force"}
#: All of them.
SHOWN = (*_MOTIONS, *_FILMS)
#: Reason for values that an interrupted sweep did not reach.
_NOT_REACHED = "not computed: the sweep was interrupted before"


def level_keys(keys: Iterable[str], figure: str) -> list[str]:
    """Keys of a level of all parts, of older files by its deprecated name."""
    keys, names = list(keys), (figure, _OLD_NAMES.get(figure))
    listed = ([key for key in keys if key.endswith(f".{name}")] for name in names)
    return next(filter(None, listed), [])


@dataclass(frozen=True)
class SweepPoint:
    """Value of a sweep with its figures or the reason of its failure."""

    values: tuple[Any, ...]  #: of the keys that vary, in SI
    figures: Mapping[str, float] = field(repr=False)  #: the summary
    failed: str = ""  #: why it failed
    warned: tuple[str, ...] = ()  #: codes of the warnings of the models

    @classmethod
    def of_failure(cls, values: tuple[object, ...], error: TribodynError) -> SweepPoint:
        """A value that cannot be computed."""
        first = error.problems[0]
        location = str(first.where).removeprefix("replace: ")  # it is the sweep that replaces
        return cls(values, {}, str(replace(first, where=location)))


@with_old_names
@record
class Sweep(Record):
    """What :func:`tribodyn.sweep` returns; ``sweep["rms_mesh_force"]`` is one figure as an array.

    Parameters
    ----------
    case : Case
        The case that was varied.
    axes : tuple of Axis
        Keys that vary, each with its values.
    points : tuple of SweepPoint
        Finished points, the last key varying fastest; all of the grid unless it was interrupted.
    """

    case: Any
    axes: tuple[Axis, ...]
    points: tuple[SweepPoint, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each key."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of values of the grid."""
        return prod(self.shape)

    @property
    def complete(self) -> bool:
        """Whether every value was reached."""
        return len(self.points) == self.size

    @cached_property
    def figures(self) -> tuple[str, ...]:
        """Names of the computed figures, in the order of the summary."""
        return tuple(in_order(name for point in self.points for name in point.figures))

    @cached_property
    def failed(self) -> NDArray[np.str_]:
        """Reason of failure of each value, in the shape of the grid; empty if it was computed."""
        reasons = [point.failed for point in self.points]
        reasons += [_NOT_REACHED] * (prod(self.shape) - len(reasons))
        return np.array(reasons).reshape(self.shape)

    def __getitem__(self, name: str) -> Array:
        """Return one figure of the summary over the grid, in SI; NaN where ``failed`` says why."""
        if not any(name in point.figures for point in self.points):
            remedy = did_you_mean(name, self.figures, f"It has: {closest(name, self.figures)}")
            why = "A sweep shows the figures that its points have"
            raise InputError(f'there is no figure "{name}" in this sweep', why=why, remedy=remedy)
        values = np.full(prod(self.shape), np.nan)
        values[: len(self.points)] = [p.figures.get(name, np.nan) for p in self.points]
        return values.reshape(self.shape)

    def __repr__(self) -> str:
        """One line."""
        ranges = " x ".join(
            f"{len(axis.values)} values of {axis.key} from {axis.show(axis.values[0])} to "
            f"{axis.show(axis.values[-1])}"
            for axis in self.axes
        )
        failed = sum(bool(point.failed) for point in self.points)
        done = "" if self.complete else f", {len(self.points)} of {prod(self.shape)} done"
        return f"Sweep({ranges}{done}{f', {failed} failed' if failed else ''})"

    def rows(self) -> Iterator[Tree]:
        """Iterate over the finished points.

        Yields
        ------
        dict
            Keys and figures in SI, ``failed`` and ``warnings``; None where there is no figure.
        """
        for point in self.points:
            keys = zip((axis.key for axis in self.axes), point.values, strict=True)
            figures = {name: point.figures.get(name) for name in self.figures}
            yield {
                **dict(keys),
                **figures,
                "failed": point.failed,
                "warnings": " ".join(dict.fromkeys(point.warned)),
            }

    def _parts(self) -> Parts:
        names = self._dimensions()
        axes: Tree = {
            name: (name, np.array(axis.values), {"units": axis.unit or "1", "key": axis.key})
            for name, axis in zip(names, self.axes, strict=True)
        }
        data: Tree = {
            name: (
                names,
                self[name],
                {"units": figure_of(name).unit or "1", "long_name": figure_of(name).meaning},
            )
            for name in self.figures
        }
        warned = [" ".join(dict.fromkeys(point.warned)) for point in self.points]
        warned += [""] * (prod(self.shape) - len(warned))
        data["failed"] = (names, self.failed.astype(object))
        data["warnings"] = (names, np.array(warned, dtype=object).reshape(self.shape))
        return Parts(data, axes, {"title": self.case.title})

    def _dimensions(self) -> list[str]:
        short = [axis.name for axis in self.axes]
        used_names = {*short, *self.figures}
        unique = len(used_names) == len(short) + len(self.figures)
        return short if unique else [axis.key.replace(".", "_") for axis in self.axes]

    def plot(self, figure: str = "rms_mesh_force", **options: Any) -> Any:
        """Draw one figure of the summary over the keys.

        Parameters
        ----------
        figure : str
            Name in the summary. The default of a machine is all levels of its parts.
        **options
            None are known.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        if figure == "rms_mesh_force" and figure not in self.figures:
            return draw(self, "machine_sweep", **options)  # each part has one
        return draw(self, figure=figure, **options)

    def to_pandas(self) -> Any:
        """Return the finished points as a pandas table.

        Returns
        -------
        pandas.DataFrame
            A row for each value: keys and figures in SI, ``failed`` and ``warnings``.
        """
        import pandas

        return pandas.DataFrame(list(self.rows()))

    def _repr_html_(self) -> str:
        """Table for notebooks: keys and the figures that reports of sweeps show."""
        names = self.displayed_figures()
        head = [*(axis.key for axis in self.axes), *map(in_words, names), "failed"]
        rows = [
            [
                *(axis.show(value) for axis, value in zip(self.axes, point.values, strict=True)),
                *(figure_of(n).show(point.figures[n]) if n in point.figures else "" for n in names),
                point.failed,
            ]
            for point in self.points
        ]
        return html_table(repr(self), head, rows)

    def displayed_figures(self, names: Sequence[str] = ()) -> list[str]:
        """Choose the figures that tables show.

        Parameters
        ----------
        names : sequence of str
            Requested figures; by default those of forces and motion, and of the film if a key of
            the film or the oil varies.

        Returns
        -------
        list of str
            Those that were computed.

        Raises
        ------
        InputError
            If there is no such figure.
        """
        for name in names:
            self[name]  # raises an error that lists the figures
        film = any(axis.key.startswith(("film", "lubricant")) for axis in self.axes)
        usual = (*_MOTIONS, *(_FILMS if film else ()))
        available = [name for name in usual if name in self.figures]
        return list(names) or available or self._of_parts()

    def _of_parts(self) -> list[str]:
        """Figures of the parts of a machine that tables show."""
        names = []
        for figure in OF_PARTS:
            parts = level_keys(self.figures, figure)
            worst = sorted(parts, key=lambda name: -float(np.nanmax(self[name])))
            names += parts if figure in _OF_ALL else worst[:1]
        return names

    def to_csv(self) -> str:
        """Write the finished points as comma-separated values in SI.

        Returns
        -------
        str
            One line for each value; units are in brackets in the first line.
        """
        units = {axis.key: axis.unit for axis in self.axes}
        units |= {name: figure_of(name).unit for name in self.figures}
        names = [*units, "failed", "warnings"]
        head = [f"{n} [{units[n]}]" if units.get(n) else n for n in names]
        rows = (["" if row[name] is None else row[name] for name in names] for row in self.rows())
        return csv_text([head, *rows])

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Write case, table and report into a new directory.

        The directory appears complete or not at all.

        Parameters
        ----------
        directory, force
            As :meth:`tribodyn.Result.save` takes them.

        Raises
        ------
        OutputExistsError
            If it exists and is not to be replaced, or is no result.
        InputError
            If the place cannot be written to.
        """
        target = Path(directory)
        with new_directory(target, force=force) as place:
            (place / "case.toml").write_text(self.case.to_toml(), encoding="utf-8")
            (place / "sweep.csv").write_text(self.to_csv(), encoding="utf-8")
            write_dataset(self.to_xarray(), place / "sweep.nc")
            write_report_of(self, place / "report.html")
        return target
