"""A line contact over time: squeeze film, moving roughness, imposed load or imposed approach."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.ehl.thermal.thermal_model import ThermalModel, read_thermal
from tribodyn.ehl.transient.heated_steps import follow_heated
from tribodyn.ehl.transient.moving_contact import (
    REASONS,
    MovingContact,
    Series,
    flooded_domain,
    read_inputs,
    reference_scale,
)
from tribodyn.ehl.transient.solution import (
    TransientLineContact,
    solution_over_time,
    with_heat_over_time,
)
from tribodyn.errors import (
    ComputationError,
    require_between,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.interrupt import stoppable
from tribodyn.lubricant import Lubricant

#: Share of the load near the last node above which the grid is too short, and how often it is
#: extended.
_LATE_LOAD, _EXTENSIONS = 1e-3, 4


def solve_transient_line_contact(
    time: ArrayLike,
    load_per_width: Series,
    equivalent_radius: Series,
    entrainment_speed: Series,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    impose: Literal["load", "approach"] = "load",
    approach: Series | None = None,
    start: Literal["steady", "unloaded"] = "steady",
    nodes: int = 513,
    domain: Literal["auto"] | tuple[float, float] = "auto",
    inlet: Literal["flooded", "zero"] = "flooded",
    viscosity_law: str = "roelands",
    compressible: bool = True,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None] = (None, None),
    surface_speeds: tuple[Series, Series] | None = None,
    thermal: bool | ThermalModel = False,
    reference_length: float | None = None,
    tolerance: float = 1e-8,
    step_halvings: int = 6,
    keep_every: int = 1,
) -> TransientLineContact:
    """Film of a line contact whose load, radius and speed change over time.

    Reynolds' equation with its squeeze term, elastic deflection and the load at every instant, on
    one fixed grid. Second order in time (backward differences) and in space; 200 to 800 steps
    over the time of contact.

    Parameters
    ----------
    time : (m,) array [s]
        Instants, rising.
    load_per_width : float, array or callable [N/m]
        Load per face width; where the approach is imposed, its estimate, which sets the grid.
    equivalent_radius, entrainment_speed : float, array or callable [m], [m/s]
        Reduced radius of curvature; HALF the sum of the surface speeds, zero or positive.
    lubricant : Lubricant
        The oil at its working temperature.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    impose : {"load", "approach"}
        What is imposed; the other is the answer.
    approach : float, array or callable, optional [m]
        Approach of the bodies since their undeformed flanks touched, rising under load, with
        the deflection counted from ``reference_length``.
    start : {"steady", "unloaded"}
        Steady state under the first inputs, or, with an imposed approach that leaves a gap,
        an unloaded film at rest.
    nodes : int
        Nodes of the grid.
    domain : "auto" or (float, float) [b]
        First and last position, b being the half width of the widest dry contact.
    inlet : {"flooded", "zero"}
        Whether the wedge before the first node is full of oil, or the oil begins there.
    viscosity_law, compressible
        As for :func:`tribodyn.ehl.solve_line_contact`.
    roughness : two of RoughnessProfile or None
        Heights of the two surfaces, carried along at their speeds.
    surface_speeds : two of float, array or callable, optional [m/s]
        Speeds of the two surfaces; needed with roughness. A heated film rolls without them.
    thermal : bool or ThermalModel
        Whether temperatures, pressure and film are solved together at every instant, and how the
        oil shears; see :func:`tribodyn.ehl.solve_line_contact`. The result is then a
        :class:`ThermalTransientLineContact`.
    reference_length : float, optional [m]
        Distance from the line of centres at which a half space has the deflection zero; by
        default the greatest radius. It shifts the approach by a multiple of the load.
    tolerance : float
        Relative change of the pressure, and of the flux, at convergence of an instant.
    step_halvings : int
        How often a time step that fails is halved.
    keep_every : int
        Steps between stored pressures and films; zero to store none.

    Raises
    ------
    InputError
        If an input is out of range or contradicts another.
    ComputationError
        If an instant does not converge; the message names it.

    Valid for smooth or resolved rough surfaces, isothermal and Newtonian unless ``thermal``; the
    film must not touch. Beyond the outlet the gap counts as full when the contact grows over it.
    Source: Reynolds equation; Venner and Lubrecht, Multilevel Methods in Lubrication (2000).
    A heated surface moves as a half-space with all the heat that it took up, after Carslaw and
    Jaeger, Conduction of Heat in Solids (1959), section 10.3.

    Examples
    --------
    >>> import numpy as np
    >>> from tribodyn.lubricant import Lubricant
    >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
    >>> time = np.linspace(0.0, 1e-3, 51)
    >>> load = 147802.0 * (1.0 - 0.3 * np.sin(np.pi * time / 1e-3) ** 2)
    >>> contact = solve_transient_line_contact(time, load, 8e-3, 3.0722, oil, 2.2e11, nodes=257)
    >>> bool(contact.central_film.max() > contact.central_film[0])
    True
    """
    _require_options(effective_modulus, start, nodes, inlet, tolerance, keep_every)
    inputs = read_inputs(
        time,
        load_per_width,
        equivalent_radius,
        entrainment_speed,
        impose=impose,
        approach=approach,
        surface_speeds=surface_speeds,
        roughness=roughness,
    )
    scale = reference_scale(
        inputs.time, inputs.load, inputs.radius, inputs.entrainment_speed, effective_modulus
    )
    extent = domain
    if extent == "auto":
        extent = flooded_domain(
            scale,
            inputs.load,
            inputs.radius,
            inputs.entrainment_speed,
            lubricant,
            effective_modulus,
        )
    length = float(np.max(inputs.radius)) if reference_length is None else reference_length
    require_positive("reference_length", length, "m")
    contact = MovingContact(
        inputs=inputs, scale=scale, lubricant=lubricant, modulus=effective_modulus, nodes=nodes,
        domain=(float(extent[0]), float(extent[1])), inlet=inlet, law=viscosity_law,
        compressible=compressible, length=length, tolerance=tolerance,
        thermal=read_thermal(thermal),
    )  # fmt: skip
    return _extended(contact, start, step_halvings, keep_every, domain == "auto")


def _extended(
    contact: MovingContact, start: str, step_halvings: int, keep_every: int, automatic: bool
) -> TransientLineContact:
    """Integrate over time, on a longer grid if the film reaches the end of this one."""
    for _ in range(_EXTENSIONS if automatic else 0):
        contact.check_roughness()
        # The film at one temperature is solved much sooner than the heated one, and reaches as far.
        cold = replace(contact, thermal=None)
        result, late = _follow(cold, start, step_halvings, keep_every)
        if late < _LATE_LOAD:
            if contact.thermal is None:
                return result
            break
        # A film that is squeezed out reaches further than a steady one.
        contact = replace(contact, domain=(contact.domain[0], 1.5 * contact.domain[1]))
    contact.check_roughness()
    result, late = _follow(contact, start, step_halvings, keep_every)
    if late >= _LATE_LOAD:
        warn(
            "transient-outlet",
            f"Up to {late:.2%} of the load lies in the last sixteenth of the grid, so that its "
            f"end at X = {contact.domain[1]:.3g} cuts the film off. Give a domain with a later "
            "last node",
        )
    return result


def _require_options(
    effective_modulus: float, start: str, nodes: int, inlet: str, tolerance: float, keep_every: int
) -> None:
    require_positive("effective_modulus", effective_modulus, "Pa")
    require_between("nodes", nodes, 65, 16385, remedy="257 to 513 nodes suit most contacts")
    require_between("tolerance", tolerance, 1e-13, 1e-3)
    require_between("keep_every", keep_every, 0, 1e9)
    require_one_of("start", start, ("steady", "unloaded"))
    require_one_of("inlet", inlet, ("flooded", "zero"))


def _follow(
    contact: MovingContact, start: str, step_halvings: int, keep_every: int
) -> tuple[TransientLineContact, float]:
    """Result, and the greatest share of the load near the last node."""
    from tribodyn.ehl._kernel.transient import RECORD, follow_contact

    inputs = contact.inputs
    imposed = inputs.approach is None
    if contact.thermal is not None:
        contact.require_rolling()
    state = contact.steady() if start == "steady" else contact.unloaded()
    m, n = inputs.time.size, contact.nodes - 1
    records = np.zeros((m, RECORD))
    stored_instants = np.arange(0, m, keep_every) if keep_every > 0 else np.zeros(0, np.int64)
    pressures, films = np.zeros((2, stored_instants.size, n + 1))
    if contact.thermal is not None:
        heat = follow_heated(
            contact, contact.thermal, state, step_halvings, stored_instants,
            (records, pressures, films), steady=start == "steady",
        )  # fmt: skip
        if heat.failure:
            raise _failure(contact, heat.failure, heat.instant, step_halvings)
        result = solution_over_time(contact, records, stored_instants, pressures, films)
        heated = with_heat_over_time(result, inputs.surface_speeds, heat, contact.thermal)
        return heated, float(np.max(records[:, 10]))
    posed = contact.kernel_contact(imposed, 1.0 if imposed else contact.depth)
    status, instant, _ = stoppable(
        follow_contact, posed, 1.25, contact.time, contact.table(), step_halvings, keep_every,
        np.zeros(0), state.P, state.H, state.instant, records, pressures, films,
    )  # fmt: skip
    if status != 0:
        raise _failure(contact, REASONS[status], instant, step_halvings)
    result = solution_over_time(contact, records, stored_instants, pressures, films)
    return result, float(np.max(records[:, 10]))


def _failure(
    contact: MovingContact, reason: str, instant: int, step_halvings: int
) -> ComputationError:
    inputs = contact.inputs
    operating_point = (
        f"load {inputs.load[instant]:.6g} N/m"
        if inputs.approach is None
        else f"approach {inputs.approach[instant]:.6g} m"
    )
    return ComputationError(
        f"The contact did not converge at instant {instant} of {inputs.time.size - 1}, "
        f"t = {inputs.time[instant]:.6g} s: {reason}",
        where=f"{operating_point}, radius {inputs.radius[instant]:.6g} m, entrainment speed "
        f"{inputs.entrainment_speed[instant]:.6g} m/s",
        why=f"the step from t = {inputs.time[instant - 1]:.6g} s failed after it was halved "
        f"{step_halvings} times",
        remedy="Use more time steps, smoother inputs, or a longer ramp from and to 1 to 2 % "
        "of the load",
    )
