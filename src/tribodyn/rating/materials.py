"""Strength of gear materials by type, grade and hardness: ISO 6336-5.

``sigma = A x + B`` with the hardness x (HBW for St and cast iron, HV for the others) in N/mm2;
outside of the range of hardness there is no value. Allowable stresses are those of 1 % probability
of damage.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

from tribodyn.errors import Argument, InputError, did_you_mean, require_between, require_positive
from tribodyn.gear import Material

SOURCE: Final = "ISO 6336-5:2016"
#: Grades of quality.
GRADES: Final = ("ML", "MQ", "ME")

#: type | grades | sigma_Hlim pieces "A B lo hi" | sigma_Flim pieces, divided by commas.
_TABLE = """
St | ML MQ | 1.000 190 110 210 | 0.455 69 110 210
St | ME | 1.520 250 110 210 | 0.386 147 110 210
St(cast) | ML MQ | 0.986 131 140 210 | 0.313 62 140 210
St(cast) | ME | 1.143 237 140 210 | 0.254 137 140 210
GTS(perl.) | ML MQ | 1.371 143 135 250 | 0.345 77 135 250
GTS(perl.) | ME | 1.333 267 175 250 | 0.403 128 175 250
GGG | ML MQ | 1.434 211 175 300 | 0.350 119 175 300
GGG | ME | 1.500 250 200 300 | 0.380 134 200 300
GG | ML MQ | 1.033 132 150 240 | 0.256 8 150 240
GG | ME | 1.465 122 175 275 | 0.200 53 175 275
V(carbon) | ML | 0.963 283 135 210 | 0.250 108 115 215
V(carbon) | MQ | 0.925 360 135 210 | 0.240 163 115 215
V(carbon) | ME | 0.838 432 135 210 | 0.283 202 115 215
V | ML | 1.313 188 200 360 | 0.423 104 200 360
V | MQ | 1.313 373 200 360 | 0.425 187 200 360
V | ME | 2.213 260 200 390 | 0.358 231 200 390
V(cast carbon) | ML MQ | 0.831 300 130 215 | 0.224 117 130 215
V(cast carbon) | ME | 0.951 345 130 215 | 0.286 167 130 215
V(cast alloy) | ML MQ | 1.276 298 200 360 | 0.364 161 200 360
V(cast alloy) | ME | 1.350 356 200 360 | 0.356 186 200 360
Eh | ML | 0 1300 600 800 | 0 312 600 800
Eh | MQ | 0 1500 660 800 | 0 461 660 800
Eh | ME | 0 1650 660 800 | 0 525 660 800
IF | ML | 0.740 602 485 615 | 0.305 76 485 615
IF | MQ | 0.541 882 500 615 | 0.138 290 500 570, 0 369 570 615
IF | ME | 0.505 1013 500 615 | 0.271 237 500 615
NT | ML | 0 1125 650 900 | 0 270 650 900
NT | MQ | 0 1250 650 900 | 0 420 650 900
NT | ME | 0 1450 650 900 | 0 468 650 900
NV(nitr.) | ML | 0 788 450 650 | 0 258 450 650
NV(nitr.) | MQ | 0 998 450 650 | 0 363 450 650
NV(nitr.) | ME | 0 1217 450 650 | 0 432 450 650
NV(nitrocar.) | ML | 0 650 300 650 | 0 224 300 650
NV(nitrocar.) | MQ ME | 1.167 425 300 450, 0 950 450 650 | 0.653 94 300 450, 0 388 450 650
"""

#: A, B, lowest and highest hardness.
_Piece = tuple[float, float, float, float]


def _pieces(text: str) -> tuple[_Piece, ...]:
    return tuple(
        (a, b, low, high)
        for a, b, low, high in (map(float, piece.split()) for piece in text.split(","))
    )


_ROWS: Final = {
    (kind.strip(), grade): (_pieces(pitting), _pieces(bending))
    for kind, grades, pitting, bending in (line.split("|") for line in _TABLE.strip().splitlines())
    for grade in grades.split()
}
_GGG: Final = ("GGG(perl.)", "GGG(bai.)", "GGG(ferr.)")
#: Types of material by their names in ISO 6336-5.
KINDS: Final = tuple(
    dict.fromkeys(name for kind, _ in _ROWS for name in (_GGG if kind == "GGG" else (kind,)))
)
#: Case-hardened and flame- or induction-hardened steel; iron with soft structure.
_HARD, _SOFT = ("Eh", "IF"), ("GG", "GGG(ferr.)")


@dataclass(frozen=True, kw_only=True)
class GearMaterial(Material):
    """Material of a gear with its strength: type, grade and hardness by ISO 6336-5, or values.

    Parameters
    ----------
    youngs_modulus : float [Pa]
        Young's modulus.
    poissons_ratio : float
        Poisson's ratio.
    density : float [kg/m^3]
        Density.
    kind : str
        Type: ``St``, ``St(cast)``, ``GTS(perl.)``, ``GGG(perl.)``, ``GGG(bai.)``, ``GGG(ferr.)``,
        ``GG``, ``V`` (alloyed), ``V(carbon)``, ``V(cast carbon)``, ``V(cast alloy)``, ``Eh``,
        ``IF``, ``NT``, ``NV(nitr.)`` or ``NV(nitrocar.)``.
    grade : str
        ``ML``, ``MQ`` or ``ME``.
    hardness : float, optional
        Hardness number (dimensionless): HBW of St and cast iron, HV of the flank of the others.
        Needed where strength depends on it.
    core_hardness : float
        HRC of the core of Eh MQ, pure number: 461 N/mm2 in bending from 25, 500 from 30.
    hardenable : bool
        False: the core of Eh MQ below 30 HRC misses 28 HRC in the Jominy test at 12 mm: 425 N/mm2.
    pitting_limit, bending_limit : float, optional
        sigma_Hlim and sigma_Flim [Pa] that replace those of the table.
    yield_strength, tensile_strength : float, optional
        sigma_S (sigma_0.2 of V) and sigma_B [Pa], for the notch sensitivity of St, V, GG.
    peened : bool
        Shot-peened roots, which stand reversed bending better.
    profile_depth : tuple of float [m]
        Depths below the surface of both profiles, rising.
    hardness_profile : tuple of float
        HV at these depths, pure numbers, for the exposure below the surface.
    residual_stress_profile : tuple of float [Pa]
        Residual stress along the surface at these depths, compression negative; none by default.

    Raises
    ------
    InputError
        Naming the types, grades or hardnesses that exist, where the value is none of these.

    Notes
    -----
    Source: ISO 6336-5:2016, for 1 % probability of damage.

    Examples
    --------
    >>> steel = GearMaterial(kind="Eh", grade="MQ", hardness=720)
    >>> steel.sigma_Hlim / 1e6, steel.sigma_Flim / 1e6
    (1500.0, 461.0)
    """

    kind: str = "Eh"
    grade: str = "MQ"
    hardness: float | None = None
    core_hardness: float = 25.0
    hardenable: bool = True
    pitting_limit: float | None = None
    bending_limit: float | None = None
    yield_strength: float | None = None
    tensile_strength: float | None = None
    peened: bool = False
    profile_depth: tuple[float, ...] = ()
    hardness_profile: tuple[float, ...] = ()
    residual_stress_profile: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, value, choices in (("kind", self.kind, KINDS), ("grade", self.grade, GRADES)):
            if value not in choices:
                remedy = did_you_mean(value, choices, "Choose one of these")
                why = f"{SOURCE} has: {', '.join(choices)}"
                raise InputError(f'{name} = "{value}"', Argument(name), why, remedy)
        for name in ("pitting_limit", "bending_limit", "yield_strength", "tensile_strength"):
            if (value := getattr(self, name)) is not None:
                require_positive(name, value, "Pa")
        if self.hardness is not None:
            require_positive("hardness", self.hardness)
        if self.kind == "Eh" and self.grade == "MQ":
            require_between("core_hardness", self.core_hardness, 25.0, 50.0, "HRC")
        self._check_profiles()
        _ = self.sigma_Hlim, self.sigma_Flim

    def _check_profiles(self) -> None:
        depth = self.profile_depth
        if any(low >= high for low, high in pairwise(depth)) or any(d < 0.0 for d in depth):
            why, remedy = "Depths are counted from the surface", "Sort them, each one once"
            raise InputError("profile_depth does not rise", Argument("profile_depth"), why, remedy)
        stated = {"hardness_profile": True, "residual_stress_profile": False}
        for name, needed in stated.items():
            count = len(getattr(self, name))
            if count != len(depth) and (needed or count):
                what = f"{name} has {count} values and profile_depth {len(depth)}"
                why, remedy = "Each depth has its value", "Give both lists the same length"
                raise InputError(what, Argument(name), why, remedy)

    def _limit(self, column: int, name: str, stated: float | None) -> float:
        if stated is not None:
            return stated
        kind = "GGG" if self.kind in _GGG else self.kind
        pieces = _ROWS[kind, self.grade][column]
        if self.hardness is None:
            if len(pieces) == 1 and pieces[0][0] == 0.0:
                return pieces[0][1] * 1e6
        else:
            for slope, offset, low, high in pieces:
                if low <= self.hardness <= high:
                    return (slope * self.hardness + offset) * 1e6
        scale = "HBW" if self.hardness_is_brinell else "HV"
        raise InputError(
            "hardness is missing" if self.hardness is None else f"hardness = {self.hardness:g}",
            Argument("hardness"),
            f"{SOURCE} has {name} of {self.kind} {self.grade} from {pieces[0][2]:g} to "
            f"{pieces[-1][3]:g} {scale}, and no value beyond",
            f"Give a hardness in this range, another type or grade, or {name} itself as "
            f"{('pitting_limit', 'bending_limit')[column]}",
        )

    @property
    def hardness_is_brinell(self) -> bool:
        """Whether ``hardness`` is in HBW rather than HV."""
        return self.kind.startswith(("St", "G"))

    @cached_property
    def sigma_Hlim(self) -> float:
        """Allowable contact stress number [Pa]."""
        return self._limit(0, "sigma_Hlim", self.pitting_limit)

    @cached_property
    def sigma_Flim(self) -> float:
        """Nominal stress number in bending [Pa]."""
        limit = self._limit(1, "sigma_Flim", self.bending_limit)
        if self.bending_limit is None and self.kind == "Eh" and self.grade == "MQ":
            if self.core_hardness >= 30.0:
                return 500e6
            return limit if self.hardenable else 425e6
        return limit

    @property
    def is_hard(self) -> bool:
        """Whether the flank is surface-hardened."""
        return self.kind in _HARD or self.kind.startswith("N")

    @property
    def life_group(self) -> str:
        """Group of the life curves: ``steel``, ``hardened``, ``brittle`` or ``nitrocarburized``."""
        if self.kind == "NV(nitrocar.)":
            return "nitrocarburized"
        if self.kind in _HARD:
            return "hardened"
        return "brittle" if self.kind in _SOFT or self.kind.startswith("N") else "steel"

    @property
    def running_in_group(self) -> str:
        """Group of running-in and size: ``steel``, ``cast iron`` or ``hard``."""
        if self.kind in _SOFT:
            return "cast iron"
        return "hard" if self.is_hard else "steel"
