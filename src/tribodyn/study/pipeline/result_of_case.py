"""The result of a case of any kind: loads, summary, sources, recordings, figures."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from importlib import import_module
from inspect import Signature
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tribodyn.drawing import FIGURES, bound_figure, figures_of
from tribodyn.errors import collected, did_you_mean
from tribodyn.record import Parts, Record, html_table
from tribodyn.study.case.hypoid import mounting
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.assembly import static_error
from tribodyn.study.pipeline.store import MOTIONS, write_result
from tribodyn.study.pipeline.summary_figures import (
    Figures,
    by_topic,
    figure_of,
    in_words,
    summary_rows,
)
from tribodyn.types import ByName

if TYPE_CHECKING:
    import pandas
    import xarray

    from tribodyn.errors import ModelWarning
    from tribodyn.gear import ToothContact
    from tribodyn.measurement import Recording
    from tribodyn.mesh import HypoidFriction, MeshTable
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.provenance import Assumption
    from tribodyn.study.faults.sensors import Sensors
    from tribodyn.study.rated_parts import PartRatings
    from tribodyn.study.rating import CaseRating, RatedMesh
    from tribodyn.types import Array

_PLOT = "plot_"


def kind_of(name: str) -> type:
    """Class of the results of one kind, which knows this module."""
    return getattr(import_module("tribodyn.study"), name)  # type: ignore[no-any-return]


class ResultOfCase(Record, ABC):
    """Base class of results: loads, summary, sources, recordings and figures."""

    #: Name of the only mesh, of a pair.
    _MESH: ClassVar[str] = ""
    #: Name of the files of motions in a stored result.
    _MOTION: ClassVar[str] = MOTIONS[0]
    #: Figure that compares results of the kind.
    _COMPARISON: ClassVar[str] = "machine_comparison"

    case: Any
    warnings: tuple[ModelWarning, ...]
    turning_motion: Any

    @abstractmethod
    def _parts(self) -> Parts:
        """Variables, coordinates and attributes of the motion at the operating point."""

    @property
    @abstractmethod
    def _headline(self) -> str:
        """Chief figures in one line."""

    @abstractmethod
    def to_csv(self) -> str:
        """Write series of the motion as comma-separated values in SI."""

    @property
    @abstractmethod
    def loads(self) -> ByName:
        """Results by load; ``"operation"`` is the operating point."""

    @property
    def tables(self) -> Mapping[str, MeshTable]:
        """Tooth contact at the operating point by the name of the mesh, ``"mesh"`` of a pair."""
        return self.loads["operation"].tables  # type: ignore[no-any-return]

    @property
    @abstractmethod
    def _pair(self) -> PairCase:
        """Pair of the first mesh whose teeth are computed, at the operating point."""

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """Values that were assumed or are defaults, each with its reason."""
        return tuple(self.case.assumptions)

    @property
    def half_backlash(self) -> float:
        """Half of the play on the line of action of the first mesh [m]; zero is a linear mesh."""
        return 0.5 * self._pair.backlash

    def static_error(self, phase: Array | float) -> Array:
        """Transmission error without load: prescribed, or a column of the mesh table.

        Parameters
        ----------
        phase : float or array
            Phase of the first mesh.

        Returns
        -------
        array [m]
        """
        dynamics, phase = self._pair.dynamics, np.asarray(phase, dtype=float)
        mesh_error = self.mesh.functions().error
        return static_error(dynamics, phase) + (0.0 if mesh_error is None else mesh_error(phase))

    def transmission_error_at_rest(self, phase: Array | float | None = None) -> Array:
        """Lag of the driven gear under load at rest, with the prescribed error of the case.

        Parameters
        ----------
        phase : float or array, optional
            Phase of the first mesh; the knots of its table by default.

        Returns
        -------
        array [m]
        """
        dynamics, mesh = self._pair.dynamics, self.mesh
        name = "transmission_error_at_rest"
        loaded = getattr(mesh, name) if phase is None else mesh.at(name, phase)
        error = static_error(dynamics, mesh.phase if phase is None else phase)
        return np.asarray(loaded + error)

    def loaded_contact(self) -> LoadedContact:
        """Loaded contact at rest, without oil film: a turn of each gear whose teeth differ.

        Returns
        -------
        LoadedContact
            Of the first mesh.
        """
        from tribodyn.study.pipeline.tooth_contact import loaded_contact, phases_of_turns

        return loaded_contact(self._pair, phases=phases_of_turns(self._pair))

    @cached_property
    def hypoid_contact(self) -> ToothContact | None:
        """Tooth contact of the first mesh without load, of hypoid gears; None of other gears."""
        from tribodyn.gear import tooth_contact

        flanks = self._pair.hypoid_flanks
        return None if flanks is None else tooth_contact(flanks, mounting(self._pair.gears))

    @cached_property
    def hypoid_friction(self) -> HypoidFriction | None:
        """Load, film and friction in the cells of the first mesh, of hypoid gears, at rest."""
        from tribodyn.study.pipeline.tooth_contact import hypoid_friction_of

        with collected():  # The run has raised the warnings.
            crossed = self._pair.hypoid_flanks is not None
            return hypoid_friction_of(mesh_inputs(self._pair)) if crossed else None

    @property
    @abstractmethod
    def _sensors(self) -> Sensors:
        """What there is to sense."""

    @abstractmethod
    def _rated(self) -> tuple[Iterable[RatedMesh], PartRatings | None]:
        """Meshes, bearings and shafts under the loads that they have to last by ``[rating]``."""

    @cached_property
    def rating(self) -> CaseRating | None:
        """Load capacity of gears, bearings and shafts; None without ``[rating]``."""
        from tribodyn.study.rating import case_rating

        return case_rating(*self._rated())

    def _shape_figures(self) -> Mapping[str, float]:
        """Figures of the gears of a machine, which all loads share."""
        return {}

    @cached_property
    def _summary(self) -> Figures:
        figures = Figures(self._shape_figures())
        for number, (name, load) in enumerate(self.loads.items()):
            prefix = f"load_cases.{name.removeprefix('load_cases.')}." if number else ""
            rated = self._rated_figures.get(name, {})
            values = chain(load.figures.items(), rated.items())
            figures.update({f"{prefix}{key}": value for key, value in values})
        return figures

    @cached_property
    def _rated_figures(self) -> Mapping[str, Mapping[str, float]]:
        """Safeties and lives by load; they belong to the summary."""
        if not self.case.is_rated:
            return {}
        from tribodyn.study.rating_summary import rating_figures

        with collected():  # the rating itself raises its warnings
            rating = self.rating
        return {} if rating is None else rating_figures(rating)

    def summary(self) -> dict[str, float]:
        """All figures as one flat dictionary.

        Returns
        -------
        dict of str to float
            In SI; :data:`tribodyn.study.SUMMARY` has unit and meaning of those of a pair. Of parts
            the keys are dotted; those of load cases begin with ``load_cases.NAME.``. Deprecated
            keys are read with a warning, but are not listed.
        """
        return Figures(self._summary)

    @property
    def table(self) -> pandas.DataFrame:
        """Figures of :meth:`summary` by topic: ``name``, ``value`` in SI, ``unit``, ``meaning``.

        Examples
        --------
        >>> import tribodyn as td
        >>> td.run("time-varying-friction").table.head(2)[["name", "unit"]]
                          name unit
        0  pitch_line_velocity  m/s
        1     tangential_force    N
        """
        import pandas

        names = (name for topic in by_topic(self._summary).values() for name in topic)
        rows = [(n, self._summary[n], figure_of(n).unit, figure_of(n).meaning) for n in names]
        return pandas.DataFrame(rows, columns=["name", "value", "unit", "meaning"])

    def to_xarray(self) -> xarray.Dataset:
        """Return the motion at the operating point as labelled arrays with units.

        Returns
        -------
        xarray.Dataset
            Series, and facts as attributes.
        """
        import xarray

        return xarray.Dataset(*self._parts())

    @property
    def signals(self) -> xarray.Dataset:
        """Signals at the operating point with units, as :meth:`to_xarray`."""
        return self.to_xarray()

    def _case_in(self, place: Path) -> Case:
        """Case whose files lie in a folder, copied there."""
        return self.case  # type: ignore[no-any-return]

    def save(
        self, directory: str | os.PathLike[str], *, force: bool = False, csv: bool = False
    ) -> Path:
        """Write case, summary, mesh tables, motions and report into a new directory.

        The directory appears complete or not at all; :func:`tribodyn.load_result` reads it. Of a
        long transient the last mesh cycles are stored, as many as 64 MB hold.

        Parameters
        ----------
        directory : str or path
            Directory to make.
        force : bool
            Replace an earlier result there.
        csv : bool
            Write :meth:`to_csv` as ``response.csv`` as well.

        Raises
        ------
        OutputExistsError
            If it exists and is not to be replaced, or is no result.
        InputError
            If the place cannot be written to.
        """
        return write_result(self, directory, force=force, csv=csv)

    def _repr_html_(self) -> str:
        """Table of the summary by topic for notebooks."""
        rows = [(topic, in_words(name), *columns) for topic, name, *columns in self.rows()]
        return html_table(repr(self), ("topic", "figure", "value", "meaning"), rows)

    def __repr__(self) -> str:
        """One line."""
        return f'Result("{self.case.title}": {self._headline})'

    def cite(self, style: str = "text") -> str:
        """Name the papers behind this result.

        Parameters
        ----------
        style : str
            ``"text"`` or ``"bibtex"``.

        Raises
        ------
        InputError
            If there is no such style.
        """
        from tribodyn.study.pipeline.citations import cite

        return cite(self.case, style)

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Topic, key, value with unit and meaning of each figure of the summary.

        Returns
        -------
        list of (str, str, str, str)
        """
        return summary_rows(self._summary)

    def recording(
        self,
        sensor: str | Sequence[str],
        duration: float,
        sample_rate: float = 25_600.0,
        *,
        sensor_angle: float = 0.0,
        window: float | Callable[[Array], Array] | None = None,
        tacho: str | None = None,
        noise: float = 0.0,
        speed_fluctuation: float = 0.0,
        tacho_jitter: float = 0.0,
        seed: int = 0,
    ) -> Recording:
        """Sample the motion over whole turns as a measuring system would.

        Parameters
        ----------
        sensor : str or sequence of str
            Names in ``turning_motion.sensors``; several make several channels. Of a pair a signal
            in the data of the result, such as ``"acceleration_loa_pinion"``, ``"mesh_force"`` or
            ``"dynamic_transmission_error"``, or a rotation such as ``"pinion_theta"``, whose
            acceleration is recorded; ``"pinion_y"`` and ``"transmission_error"`` stand for the
            same signals. Of a machine ``"bearings.A.acceleration_y"``,
            ``"housing.NODE.acceleration_30deg"``, ``"meshes.first.mesh_force"``, ... Of a
            planetary stage ``"ring.acceleration"``, ``"planet_1.sun_mesh_force"``, ...
        duration : float
            Length of the recording [s].
        sample_rate : float
            Samples per second [Hz]. What lies above half of it is filtered off.
        sensor_angle : float
            Angle of a sensor on a ring [rad]; the first planet begins at 0.
        window : float or function, optional
            How a sensor on a ring feels a passing planet, as for
            :func:`tribodyn.machine.ring_sensor_signal`.
        tacho : str, optional
            Gear of a pair, shaft of a machine or member of a stage with the tacho, or the planet
            for its turns about the pin; the pinion or the input by default.
        noise : float
            Standard deviation of white noise, in the unit of the sensor.
        speed_fluctuation : float
            Standard deviation of slow changes of the speed, over the speed [1].
        tacho_jitter : float
            Standard deviation of the edges of the tacho over a turn [1].
        seed : int
            Number of the draw of the start, the noise and all that scatters.

        Returns
        -------
        Recording
            One channel for each sensor, and ``tacho`` with one pulse a turn.

        Raises
        ------
        InputError
            If there is no such sensor or shaft, a value is out of range, or the case has gears
            from a table.

        Examples
        --------
        >>> import tribodyn
        >>> case = tribodyn.load_case("fzg-roughness").replace({
        ...     "faults.crack.kind": "crack", "faults.crack.gear": "pinion",
        ...     "faults.crack.tooth": 1, "faults.crack.depth": "1 mm"})
        >>> tribodyn.run(case).recording("acceleration_loa_pinion", 1.0)  # doctest: +SKIP
        """
        from tribodyn.study.faults.machine_section import defects_of
        from tribodyn.study.faults.recording import Scatter, recording_of
        from tribodyn.study.faults.sensors import check_sensors

        check_sensors(self._sensors, sensor, tacho)  # before the longest part
        motion = self.turning_motion.sensed_from(tacho, sensor_angle, window)
        scatter = Scatter(noise, speed_fluctuation, tacho_jitter, seed)
        return recording_of(motion, defects_of(self.case), sensor, duration, sample_rate, scatter)

    def __getattr__(self, name: str) -> Any:
        """Find ``plot_<name>`` among the figures that draw a run; else say who has the name."""
        kind = "a result" if name[0] == "_" else f"the result of a {self.case.kind.lower()}"
        what = f"{kind} has no {name}"
        if not name.startswith(_PLOT):
            kind_of("MachineResult")  # shows its members
            owner = "a machine" if type(self) is kind_of("PairResult") else "a pair of gears"
            member_of = f": that is of {owner}" * (name in Result.__annotations__)
            raise AttributeError(what + member_of)
        figure, figures = name.removeprefix(_PLOT), figures_of(self)
        if figure in figures:
            return bound_figure(self, figure)
        if figure in FIGURES:
            other: Any = FIGURES[figure]
            raise AttributeError(f"{what}. {other.missing(self)}")
        methods = [f"{_PLOT}{each}" for each in figures]
        remedy = did_you_mean(name, methods, "")
        what = f"{kind} has no figure {name!r}. {remedy}".strip()
        raise AttributeError(f"{what} It has {', '.join(methods)}")

    def __dir__(self) -> list[str]:
        """Attributes and figures."""
        return sorted({*super().__dir__(), *(f"{_PLOT}{name}" for name in figures_of(self))})


