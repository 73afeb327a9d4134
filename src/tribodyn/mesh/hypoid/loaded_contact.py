"""Loaded tooth contact of a hypoid pair in cells: which carry how much, how far the wheel lags."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np

from tribodyn.contact import effective_modulus, hertz_line
from tribodyn.errors import (
    ComputationError,
    require_between,
    require_one_of,
)
from tribodyn.gear import HypoidFlanks, Material, Misalignment
from tribodyn.mesh.grid import PhaseGrid, phase_grid
from tribodyn.mesh.hypoid.cells import (
    CellSprings,
    ContactCells,
    carried,
    contact_cells,
    first_touch,
    lag_under,
    wrench,
)
from tribodyn.mesh.hypoid.coupled import LineCompliance, coupled_load, line_compliance
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, figure_method, quantity, record
from tribodyn.types import Array

_PHASES, _PAIRS, _CELLS = ("phase",), ("phase", "pair"), ("phase", "pair", "cell")


@record
class HypoidLoadedContact(Record):
    """One mesh cycle of a hypoid pair under load; made by :func:`hypoid_loaded_contact`.

    Pair ``i`` came into contact ``i`` cycles before phase 0. What belongs to pairs that are not in
    contact is zero. Forces and levers are in the frames of both gears: x along the common
    perpendicular, y along the axis of the gear so that its running sense is positive, z across.

    Parameters
    ----------
    phase : array (phase,)
        Mesh cycles from where a pair comes into contact.
    unloaded_rotation, loaded_rotation : array (phase,) [rad]
        By how much the wheel lags behind the ratio without load, and under it.
    mesh_force : array (phase,) [N]
        Amount of the force of all cells together.
    mesh_stiffness : array (phase,) [N/m]
        That force over the way of the wheel on the line of action from the first touch on.
    mesh_stiffness_tangent : array (phase,) [N/m]
        Slope of that force there.
    pinion_direction, wheel_direction : array (phase, 6)
        Force and moment of the mesh on each gear over the amount of the force: three pure numbers
        and three levers in m, normals out of the pinion. Moments are about the point where the
        common perpendicular meets the axis.
    load_share : array (phase, pair)
        Part of the torque on each pair.
    along, across : array (phase, pair, cell) [m]
        Places of the cells on the wheel, along and across its pitch cone.
    cell_force : array (phase, pair, cell) [N]
        Force of each cell.
    load_per_width : array (phase, pair, cell) [N/m]
        Force over the length of the cell.
    hertz_pressure : array (phase, pair, cell) [Pa]
        Greatest pressure of a line contact under it.
    pinion_torque : float [N*m]
        Torque on the pinion.
    line_stiffness : float [Pa]
        Stiffness of the teeth per length of contact line; with the compliance of finite elements,
        that of all closed cells together.
    grid : PhaseGrid
        The phases.
    cells : ContactCells
        The contact lines.
    material : Material
        Material of both gears.
    film_springs : CellSprings, optional
        Springs of the teeth with the oil film of each cell in series; None without films.
    loading : array (phase,) or float
        Torque of each phase over the nominal one.
    compliance : LineCompliance, optional
        Compliance of the teeth along the contact lines; None where it is the line stiffness.
    tooth_springs : CellSprings, optional
        Springs of the flanks on this compliance.
    """

    phase: Array = quantity(*_PHASES, unit="1", axis=True)
    unloaded_rotation: Array = quantity(*_PHASES, unit="rad")
    loaded_rotation: Array = quantity(*_PHASES, unit="rad")
    mesh_force: Array = quantity(*_PHASES, unit="N")
    mesh_stiffness: Array = quantity(*_PHASES, unit="N/m")
    mesh_stiffness_tangent: Array = quantity(*_PHASES, unit="N/m")
    pinion_direction: Array = quantity(*_PHASES, "component", unit="1")
    wheel_direction: Array = quantity(*_PHASES, "component", unit="1")
    load_share: Array = quantity(*_PAIRS, unit="1")
    along: Array = quantity(*_CELLS, unit="m")
    across: Array = quantity(*_CELLS, unit="m")
    cell_force: Array = quantity(*_CELLS, unit="N")
    load_per_width: Array = quantity(*_CELLS, unit="N/m")
    hertz_pressure: Array = quantity(*_CELLS, unit="Pa")
    pinion_torque: float = fact()
    line_stiffness: float = fact()
    grid: PhaseGrid = field()
    cells: ContactCells = field()
    material: Material = field()
    film_springs: CellSprings | None = field(default=None)
    loading: Array | float = field(default=1.0)
    compliance: LineCompliance | None = field(default=None)
    tooth_springs: CellSprings | None = field(default=None)

    @property
    def springs(self) -> CellSprings:
        """Springs of the cells."""
        return self.film_springs or self.tooth_springs or CellSprings(self.line_stiffness)

    @property
    def wheel_torque(self) -> float:
        """Torque on the wheel [N*m]; without friction that of the pinion times the ratio."""
        return self.pinion_torque * self.cells.flanks.blank.ratio

    @property
    def wheel_lever(self) -> Array:
        """Lever of the mesh force about the wheel's axis (phase,) [m]."""
        return np.asarray(self.wheel_direction[:, 4])

    @property
    def unloaded_transmission_error(self) -> Array:
        """Lag of the wheel without load, on the line of action (phase,) [m]."""
        return self.wheel_lever * self.unloaded_rotation

    @property
    def loaded_transmission_error(self) -> Array:
        """Lag of the wheel under load, on the line of action (phase,) [m]."""
        return self.wheel_lever * self.loaded_rotation

    @property
    def mean_mesh_stiffness(self) -> float:
        """Mean of the mesh stiffness over the cycle [N/m]."""
        return float(self.grid.mean(self.mesh_stiffness))

    @property
    def mean_mesh_force(self) -> Array:
        """Mean of the force on the teeth of the wheel in the frame of the pinion (3,) [N]."""
        return self.grid.mean(self.mesh_force[:, None] * self.pinion_direction[:, :3])

    @property
    def maximum_pressure(self) -> float:
        """Greatest Hertzian pressure on the flank [Pa]."""
        return float(self.hertz_pressure.max())

    @cached_property
    def line_force(self) -> Array:
        """Force of the cells of the lines (lines, cells)."""
        return np.asarray(self.cell_force[self.cells.in_contact])

    @property
    def _teeth(self) -> tuple[ContactCells, PhaseGrid, Material, LineCompliance | float]:
        """What does not depend on the load."""
        return self.cells, self.grid, self.material, self.compliance or self.line_stiffness

    def under(self, pinion_torque: float) -> HypoidLoadedContact:
        """Find the same contact under another torque.

        Parameters
        ----------
        pinion_torque : float
            Torque on the pinion in its running sense [N*m].

        Raises
        ------
        InputError
            If the torque is not positive.
        """
        torque = _required_torque(pinion_torque)
        return _loaded(*self._teeth, torque)

    def with_film(self, springs: CellSprings | None) -> HypoidLoadedContact:
        """Find the contact under the same torque with oil films in series with the teeth.

        Parameters
        ----------
        springs : CellSprings, optional
            Films of the cells; none leaves the teeth alone.

        Returns
        -------
        HypoidLoadedContact
        """
        return _loaded(*self._teeth, self.pinion_torque, springs, self.loading)

    def under_loading(self, loading: Array) -> HypoidLoadedContact:
        """Find the contact of the teeth at the nominal torque times a factor.

        Parameters
        ----------
        loading : array (phase,)
            Factor at each phase.

        Returns
        -------
        HypoidLoadedContact
        """
        return _loaded(*self._teeth, self.pinion_torque, None, loading)

    plot_pressure = figure_method("hypoid_pressure", "Draw the pressure over the flank.")
    plot_load = figure_method("hypoid_load", "Draw load sharing, transmission error and stiffness.")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"HypoidLoadedContact({self.pinion_torque:.6g} N m, mean stiffness "
            f"{self.mean_mesh_stiffness:.4g} N/m, pressure up to "
            f"{self.maximum_pressure * 1e-9:.3g} GPa)"
        )


