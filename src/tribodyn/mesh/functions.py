"""What the dynamics reads from the mesh: a few functions of the mesh phase."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between
from tribodyn.mesh.columns import MeshColumns
from tribodyn.mesh.gears import SPATIAL_COORDINATES
from tribodyn.mesh.grid import PhaseFunction, PhaseGrid
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.force_law import MeshForceLaw


@dataclass(frozen=True)
class MeshFunctions:
    """What a dynamic model reads from the mesh: smooth functions of phase between the events.

    Parameters
    ----------
    stiffness : callable
        Mesh stiffness [N/m].
    friction_sum : callable or None
        Sum over the pairs of sliding direction, friction coefficient and load share; nothing
        rubs without it.
    friction_moment_pinion, friction_moment_wheel : callable or None
        The same sum, each pair with its lever, the radius of curvature of that gear [m].
    event_phases : tuple of float
        Phases at which the functions jump; they return the value after the jump.
    tangent_stiffness : callable, optional
        Slope of the force law at the nominal load [N/m].
    static_transmission_error : callable, optional
        Deflection under the nominal load at rest [m].
    total_normal_force : float, optional
        Nominal load along the line of action [N].
    force_law : MeshForceLaw, optional
        Force over deflection at every phase.
    direction : callable, optional
        Change of the compression with the six coordinates of the pair (phases, 6); that of the
        base radii where there is none.
    friction : callable, optional
        Generalized friction force over the normal force (phases, 6); that of the three sums where
        there is none.
    error : callable, optional
        Transmission error without load, taken off the compression [m].
    spatial_direction, spatial_friction : callable, optional
        Direction and friction of cylindrical gears over twelve coordinates (phases, 12), see
        :func:`tribodyn.dynamics.helical12`.
    """

    stiffness: Callable[[Array | float], Array]
    friction_sum: Callable[[Array | float], Array] | None
    friction_moment_pinion: Callable[[Array | float], Array] | None
    friction_moment_wheel: Callable[[Array | float], Array] | None
    event_phases: tuple[float, ...]
    tangent_stiffness: Callable[[Array | float], Array] | None = None
    static_transmission_error: Callable[[Array | float], Array] | None = None
    total_normal_force: float | None = None
    force_law: MeshForceLaw | None = None
    direction: Callable[[Array], Array] | None = None
    friction: Callable[[Array], Array] | None = None
    error: Callable[[Array], Array] | None = None
    spatial_direction: Callable[[Array], Array] | None = None
    spatial_friction: Callable[[Array], Array] | None = None

    def tangent_error(self, phase: Array | float) -> Array:
        """Error that makes the tangent stiffness deflect like the force law at the nominal load.

        Parameters
        ----------
        phase : float or array
            Mesh phase.

        Returns
        -------
        array [m]
            Static transmission error less the load over the tangent stiffness: the tangent to the
            force law meets zero force at this deflection.

        Raises
        ------
        InputError
            If the mesh has no force law.
        """
        error, _ = self._tangent_error(np.asarray(phase, dtype=float))
        return np.zeros_like(error) if self._is_linear else error

    @cached_property
    def _is_linear(self) -> bool:
        """Whether the tangent begins at zero: between knots only interpolation would be left."""
        tangent = self.tangent_stiffness
        knots = tangent.grid.phase if isinstance(tangent, PhaseFunction) else self.event_phases
        error, size = self._tangent_error(np.asarray(knots, dtype=float))
        return bool(np.all(np.abs(error) <= _ROUNDING * np.abs(size)))

    def _tangent_error(self, phase: Array) -> tuple[Array, Array]:
        """Error of the tangent and static transmission error."""
        tangent, static = self.tangent_stiffness, self.static_transmission_error
        if tangent is None or static is None or self.total_normal_force is None:
            raise InputError(
                "this mesh has no tangent stiffness",
                where="argument mesh_force",
                why="Tangent stiffness and static transmission error come from a loaded tooth "
                "contact",
                remedy='Take such a stiffness model, or mesh_force = "stiffness"',
            )
        deflection = np.asarray(static(phase))
        return deflection - self.total_normal_force / np.asarray(tangent(phase)), deflection


#: Difference of two deflections over their size that is none.
_ROUNDING = 1e-12
#: The sums of a mesh table that act on a structure, in this order.
CHANNELS = ("friction_sum", "friction_moment_pinion", "friction_moment_wheel")
#: Part of the first of them that asperities cause, where the friction law has such a part.
ASPERITIES = "asperity_friction_sum"
#: Moment about the line of action that tilts gears in space, where contacts are slices of lines.
COUPLE = "friction_couple"
#: Friction over each coordinate of gears on crossed axes.
WRENCH = tuple(f"friction_{name}" for name in SPATIAL_COORDINATES)
#: Loads over the nominal load at which a mesh is looked at: dense where friction laws bend.
LOADS = (0.04, 0.12, 0.27, 0.48, 0.74, 1.0, 1.3, 1.65, 2.05, 2.45, 2.8, 3.0)
_TERMS = 7


@dataclass(frozen=True, eq=False)
class MeshFriction:
    """Friction sums ``f(phase, N) = sum_k c_k(phase) x^k`` with ``x = min(N/load, limit)``.

    Parameters
    ----------
    grid : PhaseGrid
        Knots on the mesh phase, twice at each event.
    coefficients : array (n, terms, 3 or 4)
        Coefficients ``c_k`` of the sum of friction over normal force [1], of its moments on pinion
        and wheel over it [m], and of the part of the sum from asperities where that is known [1].
    load : float [N]
        Nominal normal force of all pairs.
    limit : float
        Load over the nominal load above which friction over normal force stays [1].
    fit_error : float
        Largest distance of a friction force from its polynomial, over the largest one [1].
    couple : array (n, terms), optional
        Coefficients of the moment of friction about the line of action over the normal force [m],
        where contacts are slices of lines of contact.
    wrench : array (n, terms, 12), optional
        Coefficients of friction over the coordinates of both gears on crossed axes, over the
        normal force [1], of their moments [m].
    """

    grid: PhaseGrid
    coefficients: Array
    load: float
    limit: float
    fit_error: float
    couple: Array | None = None
    wrench: Array | None = None

    def channel(self, name: str) -> PhaseFunction:
        """Coefficients of one of the sums as a function of phase.

        Parameters
        ----------
        name : str
            One of ``CHANNELS``, ``"asperity_friction_sum"`` where ``splits``, or
            ``"friction_couple"`` where there is a ``couple``, or ``"friction_pinion_x"`` and so
            on where there is a ``wrench``.

        Returns
        -------
        PhaseFunction
            Gives arrays whose last axis is the power of the load.
        """
        if name == COUPLE and self.couple is not None:
            return PhaseFunction(self.grid, self.couple)
        if name in WRENCH and self.wrench is not None:
            return PhaseFunction(self.grid, self.wrench[:, :, WRENCH.index(name)])
        place = (*CHANNELS, ASPERITIES).index(name)
        return PhaseFunction(self.grid, self.coefficients[:, :, place])

    @property
    def splits(self) -> bool:
        """Whether the part of the friction that asperities cause is known."""
        return bool(self.coefficients.shape[-1] > len(CHANNELS))

    def value(self, name: str, phase: ArrayLike, normal_force: ArrayLike) -> Array:
        """Friction sum at a phase under a load.

        Parameters
        ----------
        name : str
            As for ``channel``.
        phase : float or array
            Mesh phase.
        normal_force : float or array [N]
            Normal force of all pairs; of the same shape.

        Returns
        -------
        array
            Over the normal force; moments in m.
        """
        coefficients = self.channel(name)(np.asarray(phase, dtype=float))
        ratio = np.clip(np.abs(np.asarray(normal_force, dtype=float)) / self.load, 0.0, self.limit)
        powers = ratio[..., None] ** np.arange(coefficients.shape[-1])
        return np.asarray((coefficients * powers).sum(axis=-1))

    def __repr__(self) -> str:
        """One line."""
        return (
            f"MeshFriction(loads to {self.limit:g} times {self.load:.5g} N, "
            f"fitted within {100.0 * self.fit_error:.2g} %)"
        )


def mesh_friction(tables: Sequence[MeshColumns], nominal: MeshColumns) -> MeshFriction:
    """Join the friction of one mesh at several loads.

    Parameters
    ----------
    tables, nominal : MeshColumns
        The same mesh at the same speed under different torques, on one phase grid, and the one at
        the nominal torque.

    Raises
    ------
    InputError
        If there are too few loads, or the tables are not of the same mesh.

    Notes
    -----
    Least squares in the friction force, so that light loads, which rub little, count little. The
    quotient of friction and normal force is a polynomial of the sixth degree in the load.

    Examples
    --------
    >>> from tribodyn.gear import Material, spur_pair
    >>> from tribodyn.lubricant import Lubricant
    >>> from tribodyn.mesh import build
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=0.349, pinion_face_width=50e-3)
    >>> settings = dict(material=Material(), stiffness_model="rectangular",
    ...     stiffness_options={"pair_stiffness": 5e8}, lubricant=Lubricant(0.08, 880.0, 2e-8),
    ...     friction_law="constant", friction_options={"coefficient": 0.05},
    ...     composite_roughness=0.0, pinion_speed=100.0, steps=64)
    >>> tables = [build(pair, pinion_torque=90.0 * x, **settings) for x in LOADS]
    >>> found = mesh_friction(tables, tables[LOADS.index(1.0)])
    >>> round(float(found.value("friction_sum", 0.6, 2.0 * found.load)), 12)
    -0.05
    """
    ratio = np.array([table.total_normal_force for table in tables]) / nominal.total_normal_force
    _check(tables, nominal, ratio)
    split = all(getattr(table, ASPERITIES) is not None for table in tables)
    in_slices = nominal.face_position is not None
    in_space = nominal.direction.shape[-1] == len(WRENCH)
    names = (*CHANNELS, *(COUPLE,) * in_slices, *WRENCH * in_space, *(ASPERITIES,) * split)
    sums = np.array([_sums(table, names) for table in tables])
    powers = ratio[:, None] ** np.arange(_TERMS)
    by_force = np.linalg.lstsq(
        ratio[:, None] * powers, ratio[:, None] * sums.reshape(ratio.size, -1), rcond=None
    )[0]
    residual = ratio[:, None] * (powers @ by_force - sums.reshape(ratio.size, -1))
    force = ratio[:, None, None] * sums
    largest = np.abs(force).max(axis=(0, 2))
    if in_space:  # parts of one force or moment
        parts = slice(names.index(WRENCH[0]), names.index(WRENCH[-1]) + 1)
        largest[parts] = largest[parts].reshape(4, 3).max(axis=1).repeat(3)
    scale = np.where(largest > 0.0, largest, 1.0)[None, :, None]
    fit = np.abs(residual.reshape(force.shape)) / scale
    fit = fit[:, : len(CHANNELS) + in_slices + len(WRENCH) * in_space]
    columns = dict(zip(names, by_force.reshape(_TERMS, len(names), -1).swapaxes(0, 1), strict=True))
    couple = columns.pop(COUPLE, None)
    wrench = [columns.pop(name).T for name in WRENCH if in_space]
    return MeshFriction(
        grid=nominal.grid,
        coefficients=np.moveaxis(np.stack(list(columns.values()), axis=1), -1, 0),
        couple=None if couple is None else couple.T,
        wrench=np.stack(wrench, axis=-1) if in_space else None,
        load=nominal.total_normal_force,
        limit=float(ratio.max()),
        fit_error=float(fit.max()),
    )


def _sums(table: MeshColumns, names: tuple[str, ...]) -> list[Array]:
    """Sums of a table by name; those over the coordinates are columns of its friction."""
    return [
        table.friction[:, WRENCH.index(name)] if name in WRENCH else getattr(table, name)
        for name in names
    ]


def _check(tables: Sequence[MeshColumns], nominal: MeshColumns, ratio: Array) -> None:
    if np.unique(ratio).size <= _TERMS:
        why = f"A polynomial with {_TERMS} terms goes through more than {_TERMS} loads"
        remedy = "Build the mesh at the loads in tribodyn.mesh.LOADS"
        raise InputError(f"{np.unique(ratio).size} different loads", "argument tables", why, remedy)
    require_between("load over the nominal load", ratio, 0.0, np.inf, "")
    for number, table in enumerate(tables):
        same = np.array_equal(table.phase, nominal.phase)
        if not (same and np.isclose(table.pinion_speed, nominal.pinion_speed)):
            what = f"table {number} is of another mesh or another speed"
            why = "Friction is joined over the load alone"
            remedy = "Change nothing but pinion_torque between the tables"
            raise InputError(what, "argument tables", why, remedy)
