"""A bearing: stiffness of a linear support, or a rolling bearing by its geometry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.machine.fields import check_name, check_number
from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.types import Array

#: Coordinates of a bearing that are in a matrix of five rows: all but the rotation of the shaft.
HELD = (0, 1, 2, 4, 5)
#: Stiffness of a bearing without data: radial and axial [N/m]; it does not resist tilting.
STIFF = 1e9
#: Share of the greatest stiffness of a bearing below which it resists nothing.
_FREE = 1e-12
_UNITS = {
    "radial": ("N/m", "N*s/m"),
    "axial": ("N/m", "N*s/m"),
    "tilting": ("N*m/rad", "N*m*s/rad"),
    "torsional": ("N*m/rad", "N*m*s/rad"),
}


@dataclass(frozen=True, eq=False)
class Bearing:
    """A bearing between a shaft and the housing, or between a planet and its carrier.

    Parameters
    ----------
    shaft : str
        Name of its shaft.
    position : float
        Position of its mid plane on the shaft [m].
    radial_stiffness : float or (2,) array, optional
        Stiffness along y and z, one value for each or for both [N/m].
    axial_stiffness : float
        Stiffness along x [N/m].
    tilting_stiffness : float or (2,) array
        Stiffness against tilting about y and z [N*m/rad].
    stiffness : (6, 6) or (5, 5) array, optional
        All stiffnesses together, in the order x, y, z, theta_x, theta_y, theta_z, of five without
        theta_x [N/m, N, N*m].
    radial_damping : float or (2,) array
        Damping along y and z [N*s/m].
    axial_damping : float
        Damping along x [N*s/m].
    tilting_damping : float or (2,) array
        Damping against tilting [N*m*s/rad].
    damping : (6, 6) or (5, 5) array, optional
        All damping coefficients together [N*s/m, N*s, N*m*s].
    force : (6,) array
        Force and moment of the shaft on the bearing without a displacement: that of a rolling
        bearing whose stiffness is taken at its working load [N, N*m].
    rolling : RollingElementBearing, optional
        Rolling bearing, whose stiffness follows from its geometry and load.
    node : str, optional
        Node of the housing that carries the bearing; by default it is held by a rigid wall.
    torsional_stiffness : float
        Stiffness against rotation of the shaft, which is held by it and does not turn [N*m/rad].
    torsional_damping : float
        Damping of this rotation [N*m*s/rad].
    carrier : str, optional
        Shaft that carries the bearing in place of the housing, as a pin of a planet.
    carrier_position : float
        Position of its mid plane on the carrier [m].
    offset : (6,) array
        Displacement of its seat from where it should be, such as the error of a pin [m, rad].
    clearance : float
        Radial distance that the shaft can move from the middle before a linear bearing with equal
        stiffnesses along y and z holds it, half of the diametral clearance [m].
    unloaded : Bearing, optional
        Bearing with clearance whose stiffness at its working load this one has.
    floating : bool
        Whether its ring slides along its seat, so that it takes no axial force, as the floating
        (non-locating) bearing of a shaft.

    Raises
    ------
    InputError
        If a value is out of range, or two stiffnesses contradict each other.

    Notes
    -----
    Without any stiffness it is stiff: 1e9 N/m along x, y and z.

    Examples
    --------
    >>> Bearing("input", 0.012, radial_stiffness=4e8).stiffness_matrix.diagonal().tolist()
    [0.0, 400000000.0, 400000000.0, 0.0, 0.0, 0.0]
    """

    shaft: str
    position: float
    radial_stiffness: float | ArrayLike | None = None
    axial_stiffness: float = 0.0
    tilting_stiffness: float | ArrayLike = 0.0
    stiffness: ArrayLike | None = None
    radial_damping: float | ArrayLike = 0.0
    axial_damping: float = 0.0
    tilting_damping: float | ArrayLike = 0.0
    damping: ArrayLike | None = None
    force: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    rolling: RollingElementBearing | None = None
    node: str | None = None
    torsional_stiffness: float = 0.0
    torsional_damping: float = 0.0
    carrier: str | None = None
    carrier_position: float = 0.0
    offset: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    clearance: float = 0.0
    unloaded: Bearing | None = None
    floating: bool = False

    def __post_init__(self) -> None:
        check_name(self, "shaft")
        check_number(self, "position", "m", -1e3, 1e3)
        for way, units in _UNITS.items():
            for kind, unit in zip(("stiffness", "damping"), units, strict=True):
                if getattr(self, name := f"{way}_{kind}") is not None:
                    _check_pair(self, name, unit, 1 if way in ("axial", "torsional") else 2)
        parts = [f"{way}_stiffness" for way in _UNITS if np.any(getattr(self, f"{way}_stiffness"))]
        parts += [name for name in ("stiffness", "rolling") if getattr(self, name) is not None]
        exclusive = {"stiffness", "rolling"} & set(parts)
        if exclusive and len(parts) > 1:
            why = "A matrix and a rolling bearing hold the stiffness of all directions"
            where = Argument(f"Bearing.{parts[-1]}")
            raise InputError(
                f"{' and '.join(parts)} are both given", where, why, "Give one of them"
            )
        for name in ("stiffness", "damping"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _matrix(name, getattr(self, name)))
        if self.node is not None:
            check_name(self, "node")
        if self.carrier is not None:
            check_name(self, "carrier")
            if self.node is not None or self.torsional_stiffness:
                other = "node" if self.node is not None else "torsional_stiffness"
                what, why = f"carrier and {other} are given", "A planet turns on its pin"
                raise InputError(what, Argument(f"Bearing.{other}"), why, f"Leave {other} out")
        check_number(self, "carrier_position", "m", -1e3, 1e3)
        check_number(self, "clearance", "m", 0.0, 0.01)
        if self.clearance:
            _check_clearance(self)
        if self.floating:
            _check_floating(self)
        shift = real_numbers(Argument("Bearing.offset"), self.offset)
        if shift.shape != (6,) or not np.all(np.abs(shift) < 0.1):
            what, why = f"offset = {shift.tolist()}", "Wanted: six numbers in m and rad below 0.1"
            remedy = "Give the displacement of the seat along and about x, y, z"
            raise InputError(what, Argument("Bearing.offset"), why, remedy)

    @property
    def nonlinear(self) -> str:
        """Kind of bearing whose stiffness depends on its load; empty of a linear one."""
        if self.rolling is not None:
            return "rolling bearing"
        return "bearing with clearance" if self.clearance else ""

    @property
    def is_default(self) -> bool:
        """Whether it has no data, so that it is stiff."""
        empty = self.radial_stiffness is None and self.stiffness is None and self.rolling is None
        others = self.axial_stiffness, self.torsional_stiffness, np.any(self.tilting_stiffness)
        return empty and not any(others)

    @property
    def holds(self) -> bool:
        """Whether it holds the shaft, which does not turn."""
        return self.torsional_stiffness > 0.0 and self.carrier is None

    @property
    def floats(self) -> bool:
        """Whether a radial stiffness of zero is prescribed, so that a rigid shaft floats."""
        return np.ndim(self.radial_stiffness or 0.0) == 0 and self.radial_stiffness == 0.0

    @property
    def rest_load(self) -> Array:
        """Force and moment of the shaft on a linear bearing without a displacement (6,)."""
        return np.asarray(np.asarray(self.force) - self.stiffness_matrix @ np.asarray(self.offset))

    @property
    def stiffness_matrix(self) -> Array:
        """Stiffness of a linear bearing (6, 6); zero for a rolling bearing, which needs a load."""
        if self.is_default:
            return np.diag([0.0 if self.floating else STIFF, STIFF, STIFF, 0.0, 0.0, 0.0])
        return _assembled(self, "stiffness")

    @property
    def damping_matrix(self) -> Array:
        """Damping (6, 6)."""
        return _assembled(self, "damping")


def takes_axial_force(bearing: Bearing) -> bool:
    """Whether a rolling bearing holds the shaft along its axis, in one direction at least."""
    rolling = bearing.rolling
    return rolling is not None and rolling.takes_axial_force and not bearing.floating


def axial_way(bearing: Bearing) -> int:
    """Direction along x in which alone a bearing with a contact angle holds the shaft, or 0."""
    angle = getattr(bearing.rolling, "contact_angle", 0.0)
    return bearing.rolling.direction if bearing.rolling is not None and angle else 0


def held_by(bearing: Bearing) -> Array:
    """Projection (6, 6) on the displacements that a bearing resists, however stiff it is."""
    if bearing.rolling is not None:
        return np.diag([float(takes_axial_force(bearing)), 1.0, 1.0, 0.0, 0.0, 0.0])
    values, vectors = np.linalg.eigh(bearing.stiffness_matrix)
    stiff = vectors[:, values > _FREE * values.max(initial=0.0)]
    return np.asarray(stiff @ stiff.T)


def _check_pair(bearing: Bearing, name: str, unit: str, size: int) -> None:
    where = Argument(f"Bearing.{name}")
    values = real_numbers(where, getattr(bearing, name), f"a number [{unit}]")
    if values.shape not in ((), (size,)):
        what, why = f"{name} has the shape {values.shape}", f"Wanted: one value, or {size}"
        raise InputError(what, where, why, "Give one value, or one for each direction")
    bad = values[~((values >= 0.0) & (values < 1e30))]
    if bad.size:
        what, why = f"{name} = {bad.flat[0]:.6g} {unit}", "It must be finite and not negative"
        raise InputError(what, where, why, f"Give {name} in {unit}")
    value = float(values) if not values.ndim else tuple(values.tolist())
    object.__setattr__(bearing, name, value)


def _check_clearance(bearing: Bearing) -> None:
    """Refuse a clearance of a bearing that has another law, or unequal stiffnesses."""
    where, what = Argument("Bearing.clearance"), f"clearance = {bearing.clearance * 1e6:.6g} um"
    if bearing.torsional_stiffness:
        why, remedy = "It holds the shaft by torsional_stiffness", "Give another bearing for that"
        raise InputError(what, where, why, remedy)
    if bearing.rolling is not None or bearing.stiffness is not None:
        why = "A rolling bearing has its own clearance, and a matrix holds all directions together"
        raise InputError(what, where, why, "Give radial_stiffness, or radial_clearance of its type")
    radial = bearing.stiffness_matrix.diagonal()[1:3]
    if not radial[0] == radial[1] > 0.0:
        why = f"Beyond it the radial stiffness is {radial[0]:.4g} and {radial[1]:.4g} N/m"
        raise InputError(what, where, why, "Give one radial_stiffness above 0")


def _check_floating(bearing: Bearing) -> None:
    """Refuse a floating bearing that is stiff along the shaft, or only carries with axial force."""
    where, what = Argument("Bearing.floating"), "floating = true"
    if getattr(bearing.rolling, "contact_angle", 0.0):
        why = "A bearing with a contact angle carries radial forces only with an axial one"
        remedy = "Give another type, or a pair that is preloaded"
        raise InputError(what, where, why, remedy)
    if bearing.rolling is None and bearing.stiffness_matrix[0].any():
        why = "It takes no axial force, and its stiffness along the shaft is not zero"
        raise InputError(what, where, why, "Leave out axial_stiffness, or floating")


def _matrix(name: str, value: ArrayLike) -> Array:
    """Symmetric matrix (6, 6) from one of five or six rows."""
    where = Argument(f"Bearing.{name}")
    matrix = real_numbers(where, value)
    if matrix.shape == (5, 5):
        full = np.zeros((6, 6))
        full[np.ix_(HELD, HELD)] = matrix
        matrix = full
    if matrix.shape != (6, 6) or not np.all(np.isfinite(matrix)):
        what = f"{name} has the shape {matrix.shape} or is not finite"
        remedy = "Give the rows x, y, z, theta_y, theta_z, or all six with theta_x"
        raise InputError(what, where, "It must be a finite (5, 5) or (6, 6) matrix", remedy)
    scale = np.abs(matrix).max()
    least = float(np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0])
    if np.abs(matrix - matrix.T).max() > 1e-6 * scale or least < -1e-9 * scale:
        what = f"{name} is not symmetric, or has the negative eigenvalue {least:.4g}"
        why = "A passive support stores or dissipates energy in every motion"
        raise InputError(what, where, why, "Check signs and positions of its entries")
    matrix = 0.5 * (matrix + matrix.T)
    matrix.flags.writeable = False
    return matrix


def _assembled(bearing: Bearing, kind: str) -> Array:
    if (matrix := getattr(bearing, kind)) is not None:
        return np.array(matrix)
    radial = np.broadcast_to(np.asarray(getattr(bearing, f"radial_{kind}") or 0.0), 2)
    tilting = np.broadcast_to(np.asarray(getattr(bearing, f"tilting_{kind}")), 2)
    along = getattr(bearing, f"axial_{kind}"), *radial
    return np.diag([*along, getattr(bearing, f"torsional_{kind}"), *tilting]).astype(float)
