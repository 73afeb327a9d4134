"""Asperities of two rough flanks: their shape from roughness figures or profiles, their contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.nomenclature import positive
from tribodyn.types import Array

#: Summits per area of a random surface are ``m4/m2`` over this.
_NAYAK = 6.0 * math.pi * math.sqrt(3.0)
#: Least ``m0 m4/m2^2`` of an isotropic random surface.
_LEAST_BANDWIDTH = 1.5
#: Summit density times summit radius times rms height of typical engineering surfaces.
TYPICAL_PRODUCT = 0.05
#: Separation over rms height at which the density of the heights underflows.
_FAR = 37.0


def asperity_integral(separation_ratio: ArrayLike, order: float = 2.5) -> Array:
    """Integral ``F_n(u) = 1/sqrt(2 pi) int_u^inf (s - u)^n exp(-s^2/2) ds`` of Gaussian heights.

    Parameters
    ----------
    separation_ratio : float or array
        Distance of the mean planes over the composite rms height; negative where they overlap.
    order : float
        The power n: 2.5 for the pressure of asperities, 2 for their area, 1 for their volume.

    Returns
    -------
    float or array
        Of the same shape; below the smallest number, beyond some 37, it is zero.

    Raises
    ------
    InputError
        If a ratio is no number, or the power is not positive.

    Valid from -37 on. Source: Greenwood and Tripp, Proc. IMechE 185 (1970), as the
    parabolic cylinder function ``Gamma(n+1)/sqrt(2 pi) exp(-u^2/4) D_{-n-1}(u)``.

    Examples
    --------
    >>> [round(float(asperity_integral(u)), 4) for u in (0.0, 1.0, 3.0)]
    [0.6166, 0.0806, 0.0002]
    """
    from scipy.special import gamma, pbdv

    ratio = np.minimum(np.asarray(separation_ratio, dtype=float), _FAR)
    require_between("separation_ratio", ratio, -_FAR, _FAR)
    require_positive("order", order)
    factor = gamma(order + 1.0) / math.sqrt(2.0 * math.pi)
    return np.asarray(factor * np.exp(-0.25 * ratio**2) * pbdv(-order - 1.0, ratio)[0])[()]


@dataclass(frozen=True)
class Asperities:
    """Spherical summits on two flanks with Gaussian heights, as Greenwood and Tripp have them.

    Parameters
    ----------
    rms_height : float [m]
        Composite rms roughness: root of the sum of squares of both flanks.
    summit_radius : float [m]
        Mean radius of the summits of one flank.
    summit_density : float [1/m^2]
        Summits of one flank per area.

    Raises
    ------
    InputError
        If a value is not positive.

    Elastic contact of nominally flat surfaces, each summit on every other; where the flanks differ,
    radius and density are means. Source: Greenwood and Tripp, Proc. IMechE 185 (1970).

    Examples
    --------
    >>> asperities = Asperities(0.5e-6, 10e-6, 1e10)
    >>> print(f"{float(asperities.pressure(0.5e-6, 2.3e11)) / 1e6:.1f} MPa")
    24.5 MPa
    """

    rms_height: float
    summit_radius: float
    summit_density: float

    def __post_init__(self) -> None:
        """Check that all fields are positive."""
        require_positive(
            "rms_height", self.rms_height, "m", remedy="Smooth flanks have no asperities"
        )
        require_positive("summit_radius", self.summit_radius, "m")
        require_positive("summit_density", self.summit_density, "1/m^2")

    @classmethod
    def from_moments(cls, m0: float, m2: float, m4: float) -> Asperities:
        """Asperities of two flanks from the spectral moments of their profiles.

        Parameters
        ----------
        m0, m2, m4 : float [m^2], [-], [1/m^2]
            Mean squares of height, slope and curvature of a profile, as means of both flanks.

        Returns
        -------
        Asperities
            ``sigma = sqrt(2 m0)``, summit radius ``3/8 sqrt(pi/m4)``, summit density
            ``m4/(6 pi sqrt(3) m2)``.

        Raises
        ------
        InputError
            If a moment is not positive, or ``m0 m4/m2^2`` lies below 1.5, the least of an
            isotropic random surface.

        Source: Nayak, J. Lubr. Technol. 93 (1971); McCool, Wear 107 (1986).

        Examples
        --------
        >>> print(f"{Asperities.from_moments(0.125e-12, 0.01, 4e9).summit_density:.4g}")
        1.225e+10
        """
        for name, value, unit in (("m0", m0, "m^2"), ("m2", m2, ""), ("m4", m4, "1/m^2")):
            require_positive(name, value, unit, remedy="A flank without roughness has none")
        if m0 * m4 < _LEAST_BANDWIDTH * m2**2 * (1.0 - 1e-12):
            raise InputError(
                f"m0 m4/m2^2 = {m0 * m4 / m2**2:.4g} of the roughness",
                where="Asperities",
                why=f"no isotropic random surface has less than {_LEAST_BANDWIDTH:g}: heights, "
                "slopes and summits do not belong together",
                remedy="Give a smaller slope, more summits or higher ones, or a measured profile",
            )
        return cls(math.sqrt(2.0 * m0), 0.375 * math.sqrt(math.pi / m4), m4 / (_NAYAK * m2))

    @classmethod
    def from_slope(
        cls, rms_height: float, rms_slope: float, summit_density: float | None = None
    ) -> Asperities:
        """Asperities of two equal flanks from heights, slopes and number of summits.

        Parameters
        ----------
        rms_height : float [m]
            Composite rms roughness of both flanks.
        rms_slope : float
            Root mean square of the slope of a profile of one flank.
        summit_density : float, optional [1/m^2]
            Summits of one flank per area; by default so many that density times radius times rms
            height are 0.05, as for most engineering surfaces.

        Raises
        ------
        InputError
            If a value is not positive, or the three do not belong together.

        Source: moments as of :meth:`from_moments`; Greenwood and Tripp, Proc. IMechE 185 (1970).

        Examples
        --------
        >>> flanks = Asperities.from_slope(0.7e-6, 0.1)
        >>> print(f"{flanks.summit_radius * 1e6:.1f} um, {flanks.summit_density:.3g} 1/m^2")
        18.9 um, 3.77e+09 1/m^2
        """
        require_positive("rms_height", rms_height, "m", remedy="Smooth flanks have no asperities")
        require_positive("rms_slope", rms_slope)
        m0, m2 = 0.5 * rms_height**2, rms_slope**2
        if summit_density is None:
            # Density times radius times height are 3/8 sqrt(pi) sigma sqrt(m4)/(_NAYAK m2).
            root = TYPICAL_PRODUCT * _NAYAK * m2 / (0.375 * math.sqrt(math.pi) * rms_height)
            return cls.from_moments(m0, m2, root**2)
        require_positive("summit_density", summit_density, "1/m^2")
        return cls.from_moments(m0, m2, _NAYAK * m2 * summit_density)

    @classmethod
    def from_profiles(
        cls, pinion: RoughnessProfile, wheel: RoughnessProfile | None = None
    ) -> Asperities:
        """Asperities from a measured profile of each flank, or from one profile for both.

        Parameters
        ----------
        pinion, wheel : RoughnessProfile
            Heights on the sampling that matters: slope and curvature rise as it gets finer.

        Raises
        ------
        InputError
            If both profiles are flat, or no random surface has such moments.

        Source: McCool, Wear 107 (1986).

        Examples
        --------
        >>> heights = 1e-7 * np.random.default_rng(1).standard_normal(4000)
        >>> profile = RoughnessProfile.from_heights(1e-6, heights).filtered(20e-6)
        >>> print(f"{Asperities.from_profiles(profile).rms_height * 1e9:.0f} nm")
        38 nm
        """
        flanks = [profile.spectral_moments() for profile in (pinion, wheel or pinion)]
        return cls.from_moments(*(float(value) for value in np.mean(flanks, axis=0)))

    @property
    def product(self) -> float:
        """Summit density times summit radius times rms height; 0.03 to 0.1 is usual."""
        return self.summit_density * self.summit_radius * self.rms_height

    def pressure(self, separation: ArrayLike, effective_modulus: ArrayLike) -> Array:
        """Mean pressure of the asperities over the nominal area.

        Parameters
        ----------
        separation : float or array [m]
            Distance of the mean planes of both flanks; negative where they overlap.
        effective_modulus : float or array [Pa]
            ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

        Returns
        -------
        float or array [Pa]
            ``16 sqrt(2) pi/15 (eta beta sigma)^2 sqrt(sigma/beta) E'/2 F_5/2(d/sigma)``.

        Raises
        ------
        InputError
            If a separation is no number or the modulus is not positive.

        Source: Greenwood and Tripp (1970), whose modulus is half of E'.
        """
        (modulus,) = positive(effective_modulus=effective_modulus)
        ratio = np.asarray(separation, dtype=float) / self.rms_height
        return np.asarray(self.stiffness * modulus * asperity_integral(ratio))[()]

    @property
    def stiffness(self) -> float:
        """Pressure over E' and the integral F_5/2."""
        sharpness = math.sqrt(self.rms_height / self.summit_radius)
        return 8.0 * math.sqrt(2.0) * math.pi / 15.0 * self.product**2 * sharpness

    def contact_area(self, separation: ArrayLike) -> Array:
        """Real area of contact over the nominal one.

        Parameters
        ----------
        separation : float or array [m]
            Distance of the mean planes.

        Returns
        -------
        float or array
            ``pi^2 (eta beta sigma)^2 F_2(d/sigma)``, small where the model holds.

        Raises
        ------
        InputError
            If a separation is no number.

        Source: Greenwood and Tripp (1970).
        """
        ratio = np.asarray(separation, dtype=float) / self.rms_height
        return np.asarray((math.pi * self.product) ** 2 * asperity_integral(ratio, 2.0))[()]
