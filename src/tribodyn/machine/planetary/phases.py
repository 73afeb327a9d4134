"""Phases of the meshes of a planetary stage, and the modes that their harmonics excite."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import require_number, require_whole
from tribodyn.machine.planetary.positions import read_teeth, refuse_misfit
from tribodyn.types import Array

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
    """

    angles: Array
    sun: Array
    ring: Array

    @property
    def sun_offset(self) -> Array:
        """``Contact.offset`` of the sun meshes, (N,) cycles."""
        return _fraction(-self.sun)

    @property
    def ring_offset(self) -> Array:
        """``Contact.offset`` of the ring meshes, (N,) cycles."""
        return _fraction(-self.ring)

    def excitation(self, harmonic: int) -> HarmonicExcitation:
        """Compute how a harmonic of the mesh frequency excites each type of mode.

        Parameters
        ----------
        harmonic : int
            Order of the mesh frequency, at least 1.

        Raises
        ------
        InputError
            If it is not a whole number of at least 1.

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
        forces = np.exp(2j * np.pi * order * self.sun)
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
) -> MeshPhases:
    """Compute the phases of all meshes of a stage from its teeth and positions.

    Parameters
    ----------
    sun_teeth, ring_teeth : int
        Numbers of teeth; that of the ring with or without its minus sign.
    planets : int
        Number of planets, each with one gear.
    angles : (N,) array, optional
        Angles of the planets about the sun [rad]; equally spaced by default.
    sun_to_ring : float
        Mesh cycles by which the ring mesh of a planet lags behind its sun mesh, the same for all
        planets of a stage; it follows from the thickness of the planet's teeth [1].

    Raises
    ------
    InputError
        If the teeth of a planet at its angle do not fit between sun and ring.

    Notes
    -----
    The sun mesh of a planet at ``psi`` lags by ``z_s psi/(2 pi)``, its ring mesh by
    ``-z_r psi/(2 pi)``, both modulo 1 and from the first planet. Source: Parker
    and Lin (2004).

    Examples
    --------
    >>> mesh_phases(sun_teeth=17, ring_teeth=61, planets=3).sun.round(6)
    array([0.      , 0.666667, 0.333333])
    """
    teeth = read_teeth(sun_teeth, ring_teeth)
    at = refuse_misfit(teeth, require_whole("planets", planets), angles)
    turns = (at - at[0]) / (2.0 * np.pi)
    offset = require_number("sun_to_ring", sun_to_ring)
    return MeshPhases(at, _fraction(teeth.sun * turns), _fraction(offset - teeth.ring * turns))


def _fraction(cycles: Array) -> Array:
    """Cycles in [0, 1), with rounding next to a whole number removed."""
    fraction = np.asarray(cycles % 1.0)
    return np.where(fraction > 1.0 - 1e-12, 0.0, np.where(fraction < 1e-12, 0.0, fraction))
