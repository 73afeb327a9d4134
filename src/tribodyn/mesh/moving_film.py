"""The film of one tooth pair from its entry to its exit, over time: the squeeze included."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.errors import require_between
from tribodyn.mesh.table import MeshTable
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.ehl import RoughnessProfile, TransientLineContact
    from tribodyn.gear import Material
    from tribodyn.lubricant import Lubricant


#: Time steps of an engagement: fewer leave the change of the load unresolved.
_LEAST, _MOST = 50, 20000
_NO_ROUGHNESS = (None, None)


def moving_film(
    mesh: MeshTable,
    lubricant: Lubricant,
    material: Material,
    *,
    steps: int = 400,
    ramp: float = 0.05,
    least_share: float = 0.02,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None] = _NO_ROUGHNESS,
    **options: Any,
) -> TransientLineContact:
    """Follow the film of one tooth pair through the mesh, with the squeeze of the oil.

    Parameters
    ----------
    mesh : MeshTable
        Loads, radii and speeds of the pair over the mesh cycle.
    lubricant : Lubricant
        Oil at working temperature.
    material : Material
        Material of both gears.
    steps : int
        Time steps from entry to exit; where the number of pairs changes, one of them spreads the
        jump of the load.
    ramp : float [mesh cycles]
        Time in which the load comes up after the entry, and goes down before the exit.
    least_share : float
        Part of the load at the very entry and exit: a film needs some.
    roughness : two of RoughnessProfile or None
        Heights of the pinion's and the wheel's flank, carried along at their speeds.
    **options : Any
        Further options of :func:`tribodyn.ehl.solve_transient_line_contact`, such as ``nodes``
        and ``keep_every``.

    Returns
    -------
    TransientLineContact
        Time counts from the entry of the pair.

    Raises
    ------
    InputError
        If an option is out of range.
    ComputationError
        If an instant does not converge; the message names it.

    Notes
    -----
    Between the knots of the table the load is interpolated linearly. Source: Reynolds equation;
    see :func:`tribodyn.ehl.solve_transient_line_contact`.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> mesh = tribodyn.run(case).mesh  # doctest: +SKIP
    >>> moving_film(mesh, case.lubricant_properties, case.material_properties)  # doctest: +SKIP
    """
    from tribodyn.ehl import solve_transient_line_contact

    require_between("steps", steps, _LEAST, _MOST)
    require_between("ramp", ramp, 1e-3, 0.5, "mesh cycles")
    require_between("least_share", least_share, 1e-3, 1.0)
    names = ("load_per_width", "equivalent_radius", "entrainment_speed", "sliding_speed")
    age, columns = _life(mesh, names)
    cycles = np.linspace(0.0, age[-1], steps + 1)
    load, radius, speed, sliding = (np.interp(cycles, age, values) for values in columns)
    surfaces = (speed + 0.5 * sliding, speed - 0.5 * sliding)
    return solve_transient_line_contact(
        cycles / mesh.mesh_frequency,
        load * _share(cycles, ramp, least_share),
        radius,
        speed,
        lubricant,
        effective_modulus(material, material),
        roughness=roughness,
        surface_speeds=None if roughness == _NO_ROUGHNESS else surfaces,
        **options,
    )


def _life(mesh: MeshTable, names: tuple[str, ...]) -> tuple[Array, list[Array]]:
    """Columns of the table in the order in which one pair passes them, over mesh cycles."""
    alive = mesh.in_contact.T
    age = (mesh.phase[None, :] + np.arange(alive.shape[0])[:, None])[alive]
    return age, [getattr(mesh, name).T[alive] for name in names]


def _share(cycles: Array, ramp: float, least: float) -> Array:
    """Factor of the load: up from ``least`` after the entry, down to it before the exit."""
    inside = np.clip(np.minimum(cycles, cycles[-1] - cycles) / ramp, 0.0, 1.0)
    return np.asarray(least + (1.0 - least) * inside**2 * (3.0 - 2.0 * inside))
