"""Response to a harmonic displacement error, with the contacts at their mean stiffness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.linear.linear_system import LinearSystem, ModePhase, linear_system
from tribodyn.errors import InputError, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray


@record
class ForcedResponse(Record):
    """Complex amplitudes of the motion that a harmonic error excites.

    A signal is ``Re(amplitude*exp(2 pi i f t))`` where the error is ``Re(error*exp(2 pi i f t))``.

    Parameters
    ----------
    names : tuple of str
        Names of the coordinates.
    frequency : (f,) array
        Frequencies of the error [Hz].
    error : float
        Amplitude of the error [m].
    contact : tuple of int
        The contacts on which the error acts.
    position : (f, n) complex array
        Coordinates [m or rad].
    transmission_error : (f, contacts) complex array
        Approach of the two bodies along the direction of each contact [m].
    deflection : (f, contacts) complex array
        Compression of each contact: the approach less the error [m].
    contact_force : (f, contacts) complex array
        Force of each contact [N].
    structure_force : (f, n) complex array
        Force of the springs and dampers of the structure, bearings and shafts, against each
        coordinate [N or N*m].

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=1e8, damping=10.0)
    >>> forced_response(System([[1.0]], [[0.0]], [[0.0]], [1.0], [pair]), [100.0, 1591.5])
    ForcedResponse(2 frequencies, largest mesh force 99804.6 N at 1591.5 Hz)
    """

    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    error: float = fact()
    contact: tuple[int, ...]
    position: ComplexArray = quantity("frequency", "coordinate", unit="m or rad")
    transmission_error: ComplexArray = quantity("frequency", "contact", unit="m")
    deflection: ComplexArray = quantity("frequency", "contact", unit="m")
    contact_force: ComplexArray = quantity("frequency", "contact", unit="N")
    structure_force: ComplexArray = quantity("frequency", "coordinate", unit="N or N*m")

    @property
    def mesh_force(self) -> ComplexArray:
        """Force of the contacts on which the error acts together, (f,) [N]."""
        return np.asarray(self.contact_force[:, list(self.contact)].sum(axis=1))

    def peaks(self) -> Array:
        """Frequencies between the first and the last at which the mesh force is largest.

        Returns
        -------
        (m,) array
            Local maxima among the frequencies, rising [Hz].
        """
        size = np.abs(self.mesh_force)
        inner = (size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])
        return np.asarray(self.frequency[1:-1][inner])

    def __repr__(self) -> str:
        """One line."""
        size = np.abs(self.mesh_force)
        top = int(size.argmax())
        return (
            f"ForcedResponse({self.frequency.size} frequencies, largest mesh force "
            f"{size[top]:.6g} N at {self.frequency[top]:.6g} Hz)"
        )


def forced_response(
    system: System,
    frequency: ArrayLike,
    *,
    contact: int = 0,
    error: float = 1e-6,
    phase: ModePhase = "mean",
    friction: bool = True,
) -> ForcedResponse:
    """Compute the harmonic motion that a displacement error of one mesh excites.

    Parameters
    ----------
    system : System
    frequency : float or (f,) array
        Frequencies of the error [Hz].
    contact : int
        Contact with the error; the other ramps of its force law have the same error.
    error : float
        Amplitude of the error [m].
    phase : "mean" or float
        Contact stiffness: mean over the mesh cycle, or that at one mesh phase in [0, 1).
    friction : bool
        Whether friction follows the contact force.

    Raises
    ------
    InputError
        If a frequency is not positive, there is no such contact, or an undamped mode lies exactly
        at a frequency.

    Notes
    -----
    ``[K - w^2 M + i w C] q = sum_j (h_j + s_j)(k_j + i w c_j) e``: the error acts on the springs
    and dampers of the contacts, the resulting motion changes their compression. The result holds
    while the teeth stay in contact and the stiffness is nearly constant; for the excitation by a
    varying stiffness use ``steady_state``.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=1e8)
    >>> slow = forced_response(System([[1.0]], [[0.0]], [[0.0]], [1.0], [pair]), 1.0)
    >>> float(slow.transmission_error[0, 0].real.round(9))
    1e-06
    """
    require_positive("frequency", frequency, "Hz")
    hertz = np.atleast_1d(np.asarray(frequency, dtype=float))
    linear = linear_system(system, phase)
    count = linear.spring.size
    if not 0 <= contact < count:
        what = f"contact = {contact}"
        why = f"The system has {count} contact{'s' if count != 1 else ''}, counted from 0"
        raise InputError(what, "argument contact", why, "Give the number of one of its contacts")
    members = np.flatnonzero(linear.bundle == linear.bundle[contact])
    contact_error = np.where(np.isin(np.arange(count), members), float(error), 0.0)
    position = _solve(linear, 2.0 * np.pi * hertz, contact_error, friction)
    approach = position @ linear.direction.T
    deflection = approach - contact_error
    omega = 2j * np.pi * hertz[:, None]
    stiffness, damping = np.asarray(system.stiffness), system.rate_matrix
    return ForcedResponse(
        names=linear.names,
        frequency=hertz,
        error=float(error),
        contact=tuple(int(member) for member in members),
        position=position,
        transmission_error=approach,
        deflection=deflection,
        contact_force=(linear.spring + omega * linear.damper) * deflection,
        structure_force=position @ stiffness.T + omega * (position @ damping.T),
    )


def _solve(
    linear: LinearSystem, omega: Array, contact_error: Array, friction: bool
) -> ComplexArray:
    w = omega[:, None, None]
    spring = linear.stiffness + (linear.friction_stiffness if friction else 0.0)
    damper = linear.damping + (linear.friction_damping if friction else 0.0)
    damper = damper if linear.gyroscopic is None else damper + linear.gyroscopic
    push = linear.push if friction else linear.direction
    dynamic = spring - w**2 * linear.mass + 1j * w * damper
    force = (linear.spring + 1j * omega[:, None] * linear.damper) * contact_error @ push
    scale = 1.0 / np.sqrt(np.diag(linear.mass))
    scaled = dynamic * np.outer(scale, scale)
    try:
        solved = np.linalg.solve(scaled, (scale * force)[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError as error:
        what = "an undamped mode lies exactly at one of the frequencies"
        why = "Its motion grows without bounds"
        remedy = "Add damping to the structure or the contact"
        raise InputError(what, "argument frequency", why, remedy) from error
    return np.asarray(scale * solved)
