"""The mesh table: everything that happens in the tooth contact over one mesh cycle."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from tribodyn.errors import InputError
from tribodyn.mesh.columns import MeshColumns, whole_stiffness
from tribodyn.mesh.face_lines import (
    SUMMED,
    contact_ratio,
    face_load_factor,
    face_map,
    slice_count,
    teeth_shares,
)
from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.functions import MeshFunctions
from tribodyn.mesh.gears import load_center, spatial_columns
from tribodyn.mesh.grid import PhaseFunction
from tribodyn.mesh.storage import FORMAT, FORMAT_WITHOUT_GEARS, stored_values, write_csv
from tribodyn.record import Labels, Parts, figure_method, record
from tribodyn.types import Array

if TYPE_CHECKING:
    import xarray


@record
class MeshTable(MeshColumns):
    """One mesh cycle of the tooth contact, made by :func:`tribodyn.mesh.build`.

    Parameters and columns are those of :class:`tribodyn.mesh.MeshColumns`.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "mesh_stiffness": Labels(("knot",)),
        "transmission_error_at_rest": Labels(("knot",), of="static_transmission_error"),
        "lubrication_regime": Labels(("knot", "pair")),
        "friction_power": Labels(("knot", "pair"), of="power"),
        "friction_sum": Labels(("knot",)),
        "friction_moment_pinion": Labels(("knot",)),
        "friction_moment_wheel": Labels(("knot",)),
        "phase": Labels(("knot",), axis=True, of="mesh_phase"),
    }

    @property
    def mean_mesh_stiffness(self) -> float:
        """Mean of the mesh stiffness over the cycle [N/m]."""
        return float(self.grid.mean(self.mesh_stiffness))

    @property
    def transmission_error_at_rest(self) -> Array:
        """Lag of the driven gear on the line of action under load at rest (n,) [m].

        Counted from where perfect rigid flanks touch without oil: the approach under the load, and
        ``unloaded_transmission_error`` where the table has it. The oil film holds the flanks
        apart: a film in series lowers the error by about its thickness.
        """
        unloaded = self.unloaded_transmission_error
        approach = self.static_transmission_error - self.film_offset
        return approach if unloaded is None else np.asarray(approach + unloaded)

    @property
    def tooth_mesh_stiffness(self) -> Array:
        """Secant stiffness of the teeth of all pairs together, without oil films (n,) [N/m]."""
        return whole_stiffness(self.tooth_stiffness, *teeth_shares(self))

    @cached_property
    def contact_ratio_under_load(self) -> float:
        """Mean number of tooth pairs that carry load over the mesh cycle, oil films left out.

        The mesh cycles during which one pair carries. Teeth that deflect touch before A and after E
        and raise it above the transverse contact ratio; relief that keeps flanks apart lowers it.
        """
        return contact_ratio(self.grid, *teeth_shares(self))

    @property
    def face_load_factor(self) -> float | None:
        """Greatest over mean load per face width, each over the mesh cycle; None of whole pairs."""
        return face_load_factor(self)

    @property
    def load_face_position(self) -> Array:
        """Centre of the load on the face, which moves to and fro over the mesh cycle (n,) [m]."""
        return load_center(self)[2]

    def over_face(self, column: str) -> xarray.DataArray:
        """Values of a tooth pair over the path of contact and the face width.

        Parameters
        ----------
        column : str
            Name of a column over knots and pairs.

        Returns
        -------
        xarray.DataArray (face_position, path)
            In SI; of whole pairs, as of spur gears, the face has one row.

        Raises
        ------
        InputError
            If there is no such column.
        """
        from xarray import DataArray

        chart = face_map(self, column)
        places = {"face_position": chart.face_position, "path": chart.path}
        return DataArray(chart.values, coords=places, name=column)

    @property
    def film_mesh_stiffness(self) -> Array | None:
        """Stiffness of the films of all loaded pairs together (n,) [N/m]; None if not in series.

        In series with the teeth: ``1/K = sum f^2/K_i`` of the load shares ``f`` and the stiffness
        ``K_i`` of each film.
        """
        if self.tooth_transmission_error is None or self.film_stiffness is None:
            return None
        finite_film = (self.load_share > 0.0) & np.nan_to_num(self.film_stiffness > 0.0)
        film = np.where(finite_film, self.film_stiffness, 1.0)
        compliance = np.where(finite_film, self.load_share**2 / film, 0.0).sum(axis=1)
        return np.asarray(1.0 / compliance)

    @property
    def mean_friction_coefficient(self) -> float:
        """Mean over the cycle of the friction coefficient, weighted with the load share."""
        return float(self.grid.mean(self.by_share(self.friction_coefficient)))

    @property
    def mean_asperity_friction_coefficient(self) -> float | None:
        """Part of the mean friction coefficient from asperities; None if the law has none."""
        part = self.asperity_friction_coefficient
        return None if part is None else float(self.grid.mean(self.by_share(part)))

    @property
    def friction_power(self) -> Array:
        """Sliding power lost in each contact of the quasi-static mesh (n, pairs) [W]."""
        rubbing = self.friction_coefficient * self.normal_force * self.line_force_ratio
        return np.asarray(rubbing * np.abs(self.sliding_speed))

    @property
    def mean_friction_power(self) -> float:
        """Mean over the cycle of the sliding power lost in the quasi-static mesh [W]."""
        losses = self.by_share(self.friction_coefficient * np.abs(self.sliding_speed))
        return float(self.grid.mean(losses)) * self.total_normal_force * self.line_force_ratio

    @property
    def mean_mesh_stiffness_tangent(self) -> float:
        """Mean of the tangent stiffness over the cycle [N/m]."""
        return float(self.grid.mean(self.mesh_stiffness_tangent))

    def harmonics(self, column: str, count: int = 5) -> Array:
        """Peak amplitudes of the mesh harmonics of a column over the phase.

        Parameters
        ----------
        column : str
            Name of an array over the knots.
        count : int
            Number of harmonics.

        Returns
        -------
        array (count,)
            Orders 1, 2, ... of the mesh frequency, in the unit of the column.
        """
        return self.grid._harmonics(getattr(self, column), count)

    def at(self, column: str, phase: Array | float) -> Array:
        """Interpolate a column at any mesh phase.

        Parameters
        ----------
        column : str
            Name of an array of this table.
        phase : float or array
            Mesh phase, taken modulo one; exactly on an event the value after it is returned.

        Returns
        -------
        array
            Shape of ``phase``, and the pairs as last axis where the column has them.

        Raises
        ------
        InputError
            If there is no such column.

        Notes
        -----
        Cubic within each segment between two events; the error falls with the fourth power of
        the knot distance.
        """
        values = getattr(self, column, None)
        if not isinstance(values, np.ndarray):
            what = f'the mesh table has no column "{column}"'
            why = f"Its columns are: {', '.join(self._columns())}"
            raise InputError(what, "argument column", why, "Name one of them")
        if values.dtype == np.bool_:
            return np.asarray(PhaseFunction(self.grid, values.astype(float))(phase) > 0.5)
        return PhaseFunction(self.grid, values)(phase)

    def at_pitch_point(self, column: str) -> float | None:
        """Value of a column for the tooth pair that is at the pitch point.

        Parameters
        ----------
        column : str
            Name of a column over knots and pairs.

        Returns
        -------
        float or None
            The pair carries its own part of the load at that phase. The slice in the middle of the
            face represents its pair, or the mean of the two in the middle of an even number: forces
            and stiffnesses are those of the whole face. Where another pair enters or leaves at the
            same time, the value after that; ``None`` where the pitch point is outside of the
            contact, or there is no such column in this table.
        """
        age = None if self.gears is None else self.gears.pitch_point_age
        values = getattr(self, column, None)
        if values is None or age is None or self.gears is None:
            return None
        if self.face_position is not None:
            slices = slice_count(self)
            middle = np.unique([(slices - 1) // 2, slices // 2])
            ages = age + self.gears.entry_delay(slices)[middle]
            pairs = slices * ages.astype(int) + middle
            at = np.mean([self.at(column, a % 1.0)[p] for a, p in zip(ages, pairs, strict=True)])
            return float(at * slices if column in SUMMED else at)
        # The event that is nearest: its phase and this one may differ by rounding.
        phases = np.array(self.event_phases)
        event = int(np.argmin(np.abs((phases - age + 0.5) % 1.0 - 0.5)))
        number, knot = round(age - float(phases[event])), self.grid.segments[event].start
        return float(values[knot, number]) if self.in_contact[knot, number] else None

    def _columns(self) -> list[str]:
        columns = {k: v for k, v in vars(self).items() if not k.startswith("_")}
        stored = [name for name, value in columns.items() if isinstance(value, np.ndarray)]
        return [*stored, *(name for name in self.DERIVED if name != "phase")]

    def functions(self) -> MeshFunctions:
        """Hand over what a dynamic model reads, as functions of mesh phase."""
        return self._functions

    @cached_property
    def _functions(self) -> MeshFunctions:
        return MeshFunctions(
            stiffness=PhaseFunction(self.grid, self.mesh_stiffness),
            friction_sum=PhaseFunction(self.grid, self.friction_sum),
            friction_moment_pinion=PhaseFunction(self.grid, self.friction_moment_pinion),
            friction_moment_wheel=PhaseFunction(self.grid, self.friction_moment_wheel),
            event_phases=self.event_phases,
            tangent_stiffness=PhaseFunction(self.grid, self.mesh_stiffness_tangent),
            static_transmission_error=PhaseFunction(self.grid, self.static_transmission_error),
            total_normal_force=self.total_normal_force,
            force_law=self.force_law,
            **self._foreign_functions(),
            **self._spatial_functions(),
        )

    def _spatial_functions(self) -> dict[str, PhaseFunction]:
        """Direction and friction of cylindrical gears in space."""
        if self.gears is None:
            return {}
        columns = spatial_columns(self)
        return {f"spatial_{name}": PhaseFunction(self.grid, c) for name, c in columns.items()}

    def _foreign_functions(self) -> dict[str, PhaseFunction]:
        """Directions and error of their own, which tables of other programs may have."""
        columns = {
            "direction": self.direction if self.direction.ndim == 2 else None,
            "friction": None if self.friction_direction is None else self.friction,
            "error": self.unloaded_transmission_error,
        }
        return {n: PhaseFunction(self.grid, c) for n, c in columns.items() if c is not None}

    @property
    def force_law(self) -> MeshForceLaw:
        """Force over deflection at every mesh phase."""
        return MeshForceLaw(self.grid, self.ramp_deflection, self.ramp_stiffness)

    def _parts(self) -> Parts:
        """Columns of the file, with derived ones and the attribute that identifies the format."""
        parts = super()._parts()
        attributes = {"format": FORMAT, **parts.attributes}
        if self.gears is None:
            attributes["format"] = FORMAT_WITHOUT_GEARS
            dims = ("knot", "coordinate")[-self.direction.ndim :]
            labels_and_units = self._attributes("direction", Labels(dims))
            parts.variables["direction"] = (dims, self.direction, labels_and_units)
        else:
            attributes["gear_pair"] = self.gears.written()
        labels_and_units = self._attributes("mesh_phase", Labels(("event",)))
        parts.coordinates["event_phase"] = ("event", np.array(self.event_phases), labels_and_units)
        parts.coordinates["intervals"] = ("event", np.array(self.grid.intervals))
        return parts._replace(attributes=attributes)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the columns of the force law, of friction and of the contacts as text.

        A case with ``gears.kind = "table"`` runs such a file.

        Parameters
        ----------
        path : str or path
            File to write; an existing one is an error.

        Raises
        ------
        OutputExistsError
            If the file exists.
        """
        write_csv(self, path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> MeshTable:
        """Read a table that :meth:`save` wrote.

        Parameters
        ----------
        path : str or path
            File to read.

        Returns
        -------
        MeshTable
            Equal to the saved one to the last bit.

        Raises
        ------
        InputError
            If there is no such file, or it holds no mesh table.
        """
        return cls(**stored_values(path))

    plot_stiffness = figure_method(
        "mesh_stiffness", "Draw pair and mesh stiffness over the mesh cycle."
    )
    plot_friction = figure_method(
        "friction", "Draw the friction of a tooth pair over the path of contact."
    )
    plot_film = figure_method(
        "film", "Draw the oil film of a tooth pair and its ratio to the roughness over the path."
    )
    plot_lubrication = figure_method(
        "lubrication", "Draw lubrication regime, load share of the film and parts of the friction."
    )
    plot_film_stiffness = figure_method(
        "film_stiffness", "Draw the stiffness of the oil film and of the teeth over the path."
    )

    def _contacts(self) -> str:
        if self.gears is None:
            return f"{self.stiffness.shape[1]} contacts"
        return f"contact ratio {self.transverse_contact_ratio:.4f}"

    def __repr__(self) -> str:
        """One line with the figures that tell tables apart."""
        return (
            f"MeshTable({self._contacts()}, "
            f"mesh frequency {self.mesh_frequency:.4g} Hz, "
            f"mean stiffness {self.mean_mesh_stiffness:.4g} N/m, "
            f"mean friction coefficient {self.mean_friction_coefficient:.4g})"
        )