def hypoid_loaded_contact(
    flanks: HypoidFlanks,
    pinion_torque: float,
    *,
    misalignment: Misalignment | None = None,
    material: Material | None = None,
    line_stiffness: float = 14e9,
    stiffness_model: str = "line",
    steps: int = 100,
    cells: int = 48,
    progress: Progress = SILENT,
) -> HypoidLoadedContact:
    """Share the load of a hypoid pair among the cells of all its contact lines.

    Parameters
    ----------
    flanks : HypoidFlanks
        The flanks with their ease-off.
    pinion_torque : float
        Torque on the pinion in its running sense [N*m].
    misalignment : Misalignment, optional
        Displacements of both gears; none by default.
    material : Material, optional
        Material of both gears; steel by default.
    line_stiffness : float
        Force per length of contact line and approach of the teeth [Pa]; the default of
        14 N/(mm um) has the order of the mesh stiffness of ISO 6336.
    stiffness_model : str
        ``"line"``, or ``"fe3d"``: finite elements of the teeth of both gears, coupled along all
        contact lines, instead of the line stiffness.
    steps : int
        Intervals of the mesh cycle, at least 16.
    cells : int
        Cells of each contact line, at least 4.
    progress : Progress
        Receiver of the progress of the finite elements.

    Raises
    ------
    InputError
        If an argument is wrong.
    ComputationError
        If the flanks touch nowhere, or cut into each other where they carry.

    Notes
    -----
    Each cell carries in proportion to its length and to what the rotation of the wheel leaves of
    its gap. With ``"fe3d"`` the loads of all cells also bend the teeth of both gears under them
    (:func:`tribodyn.stiffness.fe3d.hypoid_influence`), and the contact is compressed as a line. The
    gap is taken to first order along the contact lines of the conjugate flanks, whose ends on both
    flanks are exact, and within a cell as straight, so that a cell may carry in part. The rotation
    is that at which the moments of all cells balance the torque.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> ease_off = EaseOff(lengthwise_crowning=30e-6, profile_crowning=6e-6)
    >>> loaded = hypoid_loaded_contact(hypoid_flanks(blank, ease_off=ease_off), 500.0, steps=16)
    >>> bool(loaded.mean_mesh_stiffness > 4e8)
    True
    """
    torque = _required_torque(pinion_torque)
    line_stiffness = require_number("line_stiffness", line_stiffness)
    require_between(
        "line_stiffness", line_stiffness, 1e6, 1e13, "Pa", remedy="14 N/(mm um) are 14e9"
    )
    for name, count, least in (("steps", steps, 16), ("cells", cells, 4)):
        require_between(name, require_whole(name, count, least), least, 2000)
    grid = phase_grid((0.0,), steps)
    lines = _lines(flanks, misalignment or Misalignment(), grid, cells)
    material = material or Material()
    if require_one_of("stiffness_model", stiffness_model, ("line", "fe3d")) == "line":
        return _loaded(lines, grid, material, line_stiffness, torque)
    return _loaded(lines, grid, material, _compliance(lines, material, progress), torque)


