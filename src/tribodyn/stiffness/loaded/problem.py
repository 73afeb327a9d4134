"""Loaded tooth contact problem of one mesh: compliances, gaps and widths of slices."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import PathOfContact, extended_contact
from tribodyn.contact.face_contacts import checked_slices
from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.gear import Material, flank_gap, hunting_period, pitch_gap, run_out_gap
from tribodyn.interrupt import stoppable
from tribodyn.stiffness.teeth.influence import GearInfluence, local_terms
from tribodyn.types import Array, Index, Mask

#: Separation of flanks that cannot meet [m].
FAR = 1.0


@dataclass(frozen=True, eq=False)
class ContactPlaces:
    """Places of all tooth pairs that may touch; made by :func:`contact_places`."""

    contact: PathOfContact  #: path of contact of the pair
    phase: Array  #: mesh phase
    number: Index  #: mesh cycles between the entry of each pair and that of pair 0
    path: Array  #: distance from the pinion's base tangent point along the line of action [m]
    separation: Array  #: [m]
    pinion_curvature_radius: Array  #: [m]
    wheel_curvature_radius: Array  #: [m]

    @property
    def possible(self) -> Mask:
        """Which pairs may touch (p, n)."""
        return np.asarray(self.separation < FAR)

    @property
    def on_path(self) -> Mask:
        """Which pairs are between A and E, where involutes roll on each other (p, n)."""
        return np.asarray(self.separation == 0.0)

    @property
    def is_sliced(self) -> bool:
        """Whether several contacts are slices of one pair."""
        return bool(np.unique(self.number).size < self.number.size)

    @property
    def direction(self) -> int:
        """Sense in which contacts move along the path: 1 when the pinion drives, -1 otherwise."""
        return self.contact.direction

    def slice_by_slice(self, slices: int) -> ContactPlaces:
        """Places of the pairs in each slice of the face, one after the other (p s, n)."""
        columns = ("path", "separation", "pinion_curvature_radius", "wheel_curvature_radius")
        each = (getattr(self, n).reshape(len(self.phase), -1, slices) for n in columns)
        rows = (np.moveaxis(of, 2, 1).reshape(-1, of.shape[1]) for of in each)
        chosen = dict(zip(columns, rows, strict=True), phase=np.repeat(self.phase, slices))
        return replace(self, number=self.number[::slices], **chosen)


def contact_places(contact: PathOfContact, phase: ArrayLike, *, extended: bool) -> ContactPlaces:
    """Find where tooth pairs may touch."""
    path, touching = contact.pair_paths(phase)
    turned = np.atleast_1d(np.asarray(phase, dtype=float))
    if not extended:
        return on_path_places(contact, turned, path, touching)
    return extended_places(contact, turned, path)


def extended_places(contact: PathOfContact, phase: Array, path: Array) -> ContactPlaces:
    """Places of given pairs and one more on each side, which may touch at a tip corner."""
    step = contact.direction * contact.pair.base_pitch
    path = np.concatenate([path[:, :1] - step, path, path[:, -1:] + step], axis=1)
    beyond = extended_contact(contact.pair, path)
    touched = beyond.pinion_curvature_radius, beyond.wheel_curvature_radius
    return ContactPlaces(
        contact=contact,
        phase=phase,
        number=np.arange(-1, path.shape[1] - 1),
        path=path,
        separation=np.where(beyond.possible, beyond.separation, FAR),
        **_radii(contact, *touched, beyond.possible),
    )


def on_path_places(
    contact: PathOfContact, phase: Array, path: Array, touching: Mask
) -> ContactPlaces:
    """Places of pairs that are known to be between A and E, or apart."""
    length = contact.pair.line_of_action_length
    return ContactPlaces(
        contact=contact,
        phase=phase,
        number=np.arange(path.shape[1]),
        path=path,
        separation=np.where(touching, 0.0, FAR),
        **_radii(contact, path, length - path, touching),
    )


def _radii(contact: PathOfContact, pinion: Array, wheel: Array, possible: Mask) -> dict[str, Array]:
    """Radii of curvature, with those of the pitch point where flanks cannot meet."""
    limits = sorted((contact.A, contact.E))
    middle = 0.5 * sum(limits)
    length = contact.pair.line_of_action_length
    return {
        "pinion_curvature_radius": np.where(possible, pinion, middle),
        "wheel_curvature_radius": np.where(possible, wheel, length - middle),
    }


#: Slices of a face width over which flanks vary; the middle one is in the middle of the face.
_SLICES = 21


def mesh_period(contact: PathOfContact) -> int:
    """Mesh cycles until the same teeth meet again, where teeth differ; otherwise one."""
    return hunting_period(contact.pair) if contact.pair.teeth_differ else 1


def slice_widths(contact: PathOfContact, slices: int | None) -> Array:
    """Widths of the slices of the common face of a pair whose contacts are parallel to its axes."""
    pair = contact.pair
    count = checked_slices(slices, _SLICES if pair.has_lead_modification else 1)
    return np.full(count, pair.common_face_width / count)


def slice_gaps(places: ContactPlaces, face_position: Array, *, teeth_alike: bool = False) -> Array:
    """Gap of each pair in each slice (p, s, n); face positions (s, 1), or (1, n) of slices."""
    pair = places.contact.pair
    gaps = np.repeat(places.separation[:, None, :], face_position.shape[0], axis=1)
    if not pair.has_modification:
        return gaps
    flank = flank_gap(
        pair,
        places.pinion_curvature_radius[:, None, :],
        places.wheel_curvature_radius[:, None, :],
        face_position,
    )
    gaps = gaps + flank
    if not teeth_alike and pair.teeth_differ:
        cycle = np.floor(places.phase).astype(int)
        turned = 2.0 * math.pi * places.phase / pair.pinion.teeth
        gaps = gaps + pitch_gap(pair, cycle[:, None], places.number)[:, None, :]
        gaps = gaps + run_out_gap(pair, turned)[:, None, None]
    return np.where(places.possible[:, None, :], gaps, FAR)


def coupled_compliance(pinion: GearInfluence, wheel: GearInfluence, places: ContactPlaces) -> Array:
    """Structural compliance of all pairs that may touch, coupled through both gear bodies."""
    count, opposite = places.path.shape[1], -places.contact.pair.wheel.sign
    total = np.zeros((*places.path.shape, count))
    for gear, radius, sense in (
        (pinion, places.pinion_curvature_radius, places.direction),
        (wheel, places.wheel_curvature_radius, opposite * places.direction),
    ):
        weights = gear._weights_at(np.clip(np.abs(radius.T), *gear.curvature_radius[[0, -1]]))
        for i in range(count):
            total[:, i, i] += weights[i] @ gear.self_compliance
            for j in range(i + 1, count):
                cross = gear._coupled(weights[i], weights[j], (j - i) * sense)
                total[:, [i, j], [j, i]] += cross[:, None]
    return total


def independent_compliance(stiffness: Array, face_width: Array | float) -> Array:
    """Compliance of pairs that know nothing of each other."""
    touching = stiffness > 0.0
    diagonal = np.where(touching, face_width / np.where(touching, stiffness, 1.0), 1.0)
    return np.asarray(diagonal[..., None] * np.eye(stiffness.shape[1]))


@dataclass(frozen=True, eq=False)
class Compliance:
    """Everything that the solver needs of the teeth at some phases."""

    structure: Array  #: compliance without the local compression [m^2/N]
    local: Array  #: coefficient ``A`` of the local compression ``f (A - B ln f)`` [m^2/N]
    logarithm: float  #: coefficient ``B`` [m^2/N]


def local_coefficients(material: Material, places: ContactPlaces) -> tuple[Array, float]:
    """Coefficients of the compression after Weber and Banaschek with its Hertzian half width."""
    pair = places.contact.pair
    radii = places.pinion_curvature_radius, places.wheel_curvature_radius
    terms, scale = local_terms((pair.pinion, pair.wheel), radii, material)
    return scale * terms.sum(axis=0), scale


class WideContactError(ComputationError):
    """The contact of the flanks is too wide for the formula of their local compression."""


_STATUS = {
    1: (
        ComputationError,
        "the loads of the tooth pairs do not settle",
        "Check the load and the deviations",
    ),
    2: (
        WideContactError,
        "the contact of the flanks is as wide as the teeth are thick",
        "Lower the load; the formula of the local compression holds for a narrow contact",
    ),
}


#: Loads of pairs in slices that are found within a tenth of a second.
_BRIEF = 10_000


class Equilibrium(NamedTuple):
    """What the mesh does under given loads.

    Parameters
    ----------
    approach : array (t, p) [m]
        Approach of the gears along the line of action.
    load : array (t, p, s, n) [N/m]
        Load per face width of each pair in each slice.
    tangent : array (t, p) [N/m]
        Slope of the force over the approach.
    """

    approach: Array
    load: Array
    tangent: Array


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """Compliances and gaps of all tooth pairs at some phases.

    Parameters
    ----------
    places : ContactPlaces
        Where the pairs may touch.
    compliance : Compliance
        Of the teeth.
    gaps : array (p, s, n) [m]
        Separation of each pair in each slice without load.
    widths : array (p or 1, s, n or 1) [m]
        Face width over which each pair touches in each slice, zero where it does not.
    """

    places: ContactPlaces
    compliance: Compliance
    gaps: Array
    widths: Array

    def with_film(self, film_stiffness: Array, lead: Array | None = None) -> ContactProblem:
        """Put an oil film in series with each pair.

        Parameters
        ----------
        film_stiffness : array (p, n) [N/m]
            Stiffness of the film of each pair in all slices; infinite without film.
        lead : array (p, n) [m], optional
            Distance before its flanks meet at which the film of each pair begins to carry. The
            approach is then counted from where the first film of all phases does.
        """
        structure = self.compliance.structure.copy()
        pairs = np.arange(structure.shape[1])
        structure[:, pairs, pairs] += self.face_widths / film_stiffness
        gaps = self.gaps
        if lead is not None:
            gaps = gaps - lead[:, None] + self.film_offset(lead)
        return replace(self, compliance=replace(self.compliance, structure=structure), gaps=gaps)

    def film_offset(self, lead: Array) -> float:
        """Distance before the flanks meet from which the approach with films is counted [m].

        Parameters
        ----------
        lead : array (p, n) [m]
            As :meth:`with_film` takes it.

        Returns
        -------
        float [m]
            Approaches of :meth:`with_film` are larger by it than those from the rigid flanks.
        """
        return float(self.gaps.min() - (self.gaps - lead[:, None]).min())

    @property
    def has_slices(self) -> bool:
        """Whether a pair may touch on a part of the face width alone."""
        return self.widths.shape[1] > 1 or self.places.is_sliced

    @property
    def face_widths(self) -> Array:
        """Face width over which each pair touches in all slices together (p or 1, n or 1) [m]."""
        return np.asarray(self.widths.sum(axis=1))

    def forces(self, load_per_width: Array) -> Array:
        """Force on each pair of all its slices.

        Parameters
        ----------
        load_per_width : array (..., p, s, n) [N/m]
            Loads of every pair in every slice.

        Returns
        -------
        array (..., p, n) [N]
        """
        return np.asarray((self.widths * load_per_width).sum(axis=-2))

    def face_load(self, load_per_width: Array) -> Array:
        """Force on each slice of the face over all phases and pairs, over the mean of all slices.

        Parameters
        ----------
        load_per_width : array (..., p, s, n) [N/m]
            Loads of every pair in every slice.

        Returns
        -------
        array (..., slices)
        """
        force = self.widths * load_per_width
        if self.places.is_sliced:  # contacts are counted pair by pair
            contacts, pairs = force.sum(axis=(-3, -2)), np.unique(self.places.number).size
            each = contacts.reshape(*contacts.shape[:-1], pairs, -1).sum(axis=-2)
        else:
            each = force.sum(axis=(-3, -1))
        return np.asarray(each / each.mean(axis=-1, keepdims=True))

    @property
    def least_gap(self) -> Array:
        """Approach at which the first pair touches (p,) [m]."""
        return np.asarray(self.gaps.min(axis=(1, 2)))

    def at_loads(self, totals: Array) -> Equilibrium:
        """Solve for total normal forces.

        Parameters
        ----------
        totals : array (t,) or (t, p) [N]
            Normal forces of all pairs together, positive; solved fastest in increasing order.

        Raises
        ------
        WideContactError
            If a load is beyond what the formula of the local compression covers.
        """
        from tribodyn.stiffness.loaded.kernel import solve_loads

        count, phases = len(totals), len(self.gaps)
        shapes = (count, phases), (count, *self.gaps.shape), (count, phases)
        equilibrium = Equilibrium(*map(np.empty, shapes))
        forces = np.asarray(totals, dtype=float).reshape(count, -1)
        each = np.ascontiguousarray(np.broadcast_to(forces, (count, phases)))
        self._call(solve_loads, count, self._each_width, each, *equilibrium)
        return equilibrium

    def at_approach(self, approach: Array) -> tuple[Array, Array]:
        """Force and tangent stiffness at given approaches.

        Parameters
        ----------
        approach : array (d, p) [m]
            Approaches at each phase.

        Returns
        -------
        tuple of array (d, p)
            Total force [N] and its slope [N/m]; zero below the smallest gap.

        Raises
        ------
        InputError
            If they are of another shape or not finite.
        ComputationError
            As :meth:`at_loads`.
        """
        from tribodyn.stiffness.loaded.kernel import solve_deflections

        approaches = self._of_phases("approach", approach, 2)
        total, tangent = np.empty(approaches.shape), np.empty(approaches.shape)
        arguments = self._each_width, approaches, total, tangent
        self._call(solve_deflections, approaches.shape[0], *arguments)
        return total, tangent

    @property
    def _each_width(self) -> Array:
        return np.ascontiguousarray(np.broadcast_to(self.widths, self.gaps.shape))

    def tangent_at(self, load_per_width: Array) -> Array:
        """Tangent stiffness of a single slice under given loads of its pairs.

        Parameters
        ----------
        load_per_width : array (p, n) [N/m]
            Loads; pairs without load are apart.

        Returns
        -------
        array (p,) [N/m]
        """
        parts, carries = self.compliance, load_per_width > 0.0
        logarithm = np.log(np.where(carries, load_per_width, 1.0))
        local = parts.local - parts.logarithm * (1.0 + logarithm)
        pairs = np.arange(carries.shape[1])
        both_carry = carries[:, :, None] & carries[:, None, :]
        slope = np.where(both_carry, parts.structure, 0.0)
        slope[:, pairs, pairs] += np.where(carries, local, 1.0)
        rates = np.linalg.solve(slope, carries[..., None].astype(float))[..., 0]
        return np.asarray((self.face_widths * rates * carries).sum(axis=1))

    def pickups(self, most: Array) -> Array:
        """Approach at which each pair begins to carry.

        Parameters
        ----------
        most : array (p,) [m]
            Largest approach of interest.

        Returns
        -------
        array (p, n) [m]
            At most ``most``. Only for a single slice: with several, a pair begins gradually.

        Raises
        ------
        InputError
            If ``most`` is of another shape or not finite.
        ComputationError
            As :meth:`at_loads`.
        """
        from tribodyn.stiffness.loaded.kernel import pickups

        approach = np.empty(self.compliance.local.shape)
        self._call(pickups, 1, self._of_phases("most", most, 1), approach)
        return approach

    def _of_phases(self, name: str, values: Array, dimensions: int) -> Array:
        """Values as the kernels take them, which look at no shape: their last axis the phases."""
        array, count = np.ascontiguousarray(values, dtype=float), len(self.gaps)
        if array.ndim != dimensions or array.shape[-1] != count:
            why = f"It has {dimensions} dimensions, the last one the {count} phases"
            what, remedy = f"{name} has the shape {array.shape}", "Give a value for each phase"
            raise InputError(what, Argument(name), why, remedy)
        if not np.isfinite(array).all():
            what = f"{name} = {array[~np.isfinite(array)][0]:g} m"
            raise InputError(what, Argument(name), "An approach is finite", "Correct the value")
        return array

    def _call(self, kernel: Any, solves: int, *arguments: Array) -> None:
        """Call a kernel that solves every slice of every phase so many times."""
        parts, gaps = self.compliance, np.minimum(self.gaps, FAR)
        teeth = parts.structure, parts.local, parts.logarithm
        status = stoppable(kernel, *teeth, gaps, *arguments, brief=solves * gaps.size <= _BRIEF)
        if status:
            kind, what, remedy = _STATUS[status]
            raise kind(what, "loaded tooth contact", "", remedy)
