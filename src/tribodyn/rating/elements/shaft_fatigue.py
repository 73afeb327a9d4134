"""Fatigue and yield of notched shafts: DIN 743.

In N/mm2 and mm: ``sigma_WK = sigma_W K_1/K_s``, ``K_s = (beta/K_2 + 1/K_F - 1)/K_V``, with
sigma_bW = 0.5 sigma_B, sigma_zdW = 0.4 sigma_B, tau_tW = 0.3 sigma_B. Shoulders and grooves:
``alpha = 1 + 1/sqrt(A r/t + 2 B r/d (1 + 2 r/d)^2 + C (r/t)^z d/D)``, ``beta = alpha/n``,
``n = 1 + sqrt(G') 10^-(0.33 + sigma_S(d)/712)``. Mean stress by
``psi = sigma_WK/(2 K_1 sigma_B - sigma_WK)``; amplitudes are cut at the yield strength sigma_FK;
``S = 1/sqrt((s_zda/s_zdADK + s_ba/s_bADK)^2 + (t_a/t_ADK)^2)``, at least 1.2. Against yield the
same sum with the greatest stresses over sigma_zdFK, sigma_bFK and tau_tFK.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

from tribodyn.errors import Argument, InputError, require_between, require_one_of, require_positive
from tribodyn.rating.factor import Factors, check_range
from tribodyn.rating.mesh_load import PRACTICE

SOURCE: Final = "DIN 743"
#: Slope and reference diameter of K_1 of sigma_B and of sigma_S, largest diameter [mm].
_SIZE: Final = {
    "quenched": ((0.26, 16.0), (0.34, 16.0), 300.0),
    "structural": ((0.23, 100.0), (0.26, 32.0), 300.0),
    "carburized CrNiMo": ((0.26, 16.0), (0.26, 16.0), 150.0),
    "carburized": ((0.41, 16.0), (0.41, 16.0), 150.0),
}
#: A, B, C, z of alpha by notch, for tension, bending and torsion.
_SHAPES: Final = {
    "groove": ((0.22, 1.37, 0.0, 0.0), (0.20, 2.75, 0.0, 0.0), (0.70, 10.3, 0.0, 0.0)),
    "shoulder": ((0.62, 3.5, 0.0, 0.0), (0.62, 5.8, 0.2, 3.0), (3.4, 19.0, 1.0, 2.0)),
}
_KINDS: Final = ("tension", "bending", "torsion")
_NOTCHES: Final = (*_SHAPES, "key", "two keys", "press fit", "given")


@dataclass(frozen=True, kw_only=True)
class ShaftMaterial:
    """Material of a shaft at the reference diameter of 16 mm.

    Parameters
    ----------
    tensile_strength : float [Pa]
        sigma_B.
    yield_strength : float [Pa]
        sigma_S.
    kind : str
        ``quenched``, ``structural``, ``carburized CrNiMo`` or ``carburized``.
    hard_surface : bool
        Whether the surface is hardened: notches and yield count otherwise.
    treated_diameter : float, optional [m]
        d_eff of the shaft at its heat treatment; by default d of the notch.

    Raises
    ------
    InputError
        If a value is out of range or the kind is unknown.

    Examples
    --------
    >>> ShaftMaterial(tensile_strength=1000e6, yield_strength=800e6).kind
    'quenched'
    """

    tensile_strength: float
    yield_strength: float
    kind: str = "quenched"
    hard_surface: bool = False
    treated_diameter: float | None = None

    def __post_init__(self) -> None:
        require_one_of("kind", self.kind, _SIZE)
        if self.treated_diameter is not None:
            require_between("treated_diameter", self.treated_diameter, 1e-3, 10.0, "m")
        require_between("tensile_strength", self.tensile_strength, 100e6, 3000e6, "Pa")
        require_between("yield_strength", self.yield_strength, 50e6, 3000e6, "Pa")

    def size_factors(self, diameter: float) -> tuple[float, float]:
        """Return K_1 of tensile and of yield strength.

        Parameters
        ----------
        diameter : float [m]
            Of the shaft at its heat treatment, where ``treated_diameter`` does not state it.

        Returns
        -------
        tuple of float

        Raises
        ------
        InputError
            If the diameter is beyond those for which the factor is known.
        """
        *slopes, largest = _SIZE[self.kind]
        millimetres = 1e3 * (self.treated_diameter or diameter)
        require_between("diameter", millimetres, 0.0, largest, "mm")
        values = []
        for slope, reference in slopes:
            values.append(1.0 - slope * math.log10(max(millimetres / reference, 1.0)))
        return values[0], values[1]


@dataclass(frozen=True, kw_only=True)
class ShaftNotch:
    """A notched section of a shaft.

    Parameters
    ----------
    diameter : float [m]
        d of the notched section.
    kind : str
        ``shoulder``, ``groove``, ``key``, ``two keys``, ``press fit`` or ``given``.
    large_diameter : float, optional [m]
        D of the thicker section at a shoulder or groove.
    radius : float, optional [m]
        r of a shoulder or groove.
    bore_diameter : float [m]
        Bore of a hollow shaft.
    roughness : float [m]
        Rz of the surface.
    notch_factors : tuple of float, optional
        beta of tension, bending and torsion of the kind ``given``, pure numbers.
    surface_factor : float
        K_V of strengthening, pure number.

    Raises
    ------
    InputError
        If a value is out of range or missing.

    Examples
    --------
    >>> ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3).kind
    'shoulder'
    """

    diameter: float
    kind: str = "shoulder"
    large_diameter: float | None = None
    radius: float | None = None
    bore_diameter: float = 0.0
    roughness: float = 5e-6
    notch_factors: tuple[float, float, float] | None = None
    surface_factor: float = 1.0

    def __post_init__(self) -> None:
        require_one_of("kind", self.kind, _NOTCHES)
        require_between("diameter", self.diameter, 1e-3, 1.0, "m")
        require_between("bore_diameter", self.bore_diameter, 0.0, 0.95 * self.diameter, "m")
        require_between("roughness", self.roughness, 1e-7, 1e-3, "m")
        require_between("surface_factor", self.surface_factor, 1.0, 3.0)
        needed = {"notch_factors": self.kind == "given"}
        needed |= dict.fromkeys(("large_diameter", "radius"), self.kind in _SHAPES)
        for name, required in needed.items():
            if required and getattr(self, name) is None:
                why = f"A notch of kind {self.kind} is described by it"
                raise InputError(f"{name} is missing", Argument(name), why, f"Give {name}")
        if self.kind in _SHAPES:
            require_between("large_diameter", self.large_diameter, self.diameter, 2.0, "m")
            require_positive("radius", self.radius, "m")


class ShaftStress(NamedTuple):
    """Nominal stresses of a section: amplitudes and means of tension, bending and torsion.

    Parameters
    ----------
    amplitudes : tuple of float [Pa]
        sigma_zda, sigma_ba, tau_ta.
    means : tuple of float [Pa]
        sigma_zdm, sigma_bm, tau_tm.
    """

    amplitudes: tuple[float, float, float]
    means: tuple[float, float, float] = (0.0, 0.0, 0.0)


class ShaftRating(NamedTuple):
    """Rating of a shaft section; made by :func:`rate_shaft`.

    Parameters
    ----------
    safety : float
        S against fatigue, pure number; at least 1.2 is required.
    factors : mapping of str to Factor
        Factors by the names of the standard, those of one kind of stress with its name.
    yield_safety : float
        S against yield under mean stress and amplitude together, pure number; at least 1.2 too.
    """

    safety: float
    factors: Factors
    yield_safety: float


def _shape_factor(notch: ShaftNotch, index: int) -> tuple[float, float]:
    """Alpha and G' [1/mm] of a shoulder or groove."""
    d, large, r = (
        1e3 * float(value or 0.0) for value in (notch.diameter, notch.large_diameter, notch.radius)
    )
    t = 0.5 * (large - d)
    if t <= 0.0:
        return 1.0, 0.0
    check_range("r/t", r / t, 0.03, math.inf, f"alpha of {SOURCE}")
    check_range("d/D", d / large, 0.0, 0.98, f"alpha of {SOURCE}")
    a, b, c, z = _SHAPES[notch.kind][index]
    root = a * r / t + 2.0 * b * r / d * (1.0 + 2.0 * r / d) ** 2 + c * (r / t) ** z * d / large
    phi = 1.0 / (4.0 * math.sqrt(t / r) + 2.0) if d / large > 0.67 else 0.0
    shoulder = notch.kind == "shoulder"
    if index == 2:
        gradient = (1.15 if shoulder else 1.0) / r
    else:
        gradient = (2.3 if shoulder else 2.0) * (1.0 + phi) / r
    return 1.0 + 1.0 / math.sqrt(root), gradient


