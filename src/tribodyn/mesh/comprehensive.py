"""Oil film and teeth in series over torques and speeds: the comprehensive stiffness of a source."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_positive
from tribodyn.gear import Material, SpurPair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.build import build
from tribodyn.mesh.table import MeshTable
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

_NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})
_OF_A_PAIR = ("film_stiffness", "tooth_stiffness", "pair_stiffness", "load_share")
_OF_THE_MESH = ("film_mesh_stiffness", "tooth_mesh_stiffness", "comprehensive_mesh_stiffness")


@record
class ComprehensiveStiffness(Record):
    """Stiffness of oil film and teeth; made by :func:`tribodyn.mesh.comprehensive_stiffness`.

    Values of one tooth pair stand in the order in which it passes them from A to E, a place where
    another pair enters or leaves twice; values of the mesh stand over the mesh phase.

    Parameters
    ----------
    gear_pair : SpurPair
        Both gears in their working position.
    kind : str
        ``"tangent"``, ``"secant"`` or ``"seed"``.
    stiffness_model, film_model : str
        Models of the teeth and of the film.
    pinion_torque : array (t,) [N*m]
        Torques on the pinion.
    pinion_speed : array (s,) [rad/s]
        Speeds of the pinion.
    path : array (m,) [m]
        Distance from the pinion's base tangent point along the line of action.
    roll_angle : array (m,) [rad]
        Roll angle of the driving gear.
    load_share : array (t, s, m)
        Part of the load on the pair.
    film_stiffness : array (t, s, m) [N/m]
        Stiffness of the film of the pair.
    tooth_stiffness : array (t, s, m) [N/m]
        Stiffness of the teeth of the pair without film.
    pair_stiffness : array (t, s, m) [N/m]
        Teeth and film of the pair in series.
    phase : array (p,)
        Mesh phase, 0 where a pair reaches A; events occur twice.
    film_mesh_stiffness : array (t, s, p) [N/m]
        Sum of the films of all pairs in contact.
    tooth_mesh_stiffness : array (t, s, p) [N/m]
        Stiffness of the teeth of all pairs.
    comprehensive_mesh_stiffness : array (t, s, p) [N/m]
        Stiffness of the whole mesh with its films.
    """

    gear_pair: SpurPair
    kind: str = fact()
    stiffness_model: str = fact()
    film_model: str = fact()
    pinion_torque: Array = quantity("torque", unit="N*m", axis=True)
    pinion_speed: Array = quantity("speed", unit="rad/s", axis=True)
    path: Array = quantity("place", unit="m", axis=True)
    roll_angle: Array = quantity("place", unit="rad", axis=True)
    load_share: Array = quantity("torque", "speed", "place", unit="1")
    film_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    tooth_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    pair_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    phase: Array = quantity("phase", unit="1", axis=True)
    film_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")
    tooth_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")
    comprehensive_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")

    @property
    def mean_mesh_stiffness(self) -> Array:
        """Mean of the comprehensive stiffness over the phase (t, s) [N/m]."""
        return self._mean(self.comprehensive_mesh_stiffness)

    @property
    def mean_tooth_stiffness(self) -> Array:
        """Mean stiffness of the teeth alone over the phase (t, s) [N/m]."""
        return self._mean(self.tooth_mesh_stiffness)

    @property
    def maximum_mesh_stiffness(self) -> Array:
        """Greatest comprehensive stiffness (t, s) [N/m]."""
        return np.asarray(self.comprehensive_mesh_stiffness.max(axis=2))

    @property
    def series_of_totals(self) -> Array:
        """What the literature takes: ``K_m K_o/(K_m + K_o)`` of the sums of all pairs (t, s, p)."""
        teeth, film = self.tooth_mesh_stiffness, self.film_mesh_stiffness
        return np.asarray(teeth * film / (teeth + film))

    def _mean(self, values: Array) -> Array:
        return np.asarray(np.trapezoid(values, self.phase, axis=2) / np.ptp(self.phase))

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        mean = self.mean_mesh_stiffness
        return (
            f"ComprehensiveStiffness({self.kind}, {self.film_model}, {self.stiffness_model}, "
            f"{self.pinion_torque.size} torques, {self.pinion_speed.size} speeds, "
            f"mean {mean.min():.4g} to {mean.max():.4g} N/m)"
        )


def comprehensive_stiffness(
    pair: SpurPair,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: Mapping[str, Any] = _NO_OPTIONS,
    lubricant: Lubricant,
    film_model: str = "newton",
    film_options: Mapping[str, Any] = _NO_OPTIONS,
    kind: str = "tangent",
    pinion_speed: ArrayLike,
    pinion_torque: ArrayLike,
    steps: int = 128,
    progress: Progress = SILENT,
) -> ComprehensiveStiffness:
    """Find the stiffness of oil film and teeth for every torque at every speed.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    material : Material
        Material of both gears.
    stiffness_model : str
        Name in ``tribodyn.stiffness.MODELS``.
    stiffness_options : mapping
        Options of the stiffness model.
    lubricant : Lubricant
        Oil at working temperature.
    film_model : str
        Name in ``tribodyn.ehl.FILM_MODELS``.
    film_options : mapping
        Options of the film model; ``kind`` replaces its ``stiffness``.
    kind : str
        ``"tangent"`` or ``"secant"``: the film of each pair in series with its teeth, at the load
        that it then carries. ``"seed"``: as "Prediction of Vibration Characteristics in Spur Gear
        Drives Considering Elastohydrodynamic Lubrication" prints it.
    pinion_speed : float or array (s,) [rad/s]
        Speeds of the pinion in the running sense.
    pinion_torque : float or array (t,) [N*m]
        Magnitudes of the torque on the pinion.
    steps : int
        Phase intervals of a mesh cycle.
    progress : Progress
        Told how many films are solved.

    Returns
    -------
    ComprehensiveStiffness

    Raises
    ------
    InputError
        If a value is out of range, a model unknown, or it has no such film stiffness.
    ComputationError
        If a film cannot be solved, or the load share does not settle.

    Notes
    -----
    ``1/K = 1/K_m + 1/K_o`` for each pair, and the pairs then share the load; ``"seed"`` takes it
    of the sums over all pairs. The printed sum of the source for ``K_o`` has the unit of a length;
    it is multiplied here with the Hertzian pressure, by which its pressures are divided. It still
    doubles with every doubling of the nodes. Source: "Prediction of
    Vibration Characteristics in Spur Gear Drives Considering Elastohydrodynamic Lubrication".

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=0.3490658504, pinion_face_width=50e-3)
    >>> found = comprehensive_stiffness(
    ...     pair, material=Material(), lubricant=Lubricant(0.08, 880.0, 2e-8), film_model="moes",
    ...     stiffness_model="rectangular", stiffness_options={"pair_stiffness": 5e8},
    ...     pinion_speed=100.0, pinion_torque=[90.0, 180.0], steps=32)
    >>> bool((found.pair_stiffness < 5e8).all())
    True
    """
    speeds, torques = (
        _listed(name, values)
        for name, values in (("pinion_speed", pinion_speed), ("pinion_torque", pinion_torque))
    )
    _check_kind(film_model, kind)
    tables = [
        [
            build(
                pair, material=material, stiffness_model=stiffness_model,
                stiffness_options=stiffness_options, lubricant=lubricant, friction_law="none",
                composite_roughness=0.0, film_model=film_model,
                film_options={**film_options, "stiffness": kind}, pinion_speed=float(speed),
                pinion_torque=float(torque), steps=steps, progress=progress,
            )
            for speed in speeds
        ]
        for torque in torques
    ]  # fmt: skip
    columns = [[_columns(table, kind) for table in row] for row in tables]
    table = tables[0][0]
    path = _in_order(table, table.path)
    radius = path if pair.driver == "pinion" else pair.line_of_action_length - path
    return ComprehensiveStiffness(
        gear_pair=pair,
        kind=kind,
        stiffness_model=stiffness_model,
        film_model=film_model,
        pinion_torque=torques,
        pinion_speed=speeds,
        path=path,
        roll_angle=radius / pair.driving.base_radius,
        phase=table.phase,
        **{
            name: np.array([[each[name] for each in row] for row in columns])
            for name in (*_OF_A_PAIR, *_OF_THE_MESH)
        },
    )


def _columns(table: MeshTable, kind: str) -> dict[str, Array]:
    """Values of one pair in the order of its way, and of the mesh over the phase."""
    film, teeth = np.asarray(table.film_stiffness), table.tooth_stiffness
    whole, pair_stiffness = table.mesh_stiffness, table.stiffness
    if kind == "seed":
        film = film * table.hertz_pressure  # its pressures are over the Hertzian one
    on_corners = table.mesh_stiffness / table.stiffness.sum(axis=1)
    found = {
        "film_mesh_stiffness": np.nansum(film, axis=1),
        "tooth_mesh_stiffness": teeth.sum(axis=1) * on_corners,
    }
    if kind == "seed":
        each, total = found.values()
        touch = table.in_contact & np.isfinite(film)
        pair_stiffness = np.zeros(film.shape)
        pair_stiffness[touch] = 1.0 / (1.0 / film[touch] + 1.0 / teeth[touch])
        whole = each * total / (each + total)
    of_a_pair = (film, teeth, pair_stiffness, table.load_share)
    ordered = (_in_order(table, column) for column in of_a_pair)
    return {
        **dict(zip(_OF_A_PAIR, ordered, strict=True)),
        **found,
        "comprehensive_mesh_stiffness": whole,
    }


def _in_order(table: MeshTable, column: Array) -> Array:
    """Values of a pair from its entry to its exit: those of pair 0, then of pair 1 and so on."""
    return np.asarray(column.T[table.in_contact.T])


def _listed(name: str, values: ArrayLike) -> Array:
    listed = np.atleast_1d(np.asarray(values, dtype=float))
    unit = "rad/s" if name == "pinion_speed" else "N*m"
    require_positive(name, listed, unit)
    if listed.ndim != 1 or listed.size == 0:
        raise InputError(
            f"{name} has the shape {listed.shape}",
            where=f"argument {name}",
            why="It is one value or a list of values",
            remedy="Every torque is combined with every speed: give each value once",
        )
    return listed


def _check_kind(film_model: str, kind: str) -> None:
    if film_model == "none" or kind == "none":
        raise InputError(
            "no oil film" if film_model == "none" else 'kind = "none"',
            where="argument film_model" if film_model == "none" else "argument kind",
            why="The comprehensive stiffness is that of teeth and film",
            remedy='Take film_model = "newton" and kind = "tangent"',
        )
