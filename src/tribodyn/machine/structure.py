"""Matrices of a machine without its meshes: shafts, gear bodies, bearings and housing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.linear_algebra import modes_of
from tribodyn.errors import InputError
from tribodyn.machine.beam import carried_along
from tribodyn.machine.bearing import held_by
from tribodyn.machine.fields import check_number
from tribodyn.machine.graph.bodies import GearBody
from tribodyn.machine.graph.placement import pin_lever
from tribodyn.machine.housing import AXES
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import mean_over_phase
from tribodyn.machine.planetary.turning_frame import centrifugal_force, frame_terms
from tribodyn.machine.shaft import Shaft
from tribodyn.machine.shaft_matrices import ShaftMatrices
from tribodyn.machine.static.supports import linear_load
from tribodyn.types import Array, Mask

#: Eigenvalues below this share of the largest are rounding: the motion is free.
_FREE = 1e-12


@lru_cache(maxsize=64)
def _matrices(*arguments: Any) -> ShaftMatrices:
    """Matrices of a shaft, the same object under every load."""
    return ShaftMatrices(*arguments)


@dataclass(frozen=True, eq=False)
class Reduction:
    """Reduced coordinates of a machine, and how far its natural frequencies are from the full ones.

    Parameters
    ----------
    names : tuple of str
        Names of the reduced coordinates.
    basis : (full, n) array
        Displacement of the full coordinates per reduced coordinate [SI].
    limit : float
        Frequency up to which the reduction was compared with the full model [Hz].
    error : float
        Greatest relative error of a natural frequency below the limit [1].
    """

    names: tuple[str, ...]
    basis: Array
    limit: float
    error: float

    def __repr__(self) -> str:
        """One line."""
        full, size = self.basis.shape
        error = f"error {self.error:.1e} up to {self.limit:.4g} Hz"
        return f"Reduction({full} to {size} coordinates, {error})"


@dataclass(frozen=True, eq=False)
class MachineStructure:
    """Matrices of a machine without its meshes.

    Parameters
    ----------
    machine : Machine
        The machine.
    damping_ratio : float
        Damping of every mode of the structure over its critical value, besides the damping of
        bearings and housing [1].
    element_length : float, optional
        Longest beam element [m]; by default a quarter of each section's diameter, or a sixtieth of
        the shaft if that is more.
    reduction : Reduction, optional
        Reduced coordinates; :func:`reduce_structure` supplies them.
    frame : str, optional
        Carrier with which all coordinates turn, of a planetary stage whose supports are equal in
        all directions: its Coriolis and centripetal forces are included.

    Raises
    ------
    InputError
        If a value is out of range, or a bearing is given by its geometry, so that its stiffness
        depends on its load.

    Notes
    -----
    A node of a shaft has the coordinates ``(x, y, z, theta_x, theta_y, theta_z)``, with names such
    as ``input@85mm_y``; ``theta_x`` is the deviation from uniform rotation. A rigid shaft without
    bearings only turns. With bearings it moves where they have stiffness, and tilts where they
    hold it against tilting.

    Examples
    --------
    >>> from tribodyn.machine import Bearing, Gear, Mesh, Operation, Shaft
    >>> structure = MachineStructure(Machine(
    ...     shafts={"input": Shaft(), "output": Shaft()},
    ...     gears={"z1": Gear("input", 0.0, 27, 0.05), "z2": Gear("output", 0.0, 51, 0.05)},
    ...     meshes={"first": Mesh(("z1", "z2"), normal_module=4.5e-3, stiffness=5e8)},
    ...     bearings={"A": Bearing("input", 0.0, radial_stiffness=4e8)},
    ...     operation=Operation("input", "output", speed=100.0, torque=400.0)))
    >>> structure.names
    ('input_y', 'input_z', 'input_theta_x', 'output_theta_x')
    """

    machine: Machine
    damping_ratio: float = 0.02
    element_length: float | None = None
    reduction: Reduction | None = None
    frame: str | None = None

    def __post_init__(self) -> None:
        check_number(self, "damping_ratio", "", 0.0, 2.0)
        if self.element_length is not None:
            check_number(self, "element_length", "m", 0.0, above=True)
        for name, bearing in self.machine.bearings.items():
            if bearing.nonlinear:
                what = f"the stiffness of a {bearing.nonlinear} depends on its load"
                why = "Matrices hold the stiffness at the working load"
                remedy = "Use the machine of static_balance(machine).linearized()"
                key = "rolling" if bearing.rolling else "clearance"
                raise InputError(what, f"bearings.{name}.{key}", why, remedy)

    def __repr__(self) -> str:
        """One line."""
        reduced = f", {self.reduction}" if self.reduction else ""
        return f"MachineStructure({self.size} coordinates{reduced})"

    @cached_property
    def shafts(self) -> dict[str, ShaftMatrices]:
        """Matrices of each shaft by name."""
        places = {name: [shaft.mass_position] for name, shaft in self.machine.shafts.items()}
        for gear in self.machine.gears.values():
            places[gear.shaft].append(gear.node_position)
        for bearing in self.machine.bearings.values():
            places[bearing.shaft].append(bearing.position)
            if bearing.carrier is not None:
                places[bearing.carrier].append(bearing.carrier_position)
        return {
            name: _matrices(shaft, tuple(places[name]), self.element_length)
            for name, shaft in self.machine.shafts.items()
        }

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.basis.shape[1])

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        if self.reduction:
            return self.reduction.names
        return tuple(np.asarray(self._all_names)[self._moving].tolist())

    @cached_property
    def basis(self) -> Array:
        """Displacement of all nodes and the housing per coordinate, (full, n) [SI]."""
        if self.reduction:
            return self.reduction.basis
        return np.eye(len(self._moving))[:, self._moving]

    @cached_property
    def mass(self) -> Array:
        """Mass matrix, (n, n) [kg, kg*m, kg*m^2]."""
        masses = {name: shaft.mass for name, shaft in self.shafts.items()}
        total = self._assembled({**masses, "": self._housing("mass")})
        for _, body, motion in self._bodies():
            across = body.transverse_moment_of_inertia
            inertia = [*3 * [body.mass], body.moment_of_inertia, across, across]
            total += motion.T @ np.diag(inertia) @ motion
        self._refuse_massless(np.diag(total))
        return total

    def _bodies(self) -> Iterator[tuple[str, GearBody | Shaft, Array]]:
        """Shaft, inertia and displacement (6, n) of all gears and bodies on shafts."""
        for name, body in self.machine.gear_bodies.items():
            yield self.machine.gears[name].shaft, body, self.gear(name)
        for name, shaft in self.machine.shafts.items():
            yield name, shaft, self.at(name, shaft.mass_position)

    def _refuse_massless(self, inertia: Array) -> None:
        """Refuse a motion of a rigid shaft whose gears have no inertia."""
        if self.reduction or np.all(inertia > 0.0):
            return
        name = self.names[int(np.argmin(inertia))]
        shaft = next(s for s in self.shafts if name.startswith(f"{s}_"))
        raise InputError(
            f"{name} has no inertia",
            f"shafts.{shaft}",
            "A rigid shaft has the masses and moments of inertia of its gears alone",
            "Give its gears or the shaft mass and moments of inertia, or the shaft sections",
        )

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness matrix, (n, n) [N/m, N, N*m]."""
        return np.asarray(sum(self.elements.values(), np.zeros((self.size, self.size))))

    @cached_property
    def elements(self) -> dict[str, Array]:
        """Stiffness of each part: ``shafts.input``, ``bearings.A``, ``housing``; their sum is K."""
        elements = {}
        for name, shaft in self.shafts.items():
            if shaft.shaft.sections:
                elements[f"shafts.{name}"] = self._assembled({name: shaft.stiffness})
        for name, coupling in self.machine.couplings.items():
            twist = self.twist(name)
            elements[f"couplings.{name}"] = coupling.torsional_stiffness * np.outer(twist, twist)
        for name, bearing in self.machine.bearings.items():
            motion = self.bearing(name)
            elements[f"bearings.{name}"] = motion.T @ bearing.stiffness_matrix @ motion
        if self.machine.housing is not None:
            elements["housing"] = self._assembled({"": self._housing("stiffness")})
        return elements

    @cached_property
    def damping(self) -> Array:
        """Damping matrix, (n, n) [N*s/m, N*s, N*m*s]."""
        total = self._assembled({"": self._housing("damping")})
        for name, bearing in self.machine.bearings.items():
            motion = self.bearing(name)
            total = total + motion.T @ bearing.damping_matrix @ motion
        for name, coupling in self.machine.couplings.items():
            total = total + coupling.torsional_damping * np.outer(*2 * [self.twist(name)])
        if self.damping_ratio:
            squares, shapes = modes_of(self.stiffness, self.mass)
            rates = np.sqrt(np.where(squares > _FREE * squares.max(initial=0.0), squares, 0.0))
            momentum = self.mass @ shapes
            total = total + (momentum * (2.0 * self.damping_ratio * rates)) @ momentum.T
        return np.asarray(total)

    def gyroscopic(self, speed: float | None = None) -> Array:
        """Skew matrix of the gyroscopic moments.

        Parameters
        ----------
        speed : float, optional
            Speed of the input shaft [rad/s]; that of the operation by default.

        Returns
        -------
        (n, n) array
            To be added to the damping matrix [N*s/m, N*s, N*m*s].
        """
        speed = self.machine.operation.speed if speed is None else speed
        ratios = {name: float(load.ratio) for name, load in self.machine.kinematics.shafts.items()}
        total = self._assembled(
            {n: speed * ratios[n] * shaft.gyroscopic for n, shaft in self.shafts.items()}
        )
        for shaft, body, motion in self._bodies():
            momentum = speed * ratios[shaft] * body.moment_of_inertia
            turned = momentum * np.outer(motion[4], motion[5])
            total += turned - turned.T
        return total + frame_terms(self, speed)[0]

    def at(self, shaft: str, position: float) -> Array:
        """Displacement at a position of a shaft per coordinate.

        Parameters
        ----------
        shaft : str
            Name of the shaft.
        position : float
            From its beginning [m].

        Returns
        -------
        (6, n) array
            Rows ``x, y, z, theta_x, theta_y, theta_z`` [SI].
        """
        return np.asarray(self.shafts[shaft].at(position) @ self.basis[self._rows[shaft]])

    def gear(self, name: str) -> Array:
        """Displacement of the middle of a gear per coordinate.

        Parameters
        ----------
        name : str
            Name of the gear.

        Returns
        -------
        (6, n) array
        """
        gear = self.machine.gears[name]
        return self.at(gear.shaft, gear.node_position)

    def bearing(self, name: str) -> Array:
        """Displacement of the shaft in a bearing against the housing or carrier per coordinate.

        Parameters
        ----------
        name : str
            Name of the bearing.

        Returns
        -------
        (6, n) array
        """
        bearing = self.machine.bearings[name]
        motion = self.at(bearing.shaft, bearing.position)
        if bearing.carrier is not None:
            lever = pin_lever(self.machine.placement, bearing)
            return np.asarray(motion - lever @ self.at(bearing.carrier, bearing.carrier_position))
        if bearing.node is None:
            return motion
        axes = self.machine.placement.axes[bearing.shaft]
        return motion - (axes.T @ self.housing_node(bearing.node).reshape(2, 3, -1)).reshape(6, -1)

    def twist(self, name: str) -> Array:
        """Twist of a coupling per coordinate.

        Parameters
        ----------
        name : str
            Name of the coupling.

        Returns
        -------
        (n,) array
        """
        first, second = self.machine.couplings[name].shafts
        return np.asarray(
            self.at(second, 0.0)[3] - self.at(first, self.machine.shafts[first].length)[3]
        )

    def bearing_load(
        self, name: str, position: ArrayLike, velocity: ArrayLike | None = None
    ) -> Array:
        """Force and moment of the shaft on a bearing, with those at its working load.

        Parameters
        ----------
        name : str
            Name of the bearing.
        position, velocity : (..., n) array
            Motion, such as that of a response [SI]; without a velocity the damping is left out.

        Returns
        -------
        (..., 6) array
            ``F_x, F_y, F_z, M_x, M_y, M_z`` [N and N*m].
        """
        bearing, motion = self.machine.bearings[name], self.bearing(name)
        load = linear_load(bearing, np.asarray(position) @ motion.T)
        if velocity is not None and bearing.damping_matrix.any():
            load = load + np.asarray(velocity) @ motion.T @ bearing.damping_matrix
        return load

    def mesh(self, name: str) -> Array:
        """Compression of a mesh per coordinate.

        Parameters
        ----------
        name : str
            Name of the mesh.

        Returns
        -------
        (n,) array
            [1 and m].
        """
        gears = [self.gear(gear) for gear in self.machine.meshes[name].gears]
        return np.asarray(self.machine.directions[name].direction @ np.vstack(gears))

    def mesh_stiffness(self, name: str) -> float:
        """Mean stiffness of a mesh over its phase.

        Parameters
        ----------
        name : str
            Name of the mesh.

        Returns
        -------
        float
            Along the transverse line of action [N/m].

        Raises
        ------
        InputError
            If the mesh has no stiffness.
        """
        stiffness = self.machine.meshes[name].stiffness
        if stiffness is None:
            what, why = "the mesh has no stiffness", "The motion needs the force law of its teeth"
            remedy = "Give stiffness, a number or a function of the mesh phase"
            raise InputError(what, f"meshes.{name}.stiffness", why, remedy)
        return mean_over_phase(stiffness)

    def housing_node(self, name: str) -> Array:
        """Displacement of a node of the housing per coordinate.

        Parameters
        ----------
        name : str
            Name of the node.

        Returns
        -------
        (6, n) array
        """
        housing = self.machine.housing
        numbers = np.array(housing.nodes[name] if housing and housing.nodes else [-1] * 6)
        out = np.zeros((6, self.size))
        out[numbers >= 0] = self.basis[self._rows[""]][numbers[numbers >= 0]]
        return out

    @cached_property
    def balance(self) -> Array:
        """Generalized force of a unit torque about x on the end of the output shaft, (n,) [1]."""
        output = self.machine.operation.output
        return np.asarray(self.at(output, self.machine.shafts[output].length)[3])

    @cached_property
    def force(self) -> Array:
        """Torques of input and output without losses, forces of bearings and planets, (n,)."""
        run, loads = self.machine.operation, self.machine.kinematics.shafts
        sense = -1.0 if run.speed < 0.0 else 1.0
        turning = np.copysign(sense, sense * float(loads[run.output].ratio))
        force = sense * run.torque * self.at(run.input, 0.0)[3]
        force = force - turning * loads[run.output].torque * self.balance
        for name, bearing in self.machine.bearings.items():
            force = force - self.bearing(name).T @ bearing.rest_load
        return np.asarray(force + centrifugal_force(self))

    def _assembled(self, blocks: Mapping[str, Array]) -> Array:
        """Sum of matrices of shafts, and of the housing under "", in the coordinates (n, n)."""
        total = np.zeros((self.size, self.size))
        for name, block in blocks.items():
            rows = self.basis[self._rows[name]]
            moving = np.flatnonzero(rows.any(axis=0))  # few coordinates move a shaft
            rows = rows[:, moving]
            total[np.ix_(moving, moving)] += rows.T @ block @ rows
        return total

    def _housing(self, kind: str) -> Array:
        housing = self.machine.housing
        size = 0 if housing is None else housing.size
        matrix = getattr(housing, kind, None)
        return np.zeros((size, size)) if matrix is None else np.asarray(matrix)

    @cached_property
    def _rows(self) -> dict[str, slice]:
        """Rows of each shaft in the full coordinates, and of the housing under ""."""
        sizes = [*(shaft.size for shaft in self.shafts.values()), len(self._housing("mass"))]
        ends = np.cumsum([0, *sizes])
        return {n: slice(*ends[i : i + 2]) for i, n in enumerate((*self.shafts, ""))}

    @cached_property
    def _all_names(self) -> list[str]:
        names = []
        for shaft, matrices in self.shafts.items():
            for node in matrices.nodes:
                place = f"{shaft}@{1e3 * node:.6g}mm" if matrices.shaft.sections else shaft
                names += [f"{place}_{axis}" for axis in AXES]
        housing = self.machine.housing
        return names if housing is None else [*names, *housing.names]

    @cached_property
    def _moving(self) -> Mask:
        """Which of the full coordinates move."""
        moving = [
            np.ones(matrices.size, dtype=bool)
            if matrices.shaft.sections
            else self._rigid_motions(name)
            for name, matrices in self.shafts.items()
        ]
        return np.concatenate((*moving, np.ones(len(self._housing("mass")), dtype=bool)))

    def _rigid_motions(self, shaft: str) -> Mask:
        """Coordinates in which a rigid shaft moves: those in which its bearings hold it."""
        total, floats = np.zeros((6, 6)), False
        for bearing in self.machine.bearings.values():
            arm = carried_along(bearing.position)
            if bearing.carrier == shaft:
                lever = pin_lever(self.machine.placement, bearing)
                arm = lever @ carried_along(bearing.carrier_position)
            elif bearing.shaft != shaft:
                continue
            floats |= bearing.floats
            total += arm.T @ held_by(bearing) @ arm
        size = np.sqrt(np.diag(total))
        moving = size > 1e-9 * size.max(initial=0.0)
        tilt = [i for i in (1, 2, 4, 5) if moving[i]]
        scaled = total[np.ix_(tilt, tilt)] / np.outer(size[tilt], size[tilt])
        if tilt and np.linalg.eigvalsh(scaled)[0] < 1e-9:
            moving[4:] = False
        moving[3] = True
        moving[1:3] |= floats
        return np.asarray(moving, dtype=bool)