def _notch_factor(notch: ShaftNotch, material: ShaftMaterial, index: int) -> tuple[float, float]:
    """Beta and alpha (beta where there is no alpha) of one kind of stress."""
    k_b, k_s = material.size_factors(notch.diameter)
    strength = 1e-6 * k_b * material.tensile_strength
    if notch.notch_factors is not None:
        return notch.notch_factors[index], notch.notch_factors[index]
    if notch.kind in _SHAPES:
        alpha, gradient = _shape_factor(notch, index)
        yielding = 1e-6 * k_s * material.yield_strength
        exponent = 0.7 if material.hard_surface else 0.33 + yielding / 712.0
        beta = alpha / (1.0 + math.sqrt(gradient) * 10.0**-exponent)
        return max(beta, 1.0), alpha
    if notch.kind == "press fit":
        bending = 2.7 * (strength / 1000.0) ** 0.43
        torsion = 0.65 * bending
    else:
        bending = 3.0 * (strength / 1000.0) ** 0.38 * (1.15 if notch.kind == "two keys" else 1.0)
        torsion = 0.56 * bending + 0.1
    beta = torsion if index == 2 else bending
    return beta * _size_of_test(beta, notch.diameter), beta


def _size_of_test(beta: float, diameter: float) -> float:
    """K_3 at the test diameter of 40 mm over that at the diameter."""

    def k_3(millimetres: float) -> float:
        return 1.0 - 0.2 * math.log10(beta) * math.log10(millimetres / 7.5) / math.log10(20.0)

    return k_3(40.0) / k_3(min(max(1e3 * diameter, 7.5), 150.0))


