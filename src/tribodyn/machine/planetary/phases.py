"""Phases of the meshes of a planetary stage, and the modes that their harmonics excite."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import gcd
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_one_of
from tribodyn.machine.planetary.positions import PlanetType, read_teeth, refuse_misfit
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.types import Array

_CYCLES = MappingProxyType({"sun": 1, "ring": 1, "planet": 1})
#: Part of the largest possible sum of phases that is rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class HarmonicExcitation:
    """How a harmonic of the mesh frequency excites a stage.

    Parameters
    ----------
    harmonic : int
        Order of the mesh frequency.
    rotational, translational, planet : float
        Part of the mean square of the mesh forces of this harmonic, equal in size, that acts in
        common on the rotation of the central members, on their translation, and on the
        planets alone [1]. They add up to 1 at equal spacing; the first two overlap at
        unequal spacing.
    """

    harmonic: int
    rotational: float
    translational: float
    planet: float

    @property
    def types(self) -> str:
        """Types of modes that are excited: some of the letters R, T, P."""
        parts = {"R": self.rotational, "T": self.translational, "P": self.planet}
        return "".join(letter for letter, part in parts.items() if part > _ROUNDING)


@dataclass(frozen=True, eq=False)
class MeshPhases:
    """Phases of the sun and ring meshes of every planet.

    Parameters
    ----------
    angles : (N,) array
        Angles of the planets about the sun [rad].
    sun, ring : (N,) array
        Mesh cycles by which each sun and ring mesh lags behind the sun mesh of the first planet,
        from 0 to below 1, while the sun turns towards greater angles relative to the carrier. In
        the other direction of rotation they lead by as much [1].
    planet : (N,) array, optional
        The same of the meshes between the planets of pairs [1].
    cycles : mapping of str to int
        Mesh cycles of each kind of mesh in the period of all. They differ for stepped planets, of
        which each lag is in cycles of its own mesh.
    """

    angles: Array
    sun: Array
    ring: Array
    planet: Array | None = None
    cycles: Mapping[str, int] = field(default_factory=lambda: _CYCLES)

    @property
    def sun_offset(self) -> Array:
        """``Contact.offset`` of the sun meshes, (N,) cycles."""
        return _fraction(-self.sun)

    @property
    def ring_offset(self) -> Array:
        """``Contact.offset`` of the ring meshes, (N,) cycles."""
        return _fraction(-self.ring)

    def offset(self, mesh: str) -> Array:
        """``Contact.offset`` of all meshes of a kind.

        Parameters
        ----------
        mesh : {"sun", "ring", "planet"}
            Kind of mesh.

        Returns
        -------
        (N,) array
            In cycles of the mesh [1].
        """
        lag = getattr(self, mesh)
        return _fraction(-(np.zeros(self.angles.size) if lag is None else lag))

    def excitation(self, harmonic: int, mesh: str = "sun") -> HarmonicExcitation:
        """Compute how a harmonic of the mesh frequency excites each type of mode.

        Parameters
        ----------
        harmonic : int
            Order of the mesh frequency, at least 1.
        mesh : {"sun", "ring"}
            Meshes whose forces excite: those of the ring excite the same types as those of the
            sun, but for stepped planets, where both have different frequencies.

        Raises
        ------
        InputError
            If it is not a whole number of at least 1, or there is no such mesh.

        Notes
        -----
        With the phases ``p`` of the planets at the angles ``psi``, harmonic l excites
        rotational modes if the sum of ``exp(2 pi i l p)`` is not zero, translational modes if one
        of the sums of ``exp(2 pi i l p +- i psi)`` is not, and modes of the planets if
        ``exp(2 pi i l p)`` is no combination of 1, cos psi and sin psi. At equal
        spacing exactly one holds: ``l z_s/N`` whole, ``(l z_s +- 1)/N`` whole, or neither.

        Examples
        --------
        >>> phases = mesh_phases(sun_teeth=28, ring_teeth=62, planets=5)
        >>> " ".join(phases.excitation(harmonic).types for harmonic in range(1, 9))
        'P T T P R P T T'
        """
        order = require_whole("harmonic", harmonic)
        require_one_of("mesh", mesh, ("sun", "ring"))
        forces = np.exp(2j * np.pi * order * getattr(self, mesh))
        turned = np.exp(1j * np.outer([0, 1, -1], self.angles))
        rotation, *translations = np.abs((turned * forces).mean(axis=1)) ** 2
        # The planets alone: what no common rotation or translation of a member produces.
        central = turned.T
        remainder = forces - central @ np.linalg.lstsq(central, forces, rcond=1e-9)[0]
        translation = max(translations) if self.angles.size < 3 else sum(translations)
        alone = float((np.abs(remainder) ** 2).mean())
        return HarmonicExcitation(order, float(rotation), float(translation), alone)


def mesh_phases(
    *,
    sun_teeth: int,
    ring_teeth: int,
    planets: int,
    angles: ArrayLike | None = None,
    sun_to_ring: float = 0.0,
    planet_teeth: int | tuple[int, int] | None = None,
    planet_type: PlanetType = "single",
    sun_to_planet: float = 0.0,
) -> MeshPhases:
    """Compute the phases of all meshes of a stage from its teeth and positions.

    Parameters
    ----------
    sun_teeth, ring_teeth : int
        Numbers of teeth; that of the ring with or without its minus sign.
    planets : int
        Number of planets, or of pairs of planets that mesh with each other.
    angles : (N,) array, optional
        Angles of the planets about the sun [rad]; equally spaced by default.
    sun_to_ring : float
        Mesh cycles by which the ring mesh of a planet lags behind its sun mesh, the same for all
        planets of a stage; it follows from the thickness of the planet's teeth. Of stepped planets
        in cycles of the ring mesh [1].
    planet_teeth : int or (int, int), optional
        Teeth of a planet; of double planets the gear at the sun first.
    planet_type : {"single", "stepped", "meshed"}
        Planets with one gear, with two gears on one shaft, or pairs that mesh with each other.
    sun_to_planet : float
        Mesh cycles by which the mesh between the planets of a pair lags behind its sun mesh [1].

    Raises
    ------
    InputError
        If the teeth of a planet at its angle do not fit between sun and ring.

    Notes
    -----
    The sun mesh of a planet at ``psi`` lags by ``z_s psi/(2 pi)``, its ring mesh by
    ``-z_r psi/(2 pi)``, both modulo 1 and from the first planet. Source: Parker
    and Lin (2004). The ring of meshed planets turns with the sun, and all meshes of a pair lag by
    ``z_s psi/(2 pi)``. With stepped planets of z_1 and z_2 teeth the frequencies of
    the sun and the ring meshes are as z_1 to z_2, and each lag is in cycles of its own mesh.

    Examples
    --------
    >>> mesh_phases(sun_teeth=17, ring_teeth=61, planets=3).sun.round(6)
    array([0.      , 0.666667, 0.333333])
    """
    teeth = read_teeth(sun_teeth, ring_teeth, planet_teeth, planet_type)
    at = refuse_misfit(teeth, require_whole("planets", planets), angles)
    turns = (at - at[0]) / (2.0 * np.pi)
    offset = require_number("sun_to_ring", sun_to_ring)
    lag = {"sun": teeth.sun * turns, "ring": offset - teeth.ring * turns}
    cycles: Mapping[str, int] = _CYCLES
    if planet_type == "meshed":
        lag["ring"] = offset + teeth.ring * turns
        lag["planet"] = require_number("sun_to_planet", sun_to_planet) + lag["sun"]
    elif planet_type == "stepped":
        first, second = (z // gcd(*teeth.planets) for z in teeth.planets)
        cycles = {"sun": first, "ring": second}
    return MeshPhases(at, **{k: _fraction(v) for k, v in lag.items()}, cycles=cycles)


def _fraction(cycles: Array) -> Array:
    """Cycles in [0, 1), with rounding next to a whole number removed."""
    fraction = np.asarray(cycles % 1.0)
    return np.where(fraction > 1.0 - 1e-12, 0.0, np.where(fraction < 1e-12, 0.0, fraction))
