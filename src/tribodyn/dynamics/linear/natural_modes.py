"""Natural frequencies and modes of a system linearised about its static load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.linear_algebra import groups_of_equal, leading, standard_rotation
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.linear.linear_system import LinearSystem, ModePhase, linear_system
from tribodyn.errors import InputError
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array, ComplexArray

#: Squared frequencies below this share of the largest are rounding: the mode is rigid.
_RIGID = 1e-12
#: Share of the strain energy below which a negative one is rounding.
_ROUNDED = 1e-9


@record
class NaturalModes(Record):
    """Undamped modes of a system about its static load, and its damped eigenvalues.

    Modes are sorted by frequency; rigid ones come first, with exactly 0 Hz. With gyroscopic
    moments the shapes are complex, ``Re(shape*exp(2 pi i f t))``, and stay so normalised.

    Parameters
    ----------
    names : tuple of str
        Names of the coordinates.
    frequency : (n,) array
        Natural frequencies [Hz].
    shape : (n, n) array
        One mode per row, with ``conj(shape) M shape^T = 1`` [1/sqrt(kg) or 1/sqrt(kg*m^2)].
    damping_ratio : (n,) array
        Part of the critical damping from the diagonal of the modal damping matrix; NaN for rigid
        modes [1].
    kinetic_share : (n, n) array
        Share of each coordinate in the kinetic energy of each mode; rows sum to 1.
    elements : tuple of str
        Names of the springs, those of the contacts last.
    strain_share : (n, elements) array
        Share of each spring in the strain energy of each mode; rows sum to 1, those of rigid modes
        are zero.
    contacts : int
        Number of contacts: as many elements at the end are contacts.
    eigenvalues : (2 n,) complex array
        Of the damped motion ``exp(eigenvalue*time)``, sorted by modulus [rad/s].
    complex_shape : (2 n, n) complex array
        Displacements that go with each eigenvalue, the largest of them 1.
    linear : LinearSystem
        The matrices.

    Examples
    --------
    >>> natural_modes(System([[1.0]], [[0.0]], [[4.0]], [0.0]))
    NaturalModes(1 coordinates, 0 rigid, first 0.31831 Hz)
    """

    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    frequency: Array = quantity("mode", unit="Hz")
    shape: Array | ComplexArray = quantity("mode", "coordinate", unit="kg^-1/2 or kg^-1/2/m")
    damping_ratio: Array = quantity("mode", unit="1")
    kinetic_share: Array = quantity("mode", "coordinate", unit="1")
    elements: tuple[str, ...] = quantity("element", axis=True, name="element")
    strain_share: Array = quantity("mode", "element", unit="1")
    contacts: int
    eigenvalues: ComplexArray
    complex_shape: ComplexArray
    linear: LinearSystem

    @property
    def rigid(self) -> int:
        """Number of modes without strain."""
        return int(np.count_nonzero(self.frequency == 0.0))

    @property
    def contact_share(self) -> Array:
        """Share of all contacts together in the strain energy of each mode, (n,)."""
        first = len(self.elements) - self.contacts
        return np.asarray(self.strain_share[:, first:].sum(axis=1))

    @property
    def damped_frequency(self) -> Array:
        """Frequencies of the damped motion, one for each conjugate pair, rising [Hz]."""
        swinging = self.eigenvalues.imag > 1e-9 * np.abs(self.eigenvalues)
        return np.asarray(np.sort(self.eigenvalues.imag[swinging]) / (2.0 * np.pi))

    @property
    def stable(self) -> bool:
        """Whether no damped motion grows; friction can cause growth."""
        size = np.abs(self.eigenvalues).max(initial=0.0)
        return bool(np.all(self.eigenvalues.real <= 1e-9 * size))

    def body_share(self) -> dict[str, Array]:
        """Share of each body in the kinetic energy: coordinates with one name before ``_``.

        Returns
        -------
        dict
            Name of the body and its share in each mode, (n,) [1].
        """
        bodies: dict[str, Array] = {}
        for column, name in enumerate(self.names):
            body = name.rpartition("_")[0] or name
            bodies[body] = bodies.get(body, np.zeros(len(self.names)))
            bodies[body] = bodies[body] + self.kinetic_share[:, column]
        return bodies

    def strain_by_kind(self) -> dict[str, Array]:
        """Share of meshes, shafts and supports in the strain energy.

        Returns
        -------
        dict
            ``mesh`` (contacts), ``shaft`` (springs between coordinates) and ``support`` (springs to
            the ground), (n,) each; elements with other names count as ``support`` [1].
        """
        last = len(self.elements) - self.contacts
        between = np.array([" - " in name for name in self.elements[:last]], dtype=bool)
        structure = self.strain_share[:, :last]
        return {
            "mesh": self.contact_share,
            "shaft": np.asarray(structure[:, between].sum(axis=1)),
            "support": np.asarray(structure[:, ~between].sum(axis=1)),
        }

    def __repr__(self) -> str:
        """One line."""
        elastic = self.frequency[self.rigid :]
        first = f"first {elastic[0]:.6g} Hz" if elastic.size else "no elastic mode"
        return f"NaturalModes({len(self.names)} coordinates, {self.rigid} rigid, {first})"


def natural_modes(
    system: System,
    *,
    phase: ModePhase = "mean",
    elements: Mapping[str, ArrayLike] | None = None,
    friction: bool = False,
) -> NaturalModes:
    """Compute the natural frequencies of a system about its static load.

    Parameters
    ----------
    system : System
    phase : "mean" or float
        Contact stiffness: mean over the mesh cycle, or that at one mesh phase in [0, 1).
    elements : mapping of str to (n, n) array, optional
        Stiffness matrices of the springs of the structure, which add up to its stiffness matrix
        [N/m, N*m/rad, ...]; by default one spring to the ground per coordinate and one
        between each pair of coupled coordinates.
    friction : bool
        Whether the damped motion includes friction, which can make it grow.

    Raises
    ------
    InputError
        If the phase lies outside [0, 1), mass or stiffness matrix are not symmetric, the system
        is not stable at rest, or the elements do not add up.

    Notes
    -----
    A contact with backlash is closed, as under load; of a force law the ramps that are closed at
    the static load count. ``frequency`` neglects damping and friction; ``eigenvalues`` belong to
    ``M q'' + (C + G) q' + K q = 0`` with the damping of the contacts, the gyroscopic moments G of
    the system and, if requested, friction. With gyroscopic moments ``frequency`` and ``shape`` are
    those of ``M q'' + G q' + K q = 0``.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([0.03, -0.06], stiffness=2e8)
    >>> gears = System(np.diag([1e-3, 8e-3]), np.zeros((2, 2)), np.zeros((2, 2)), [0, 0], [pair])
    >>> natural_modes(gears).frequency.round(3)
    array([   0.   , 2615.183])
    """
    linear = linear_system(system, phase)
    springs = structure_elements(system, elements)
    frequency, shape = undamped_modes(linear.mass, linear.stiffness)
    names = (*springs, *(f"contact {j}" for j in range(len(linear.contact_stiffness))))
    matrices = np.array([*springs.values(), *linear.contact_stiffness]).reshape(
        -1, system.size, system.size
    )
    eigenvalues, complex_shape = _damped(linear, frequency, shape, friction)
    modes: Array | ComplexArray = shape
    if linear.gyroscopic is not None:
        frequency, modes = _whirling(linear.gyroscopic, frequency, shape)
    return NaturalModes(
        names=linear.names,
        frequency=frequency,
        shape=modes,
        damping_ratio=_damping_ratio(linear, frequency, modes),
        kinetic_share=np.real(modes.conj() * (modes @ linear.mass)),
        elements=tuple(names),
        strain_share=_shares(matrices, frequency, modes),
        contacts=len(linear.contact_stiffness),
        eigenvalues=eigenvalues,
        complex_shape=complex_shape,
        linear=linear,
    )


def frequencies_at(linear: LinearSystem, gyroscopic: Sequence[Array | None]) -> list[Array]:
    """Natural frequencies [Hz] of a system with each of several gyroscopic matrices."""
    frequency, shape = undamped_modes(linear.mass, linear.stiffness)
    return [
        frequency if matrix is None else _whirling(matrix, frequency, shape)[0]
        for matrix in gyroscopic
    ]


def undamped_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Natural frequencies [Hz] and shapes of two matrices, sorted by frequency."""
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    matrix = inverse @ stiffness @ inverse.T
    squares, columns = np.linalg.eigh(0.5 * (matrix + matrix.T))
    rigid = np.abs(squares) <= _RIGID * np.abs(squares).max(initial=0.0)
    if np.any(squares[~rigid] < 0.0):
        what = "the system is statically unstable: a stiffness is negative"
        why = "A motion moves away from the static equilibrium without oscillating"
        remedy = "Check the signs in the stiffness matrix and of the contact stiffnesses"
        raise InputError(what, "System.stiffness", why, remedy)
    squares = np.where(rigid, 0.0, squares)
    shape = columns.T @ inverse
    return np.sqrt(squares) / (2.0 * np.pi), standard_rotation(squares, shape) @ shape