def _strengths(
    notch: ShaftNotch, material: ShaftMaterial, factors: Factors
) -> tuple[list[float], list[float]]:
    """sigma_WK and sigma_FK [Pa] of tension, bending and torsion."""
    k_b, k_s = material.size_factors(notch.diameter)
    record = factors.record
    record("K_1", k_b, f"{SOURCE}, size of the strength")
    record("K_1S", k_s, f"{SOURCE}, size of the yield strength")
    millimetres = min(max(1e3 * notch.diameter, 7.5), 150.0)
    size = 1.0 - 0.2 * math.log10(millimetres / 7.5) / math.log10(20.0)
    strength = 1e-6 * k_b * material.tensile_strength
    rough, branch = 1.0, "in the notch factor"
    if notch.kind in _SHAPES or notch.kind == "given":
        depth, branch = max(1e6 * notch.roughness, 1.0), f"Rz {1e6 * notch.roughness:g} um"
        rough -= 0.22 * math.log10(depth) * (math.log10(strength / 20.0) - 1.0)
    fatigue, yielding = [], []
    for index, kind in enumerate(_KINDS):
        beta, alpha = _notch_factor(notch, material, index)
        source = f"{SOURCE}, notch factor"
        if notch.notch_factors is None and notch.kind not in _SHAPES:
            source += f"; K_3 from {PRACTICE}"
        beta = record(f"beta_{kind}", beta, source, branch=notch.kind)
        k_2 = record(f"K_2_{kind}", 1.0 if index == 0 else size, f"{SOURCE}, size of the section")
        k_f = 0.575 * rough + 0.425 if index == 2 else rough
        k_f = record(f"K_F_{kind}", k_f, f"{SOURCE}, roughness", branch=branch)
        total = (beta / k_2 + 1.0 / k_f - 1.0) / notch.surface_factor
        total = record(f"K_s_{kind}", total, f"{SOURCE}, total influence")
        limit = (0.4, 0.5, 0.3)[index] * material.tensile_strength * k_b / total
        fatigue.append(record(f"sigma_WK_{kind}", limit, SOURCE, unit="Pa"))
        raised = _yield_factors(notch, material, index, alpha)
        limit = k_s * raised * material.yield_strength / (math.sqrt(3.0) if index == 2 else 1.0)
        yielding.append(record(f"sigma_FK_{kind}", limit, SOURCE, unit="Pa"))
    return fatigue, yielding


