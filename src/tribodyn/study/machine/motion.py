"""Motion of a machine under one load: forces, errors and accelerations of its parts by name."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.record import Record, fact, labels_of, quantity, record
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.machine import MachineStructure

#: Directions of forces and moments of a bearing.
DIRECTIONS = ("x", "y", "z", "theta_x", "theta_y", "theta_z")


class PeriodicSamples(Record):
    """Signals over a period, on samples with weights."""

    weight: Array

    def mean(self, signal: Array) -> Array:
        """Mean over the period.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.tensordot(self.weight, signal, axes=1))

    def rms(self, signal: Array) -> Array:
        """Root mean square about the mean.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.sqrt(np.maximum(self.mean((signal - self.mean(signal)) ** 2), 0.0)))


@record
class MachineMotion(PeriodicSamples):
    """Periodic motion of a machine over one period of its clock.

    Parameters
    ----------
    clock : (s,) array
        Phase of the clock; both ends and the middle of every step.
    weight : (s,) array
        Weights of the samples for means over the period.
    mesh : tuple of str
        Names of the meshes.
    bearing : tuple of str
        Names of the bearings.
    node : tuple of str
        Names of the nodes of the housing.
    mesh_force : (s, meshes) array
        Force along the transverse line of action [N].
    compression : (s, meshes) array
        Compression of the teeth, from where rigid flanks touch [m].
    transmission_error : (s, meshes) array
        Rotation of the driving over that of the driven gear, on the line of action [m].
    open : (s, meshes) array
        1 where the driving flanks are apart.
    bearing_force : (s, bearings, 6) array
        Force and moment of the shaft on each bearing [N, N*m].
    acceleration : (s, nodes, 3) array
        Acceleration of the nodes of the housing [m/s^2].
    cycles : (meshes,) array
        Mesh cycles of each mesh in a period.
    frequency : float
        Periods of the clock per second [Hz].
    """

    clock: Array = quantity("clock", unit="1", axis=True)
    weight: Array = quantity("clock", unit="1")
    mesh: tuple[str, ...] = quantity("mesh", axis=True, unit="")
    bearing: tuple[str, ...] = quantity("bearing", axis=True, unit="")
    node: tuple[str, ...] = quantity("node", axis=True, unit="")
    mesh_force: Array = quantity("clock", "mesh", unit="N")
    compression: Array = quantity("clock", "mesh", unit="m")
    transmission_error: Array = quantity("clock", "mesh", unit="m")
    open: Array = quantity("clock", "mesh", unit="1")
    bearing_force: Array = quantity("clock", "bearing", "direction", unit="N or N*m")
    acceleration: Array = quantity("clock", "node", "axis", unit="m/s^2")
    cycles: Array = quantity("mesh", unit="1")
    frequency: float = fact()

    def harmonics(self, signal: Array, orders: Array) -> ComplexArray:
        """Complex amplitudes at orders of the clock.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.
        orders : (k,) array
            Periods of the wave in a period of the clock.

        Returns
        -------
        (k, ...) complex array
            In the unit of the signal.
        """
        waves = self.weight * np.exp(-2j * np.pi * np.multiply.outer(orders, self.clock))
        return np.asarray(2.0 * np.tensordot(waves, signal, axes=1))

    def mesh_orders(self, count: int) -> dict[int, list[tuple[str, int]]]:
        """Orders of the clock that meshes excite.

        Parameters
        ----------
        count : int
            Harmonics of each mesh.

        Returns
        -------
        dict of int to list of (str, int)
            Meshes and their harmonics by order.
        """
        orders: dict[int, list[tuple[str, int]]] = {}
        for name, cycles in zip(self.mesh, self.cycles, strict=True):
            for harmonic in range(1, count + 1):
                orders.setdefault(int(cycles) * harmonic, []).append((name, harmonic))
        return dict(sorted(orders.items()))

    def mesh_spectra(self, mesh: str, harmonics: int = 20) -> Any:
        """Peak amplitudes of all signals over the order of one mesh, as those of a pair.

        Parameters
        ----------
        mesh : str
            Name of the mesh whose frequency is order 1; lines of others are between its harmonics.
        harmonics : int
            Highest order.

        Returns
        -------
        xarray.Dataset
            ``meshes.NAME.mesh_force_spectrum``, ``meshes.NAME.transmission_error_spectrum``,
            ``bearings.NAME.force_y_spectrum`` and ``housing.NAME.acceleration_y_spectrum`` for x,
            y and z, over ``order``; ``mesh_frequency`` is an attribute.

        Raises
        ------
        InputError
            If there is no such mesh.
        """
        import xarray

        if mesh not in self.mesh:
            why, remedy = f"Known: {', '.join(self.mesh)}", "Name one of these"
            raise InputError(f'there is no mesh "{mesh}"', Argument("mesh"), why, remedy)
        cycles = int(self.cycles[self.mesh.index(mesh)])
        orders = np.arange(1.0, cycles * harmonics + 1.0)
        axes = "xyz"
        signals = {f"meshes.{n}.mesh_force": self.mesh_force[:, i] for i, n in enumerate(self.mesh)}
        error = self.transmission_error
        signals |= {f"meshes.{n}.transmission_error": error[:, i] for i, n in enumerate(self.mesh)}
        for kind, names, values in (
            ("bearings.{}.force_{}", self.bearing, self.bearing_force),
            ("housing.{}.acceleration_{}", self.node, self.acceleration),
        ):
            for i, name in enumerate(names):
                signals |= {kind.format(name, axes[k]): values[:, i, k] for k in range(3)}
        waves = np.abs(self.harmonics(np.stack(list(signals.values()), axis=1), orders))
        columns = {
            f"{name}_spectrum": (
                "order",
                waves[:, k],
                {"units": "m/s^2" if "accel" in name else "m" if "error" in name else "N"},
            )
            for k, name in enumerate(signals)
        }
        attributes = {"mesh_frequency": cycles * self.frequency}
        return xarray.Dataset(columns, {"order": orders / cycles}, attributes)

    @cached_property
    def radial_force(self) -> Array:
        """Size of the radial force of each bearing (s, bearings) [N]."""
        return np.hypot(self.bearing_force[..., 1], self.bearing_force[..., 2])


def joined(series: Mapping[str, Array], samples: int, width: tuple[int, ...] = ()) -> Array:
    """Series by name as one array (s, names, ...)."""
    if not series:
        return np.zeros((samples, 0, *width))
    return np.stack(list(series.values()), axis=1)


def machine_motion(structure: MachineStructure, response: Response) -> MachineMotion:
    """Forces, errors and accelerations of the parts of a machine along its motion."""
    machine, fine = structure.machine, response.fine
    samples = fine.phase.size
    force, compression, error, separated = {}, {}, {}, {}
    first = 0
    for name, mesh in machine.meshes.items():
        count = max(len(mesh.contacts), 1)
        force[name] = fine.contact_force[:, first : first + count].sum(axis=1)
        compression[name] = fine.deflection[:, first]
        separated[name] = (force[name] == 0.0).astype(float)
        error[name] = fine.position @ mesh_rotation(structure, name)
        first += count
    bearings = {
        name: structure.bearing_load(name, fine.position, fine.velocity)
        for name in machine.bearings
    }
    nodes = machine.housing.nodes if machine.housing is not None else {}
    accelerations = {n: fine.acceleration @ structure.housing_node(n)[:3].T for n in nodes or {}}
    return MachineMotion(
        clock=fine.phase - fine.phase[0],
        weight=fine.weight,
        mesh=tuple(force),
        bearing=tuple(bearings),
        node=tuple(accelerations),
        mesh_force=joined(force, samples),
        compression=joined(compression, samples),
        transmission_error=joined(error, samples),
        open=joined(separated, samples),
        bearing_force=joined(bearings, samples, (6,)),
        acceleration=joined(accelerations, samples, (3,)),
        cycles=np.array([machine.clock.cycles[name] for name in force]),
        frequency=machine.clock.frequency,
    )


def motion_from(data: Any) -> MachineMotion:
    """Motion from its data set in a file."""
    values: dict[str, Any] = {}
    for name, labels in labels_of(MachineMotion).items():
        if not labels.dims:
            values[name] = float(data.attrs[name])
        elif name in ("mesh", "bearing", "node"):
            values[name] = tuple(map(str, data[name].values)) if name in data else ()
        else:
            values[name] = np.asarray(data[name].values)
    return MachineMotion(**values)


def mesh_rotation(structure: MachineStructure, mesh: str) -> Array:
    """Rotation of both gears, against their carrier, on the line of action (n,) [1 and m]."""
    gears, carrier = structure.machine.meshes[mesh].gears, structure.machine.meshes[mesh].carrier
    direction = structure.machine.directions[mesh].direction
    turns = [structure.gear(name)[3] for name in gears]
    if carrier:
        turned = structure.at(carrier, _carrier_position(structure, carrier))[3]
        turns = [turn - turned for turn in turns]
    return np.asarray(direction[3] * turns[0] + direction[9] * turns[1])


def _carrier_position(structure: MachineStructure, carrier: str) -> float:
    """Position of the planets on their carrier [m]."""
    bearings = structure.machine.bearings.values()
    return next((b.carrier_position for b in bearings if b.carrier == carrier), 0.0)