def _required_torque(pinion_torque: float) -> float:
    torque = require_number("pinion_torque", pinion_torque)
    require_between("pinion_torque", torque, 1e-6, 1e7, "N*m", remedy="Give its amount")
    return torque


def _lines(
    flanks: HypoidFlanks, misalignment: Misalignment, grid: PhaseGrid, cells: int
) -> ContactCells:
    """Contact lines, which do not depend on the torque: the flanks cache the last ones."""
    key = (misalignment, grid.phase.size, cells)
    cached_key, cached_lines = vars(flanks).get("_lines_found_last", (None, None))
    if isinstance(cached_lines, ContactCells) and cached_key == key:
        return cached_lines
    lines = contact_cells(flanks, misalignment, grid.phase, cells)
    vars(flanks)["_lines_found_last"] = (key, lines)
    return lines


def _compliance(cells: ContactCells, material: Material, progress: Progress) -> LineCompliance:
    """Compliance along contact lines, which cache the last one."""
    cached_material, cached = vars(cells).get("_compliance_found_last", (None, None))
    if isinstance(cached, LineCompliance) and cached_material == material:
        return cached
    compliance = line_compliance(cells, material, progress)
    vars(cells)["_compliance_found_last"] = (material, compliance)
    return compliance


def wheel_torque_at(loaded: HypoidLoadedContact, lag: Array) -> Array:
    """Torque on a wheel that lags by some angles (..., phase) [rad]."""
    lags = np.reshape(lag, (-1, loaded.phase.size))
    if loaded.compliance is None:
        torques = [carried(loaded.cells, loaded.springs, each)[1] for each in lags]
    else:
        force, torques = loaded.line_force, []
        for each in lags:
            load = coupled_load(
                loaded.cells, loaded.compliance, each, force, springs=loaded.film_springs
            )
            torques.append(load.torque)
    return np.reshape(torques, np.shape(lag))


