"""Reduction of a machine to fewer coordinates, after Craig and Bampton (1968)."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from tribodyn.arrays.linear_algebra import groups_of_equal, modes_of, standard_rotation
from tribodyn.arrays.memory import Memo
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.machine import Machine
from tribodyn.machine.static.balance import static_balance
from tribodyn.machine.structure import MachineStructure, Reduction
from tribodyn.types import Array, Index, Mask

#: Shares of the tolerance that omitted modes may use up by estimate, tried in turn.
_SHARES = (1.0, 0.5, 0.1, 0.01, 1e-3, 0.0)
#: Frequency over the limit below which no mode is left out.
_ALL_BELOW = 1.5
#: Squared frequencies below this share of the greatest are rounding.
_RIGID = 1e-12
#: Columns whose omission changes the frequencies equally, to this part, are left out together.
_ALIKE = 1e-6
#: Rounding of a frequency that is zero, over the greatest rate of a coordinate.
_ROUNDING = 3e-8
#: Range of the limit of a reduction by default [Hz], and mesh harmonics within half of it.
_LIMITS, _HARMONICS = (5e3, 5e4), 3
#: Coordinates beyond which a machine is reduced, and error of the frequencies by default.
_LARGE, _TOLERANCE = 120, 4e-4
#: Modes of the shafts between bearings and meshes, which loads and speeds do not change.
_modes_of_shafts: Memo[tuple[Array, Array]] = Memo(4)
#: Bases and natural modes of the last machines, which a speed does not change.
_bases: Memo[tuple[Array, Array]] = Memo(4)
_natural: Memo[tuple[Array, Array]] = Memo(4)


def default_limit(machine: Machine) -> float:
    """Twice the third harmonic of the fastest mesh, between 5 and 50 kHz [Hz]."""
    meshes = machine.kinematics.meshes.values()
    fastest = max((mesh.mesh_frequency for mesh in meshes), default=0.0)
    return float(np.clip(2.0 * _HARMONICS * fastest, *_LIMITS))


def unreduced_size(machine: Machine) -> int:
    """Number of coordinates of a machine in full, whatever the stiffness of its bearings."""
    springs = {
        name: Bearing(each.shaft, each.position)
        for name, each in machine.bearings.items() if each.nonlinear
    }  # fmt: skip
    return MachineStructure(machine._with(bearings=springs)).size


def is_large(size: int) -> bool:
    """Whether a machine of so many coordinates is reduced where nothing is said of it."""
    return size > _LARGE


def machine_structure(machine: Machine, *, damping_ratio: float = 0.02) -> MachineStructure:
    """Matrices of a machine as its motion needs them.

    Parameters
    ----------
    machine : Machine
        The machine.
    damping_ratio : float
        Damping of every mode of the structure over its critical value [1].

    Returns
    -------
    MachineStructure
        With rolling bearings at the load of the static balance; of more than 120 coordinates
        reduced by :func:`reduce_structure`, which ``reduction`` states with its error.

    Examples
    --------
    >>> from tribodyn.machine import Bearing, Gear, Mesh, Operation, Section, Shaft
    >>> shaft = Shaft([Section(0.2, 0.03)])
    >>> machine_structure(Machine(
    ...     shafts={"in": shaft, "out": shaft},
    ...     gears={"z1": Gear("in", 0.05, 20, 0.02), "z2": Gear("out", 0.05, 40, 0.02)},
    ...     meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
    ...     bearings={f"{s}{x}": Bearing(s, x) for s in ("in", "out") for x in (0.0, 0.2)},
    ...     operation=Operation("in", "out", 100.0, 60.0))).reduction
    Reduction(336 to 40 coordinates, error 3.3e-04 up to 5000 Hz)
    """
    if any(bearing.nonlinear for bearing in machine.bearings.values()):
        machine = static_balance(machine).linearized()
    return Parts(MachineStructure(machine, damping_ratio)).at(machine)


def reduce_structure(
    structure: MachineStructure, limit: float | None = None, *, tolerance: float = _TOLERANCE
) -> MachineStructure:
    """Reduce a machine to the coordinates that meshes and bearings touch, and modes of the rest.

    Parameters
    ----------
    structure : MachineStructure
        Matrices of the machine.
    limit : float, optional
        Frequency up to which the reduced machine has the natural frequencies of the full one [Hz];
        twice the third harmonic of the fastest mesh by default, between 5 and 50 kHz.
    tolerance : float
        Greatest relative error of these frequencies [1].

    Returns
    -------
    MachineStructure
        With ``reduction``, which holds the error.

    Raises
    ------
    InputError
        If the limit or the tolerance is not positive, or the structure is reduced already.

    Notes
    -----
    The interface are the coordinates on which meshes, bearings and torques act. To its static
    displacements come modes of the rest with the interface fixed, R. R. Craig and M. C. C. Bampton
    (1968). Of these modes those are left out whose part in the motions below the limit is so small
    that the tolerance holds. The error is that of all natural frequencies below the limit, at rest,
    with the mean stiffness of the meshes, against the full model.

    Examples
    --------
    >>> from tribodyn.machine import Bearing, Gear, Machine, Mesh, Operation, Section, Shaft
    >>> shaft = Shaft([Section(0.2, 0.03)])
    >>> machine = Machine(
    ...     shafts={"in": shaft, "out": shaft},
    ...     gears={"z1": Gear("in", 0.05, 20, 0.02), "z2": Gear("out", 0.05, 40, 0.02)},
    ...     meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
    ...     bearings={f"{s}{x}": Bearing(s, x) for s in ("in", "out") for x in (0.0, 0.2)},
    ...     operation=Operation("in", "out", 100.0, 60.0))
    >>> full = MachineStructure(machine)
    >>> reduced = reduce_structure(full, 5000.0)
    >>> full.size, reduced.size, reduced.reduction.error < 1e-3
    (336, 40, True)
    """
    if structure.reduction is not None:
        remedy = "Reduce the structure of the machine itself"
        raise InputError("the structure is reduced already", "argument structure", "", remedy)
    if limit is not None:
        require_positive("limit", limit, "Hz")
    require_between("tolerance", tolerance, 1e-9, 1.0, "")
    return Parts(structure).reduced(structure.machine, limit, tolerance)


class Parts:
    """Matrices of a machine and its reductions, which another speed does not change."""

    def __init__(self, structure: MachineStructure) -> None:
        self.unreduced, self._reduced = structure, dict[bytes, tuple[MachineStructure, Array]]()

    def at(self, machine: Machine) -> MachineStructure:
        """Structure of the machine at its speed, reduced where it is large."""
        return self.reduced(machine) if is_large(self.unreduced.size) else self.turned(machine)

    def turned(self, machine: Machine, of: MachineStructure | None = None) -> MachineStructure:
        """Structure of the machine at its speed, not reduced, or that with its matrices."""
        structure = of or self.unreduced
        for name in ("mass", "stiffness", "damping", "force"):
            getattr(structure, name)  # those of all
        turned = copy(structure)
        vars(turned)["machine"] = machine
        return turned

    @cached_property
    def _basis(self) -> tuple[Array, Array, list[str]]:
        """Basis of Craig and Bampton, squared frequencies and names of its columns."""
        unreduced, interface = self.unreduced, _interface(self.unreduced)
        content = unreduced.mass, unreduced.stiffness, interface
        basis, squares = _bases.get(content, lambda: _craig_bampton(unreduced, interface))
        names = [unreduced.names[i] for i in np.flatnonzero(interface)]
        names += [f"mode {j + 1}_q" for j in range(unreduced.size - len(names))]
        return basis, squares, names

    def _with_columns(self, columns: Index, limit: float) -> tuple[MachineStructure, Array]:
        """Structure with these columns of the basis, and its natural frequencies."""
        key = columns.tobytes()
        if key not in self._reduced:
            basis, _, names = self._basis
            motion = self.unreduced.basis @ basis[:, columns]
            reduction = Reduction(tuple(names[i] for i in columns), motion, limit, 0.0)
            reduced = replace(self.unreduced, reduction=reduction)
            self._reduced[key] = reduced, _modes(reduced.mass, _at_rest(reduced), np.inf)[0]
        return self._reduced[key]

    def reduced(
        self, machine: Machine, limit: float | None = None, tolerance: float = _TOLERANCE
    ) -> MachineStructure:
        """Structure of the machine at its speed, see :func:`reduce_structure`."""
        limit = default_limit(machine) if limit is None else limit
        unreduced, (basis, squares, _) = self.unreduced, self._basis
        squares, (full, amplitudes) = squares.copy(), _natural_modes(unreduced, limit, basis)
        least = _ROUNDING * np.sqrt((np.diag(unreduced.stiffness) / np.diag(unreduced.mass)).max())
        squares[squares <= (_ALL_BELOW * 2.0 * np.pi * limit) ** 2] = np.inf
        omission = _omission(amplitudes, squares, full)
        for share in _SHARES:
            columns = _columns(omission, share * tolerance)
            structure, frequency = self._with_columns(columns, limit)
            error = _error(full, frequency, least)
            if error <= tolerance:
                break
        final = self.turned(machine, structure)
        assert structure.reduction is not None
        vars(final)["reduction"] = replace(structure.reduction, limit=limit, error=error)
        return final


def _interface(structure: MachineStructure) -> Mask:
    """Coordinates on which a mesh, a bearing or a torque acts."""
    machine = structure.machine
    used = (structure.balance != 0.0) | (structure.force != 0.0)
    for name, mesh in machine.meshes.items():
        acting = machine.directions[name].direction.reshape(2, 6) != 0.0
        acting[:, 1:4] = True  # friction
        acting |= mesh.helix_angle > 0.0 or mesh.crossed is not None  # the load moves over the face
        for gear, rows in zip(mesh.gears, acting, strict=True):
            used |= (structure.gear(gear)[rows] != 0.0).any(axis=0)
    for name, bearing in machine.bearings.items():
        acting = (bearing.stiffness_matrix != 0.0) | (bearing.damping_matrix != 0.0)
        used |= (structure.bearing(name)[acting.any(axis=0)] != 0.0).any(axis=0)
    return np.asarray(used)


def _craig_bampton(structure: MachineStructure, interface: Mask) -> tuple[Array, Array]:
    """Basis of static displacements and fixed modes, and squared frequencies of both."""
    inner = np.flatnonzero(~interface)
    parts = [m[np.ix_(inner, inner)] for m in (structure.mass, structure.stiffness)]
    squares, shapes = _modes_of_shafts.get((*parts,), lambda: _fixed_modes(*parts))
    edge = np.flatnonzero(interface)
    elastic = squares > _RIGID * squares.max(initial=0.0)
    basis = np.zeros((structure.size, structure.size))
    basis[edge, range(len(edge))] = 1.0
    coupled = shapes[:, elastic].T @ structure.stiffness[np.ix_(inner, edge)]
    basis[inner, : len(edge)] = -shapes[:, elastic] @ (coupled / squares[elastic, None])
    basis[inner, len(edge) :] = shapes
    fixed = np.where(elastic, squares, np.inf)
    return basis, np.concatenate((np.full(len(edge), np.inf), fixed))


def _fixed_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Squared frequencies and shapes of the modes with the interface fixed."""
    squares, shapes = np.zeros(len(mass)), np.zeros(mass.shape)
    first = _first_of_each((mass != 0.0) | (stiffness != 0.0))
    for part in (np.flatnonzero(first == number) for number in np.unique(first)):
        at = np.ix_(part, part)
        squares[part], vectors = modes_of(stiffness[at], mass[at])
        shapes[at] = vectors @ standard_rotation(squares[part], vectors.T).T
    order = np.argsort(squares, kind="stable")
    for group in groups_of_equal(squares[order]):
        order[group] = np.sort(order[group])
    return squares[order], shapes[:, order]


