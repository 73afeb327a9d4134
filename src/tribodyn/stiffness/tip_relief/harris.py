"""Static transmission error over phase and torque: what the mesh does before anything vibrates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import PathOfContact, path_of_contact
from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material, SpurPair, default_relief_length
from tribodyn.gear.mesh_geometry import flank_ranges
from tribodyn.model import NO_OPTIONS
from tribodyn.nomenclature import one_or_more
from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.stiffness.loaded import LoadedContact, loaded_contact
from tribodyn.stiffness.loaded.problem import mesh_period, slice_widths
from tribodyn.stiffness.loaded.result import harmonic_amplitudes
from tribodyn.types import Array, ByName, Index

#: Loads of single pairs in single slices that are held in memory at the same time.
_AT_ONCE = 4_000_000
#: Phases and harmonics where nothing is said.
_PHASES = 256
_HARMONICS = 10
#: Part of the greatest force that counts as load.
_LOADED = 1e-9
#: Distance from an event that shows its other side, and digits of a phase that tell both apart.
_SIDE, _DIGITS = 1e-9, 10
#: Tooth pairs that may touch, about.
_PAIRS = 4


@record
class HarrisMap(Record):
    """Static transmission error of a mesh over phase and torque.

    Parameters
    ----------
    gear_pair : SpurPair or None
        Both gears in their working position; None for a hypoid pair.
    provider : str
        What the tooth compliances come from.
    reference : str
        Where the gear bodies are held; for a hypoid pair, how stiff its contact lines are.
    torque : array (t,) [N*m]
        Torques on the pinion, increasing.
    phase : array (p,)
        Mesh phase, 0 where a pair comes into contact (at A), from 0 to the number of mesh cycles.
    mesh_cycles : int
        Mesh cycles after which everything repeats.
    transmission_error : array (t, p) [m]
        Approach of the gears along the line of action under load at rest.
    unloaded_transmission_error : array (p,) [m]
        That of the rigid mesh: what the flanks alone do.
    harmonics : array (t, k) [m]
        Peak amplitudes of the orders 1, 2, ... of the mesh frequency.
    mean_mesh_stiffness_secant, mean_mesh_stiffness_tangent : array (t,) [N/m]
        Means over the phases.
    corner_phase : array (c,) or None
        Mesh phases between the even ones at which curves have corners: where a pair enters and
        leaves, at the ends of reliefs, and where a pair begins or ceases to carry under one of the
        torques. None where slices of the face or teeth that differ multiply the work.
    corner_transmission_error : array (t, c) [m] or None
        Transmission error there.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "mean_transmission_error": Labels(("torque",), "m"),
        "peak_to_peak_transmission_error": Labels(("torque",), "m"),
        "order": Labels(("order",), "1", axis=True),
    }

    gear_pair: SpurPair | None
    provider: str = fact()
    reference: str = fact()
    torque: Array = quantity("torque", unit="N*m", axis=True)
    phase: Array = quantity("phase", unit="1", axis=True)
    mesh_cycles: int
    transmission_error: Array = quantity("torque", "phase", unit="m")
    unloaded_transmission_error: Array = quantity("phase", unit="m")
    harmonics: Array = quantity("torque", "order", unit="m")
    mean_mesh_stiffness_secant: Array = quantity("torque", unit="N/m")
    mean_mesh_stiffness_tangent: Array = quantity("torque", unit="N/m")
    corner_phase: Array | None = quantity("corner", unit="1", axis=True, default=None)
    corner_transmission_error: Array | None = quantity("torque", "corner", unit="m", default=None)

    @property
    def mean_transmission_error(self) -> Array:
        """Mean over the phases (t,) [m]."""
        return np.asarray(self.transmission_error.mean(axis=1))

    @property
    def peak_to_peak_transmission_error(self) -> Array:
        """Largest less least transmission error over the even phases (t,) [m]."""
        return np.asarray(np.ptp(self.transmission_error, axis=1))

    def curves(self) -> tuple[Array, Array]:
        """Transmission error over all phases, corners between the even ones included.

        Returns
        -------
        tuple of array (q,), (t, q)
            Phases in order, and the transmission error under each torque [m].
        """
        if self.corner_phase is None or self.corner_transmission_error is None:
            return self.phase, self.transmission_error
        phase = np.concatenate((self.phase, self.corner_phase))
        order = np.argsort(phase, kind="stable")
        errors = (self.transmission_error, self.corner_transmission_error)
        return phase[order], np.concatenate(errors, axis=1)[:, order]

    @property
    def order(self) -> Index:
        """Orders of the mesh frequency (k,)."""
        return np.arange(1, self.harmonics.shape[1] + 1)

    @property
    def quietest_torque(self) -> float:
        """Torque of the least peak-to-peak transmission error [N*m]."""
        return float(self.torque[np.argmin(self.peak_to_peak_transmission_error)])

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        peak = self.peak_to_peak_transmission_error * 1e6
        return (
            f"HarrisMap({self.provider}, {self.torque.size} torques from {self.torque[0]:g} to "
            f"{self.torque[-1]:g} N*m, peak to peak {peak.min():.4g} to {peak.max():.4g} um, "
            f"least at {self.quietest_torque:g} N*m)"
        )