class Result(ResultOfCase):
    """What :func:`tribodyn.run` returns: loads, summary, sources, recordings and figures.

    The result of a pair of gears is a :class:`tribodyn.study.PairResult`, which the arguments are
    of; that of a machine or a planetary stage a :class:`tribodyn.study.MachineResult`. Every
    figure that draws a run is a method: ``result.plot_mesh_force()``.

    Examples
    --------
    >>> import tribodyn as td
    >>> result = td.run("time-varying-friction")
    >>> isinstance(result, td.Result), list(result.loads)
    (True, ['operation'])
    """

    __signature__: ClassVar[Signature | None]

    def __new__(cls, *parts: object, **more: object) -> Result:
        """Return the unset result of a pair, where no kind is named."""
        return object.__new__(kind_of("PairResult") if cls is Result else cls)

    def __init_subclass__(cls, of: type = object) -> None:
        """Show the members of a kind of result, and of what it is of, on this class too."""
        super().__init_subclass__()
        cls.__signature__ = None  # its own
        names = (*vars(cls), *cls.__annotations__, *vars(of), *getattr(of, "__annotations__", ()))
        members = {name: "Any" for name in names if name[0] != "_" and not hasattr(Result, name)}
        Result.__annotations__ = {**members, **Result.__annotations__}