def _first_of_each(linked: Mask) -> Index:
    """Number of the first coordinate of the part that each one belongs to, by a table of links."""
    first = np.arange(len(linked))
    while True:
        least = np.where(linked, first, len(first)).min(axis=1, initial=len(first))
        if np.array_equal(least := least[least], first):
            return first
        first = least


def _omission(amplitudes: Array, squares: Array, frequency: Array) -> Array:
    """Relative rise of each natural frequency without each column of the basis, to first order."""
    natural = (2.0 * np.pi * frequency) ** 2
    elastic = natural > _RIGID * natural.max(initial=0.0)
    excess = squares[:, None] / natural[elastic] - 1.0
    rise = np.full((len(squares), int(elastic.sum())), np.inf)
    modes = np.isfinite(squares)
    rise[modes] = 0.5 * amplitudes[np.ix_(modes, elastic)] ** 2 * np.abs(excess[modes])
    return rise


def _columns(omission: Array, tolerance: float) -> Index:
    """Columns of the basis that the tolerance needs."""
    size = omission.max(axis=1, initial=0.0)
    order = np.argsort(size)
    total = np.cumsum(omission[order], axis=0).max(axis=1, initial=0.0)
    least = size[order[total > tolerance]].min(initial=np.inf)
    return np.flatnonzero(size >= (1.0 - _ALIKE) * least)  # all of equal size, or none