def _whirling(gyroscopic: Array, frequency: Array, shape: Array) -> tuple[Array, ComplexArray]:
    """Frequencies and shapes with gyroscopic moments, from those of the system at rest."""
    # In the modes at rest, a = rate*position and b = velocity follow (a, b)' = S (a, b) with a
    # skew matrix S: its eigenvalues are imaginary whatever the speed.
    modal = shape @ gyroscopic @ shape.T
    size, rigid = len(frequency), int(np.count_nonzero(frequency == 0.0))
    rate = 2.0 * np.pi * frequency[rigid:]
    state = np.zeros((2 * size - rigid,) * 2)
    state[: size - rigid, size:] = np.diag(rate)
    state -= state.T
    state[size - rigid :, size - rigid :] = 0.5 * (modal.T - modal)
    values, vectors = np.linalg.eigh(-1j * state)
    whirls = values > np.sqrt(_RIGID) * np.abs(values).max(initial=0.0)
    motion, values = vectors[size - rigid :, whirls].T, values[whirls]
    motion = standard_rotation(values, motion @ shape) @ motion
    motion /= np.linalg.norm(motion, axis=1, keepdims=True)
    still = np.linalg.svd(modal[:, :rigid])[2][rigid - (size - len(motion)) :]
    shapes = np.vstack((still @ shape[:rigid], motion @ shape))
    frequency = np.concatenate((np.zeros(len(still)), values / (2.0 * np.pi)))
    at_rest = slice(len(still))
    shapes[at_rest] = standard_rotation(frequency[at_rest], shapes[at_rest]) @ shapes[at_rest]
    return frequency, np.asarray(shapes, dtype=complex)