def _yield_factors(notch: ShaftNotch, material: ShaftMaterial, index: int, alpha: float) -> float:
    """K_2F gamma_F: plastic reserve of the section and of the notch."""
    if material.hard_surface:
        return 1.0
    hollow = notch.bore_diameter > 0.0
    reserve = (1.0, 1.1 if hollow else 1.2, 1.0 if hollow else 1.2)[index]
    if index == 2 or notch.kind not in (*_SHAPES, "press fit"):  # keys do not go around
        return reserve
    steps = ((1.5, 1.0), (2.0, 1.05), (3.0, 1.10))
    return reserve * next((value for limit, value in steps if alpha < limit), 1.15)


def rate_shaft(
    notch: ShaftNotch, material: ShaftMaterial, stress: ShaftStress, *, constant_ratio: bool = True
) -> ShaftRating:
    """Safeties of a notched shaft section against fatigue and against yield.

    Parameters
    ----------
    notch : ShaftNotch
        The section.
    material : ShaftMaterial
        Strength at the reference diameter.
    stress : ShaftStress
        Nominal stresses of the section [Pa].
    constant_ratio : bool
        Overload raises mean and amplitude in one ratio (case 2); else the mean stays (case 1).

    Returns
    -------
    ShaftRating

    Raises
    ------
    InputError
        If a value is out of range or no amplitude is positive.

    Notes
    -----
    Source: DIN 743:2012; the size scale of keys and press fits is from memory of its text.

    Examples
    --------
    >>> notch = ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3)
    >>> steel = ShaftMaterial(tensile_strength=1000e6, yield_strength=800e6)
    >>> round(rate_shaft(notch, steel, ShaftStress((0.0, 100e6, 0.0))).safety, 2)
    1.98
    """
    for name, values in zip(("amplitudes", "means"), stress, strict=True):
        require_between(name, values, -1e10, 1e10, "Pa")
    if not any(stress.amplitudes):
        why = "Fatigue needs a stress that changes"
        raise InputError("all amplitudes are zero", Argument("stress"), why, "Give one of them")
    factors = Factors()
    fatigue, yielding = _strengths(notch, material, factors)
    axial = stress.means[0] + stress.means[1]
    mean = math.sqrt(axial**2 + 3.0 * stress.means[2] ** 2)
    strength = factors["K_1"] * material.tensile_strength
    utilization = []
    for index, kind in enumerate(_KINDS):
        amplitude = abs(stress.amplitudes[index])
        mean_stress = mean / math.sqrt(3.0) if index == 2 else mean
        limit, cut = fatigue[index], yielding[index]
        psi = limit / (2.0 * strength - limit)
        psi = factors.record(f"psi_{kind}", psi, f"{SOURCE}, mean stress sensitivity")
        if not constant_ratio:
            allowed, bound = limit - psi * mean_stress, cut - mean_stress
        elif amplitude > 0.0:
            allowed = limit / (1.0 + psi * mean_stress / amplitude)
            bound = cut / (1.0 + mean_stress / amplitude)
        else:
            allowed = bound = limit
        branch = "yield strength" if bound < allowed else "mean stress"
        allowed = max(min(allowed, bound), 0.0)
        allowed = factors.record(f"sigma_ADK_{kind}", allowed, SOURCE, unit="Pa", branch=branch)
        utilization.append(amplitude / allowed if amplitude else 0.0)
    safety = 1.0 / math.hypot(utilization[0] + utilization[1], utilization[2])
    safety = factors.record("S", safety, f"{SOURCE}, at least 1.2")
    return ShaftRating(safety, factors, _record_yield(stress, yielding, factors))


def _record_yield(stress: ShaftStress, yielding: list[float], factors: Factors) -> float:
    """S against yield of the greatest stresses."""
    tension, bending, torsion = (
        (abs(amplitude) + abs(mean)) / limit
        for amplitude, mean, limit in zip(*stress, yielding, strict=True)
    )
    safety = 1.0 / math.hypot(tension + bending, torsion)
    return factors.record("S_yield", safety, f"{SOURCE}, against yield, at least 1.2")


def yield_safety(notch: ShaftNotch, material: ShaftMaterial, stress: ShaftStress) -> float:
    """S against yield, also of a stress that does not change."""
    factors = Factors()
    return _record_yield(stress, _strengths(notch, material, factors)[1], factors)
