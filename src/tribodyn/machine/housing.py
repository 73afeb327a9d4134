"""A housing by its reduced matrices, with named nodes that carry the bearings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.types import Array

#: Coordinates of a node, in their order.
AXES = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
#: Eigenvalue of a scaled matrix below which it is singular, over the greatest.
_SINGULAR = 1e-12


@dataclass(frozen=True, eq=False)
class Housing:
    """Reduced matrices of a housing; without one the bearings are held by a rigid wall.

    Parameters
    ----------
    mass, stiffness : (n, n) array
        Mass matrix [kg] and stiffness matrix [N/m], with rotations in rad.
    damping : (n, n) array, optional
        Damping matrix [N*s/m].
    nodes : mapping of str to (6,) sequence of int
        Numbers of the coordinates of each node in the order x, y, z, theta_x, theta_y, theta_z,
        counted from 0; -1 where the node does not move.

    Raises
    ------
    InputError
        If a matrix has a wrong shape, is not finite and symmetric, or mass or stiffness is
        singular, or damping has a negative eigenvalue, or a node has a coordinate that the
        matrices do not have.

    Examples
    --------
    >>> Housing(np.eye(3), 1e9 * np.eye(3), nodes={"seat A": [0, 1, 2, -1, -1, -1]}).size
    3
    """

    mass: ArrayLike
    stiffness: ArrayLike
    damping: ArrayLike | None = None
    nodes: Mapping[str, Sequence[int]] | None = None

    def __post_init__(self) -> None:
        for name in ("mass", "stiffness", "damping"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _symmetric(name, getattr(self, name)))
        sizes = {n: np.shape(getattr(self, n)) for n in ("mass", "stiffness", "damping")}
        if len(shapes := {shape for shape in sizes.values() if shape}) > 1:
            what = f"the matrices have the shapes {', '.join(map(str, sorted(shapes)))}"
            why = "All are over the same coordinates"
            where = Argument("Housing.stiffness")
            raise InputError(what, where, why, "Give matrices of one size")
        nodes = {
            str(name): _coordinates(str(name), numbers, self.size)
            for name, numbers in (self.nodes or {}).items()
        }
        object.__setattr__(self, "nodes", nodes)
        self._refuse_singular()
        self._refuse_active_damping()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates: ``housing_seat A_x``, or by their number."""
        names = [f"housing_{number}" for number in range(self.size)]
        for node, numbers in (self.nodes or {}).items():
            for axis, number in zip(AXES, numbers, strict=True):
                if number >= 0:
                    names[number] = f"housing_{node}_{axis}"
        return tuple(names)

    def _refuse_singular(self) -> None:
        """Refuse motions without kinetic energy, and a housing that nothing holds."""
        for name, energy, remedy in (
            ("mass", "kinetic", "Remove coordinates without inertia before the reduction"),
            ("stiffness", "strain", "Hold the housing at its feet before the reduction"),
        ):
            matrix = np.asarray(getattr(self, name))
            size = np.sqrt(np.abs(np.diag(matrix)))
            size[size == 0.0] = 1.0
            values, motions = np.linalg.eigh(matrix / np.outer(size, size))
            if values[0] > _SINGULAR * values[-1]:
                continue
            motion = np.abs(motions[:, 0] / size)
            most = [
                self.names[i] for i in np.argsort(-motion)[:3] if motion[i] > 0.3 * motion.max()
            ]
            raise InputError(
                f"the {name} matrix is singular or not positive: a motion of {', '.join(most)} has "
                f"no {energy} energy",
                Argument(f"Housing.{name}"),
                f"Its least eigenvalue is {values[0] / values[-1]:.2g} of the greatest",
                remedy,
            )

    def _refuse_active_damping(self) -> None:
        values = [0.0] if self.damping is None else np.linalg.eigvalsh(np.asarray(self.damping))
        if values[0] < -1e-6 * max(abs(values[0]), values[-1]):
            what = f"the damping matrix feeds in power: its least eigenvalue is {values[0]:.4g}"
            why = "The damping of a passive housing is positive semi-definite"
            raise InputError(what, Argument("Housing.damping"), why, "Check the file and its signs")

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(np.asarray(self.mass))


def _symmetric(name: str, value: ArrayLike) -> Array:
    where = Argument(f"Housing.{name}")
    matrix = np.array(real_numbers(where, value), ndmin=2)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not np.all(np.isfinite(matrix)):
        what = f"{name} has the shape {matrix.shape} or is not finite"
        why = "It must be a finite square matrix"
        raise InputError(what, where, why, "Give rows and columns over the same coordinates")
    # over the sizes of both coordinates, which may be lengths and angles
    size = np.sqrt(np.abs(np.diag(matrix)))
    size[size == 0.0] = np.sqrt(np.abs(matrix).max()) or 1.0
    difference = np.abs(matrix - matrix.T) / np.outer(size, size)
    if difference.max() > 1e-6:
        row, column = np.unravel_index(difference.argmax(), matrix.shape)
        values = f"{matrix[row, column]:.6g} and {matrix[column, row]:.6g}"
        what = f"{name} is not symmetric: entries ({row}, {column}) are {values}"
        why = "Reduced matrices of a passive housing are symmetric"
        raise InputError(what, where, why, "Check the file; give a lower triangle completed")
    return np.asarray(0.5 * (matrix + matrix.T))


def _coordinates(node: str, numbers: Sequence[int], size: int) -> tuple[int, ...]:
    where = Argument("Housing.nodes")
    values = real_numbers(where, numbers, "six whole numbers").reshape(-1)
    valid = (values == np.round(values)) & (values >= -1) & (values < size)
    if values.size != 6 or not np.all(valid):
        what = f'node "{node}" has the coordinates {values.tolist()}'
        why = f"Wanted: six whole numbers from -1 to {size - 1}"
        remedy = (
            "Give the numbers of its coordinates x, y, z, theta_x, theta_y, theta_z, -1 at rest"
        )
        raise InputError(what, where, why, remedy)
    return tuple(int(value) for value in values)