def _loaded(
    cells: ContactCells,
    grid: PhaseGrid,
    material: Material,
    teeth: LineCompliance | float,
    torque: float,
    film_springs: CellSprings | None = None,
    loading: Array | float = 1.0,
) -> HypoidLoadedContact:
    wheel_torque = torque * cells.flanks.blank.ratio * loading
    lag, force, balanced, rate, springs = _balanced(cells, teeth, wheel_torque, film_springs)
    start = first_touch(cells, springs.lead)
    coupled = None if isinstance(teeth, float) else teeth
    normals = force[..., None] * cells.touch.contact.wheel.normal
    pinion, wheel = (
        cells.summed(wrench(cells, normals, gear).sum(axis=1)) for gear in ("pinion", "wheel")
    )
    amount = np.linalg.norm(pinion[:, :3], axis=-1)
    lever = wheel[:, 4] / amount
    width = force / cells.length
    touch = cells.touch
    return HypoidLoadedContact(
        phase=grid.phase,
        unloaded_rotation=start,
        loaded_rotation=lag,
        mesh_force=amount,
        mesh_stiffness=amount / (lever * (lag - start)),
        mesh_stiffness_tangent=rate / lever**2,
        pinion_direction=pinion / amount[:, None],
        wheel_direction=wheel / amount[:, None],
        load_share=cells.spread((force * touch.lever).sum(axis=1)) / balanced[:, None],
        along=cells.spread(touch.places[..., 0]),
        across=cells.spread(touch.places[..., 1]),
        cell_force=cells.spread(force),
        load_per_width=cells.spread(width),
        hertz_pressure=cells.spread(_pressure(cells, width, material)),
        pinion_torque=torque,
        line_stiffness=teeth if isinstance(teeth, float) else _over_lines(cells, lag, force),
        grid=grid,
        cells=cells,
        material=material,
        film_springs=film_springs,
        loading=loading,
        compliance=coupled,
        tooth_springs=springs if coupled and film_springs is None else None,
    )


def _balanced(
    cells: ContactCells,
    teeth: LineCompliance | float,
    wheel_torque: Array | float,
    film_springs: CellSprings | None,
) -> tuple[Array, Array, Array, Array, CellSprings]:
    """Lag of the wheel, forces of the cells, torque, its slope, and the springs of the cells."""
    if isinstance(teeth, float):
        springs = film_springs or CellSprings(teeth)
        lag = lag_under(cells, springs, wheel_torque)
        return lag, *carried(cells, springs, lag), springs
    even = wheel_torque / cells.summed((cells.length * cells.touch.lever).sum(axis=1))
    force = cells.length * even[cells.row, None]
    start = film_springs or teeth.local_springs(cells, force / cells.length)
    torque = np.broadcast_to(wheel_torque, cells.phase.shape)
    load = coupled_load(
        cells,
        teeth,
        lag_under(cells, start, wheel_torque),
        force,
        wheel_torque=torque,
        springs=film_springs,
    )
    return load.lag, load.closed.force, load.torque, load.rate, load.springs


def _over_lines(cells: ContactCells, lag: Array, force: Array) -> float:
    """Stiffness per length of all cells together that the rotation closes."""
    closing = np.maximum(cells.touch.lever * lag[cells.row, None] - cells.gap, 0.0)
    return float(force.sum() / (cells.length * closing).sum())


def _pressure(cells: ContactCells, load_per_width: Array, material: Material) -> Array:
    """Greatest pressure of each cell."""
    curvature, loaded = cells.curvature.tensor[..., 1, 1], load_per_width > 0.0
    if np.any(curvature[loaded] <= 0.0):
        raise ComputationError(
            "the flanks cut into each other where they carry",
            why="The gap across the contact line is curved the wrong way",
            remedy="Give the pinion more teeth, a larger spiral angle or a smaller working depth",
        )
    radius = 1.0 / np.where(loaded, curvature, 1.0)
    return hertz_line(
        load_per_width, radius, effective_modulus(material, material)
    ).maximum_pressure
