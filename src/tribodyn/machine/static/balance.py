"""Static balance of a machine: shafts, meshes, bearings and housing under the torque.

The potential energy of the machine is convex in the coordinates of all nodes, so Newton's method
with a limited step finds its minimum even where a clearance leaves shafts free at first. The
output is held against rotation; the torque there is a result.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.memory import Memo
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    collected,
    no_such,
    real_numbers,
    warn,
)
from tribodyn.gear import Misalignment
from tribodyn.machine.machine import Machine
from tribodyn.machine.planetary.turning_frame import centrifugal_force
from tribodyn.machine.rolling.element_ring import BearingState, RollingElementBearing
from tribodyn.machine.static.face_law import FaceLaw
from tribodyn.machine.static.static_model import MeshLaw, StaticModel
from tribodyn.machine.static.supports import least_stiffness
from tribodyn.types import Array

#: Most Newton steps, greatest displacement in one of them [m], greatest residual over the loads.
_STEPS, _STRIDE, _TOLERANCE = 200, 2e-4, 1e-12
#: Share of the greatest load, and force [N], below which a force is rounding.
_ROUNDING = 1e-9
#: Share of its load by stiffness that a mesh in a loop has at least, whose teeth are computed.
_LEAST_SHARE = 0.01
#: Displacements of the last balances, which a speed does not change.
_solved: Memo[tuple[Array, float, int]] = Memo(8)
#: Points at which the deflection of a shaft is sampled, besides its nodes.
_POINTS = 41


@dataclass(frozen=True, eq=False)
class MeshBalance:
    """A mesh in static balance.

    Parameters
    ----------
    force : float [N]
        Force along the transverse line of action.
    moment : float [N*m]
        Moment of the force about mid face, in the plane of action; zero unless a law gives one.
    compression : float [m]
        Compression along the line of action at mid face, deflection of shafts and bearings left
        out.
    misalignment : float [m]
        Increase of the compression over the common face width along x, by the deflection of
        shafts, bearings and housing.
    stiffness : (2, 2) array
        Derivative of force and moment with respect to compression and its slope [N/m, N, N*m].
    face_load_factor : float or None
        Greatest over mean load per face width; None without a :class:`FaceLaw`, and of a mesh
        that carries no load, whose load has no distribution.
    mounting : Misalignment or None
        On crossed axes: the changes V, H, J and alpha of offset, mounting distances and shaft
        angle by the deflection; ``misalignment`` is zero then.
    """

    force: float
    moment: float
    compression: float
    misalignment: float
    stiffness: Array
    face_load_factor: float | None
    mounting: Misalignment | None = None


@dataclass(frozen=True, eq=False)
class BearingBalance:
    """A bearing in static balance.

    Parameters
    ----------
    displacement : (6,) array [m, rad]
        Of the shaft against the housing.
    load : (6,) array [N, N*m]
        Force and moment of the shaft on the bearing.
    stiffness : (6, 6) array
        Stiffness at this load [N/m, N, N*m].
    state : BearingState or None
        Loads and pressures of the rolling elements; None for a linear bearing.
    """

    displacement: Array
    load: Array
    stiffness: Array
    state: BearingState | None


@dataclass(frozen=True, eq=False)
class ShaftDeflection:
    """A shaft in static balance.

    Parameters
    ----------
    position : (points,) array [m]
        From the beginning of the shaft: gears, bearings, ends of sections, and points in between.
    displacement : (points, 6) array [m, rad]
        x, y, z, theta_x, theta_y, theta_z.
    """

    position: Array
    displacement: Array


@dataclass(frozen=True, eq=False)
class StaticBalance:
    """Static balance of a machine.

    Parameters
    ----------
    machine : Machine
        The machine.
    meshes : mapping of str to MeshBalance
        Forces and misalignment of the meshes.
    bearings : mapping of str to BearingBalance
        Displacements, loads and stiffness of the bearings.
    shafts : mapping of str to ShaftDeflection
        Deflection of the shafts.
    gears : mapping of str to array
        Displacement of each gear (6,) [m, rad].
    housing : array [m, rad]
        Displacement of the coordinates of the housing; empty where it is rigid.
    output_torque : float [N*m]
        Torque about x that holds the output.
    steps : int
        Newton steps.
    assumptions : tuple of str
        What was assumed because it was not given.
    """

    machine: Machine
    meshes: Mapping[str, MeshBalance]
    bearings: Mapping[str, BearingBalance]
    shafts: Mapping[str, ShaftDeflection]
    gears: Mapping[str, Array]
    housing: Array
    output_torque: float
    steps: int
    assumptions: tuple[str, ...]

    def __repr__(self) -> str:
        """One line."""
        forces = ", ".join(f"{name} {mesh.force:.6g} N" for name, mesh in self.meshes.items())
        return f"StaticBalance({forces}; {len(self.bearings)} bearings)"

    def linearized(self) -> Machine:
        """Machine whose rolling bearings are springs with the stiffness at the working load.

        Returns
        -------
        Machine
            A rolling bearing without preload that carries less than its share of the weight of its
            shaft has the stiffness that it has under this share.

        Warns
        -----
        ModelWarning
            ``unloaded-bearing`` names such a bearing.
        """
        bearings = dict(self.machine.bearings)
        for name, bearing in bearings.items():
            if bearing.nonlinear:
                state = self.bearings[name]
                stiffness = self._stiffness(name)
                force = state.load - stiffness @ state.displacement
                loose = bearing if bearing.clearance else None
                bearings[name] = replace(
                    bearing, rolling=None, radial_stiffness=None, axial_stiffness=0.0,
                    tilting_stiffness=0.0, clearance=0.0,
                    stiffness=stiffness, force=force, offset=np.zeros(6), unloaded=loose,
                )  # fmt: skip
                least = 1e-3 * loose.stiffness_matrix[1, 1] if loose else 0.0
                if np.abs(stiffness[:3, :3]).max() <= least:
                    warn(
                        "unloaded-bearing",
                        f'bearing "{name}" carries no load, so that its stiffness is zero: reduce '
                        "its clearance, or preload it",
                    )
        return self.machine._with(bearings=bearings)

    @property
    def sharing(self) -> dict[str, float]:
        """Torques of the first gears of meshes in loops, over that of the input [1]."""
        # The planets of a stage have equal shares; its load factors say how they differ.
        machine, meshes = self.machine, self.machine.kinematics.meshes.items()
        looped = {n: m for n, m in meshes if m.shared and m.force and not machine.meshes[n].carrier}
        torque = math.copysign(1.0, machine.operation.speed) * machine.operation.torque
        over = {n: max(self.meshes[n].force / m.force, _LEAST_SHARE) for n, m in looped.items()}
        return {n: m.torque[0] / torque * over[n] for n, m in looped.items()}

    def _stiffness(self, name: str) -> Array:
        """Stiffness of a bearing at its load, of a rolling one at least at that of a weight."""
        state = self.bearings[name]
        least = least_stiffness(self.machine, name, state.load)
        if least is None:
            return state.stiffness
        warn(
            "unloaded-bearing",
            f'bearing "{name}" carries no load, or less than its share of the weight of shaft '
            f'"{self.machine.bearings[name].shaft}", {least[1]:.4g} N: it has the stiffness that '
            "it has under this share; preload it, or give stiffnesses in place of its type",
        )
        return least[0]


def static_balance(
    machine: Machine,
    *,
    laws: Mapping[str, MeshLaw] | None = None,
    loads: Mapping[str, ArrayLike] | None = None,
) -> StaticBalance:
    """Balance of a machine at rest under its torque.

    Parameters
    ----------
    machine : Machine
        The machine; its torque acts on the beginning of the input shaft, and the end of the
        output shaft is held.
    laws : mapping of str to function, optional
        Laws of meshes in place of their mean stiffness: force [N] and moment about mid face
        [N*m] of the compression [m] at mid face and its slope over the face [1], and the
        derivatives of both, (2, 2).
    loads : mapping of str to (6,) array, optional
        Further forces and moments on gears, by name [N, N*m].

    Returns
    -------
    StaticBalance

    Raises
    ------
    InputError
        If a law or a load names a part that the machine does not have.
    ComputationError
        If nothing balances the loads; the message names the shaft.

    Notes
    -----
    Meshes carry on the flank that the torque presses; errors enter with their mean.

    Examples
    --------
    >>> from tribodyn.machine import Bearing, Gear, Mesh, Operation, Section, Shaft
    >>> shaft = Shaft([Section(0.2, 0.04)])
    >>> machine = Machine(
    ...     shafts={"in": shaft, "out": shaft},
    ...     gears={"z1": Gear("in", 0.05, 20, 0.02), "z2": Gear("out", 0.05, 40, 0.02)},
    ...     meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
    ...     bearings={f"{s}{x}": Bearing(s, x) for s in ("in", "out") for x in (0.0, 0.2)},
    ...     operation=Operation("in", "out", 100.0, 60.0))
    >>> balance = static_balance(machine)
    >>> round(balance.meshes["first"].force, 3), round(balance.output_torque, 6)
    (2128.356, 120.0)
    >>> round(float(np.hypot(*balance.bearings["in0.0"].load[1:3])), 3)  # three quarters of it
    1596.267
    """
    model = StaticModel(machine, laws or {})
    for kind, names, parts in (
        ("mesh", laws or {}, machine.meshes),
        ("gear", loads or {}, machine.gears),
    ):
        for name in names:
            if name not in parts:
                raise InputError(no_such(kind, name, parts, Argument("laws and loads")))
    run = machine.operation
    torque = np.copysign(1.0, run.speed) * run.torque
    external = torque * model.structure.at(run.input, 0.0)[3]
    external += centrifugal_force(model.structure)
    for name, load in (loads or {}).items():
        values = real_numbers(Argument(f"loads[{name}]"), load)
        if values.shape != (6,):
            what, why = f"the load has the shape {values.shape}", "Wanted: forces and moments, (6,)"
            raise InputError(what, Argument(f"loads[{name}]"), why, "Give six numbers")
        external += values @ model.gears[name]
    output_row = model.structure.balance
    displacement, output, steps = _solved.get(
        (external, output_row, *model.content), lambda: _solve(model, external, output_row)
    )
    return _balance(model, external, displacement, output, steps)


class _Forces:
    """Loads and stiffness of all parts at a displacement of all coordinates."""

    def __init__(
        self, model: StaticModel, laws: Mapping[str, MeshLaw], displacement: Array
    ) -> None:
        self.total, self.tangent = model.stiffness @ displacement, model.stiffness.copy()
        self.meshes: dict[str, tuple[Array, Array]] = {}
        self.bearings: dict[str, tuple[Array, Array]] = {}
        for name, rows in model.meshes.items():
            force, moment, stiffness = laws[name](*(rows @ displacement).tolist())
            self.meshes[name] = np.array([force, moment]), np.asarray(stiffness, dtype=float)
        for name, rows in model.bearings.items():
            self.bearings[name] = model.bearing(name, rows @ displacement)
        for group, kind in ((self.meshes, model.meshes), (self.bearings, model.bearings)):
            for name, (load, stiffness) in group.items():
                self.total += load @ kind[name]
                self.tangent += kind[name].T @ stiffness @ kind[name]

    def rounding(self, external: Array) -> float:
        """Force below which a force is rounding of the loads [N]."""
        loads = [*self.meshes.values(), *self.bearings.values()]
        greatest = max(np.abs(external).max(), *(np.abs(load[:3]).max() for load, _ in loads))
        return _ROUNDING * max(float(greatest), 1.0)


def _solve(model: StaticModel, external: Array, output_row: Array) -> tuple[Array, float, int]:
    """Displacement of all coordinates, torque that holds the output, number of steps."""
    laws = {name: model.law(name) for name in model.meshes}
    rolling = [n for n, b in model.machine.bearings.items() if b.nonlinear]
    reach = np.concatenate([model.bearings[n][:3] for n in rolling] or [np.zeros((0, model.size))])
    shift, softest = (1e7 if rolling else 0.0), 1e-3
    displacement, best, torque = np.zeros(model.size), np.inf, 0.0
    limit = _TOLERANCE * float(np.abs(external * model.scale).max()) + 1e-12
    forces = _Forces(model, laws, displacement)
    for step in range(_STEPS):
        residual = external - forces.total
        shift = max(0.1 * shift, softest)
        matrix = np.zeros((model.size + 1, model.size + 1))
        matrix[:-1, :-1] = forces.tangent + np.diag(shift / model.scale**2)
        matrix[:-1, -1] = matrix[-1, :-1] = output_row
        change, torque = _split(np.linalg.solve(matrix, np.append(residual, 0.0)))
        remainder = float(np.abs((residual - torque * output_row) * model.scale).max())
        if remainder <= limit or (remainder <= 1e4 * limit and remainder > 0.5 * best):
            return displacement, -torque, step
        best = min(remainder, best)
        if not np.abs(displacement / model.scale).max() < 1.0:
            break
        share = min(1.0, _STRIDE / max(float(np.abs(reach @ change).max(initial=0.0)), 1e-30))
        new = _advance(model, laws, external, (displacement, forces), share * change)
        displacement, forces, shortened = new
        shift *= 100.0 if shortened else 1.0
    raise _unbalanced(model, (residual - torque * output_row) * model.scale, displacement)


def _split(solution: Array) -> tuple[Array, float]:
    return solution[:-1], float(solution[-1])


def _advance(
    model: StaticModel,
    laws: Mapping[str, MeshLaw],
    external: Array,
    start: tuple[Array, _Forces],
    change: Array,
) -> tuple[Array, _Forces, bool]:
    """Go along a step until the energy no longer falls; whether the step was shortened."""
    displacement, forces = start
    share, first = 1.0, float((external - forces.total) @ change)
    for _ in range(20):
        moved = displacement + share * change
        forces = _Forces(model, laws, moved)
        end = float((external - forces.total) @ change)
        if first <= 0.0 or end >= -0.5 * first:
            break
        share *= max(0.1, first / (first - end))
    return moved, forces, share < 1.0


def _unbalanced(model: StaticModel, residual: Array, displacement: Array) -> ComputationError:
    """Error that names the shaft that nothing holds."""
    moved = np.abs(displacement / model.scale)
    values = moved if moved.max() > 1e-2 else np.abs(residual)
    shafts = {
        name: np.abs(model.nodes(name)).max(axis=(0, 1)) > 0.0 for name in model.machine.shafts
    }
    shaft = max(shafts, key=lambda name: float(values[shafts[name]].max(initial=-1.0)))
    part = shafts[shaft]
    worst = np.array(model.structure.names)[part][values[part].argmax()]
    way = f"theta_{worst[-1]}" if "_theta_" in worst else worst[-1]
    bearings = [n for n, b in model.machine.bearings.items() if b.shaft == shaft]
    return ComputationError(
        f"nothing balances the load on {way} of the shaft: after {_STEPS} steps or less it is "
        f"displaced by {1e3 * moved[part].max():.4g} mm, and "
        f"{np.abs(residual[part]).max():.4g} N is left",
        f"shafts.{shaft}",
        f"It is held by {', '.join(bearings) or 'no bearing'}; bearings without axial or tilting "
        "stiffness, of one axial direction only, or too much clearance leave it free",
        "Add a bearing that takes this load, or correct direction, clearance and preload",
    )


def _check_direction(
    name: str, bearing: RollingElementBearing, load: Array, rounding: float
) -> None:
    """Refuse an axial load that an angular contact bearing does not carry."""
    angle = getattr(bearing, "contact_angle", 0.0)
    least = max(1e-6 * np.abs(load[:3]).max(), rounding)
    if angle and bearing.direction * load[0] < -least:
        ways = "+x" if load[0] > 0.0 else "-x", "+x" if bearing.direction > 0 else "-x"
        raise ComputationError(
            f"the shaft presses the bearing along {ways[0]} by {abs(load[0]):.4g} N",
            f"bearings.{name}.direction",
            f"A bearing with a contact angle of {np.degrees(angle):.3g} deg and this direction "
            f"carries axial forces along {ways[1]} only",
            "Turn it, add a bearing of the other direction, or preload it",
        )


def _balance(
    model: StaticModel, external: Array, displacement: Array, output: float, steps: int
) -> StaticBalance:
    """Collect the results by part."""
    laws = {name: model.law(name) for name in model.meshes}
    forces = _Forces(model, laws, displacement)
    meshes, rounding = {}, forces.rounding(external)
    for name, (load, stiffness) in forces.meshes.items():
        compression, slope = (model.meshes[name] @ displacement).tolist()
        misalignment = slope * model.face_width(name)
        law, (force, moment), factor = laws[name], load.tolist(), None
        if isinstance(law, FaceLaw) and force > rounding:
            factor = law.face_load_factor(compression, slope)
        mounting = model.mounting(name, displacement)
        values = force, moment, compression, misalignment, stiffness, factor, mounting
        meshes[name] = MeshBalance(*values)
        if force < -rounding:
            warn(
                "mesh-tension",
                f'mesh "{name}" carries {force:.4g} N: in its loop the other flank would carry '
                "after the backlash; correct stiffness or errors of the loop",
            )
    bearings = {}
    for name, (load, stiffness) in forces.bearings.items():
        moved = model.bearings[name] @ displacement
        rolling = model.machine.bearings[name].rolling
        if rolling is not None:
            _check_direction(name, rolling, load, rounding)
        with collected() as warnings:
            state = model.ring_state(name, moved)
        for warning in warnings:
            warn(warning.code, f'bearing "{name}": {warning.message}')
        bearings[name] = BearingBalance(moved, load, stiffness, state)
    shafts = {}
    for name, shaft in model.structure.shafts.items():
        position = np.union1d(shaft.nodes, np.linspace(0.0, shaft.shaft.length, _POINTS))
        moved = model.structure.basis[model.structure._rows[name]] @ displacement
        rows = np.array([shaft.at(place) for place in position])
        shafts[name] = ShaftDeflection(position, rows @ moved)
    notes = [
        f"meshes.{name}.stiffness: 14 N/(mm um) over the face width"
        for name, mesh in model.machine.meshes.items()
        if mesh.stiffness is None
    ]
    for name, bearing in model.machine.bearings.items():
        if bearing.rolling is not None:
            notes += [f"bearings.{name}.{note}" for note in bearing.rolling.assumptions]
        elif bearing.is_default:
            notes.append(f"bearings.{name} is stiff: 1e9 N/m along x, y and z")
    housing = model.machine.housing
    return StaticBalance(
        machine=model.machine,
        meshes=meshes,
        bearings=bearings,
        shafts=shafts,
        gears={name: rows @ displacement for name, rows in model.gears.items()},
        housing=displacement[model.size - (housing.size if housing else 0) :],
        output_torque=output,
        steps=steps,
        assumptions=tuple(dict.fromkeys(notes)),
    )