def transmission_error_over_torque(
    pair: SpurPair,
    torque: ArrayLike,
    *,
    provider: str = "fe2d",
    phases: int | None = None,
    harmonics: int | None = None,
    extended_contact: bool = True,
    reference: str | None = None,
    material: Material | None = None,
    slices: int | None = None,
    options: ByName = NO_OPTIONS,
) -> HarrisMap:
    """Find the static transmission error of a mesh over phase and torque (Harris map).

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, with modifications and deviations of their flanks.
    torque : float or array (t,) [N*m]
        Torques on the pinion, in any order.
    provider : str
        Where the tooth compliances come from.
    phases : int, optional
        Evenly spaced phases of a mesh cycle; by default 256, or 64 where slices of the face width
        or the hunting tooth period multiply the work.
    harmonics : int, optional
        Number of mesh harmonics, less than half the phases; 10 by default, or all that there are.
    extended_contact, reference, material, slices, options
        As for :func:`tribodyn.stiffness.loaded_contact`.

    Returns
    -------
    HarrisMap
        Over the hunting tooth period where teeth differ.

    Raises
    ------
    InputError
        If a value is out of range.
    ComputationError
        If a load is beyond what the formula of the local compression covers.

    Notes
    -----
    :func:`tribodyn.stiffness.loaded_contact` at every torque. The map is named after Harris (1958),
    Proc. Inst. Mech. Eng. 172, 87-112, who drew the curves of all torques above each other.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> found = transmission_error_over_torque(pair, [50.0, 100.0], provider="analytic")
    >>> found.transmission_error.shape
    (2, 256)
    """
    torques = np.unique(one_or_more(torque=torque)[0])
    path = path_of_contact(pair)
    work = mesh_period(path) * slice_widths(path, slices).size
    if phases is None:
        phases = _PHASES if work == 1 else _PHASES // 4
    orders = _orders(harmonics, phases)
    settings: dict[str, Any] = {
        "provider": provider,
        "phases": phases,
        "extended_contact": extended_contact,
        "reference": reference,
        "material": material,
        "slices": slices,
        "options": options,
    }
    size = max(phases, 1) * work * _PAIRS
    count = min(torques.size, 1 + torques.size * size // _AT_ONCE)
    rows, ends = [], []
    for some_torques in np.array_split(torques, count):
        contact = loaded_contact(pair, some_torques, **settings)
        secant = contact.mesh_stiffness_secant.mean(axis=1)
        tangent = contact.mesh_stiffness_tangent.mean(axis=1)
        rows.append((contact.transmission_error, secant, tangent))
        ends.append(_ends_of_contact(contact))
    error, secant, tangent = (np.concatenate(column) for column in zip(*rows, strict=True))
    corners: Array | None = None
    corner_error: Array | None = None
    if work == 1:
        corners = _corners(path, np.concatenate(ends))
        at_corners = loaded_contact(pair, torques, **{**settings, "phases": corners})
        corner_error = at_corners.transmission_error
    return HarrisMap(
        gear_pair=pair,
        provider=contact.provider,
        reference=contact.reference,
        torque=torques,
        phase=contact.phase,
        mesh_cycles=contact.mesh_cycles,
        transmission_error=error,
        unloaded_transmission_error=contact.unloaded_transmission_error,
        harmonics=harmonic_amplitudes(contact.phase, error, contact.mesh_cycles, orders),
        mean_mesh_stiffness_secant=secant,
        mean_mesh_stiffness_tangent=tangent,
        corner_phase=corners,
        corner_transmission_error=corner_error,
    )


def _ends_of_contact(contact: LoadedContact) -> Array:
    """Mesh phases between two even ones at which a pair begins or ceases to carry."""
    force = np.moveaxis(contact.normal_force, -1, 0)  # pairs, torques, phases
    force = force.reshape(-1, contact.phase.size)
    loaded = force > _LOADED * force.max()
    row, left = np.nonzero(loaded[:, 1:] != loaded[:, :-1])
    begins = loaded[row, left + 1]
    last = np.where(begins, left + 1, left)
    sense = np.where(begins, 1, -1)
    before = np.clip(last + sense, 0, contact.phase.size - 1)
    rise = force[row, before] - force[row, last]
    share = force[row, last] / np.where(rise > 0.0, rise, np.inf)
    step = contact.phase[1] - contact.phase[0]
    return np.asarray(contact.phase[last] - sense * step * np.minimum(share, 1.0))


def _corners(path: PathOfContact, ends: Array) -> Array:
    """Phases of all corners in order: ends of the path from both sides, of reliefs, of contact."""
    pair = path.pair
    lowest, highest = flank_ranges(pair)[0]
    bends = []
    for gear, tip, root in ((pair.pinion, highest, lowest), (pair.wheel, lowest, highest)):
        modification = gear.modification
        for amount, length, end in (
            (modification.tip_relief, modification.tip_relief_length, tip),
            (modification.root_relief, modification.root_relief_length, root),
        ):
            if amount:
                reach = default_relief_length(pair) if length is None else length
                bends.append(end - reach if end == highest else end + reach)
    ages = path.direction * (np.array(bends) - path.A) / pair.base_pitch
    leaves = path.contact_ratio % 1.0
    sides = [1.0 - _SIDE, leaves, (leaves - _SIDE) % 1.0]
    return np.unique(np.round(np.concatenate((ages % 1.0, sides, ends % 1.0)), _DIGITS) % 1.0)


def _orders(harmonics: int | None, phases: int) -> int:
    """Check the number of harmonics, or choose it."""
    most = (phases - 1) // 2
    if harmonics is None:
        return max(1, min(_HARMONICS, most))
    if not 1 <= harmonics <= most:
        why = f"{phases} phases of a mesh cycle show 1 to {most} harmonics"
        remedy = "Give more phases, for example phases=64"
        raise InputError(f"harmonics = {harmonics}", Argument("harmonics"), why, remedy)
    return harmonics