def _natural_modes(structure: MachineStructure, limit: float, basis: Array) -> tuple[Array, Array]:
    """Natural frequencies up to a limit [Hz], and amplitudes of a basis in their modes."""
    # Limits that follow the speed of a study share the modes up to a round one.
    highest = _LIMITS[0] * 2.0 ** float(np.ceil(np.log2(limit / _LIMITS[0])))
    content = structure.mass, _at_rest(structure)

    def compute() -> tuple[Array, Array]:
        frequency, shapes = _modes(*content, highest)
        return frequency, np.asarray(np.linalg.solve(basis, shapes))

    frequency, amplitudes = _natural.get((*content, np.array([highest])), compute)
    below = frequency <= limit
    return frequency[below], amplitudes[:, below]


def _at_rest(structure: MachineStructure) -> Array:
    """Stiffness (n, n) with meshes at their mean stiffness."""
    stiffness = structure.stiffness.copy()
    for name in structure.machine.meshes:
        direction = structure.mesh(name)
        stiffness += structure.mesh_stiffness(name) * np.outer(direction, direction)
    return stiffness


def _modes(mass: Array, stiffness: Array, limit: float) -> tuple[Array, Array]:
    """Natural frequencies up to a limit [Hz], and shapes."""
    squares, shapes = modes_of(stiffness, mass)
    shapes = shapes[:, below := squares <= (2.0 * np.pi * limit) ** 2]
    squares = squares[below]
    shapes = shapes @ standard_rotation(squares, shapes.T).T
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi), shapes


def _error(full: Array, reduced: Array, least: float) -> float:
    """Greatest relative difference of frequencies above the least, below which they are zero."""
    if len(reduced) < len(full):
        return np.inf
    elastic = full > least
    difference = np.abs(reduced[: len(full)][elastic] / full[elastic] - 1.0)
    return float(difference.max(initial=0.0))
