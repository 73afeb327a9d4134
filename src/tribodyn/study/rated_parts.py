"""Life of the bearings and fatigue of the shafts of a result, from computed loads."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import ModelWarning
from tribodyn.machine import BearingState
from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.machine.rolling.roller_bearing import RollerBearing
from tribodyn.rating import (
    RatedBearing,
    ShaftMaterial,
    ShaftNotch,
    ShaftStress,
    ball_bearing_life,
    bearing_life,
    deep_groove_load,
    rate_shaft,
    roller_bearing_life,
    system_life,
)
from tribodyn.rating.elements.shaft_fatigue import yield_safety
from tribodyn.rating.factor import Factor, Factors, check_range
from tribodyn.rating.mesh_load import PRACTICE
from tribodyn.types import Tree

#: f_0 of deep groove ball bearings, which lies between 12 and 16 for usual sizes.
_USUAL_SHARE = 14.0
_LIFE, _LOAD = "ISO 281", "computed load"
#: Required safety of shafts.
SHAFT_SAFETY = 1.2
ALL_CASES = "all load cases"


class Verdict(NamedTuple):
    """Safety of one part against one mode of failure.

    Parameters
    ----------
    mode : str
        Mode of failure: ``pitting``, ``bending``, ``scuffing (flash)``...
    part : str
        Gear, mesh, bearing or section of a shaft.
    load : str
        Load.
    safety : float
        Safety by the factors of the standard, pure number.
    required : float
        Required safety, pure number.
    computed : float, optional
        Safety by computed load factors, pure number.
    where : str
        Where on the part, such as a point of the path of contact.
    """

    mode: str
    part: str
    load: str
    safety: float
    required: float
    computed: float | None
    where: str = ""

    @property
    def margin(self) -> float:
        """Safety over the required one, less 1."""
        return self.safety / self.required - 1.0


@dataclass(frozen=True)
class BearingLoad:
    """A bearing under one load, as it is rated."""

    load: str
    share: float | None  #: of the time, of a load case
    radial: float  #: [N]
    axial: float  #: [N]
    speed: float  #: of one ring against the other [rad/s]
    viscosity: float | None  #: kinematic, at the temperature of the oil [m^2/s]
    dynamic: float = 1.0  #: mean of force^p over the motion, over the mean force
    state: BearingState | None = None


@dataclass(frozen=True)
class PartBearing:
    """A bearing of a machine with its catalogue values and the conditions of its life."""

    catalogue: Any
    conditions: Any
    rolling: RollingElementBearing | None = None
    kind: str = ""  #: type of a rolling bearing
    prefix: str = ""  #: of the keys, ``pin_`` of planets

    @cached_property
    def rated(self) -> RatedBearing:
        """Catalogue values as ratings take them."""
        rolling, values = self.rolling, self.catalogue
        is_ball = not isinstance(rolling, RollerBearing)
        if rolling is None:
            is_ball = values.elements == "ball"
        pitch = values.pitch_diameter if rolling is None else rolling.pitch
        return RatedBearing(
            kind="radial ball" if is_ball else "radial roller",
            dynamic_capacity=values.dynamic_load_rating,
            pitch_diameter=pitch or 0.1,  # without it there is no modified life
            static_capacity=values.static_load_rating,
            fatigue_load=values.fatigue_load_limit,
        )

    @property
    def missing(self) -> str:
        """What the modified life lacks; empty where nothing is missing."""
        if self.rolling is None and self.catalogue.pitch_diameter is None:
            return f"no {self.prefix}pitch_diameter"
        if self.rated.fatigue_limit is None:
            return f"no {self.prefix}fatigue_load_limit or {self.prefix}static_load_rating"
        return ""

    def equivalent_load(self, radial: float, axial: float) -> tuple[float | None, str]:
        """P [N] and the branch taken; None where only the loads of the elements give it."""
        angle = getattr(self.rolling, "contact_angle", 0.0)
        if self.kind == "tapered-roller":
            if axial <= 1.5 * math.tan(angle) * radial:
                return radial, "F_r"
            return 0.4 * radial + 0.4 * axial / math.tan(angle), "0.4 F_r + 0.4 cot(alpha) F_a"
        if self.kind == "angular-contact":
            return None, ""
        if self.rated.kind == "radial roller":
            return radial, "F_r; F_a is not counted" if axial > 1e-3 * radial else "F_r"
        static = self.rated.static_capacity
        share = _USUAL_SHARE * axial / static if static else 0.0
        load = deep_groove_load(radial, axial, share)
        factor = f"f_0 = {_USUAL_SHARE:g}" if static else "largest Y, without C_0"
        return load, "F_r" if load == radial else f"0.56 F_r + Y F_a, {factor}"

    def element_life(self, state: BearingState, factor: float) -> float | None:
        """L_10r in turns from the loads of the elements times a factor; None without load."""
        ring = self.rolling
        if ring is None or not np.any(state.element_load > 0.0):
            return None
        size = ring.element_diameter / ring.pitch, getattr(ring, "contact_angle", 0.0)
        values = self.rated.dynamic_capacity, size
        if isinstance(ring, RollerBearing):
            return roller_bearing_life(factor * ring.lamina_loads(state.displacement), *values)
        grooves = ring.inner_groove, ring.outer_groove  # type: ignore[attr-defined]
        return ball_bearing_life(factor * state.element_load, *values, grooves=grooves)


class BearingLoadLife(NamedTuple):
    """Life of a bearing under one load."""

    load: str
    share: float | None  #: of the time, of a load case
    basic_life: float  #: L_10h [s], infinite without load
    modified_life: float | None  #: L_nmh [s]
    reference_life: float | None  #: L_10rh from the loads of the rolling elements [s]
    factors: Mapping[str, Factor]


LIVES = "basic_life", "modified_life", "reference_life"


def _lives(each: Any) -> dict[str, float | None]:
    """Lives by name, as JSON has them."""
    return {name: _finite(getattr(each, name)) for name in LIVES}


def _listed(factors: Mapping[str, Factor]) -> Tree:
    return {name: factor.to_dict() for name, factor in factors.items()}


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def bearing_life_under(bearing: PartBearing, load: BearingLoad, application: float) -> Any:
    """Life of a bearing under one load, multiplied by the application factor."""
    factors = Factors()
    record = factors.record
    outer = application * load.dynamic
    record("K_A", application, "application factor")
    record("f_dyn", load.dynamic, "mean of force^p over the computed motion, over the mean force")
    radial = record("F_r", outer * load.radial, _LOAD, unit="N")
    axial = record("F_a", outer * load.axial, _LOAD, unit="N")
    record("C", bearing.rated.dynamic_capacity, "catalogue", unit="N")
    turns = None if load.state is None else bearing.element_life(load.state, outer)
    capacity, exponent = bearing.rated.dynamic_capacity, bearing.rated.exponent
    p_ref = None if turns is None else capacity * (1e6 / turns) ** (1.0 / exponent)
    equivalent, branch = bearing.equivalent_load(radial, axial)
    if equivalent is None:
        equivalent, branch = p_ref or 0.0, "reference load of ISO/TS 16281"
    source = PRACTICE if branch.startswith("0.") else _LIFE  # factors X and Y
    record("P", equivalent, f"{source}, equivalent load", unit="N", branch=branch)
    if not load.speed or not (equivalent or p_ref):
        return BearingLoadLife(load.load, load.share, math.inf, math.inf, None, factors)
    check_range("P/C", equivalent / capacity, 0.0, 0.5, _LIFE)
    if p_ref is not None:
        source = "ISO/TS 16281" if bearing.rated.kind.endswith("ball") else PRACTICE
        record("P_ref", p_ref, f"{source}, from the loads of the elements", unit="N")
    lacks = bearing.missing
    life = bearing_life(
        bearing.rated,
        equivalent,
        load.speed,
        viscosity=None if lacks else load.viscosity,
        contamination=bearing.conditions.cleanliness,
        reliability=bearing.conditions.reliability,
    )
    cleanliness = str(bearing.conditions.cleanliness)
    sources = {
        "nu": "oil of the case",
        "e_C": _LIFE if cleanliness.startswith("grease") else f"{PRACTICE}, {cleanliness}",
        "C_u": "catalogue" if bearing.rated.fatigue_load else f"{PRACTICE}, from C_0",
    }
    for name, value, unit in (
        ("a_1", life.reliability_factor, ""),
        ("nu", load.viscosity, "m^2/s"),
        ("kappa", life.viscosity_ratio, ""),
        ("e_C", life.contamination_factor, ""),
        ("C_u", bearing.rated.fatigue_limit, "N"),
        ("a_ISO", life.life_factor, ""),
    ):
        if value is not None:
            record(name, value, sources.get(name, _LIFE), unit=unit, branch=bearing.rated.kind)
    # The life of rollers falls with another power of the load: their lives differ by design.
    longer = 1.0 if turns is None else turns / life.basic_turns
    modified = None if life.modified_life is None else longer * life.modified_life
    reference = None if turns is None else longer * life.basic_life
    lives = life.basic_life, modified, reference
    return BearingLoadLife(load.load, load.share, *lives, factors)


@dataclass(frozen=True)
class BearingRating:
    """Life of a bearing of a machine.

    Parameters
    ----------
    bearing : str
        Name.
    lives : tuple
        Under each load: ``load``, ``basic_life``, ``modified_life``, ``reference_life`` [s] and
        ``factors``; empty where the bearing is not rated.
    exponent : float
        Life exponent p.
    reason : str
        Why it is not rated, or has no modified life; empty otherwise.
    """

    bearing: str
    lives: tuple[BearingLoadLife, ...]
    exponent: float = 3.0
    reason: str = ""

    def _combined(self, name: str) -> float | None:
        values = [getattr(each, name) for each in self.lives]
        if not values or None in values:
            return None
        shares = [each.share for each in self.lives]
        if None in shares:
            return float(min(values))
        damage = sum(share / value for share, value in zip(shares, values, strict=True))
        return 1.0 / damage if damage else math.inf

    @property
    def basic_life(self) -> float | None:
        """L_10h over all loads by their shares of the time [s]; None where it is not rated."""
        return self._combined("basic_life")

    @property
    def modified_life(self) -> float | None:
        """L_nmh over all loads by their shares of the time [s]; None where a value is missing."""
        return self._combined("modified_life")

    @property
    def reference_life(self) -> float | None:
        """L_10rh from the loads of the rolling elements over all loads [s]; None without them."""
        return self._combined("reference_life")

    @property
    def life(self) -> float | None:
        """Modified life where it is known, else the basic one [s]."""
        return self.basic_life if self.modified_life is None else self.modified_life

    def to_dict(self) -> Tree:
        """Lives over all loads and under each, as JSON has them.

        Returns
        -------
        dict of str
        """
        loads = {
            each.load: {**_lives(each), "share": each.share, "factors": _listed(each.factors)}
            for each in self.lives
        }
        return {**_lives(self), "reason": self.reason, "loads": loads}


@dataclass(frozen=True)
class NotchRating:
    """Fatigue of a notched section of a shaft under one load.

    Parameters
    ----------
    shaft, notch, load : str
        Names.
    safety : float
        S against fatigue by DIN 743, pure number; infinite without a stress that changes.
    factors : mapping of str to Factor
        Factors by the names of the standard, and the nominal stresses.
    yield_safety : float
        S against yield by DIN 743, pure number; infinite without a stress.
    """

    shaft: str
    notch: str
    load: str
    safety: float
    factors: Mapping[str, Factor]
    yield_safety: float = math.inf

    def to_dict(self) -> Tree:
        """Safeties and factors, as JSON has them.

        Returns
        -------
        dict of str
        """
        safeties = {name: _finite(getattr(self, name)) for name in ("safety", "yield_safety")}
        return {**safeties, "factors": _listed(self.factors)}


class SectionLoad(NamedTuple):
    """Forces and moments in a section of a shaft under one load."""

    force: float  #: along the axis [N]
    bending: float  #: moment [N*m]
    torque: float  #: [N*m]
    application: float  #: K_A
    dynamic: float  #: greatest over mean force of the meshes of the shaft
    turns: bool  #: whether the shaft turns against its load


def rate_notch(
    names: tuple[str, str, str], notch: ShaftNotch, material: ShaftMaterial, load: SectionLoad
) -> NotchRating:
    """Safeties of a section: bending turns with the shaft, torque and tension follow the motion."""
    d, bore = notch.diameter, notch.bore_diameter
    hollow = 1.0 - (bore / d) ** 4
    area = 0.25 * math.pi * (d**2 - bore**2)
    modulus = math.pi * d**3 / 32.0 * hollow
    tension, torsion = load.force / area, load.torque / (2.0 * modulus)
    bending = load.bending / modulus
    stresses = load.application * np.abs([tension, bending, torsion])
    means, amplitudes = stresses.copy(), (load.dynamic - 1.0) * stresses
    if load.turns:
        means[1], amplitudes[1] = 0.0, load.dynamic * stresses[1]
    shaft, place, name = names
    if not stresses.any():
        return NotchRating(shaft, place, name, math.inf, {})
    stress = ShaftStress(tuple(amplitudes.tolist()), tuple(means.tolist()))
    if not amplitudes.any():
        static = yield_safety(notch, material, stress)
        return NotchRating(shaft, place, name, math.inf, {}, static)
    rating = rate_shaft(notch, material, stress)
    record = rating.factors.record
    record("K_A", load.application, "application factor")
    record("K_v", load.dynamic, "greatest over mean force of the meshes of the shaft, computed")
    for symbol, values in zip(
        ("sigma_zd", "sigma_b", "tau_t"), zip(*stress, strict=True), strict=True
    ):
        for end, value in zip("am", values, strict=True):
            record(f"{symbol}{end}", value, _LOAD, unit="Pa")
    return NotchRating(shaft, place, name, rating.safety, rating.factors, rating.yield_safety)


@dataclass(frozen=True)
class PartRatings:
    """Bearings and shafts of a result, with the conditions that hold for both."""

    bearings: tuple[BearingRating, ...] = ()
    notches: tuple[NotchRating, ...] = ()
    required_life: float | None = None
    minimum_safety: float | None = None
    warnings: tuple[ModelWarning, ...] = ()

    @property
    def system_life(self) -> float | None:
        """Life of all rated bearings together [s]; None where there are none, or without load."""
        lives = [each.life for each in self.bearings]
        loaded = [life for life in lives if life is not None and math.isfinite(life)]
        return system_life(loaded) if loaded else None

    def verdicts(self) -> Iterator[Verdict]:
        """Iterate over the verdicts on bearings and shafts that are loaded."""
        for each in self.bearings:
            if self.required_life and each.life is not None and math.isfinite(each.life):
                load = ALL_CASES if len(each.lives) > 1 else each.lives[0].load
                safety = (each.life / self.required_life) ** (1.0 / each.exponent)
                required = self.minimum_safety or 1.0
                yield Verdict("bearing life", each.bearing, load, safety, required, None)
        for notch in self.notches:
            modes = {"shaft fatigue": notch.safety, "shaft yield": notch.yield_safety}
            for mode, safety in modes.items():
                if math.isfinite(safety):
                    values = safety, self.minimum_safety or SHAFT_SAFETY, None
                    yield Verdict(mode, notch.shaft, notch.load, *values, f"notch {notch.notch}")

    def to_dict(self) -> Tree:
        """Lives and safeties by part, as JSON has them."""
        shafts: dict[str, Tree] = {}
        for each in self.notches:
            notch = shafts.setdefault(each.shaft, {}).setdefault(each.notch, {})
            notch.setdefault("loads", {})[each.load] = each.to_dict()
            safeties = [load["safety"] for load in notch["loads"].values() if load["safety"]]
            notch["safety"] = min(safeties, default=None)
        return {
            "bearings": {each.bearing: each.to_dict() for each in self.bearings},
            "system_life": self.system_life,
            "shafts": shafts,
        }


def rate_bearing(
    name: str, bearing: PartBearing, loads: Sequence[BearingLoad], application: float
) -> BearingRating:
    """Life of a bearing under its loads."""
    lives = tuple(bearing_life_under(bearing, load, application) for load in loads)
    reason = bearing.missing
    if not reason and any(load.viscosity is None for load in loads):
        reason = "no oil"
    if all(math.isinf(life.basic_life) for life in lives):
        return BearingRating(name, lives, bearing.rated.exponent, "no load or no rotation")
    reason = f"no modified life: {reason}" if reason else ""
    return BearingRating(name, lives, bearing.rated.exponent, reason)


def internal_loads(nodes: Iterable[float], forces: np.ndarray, position: float) -> np.ndarray:
    """Force and moment (6,) in a section, by the loads (nodes, 6) on the shaft before it."""
    total = np.zeros(6)
    for node, load in zip(nodes, forces, strict=True):
        if node < position:
            total += load
            lever = node - position
            total[4:] += -lever * load[2], lever * load[1]
    return total
