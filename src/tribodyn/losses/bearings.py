"""Frictional moment of rolling bearings by the model of SKF."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.units import RPM


@dataclass(frozen=True)
class Family:
    """Constants of a kind of bearing, in the units of the catalogue (N, mm, rpm, mm^2/s)."""

    kind: str  #: "deep-groove", "cylindrical-roller" or "four-point"
    rolling: tuple[float, ...]  #: R_1, R_2 and R_3, as far as the kind has them
    sliding: tuple[float, ...]  #: S_1, S_2 and S_3
    k_z: float  #: geometry constant K_Z
    k_l: float = 0.0  #: K_L of rollers


#: Families by their series. Source: SKF, Rolling Bearings (2018), the SKF model of the frictional
#: moment, tables of its constants. Those of deep groove balls, K_Z, S_1 and S_2 of rollers and the
#: formulas agree with open programs that copied the tables; R_1 of "NJ 4" and the constants of
#: "QJ 3" stand without such a second reading, and so does the factor of l_D^3 in the oil drag of
#: rollers, which one program has as 2.789e-3: that would be 0.8 % more drag of NJ 406.
FAMILIES = {
    "60": Family("deep-groove", (4.1e-7, 1.7), (3.73e-3, 14.6), 3.1),
    "62": Family("deep-groove", (3.9e-7, 1.7), (3.23e-3, 36.5), 3.1),
    "63": Family("deep-groove", (3.7e-7, 1.7), (2.84e-3, 92.8), 3.1),
    "64": Family("deep-groove", (3.6e-7, 1.7), (2.43e-3, 198.0), 3.1),
    "NJ 4": Family("cylindrical-roller", (1.0e-6,), (0.16, 0.0015), 5.1, 0.65),
    "QJ 3": Family("four-point", (4.78e-7, 2.42, 1.4e-12), (1.2e-2, 0.9, 1.4e-12), 3.1),
}


@dataclass(frozen=True)
class RollingBearing:
    """A rolling bearing.

    Parameters
    ----------
    family : str
        Series, a name of the catalogue: "60", "62", "63", "64", "NJ 4" or "QJ 3".
    bore_diameter : float [m]
        d.
    outer_diameter : float [m]
        D.
    width : float [m]
        B.
    static_load_rating : float [N]
        C_0, which only axial loads of ball bearings need; zero where it is not known.
    seal : tuple of float
        K_S1, exponent, d_s [mm] and K_S2 [N*mm] of the contact seals; zeros for an open bearing.
    source : str
        Where the dimensions come from.

    Raises
    ------
    InputError
        If the family is unknown or the dimensions are no bearing.

    Examples
    --------
    >>> RollingBearing("62", 30e-3, 62e-3, 16e-3, 11200.0).mean_diameter
    0.046
    """

    family: str
    bore_diameter: float
    outer_diameter: float
    width: float
    static_load_rating: float = 0.0
    seal: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    source: str = ""

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.family not in FAMILIES:
            what, remedy = f'no bearing series is called "{self.family}"', "Choose one of these"
            raise InputError(what, "RollingBearing", f"Known: {', '.join(FAMILIES)}", remedy)
        require_positive("bore_diameter", self.bore_diameter, "m", remedy="30 mm is 0.030 m")
        require_positive("width", self.width, "m")
        least = 1.05 * self.bore_diameter
        require_between("outer_diameter", self.outer_diameter, least, 10.0, "m")
        require_between("static_load_rating", self.static_load_rating, 0.0, math.inf, "N")

    @property
    def mean_diameter(self) -> float:
        """Half the sum of bore and outer diameter [m]."""
        return 0.5 * (self.bore_diameter + self.outer_diameter)


def _bearing(name: str, bore: float, outer: float, width: float, static: float) -> RollingBearing:
    """A bearing of the catalogue: mm and kN; its series are all characters but the size."""
    source = _PLACES.get(name, "SKF catalogue")
    sizes = (1e-3 * bore, 1e-3 * outer, 1e-3 * width, 1e3 * static)
    return RollingBearing(name[:-2].strip(), *sizes, source=source)


_PLACES = {
    "NJ 406": "SKF catalogue; test gearbox of an FZG rig",
    "QJ 308": "SKF catalogue; slave gearbox of an FZG rig",
}
#: Bearings of a standard FZG rig, and deep groove ball bearings of shafts of 25 to 40 mm.
BEARINGS = {
    row[0]: _bearing(*row)
    for row in (
        ("NJ 406", 30, 90, 23, 0),
        ("QJ 308", 40, 90, 23, 0),
        ("6205", 25, 52, 15, 7.8),
        ("6206", 30, 62, 16, 11.2),
        ("6207", 35, 72, 17, 15.3),
        ("6208", 40, 80, 18, 19),
        ("6305", 25, 62, 17, 11.6),
        ("6306", 30, 72, 19, 16),
        ("6307", 35, 80, 21, 19),
        ("6308", 40, 90, 23, 24),
    )
}


@dataclass(frozen=True)
class BearingMoments:
    """Parts of the frictional moment of a bearing.

    Parameters
    ----------
    rolling : float [N*m]
        Rolling friction.
    sliding : float [N*m]
        Sliding friction.
    seal : float [N*m]
        Contact seals.
    drag : float [N*m]
        Drag of the oil bath.

    Examples
    --------
    >>> BearingMoments(0.25, 0.5, 0.0, 0.125).total
    0.875
    """

    rolling: float
    sliding: float
    seal: float
    drag: float

    @property
    def total(self) -> float:
        """Sum of all parts [N*m]."""
        return self.rolling + self.sliding + self.seal + self.drag


def bearing_moments(
    bearing: RollingBearing,
    speed: float,
    kinematic_viscosity: float,
    radial_load: float,
    axial_load: float = 0.0,
    *,
    sliding_friction: float | None = None,
    replenishment: float = 3e-8,
    drag_factor: float = 0.0,
    oil_level: float = 0.0,
) -> BearingMoments:
    """Frictional moment of a bearing: rolling, sliding, seals and drag of the oil bath.

    ``M_rr = phi_ish phi_rs G_rr (nu n)^0.6`` and ``M_sl = G_sl mu_sl`` with
    ``mu_sl = phi_bl 0.12 + (1 - phi_bl) mu_EHL``.

    Parameters
    ----------
    bearing : RollingBearing
        The bearing.
    speed : float [rad/s]
        Speed of the inner ring.
    kinematic_viscosity : float [m^2/s]
        Viscosity over density at the temperature of the bearing.
    radial_load : float [N]
        Radial load.
    axial_load : float [N]
        Axial load; its sense does not matter.
    sliding_friction : float, optional
        mu_EHL, the coefficient of the full film: 0.05 for mineral oil, 0.04 for synthetic oil, 0.02
        for cylindrical rollers; by default 0.05, or 0.02 for these.
    replenishment : float
        K_rs: 3e-8 for an oil bath or jet, 6e-8 for grease and oil-air, a dimensionless factor.
    drag_factor : float
        V_M of the oil bath, read off the diagram of the catalogue at the oil level, up to 0.0012.
    oil_level : float [m]
        H: height of the oil above the lowest point of the outer raceway.

    Raises
    ------
    InputError
        If a value is negative or not finite, or a ball bearing under axial load lacks its static
        load rating.

    Valid above the minimum load and at steady speed. Source: SKF, Rolling Bearings (2018).

    Examples
    --------
    >>> moments = bearing_moments(BEARINGS["NJ 406"], 146.6, 60e-6, 2000.0)
    >>> round(moments.rolling, 3), round(moments.sliding, 4)
    (0.164, 0.0036)
    """
    require_between("speed", speed, 0.0, math.inf, "rad/s")
    require_positive("kinematic_viscosity", kinematic_viscosity, "m^2/s", remedy="60 cSt is 60e-6")
    require_between("radial_load", radial_load, 0.0, math.inf, "N")
    require_between("axial_load", axial_load, -math.inf, math.inf, "N")
    require_between("drag_factor", drag_factor, 0.0, 0.01)
    require_between("oil_level", oil_level, 0.0, 10.0, "m")
    family = FAMILIES[bearing.family]
    if sliding_friction is None:
        sliding_friction = 0.02 if family.kind == "cylindrical-roller" else 0.05
    require_between("sliding_friction", sliding_friction, 0.0, 1.0)
    turns, viscosity = speed / RPM, 1e6 * kinematic_viscosity
    bore, outer = 1e3 * bearing.bore_diameter, 1e3 * bearing.outer_diameter
    mean = 0.5 * (bore + outer)
    rolling, sliding = _base_values(bearing, family, turns, radial_load, abs(axial_load))
    heating = 1.0 / (1.0 + 1.84e-9 * (turns * mean) ** 1.28 * viscosity**0.64)
    width = math.sqrt(family.k_z / (2.0 * (outer - bore)))
    require_between("replenishment", replenishment, 0.0, 1e-3)
    starving = math.exp(-replenishment * viscosity * turns * (bore + outer) * width)
    boundary = math.exp(-2.6e-8 * (turns * viscosity) ** 1.4 * mean)
    friction = boundary * (0.12 if turns else 0.15) + (1.0 - boundary) * sliding_friction
    first, exponent, counterface, second = bearing.seal
    return BearingMoments(
        rolling=1e-3 * heating * starving * rolling * (viscosity * turns) ** 0.6,
        sliding=1e-3 * sliding * friction,
        seal=1e-3 * (first * counterface**exponent + second) if first or second else 0.0,
        drag=1e-3 * _drag(bearing, family, turns, viscosity, drag_factor, 1e3 * oil_level),
    )


def _base_values(
    bearing: RollingBearing, family: Family, turns: float, radial: float, axial: float
) -> tuple[float, float]:
    """G_rr and G_sl in the units of the catalogue."""
    mean = 1e3 * bearing.mean_diameter
    if family.kind == "cylindrical-roller":
        first, second = family.sliding
        rolling = family.rolling[0] * mean**2.41 * radial**0.31
        return rolling, first * mean**0.9 * axial + second * mean * radial
    if family.kind == "four-point":
        (r1, r2, r3), (s1, s2, s3) = family.rolling, family.sliding
        rolling = r1 * mean**1.97 * (radial + r3 * mean**4 * turns**2 + r2 * axial) ** 0.54
        turned = radial + s3 * mean**4 * turns**2
        return rolling, s1 * mean**0.26 * (turned ** (4 / 3) + s2 * axial ** (4 / 3))
    (r1, r2), (s1, s2) = family.rolling, family.sliding
    if axial == 0.0:
        return r1 * mean**1.96 * radial**0.54, s1 * mean**-0.26 * radial ** (5 / 3)
    require_positive(
        "static_load_rating", bearing.static_load_rating, "N", remedy="Read C_0 in the catalogue"
    )
    angle = math.sin(math.radians(24.6 * (axial / bearing.static_load_rating) ** 0.24))
    rolling = r1 * mean**1.96 * (radial + r2 / angle * axial) ** 0.54
    cubed = radial**5 + s2 * mean**1.5 / angle * axial**4
    return rolling, s1 * mean**-0.145 * cubed ** (1 / 3)


def _drag(
    bearing: RollingBearing,
    family: Family,
    turns: float,
    viscosity: float,
    factor: float,
    level: float,
) -> float:
    """Drag moment of the oil bath [N*mm]."""
    if factor == 0.0 or turns == 0.0:
        return 0.0
    bore, outer = 1e3 * bearing.bore_diameter, 1e3 * bearing.outer_diameter
    mean = 0.5 * (bore + outer)
    shape = family.k_z * (outer + bore) / (outer - bore)
    wet = 2.0 * math.acos((0.6 * mean - min(level, 1.2 * mean)) / (0.6 * mean))
    reach = math.sin(0.5 * wet) if wet <= math.pi else 1.0
    surface = 0.36 * mean**2 * (wet - math.sin(wet)) * 0.05 * shape
    if family.k_l:
        slim = 5.0 * family.k_l * 1e3 * bearing.width / mean
        fullness = 2.789e-10 * slim**3 - 2.786e-4 * slim**2 + 0.0195 * slim + 0.6439
        body = 4.0 * family.k_l * shape * 1e-12 * fullness * 1e3 * bearing.width * mean**4
    else:
        body = 0.4 * shape * 1e-12 * mean**5
    drag = factor * body * turns**2
    if reach > 0.0:
        stirring = (turns * mean**2 * reach / viscosity) ** -1.379
        drag += 1.093e-7 * turns**2 * mean**3 * stirring * surface
    return drag
