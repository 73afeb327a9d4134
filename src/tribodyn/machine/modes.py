"""Natural modes of a machine at a speed, and the parts that store their energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribodyn.arrays.linear_algebra import leading
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.dynamics.linear.linear_system import linear_system
from tribodyn.dynamics.linear.natural_modes import frequencies_at, natural_modes
from tribodyn.errors import Argument, InputError, no_such
from tribodyn.machine.assembly import mesh_contacts, system
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import mean_over_phase
from tribodyn.machine.planetary.modes import PlanetaryModes, modes_of_stage
from tribodyn.machine.planetary.turning_frame import frame_terms
from tribodyn.machine.reduction import machine_structure
from tribodyn.machine.structure import MachineStructure
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Mask


@record
class MachineModes(Record):
    """Natural modes of a machine without its free rotation, of a reduced one up to its limit.

    Parameters
    ----------
    speed : float
        Speed of the input shaft, whose gyroscopic moments are included [rad/s].
    names : tuple of str
        Names of the coordinates.
    frequency : (m,) array
        Natural frequencies, rising [Hz].
    shape : (m, n) complex array
        Displacements ``Re(shape*exp(2 pi i f t))``, the greatest of them 1 [m or rad].
    damping_ratio : (m,) array
        Damping over its critical value [1].
    parts : tuple of str
        Parts that store energy: ``shafts.input``, ``bearings.A``, ``meshes.first``, ``housing``.
    strain_share : (m, parts) array
        Share of each part in the strain energy of each mode; rows sum to 1.
    structure : MachineStructure
        Matrices of the machine; its ``at`` turns a shape into the deflection of a shaft.
    """

    speed: float = fact()
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    frequency: Array = quantity("mode", unit="Hz")
    shape: ComplexArray = quantity("mode", "coordinate", unit="m or rad")
    damping_ratio: Array = quantity("mode", unit="1")
    parts: tuple[str, ...] = quantity("part", axis=True, name="part")
    strain_share: Array = quantity("mode", "part", unit="1")
    structure: MachineStructure

    def share_by_kind(self) -> dict[str, Array]:
        """Share of meshes, shafts with couplings, bearings and housing in the strain energy.

        Returns
        -------
        dict
            ``meshes``, ``shafts``, ``bearings``, ``housing``, (m,) each; their sum is 1.
        """
        kinds = np.array([part.partition(".")[0] for part in self.parts])
        kinds[kinds == "couplings"] = "shafts"
        return {
            kind: np.asarray(self.strain_share[:, kinds == kind].sum(axis=1))
            for kind in ("meshes", "shafts", "bearings", "housing")
        }

    def of_stage(self, name: str) -> PlanetaryModes:
        """Select the motions of a planetary stage in its plane.

        Parameters
        ----------
        name : str
            Name of the stage.

        Returns
        -------
        PlanetaryModes
            All modes with their types.

        Raises
        ------
        InputError
            If the machine has no such stage.
        """
        stages = self.structure.machine.planets
        if name not in stages:
            raise InputError(no_such("stage", name, stages, Argument("name")))
        return modes_of_stage(self, name)

    def __repr__(self) -> str:
        """One line."""
        first = f", first {self.frequency[0]:.6g} Hz" if self.frequency.size else ""
        rpm = 30.0 / np.pi * self.speed
        return f"MachineModes({self.frequency.size} modes at {rpm:.6g} rpm{first})"


def machine_modes(machine: Machine | MachineStructure, speed: float | None = None) -> MachineModes:
    """Compute the natural modes of a machine with the mean stiffness of its meshes.

    Parameters
    ----------
    machine : Machine or MachineStructure
        The machine, whose matrices :func:`machine_structure` computes, or its matrices.
    speed : float, optional
        Speed of the input shaft [rad/s]; that of the operation by default, 0 at rest.

    Raises
    ------
    InputError
        If a mesh has no stiffness.

    Notes
    -----
    Backlash is closed, as under load. Motions without strain, of which the rotation of the whole
    drive is one, are left out, and so are modes above the limit of a reduced structure, which its
    coordinates do not hold: ``MachineStructure(machine)`` has them all.

    Examples
    --------
    >>> from tribodyn.machine import Gear, Machine, Mesh, Operation, Shaft
    >>> machine = Machine(
    ...     shafts={"input": Shaft(), "output": Shaft()},
    ...     gears={"z1": Gear("input", 0.0, 20, 0.05, 1.0, 1e-3, 1e-3),
    ...            "z2": Gear("output", 0.0, 20, 0.05, 1.0, 1e-3, 1e-3)},
    ...     meshes={"first": Mesh(("z1", "z2"), normal_module=4e-3, stiffness=5e8)},
    ...     operation=Operation("input", "output", speed=100.0, torque=400.0))
    >>> modes = machine_modes(machine)
    >>> modes.frequency.round(1), modes.share_by_kind()["meshes"]
    (array([5982.3]), array([1.]))
    """
    structure = machine_structure(machine) if isinstance(machine, Machine) else machine
    names = tuple(structure.machine.meshes)
    speed = structure.machine.operation.speed if speed is None else float(speed)
    elements = dict(structure.elements)
    if structure.frame is not None:  # what its turning stores counts for the carrier
        carrier = f"shafts.{structure.frame}"
        elements[carrier] = elements.get(carrier, 0.0) + frame_terms(structure, speed)[1]
    mean_system = _with_mean_stiffness(structure)
    modes = natural_modes(_turning(structure, mean_system, speed), elements=elements)
    elastic = _reliable(structure, modes.frequency)
    shape = modes.shape[elastic].astype(complex)
    return MachineModes(
        speed=speed,
        names=structure.names,
        frequency=modes.frequency[elastic],
        shape=shape / leading(shape),
        damping_ratio=modes.damping_ratio[elastic],
        parts=(*elements, *(f"meshes.{name}" for name in names)),
        strain_share=modes.strain_share[elastic],
        structure=structure,
    )


def machine_frequencies(structure: MachineStructure, speeds: Array) -> list[Array]:
    """Natural frequencies [Hz] at each speed of the input [rad/s], as :func:`machine_modes`."""
    mean_system = _with_mean_stiffness(structure)
    if structure.frame is None:
        turning = [structure.gyroscopic(float(speed)) if speed else None for speed in speeds]
        rows = frequencies_at(linear_system(mean_system), turning)
    else:  # their stiffness depends on the speed too
        rows = [natural_modes(_turning(structure, mean_system, float(n))).frequency for n in speeds]
    return [each[_reliable(structure, each)] for each in rows]


def _turning(structure: MachineStructure, mean_system: System, speed: float) -> System:
    """System with the mean stiffness of its meshes at a speed of the input [rad/s]."""
    return replace(
        mean_system,
        stiffness=structure.stiffness + frame_terms(structure, speed)[1],
        gyroscopic=structure.gyroscopic(speed) if speed else None,
    )


def _reliable(structure: MachineStructure, frequency: Array) -> Mask:
    """Which frequencies are those of elastic modes within the limit of a reduction."""
    limit = np.inf if structure.reduction is None else structure.reduction.limit
    return np.asarray((frequency > 0.0) & (frequency <= limit))


def _with_mean_stiffness(structure: MachineStructure) -> System:
    """System of a machine at rest whose meshes have their mean stiffness and damping."""
    names, nonlinear = structure.machine.meshes, system(structure)
    contacts = [
        Contact(
            structure.mesh(name),
            structure.mesh_stiffness(name),
            damping=sum(mean_over_phase(contact.damping) for contact in contacts),
        )
        for name, contacts in zip(names, mesh_contacts(structure, nonlinear), strict=True)
    ]
    return replace(nonlinear, contacts=contacts, gyroscopic=None)