def _damping_ratio(linear: LinearSystem, frequency: Array, shape: Array | ComplexArray) -> Array:
    """Share of critical damping, to the first order in the damping."""
    modal = np.einsum("mi,ik,mk->m", shape.conj(), linear.damping, shape, optimize=True).real
    inertia = 4.0 * np.pi * np.where(frequency > 0.0, frequency, np.nan)
    if linear.gyroscopic is not None:
        turned = np.einsum("mi,ik,mk->m", shape.conj(), linear.gyroscopic, shape, optimize=True)
        inertia = inertia + turned.imag
    return np.asarray(modal / inertia)


def _shares(matrices: Array, frequency: Array, shape: Array | ComplexArray) -> Array:
    energy = (
        np.stack(
            [np.real(np.sum(shape.conj() * (shape @ matrix), axis=1)) for matrix in matrices],
            axis=1,
        )
        if len(matrices)
        else np.zeros((len(frequency), 0))
    )
    total = np.where(frequency > 0.0, energy.sum(axis=1), np.inf)
    share = energy / total[:, None]
    # An element that a mode does not strain has none, not one of a sign that rounding gives.
    return np.asarray(np.where((share < 0.0) & (share > -_ROUNDED), 0.0, share))


def _damped(
    linear: LinearSystem, frequency: Array, shape: Array, friction: bool
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues and shapes in the undamped modes, without the position of the rigid ones."""
    spring = linear.stiffness + (linear.friction_stiffness if friction else 0.0)
    damper = linear.damping + (linear.friction_damping if friction else 0.0)
    damper = damper if linear.gyroscopic is None else damper + linear.gyroscopic
    size, rigid = len(frequency), int(np.count_nonzero(frequency == 0.0))
    swinging = size - rigid
    # Displacements are scaled by a typical rate, so that all entries have similar magnitude.
    rate = max(2.0 * np.pi * float(frequency.max(initial=0.0)), 1e-30)
    state = np.zeros((swinging + size, swinging + size))
    state[:swinging, swinging + rigid :] = rate * np.eye(swinging)
    state[swinging:, :swinging] = -(shape @ spring @ shape[rigid:].T) / rate
    state[swinging:, swinging:] = -(shape @ damper @ shape.T)
    values, vectors = np.linalg.eig(state)
    values = np.concatenate((np.zeros(rigid), values)).astype(complex)
    # Displacement and velocity of a mode are proportional.
    moved: ComplexArray = np.vstack(
        (shape[:rigid].astype(complex), vectors[swinging:].T @ shape)
    ).astype(complex)
    order = np.argsort(np.abs(values), kind="stable")
    for group in groups_of_equal(np.abs(values[order])):
        order[group] = order[group][np.argsort(values[order[group]].imag, kind="stable")]
    moved = moved[order]
    top = leading(moved)
    shapes = np.asarray(moved / np.where(top == 0.0, 1.0, top), dtype=complex)
    return np.asarray(values[order], dtype=complex), shapes


#: Entries below this share of the row's largest are rounding of the sums.
_ROUNDING = 1e-12


def structure_elements(
    system: System, elements: Mapping[str, ArrayLike] | None = None
) -> dict[str, Array]:
    """Name the springs of the structure."""
    matrix = np.asarray(system.stiffness)
    size = float(np.abs(matrix).max(initial=0.0))
    if np.abs(matrix - matrix.T).max(initial=0.0) > 1e-9 * size:
        why = "Only a symmetric matrix stores energy"
        remedy = "Model friction as the friction of a contact"
        raise InputError("the stiffness matrix is not symmetric", "System.stiffness", why, remedy)
    if elements is None:
        return _springs(matrix, tuple(system.names))
    matrices = {name: np.asarray(element, dtype=float) for name, element in elements.items()}
    wrong = [name for name, element in matrices.items() if element.shape != matrix.shape]
    if wrong or np.abs(sum(matrices.values()) - matrix).max() > 1e-9 * size:
        what = f'"{wrong[0]}" is not a {matrix.shape} matrix' if wrong else "they do not add up"
        why = "The sum of the springs is the stiffness matrix of the structure"
        remedy = "Give all springs of the structure, including those to the ground"
        raise InputError(what, "argument elements", why, remedy)
    return matrices


def _springs(matrix: Array, names: tuple[str, ...]) -> dict[str, Array]:
    count = len(names)
    springs: dict[str, Array] = {}
    for i in range(count):
        ground = float(matrix[i].sum())
        if abs(ground) > _ROUNDING * np.abs(matrix[i]).sum():
            springs[names[i]] = _spring(count, i, None, ground)
        for k in range(i + 1, count):
            if matrix[i, k] != 0.0:
                springs[f"{names[i]} - {names[k]}"] = _spring(count, i, k, -float(matrix[i, k]))
    return springs


def _spring(count: int, i: int, k: int | None, stiffness: float) -> Array:
    along = np.zeros(count)
    along[i] = 1.0
    if k is not None:
        along[k] = -1.0
    return np.asarray(stiffness * np.outer(along, along))
