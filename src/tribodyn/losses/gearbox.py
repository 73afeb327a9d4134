"""Losses of a gear stage: its loss factor; teeth, bearings, seals and oil over torque and speed."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import gear_loss_factor as integrated
from tribodyn.contact import path_of_contact
from tribodyn.errors import Argument, InputError, require_between, warn
from tribodyn.gear import HypoidBlank, HypoidFlanks, SpurPair
from tribodyn.losses.bearings import RollingBearing, bearing_moments
from tribodyn.losses.no_load import churning_loss, seal_loss, windage_loss
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import GEARS, one_or_more
from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.types import Array

#: Parts of a loss in the order of display, with their labels.
PARTS = {
    "gear": "teeth",
    "bearing_rolling": "bearings: rolling",
    "bearing_sliding": "bearings: sliding",
    "bearing_seal": "bearings: seals",
    "bearing_drag": "bearings: oil drag",
    "seal": "shaft seals",
    "churning": "churning",
    "windage": "windage",
}
_GRID = ("torque", "speed")


def gear_loss_factor(pair: SpurPair, load_share: Callable[[Array], Array] | None = None) -> float:
    """Gear loss factor H_V: lost part of the power over the mean friction coefficient.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    load_share : callable, optional
        Load share of a tooth pair as a function of its ``path`` in m; equal sharing by default.

    Returns
    -------
    float
        H_V, 1/p_b times the integral of share times sliding over the path of contact.

    Raises
    ------
    ComputationError
        If the share is not finite somewhere.

    Valid wherever the pitch point lies. Source: Ohlendorf (1958), the integral.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(gear_loss_factor(pair), 4)
    0.1791
    """
    return integrated(pair, load_share)


def ohlendorf_loss_factor(pair: SpurPair) -> float:
    """Gear loss factor H_V in the closed form of Ohlendorf.

    ``H_V = pi (u + 1)/(z_1 u cos beta_b) (1 - eps + eps_1^2 + eps_2^2)`` with the transverse
    contact ratio eps and its parts before and after the pitch point; u is negative for a ring.

    Parameters
    ----------
    pair : SpurPair
        The pair.

    Returns
    -------
    float
        H_V for equal sharing, exact for spur gears where the pitch point lies among the positions
        of single contact.

    Warns
    -----
    ModelWarning
        Code ``loss-factor`` where it lies elsewhere, or the contact ratio is not between 1 and 2:
        the form is wrong there.

    Source: Ohlendorf, Diss. TH Munich (1958).

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(ohlendorf_loss_factor(pair), 4)
    0.1791
    """
    path = path_of_contact(pair)
    approach = path.direction * (path.C - path.A) / pair.base_pitch
    recess = path.contact_ratio - approach
    factor = 1.0 - path.contact_ratio + approach**2 + recess**2
    if not (path.contact_ratio <= 2.0 and path.contact_ratio - 1.0 <= approach <= 1.0):
        zone = "" if path.contact_ratio <= 2.0 else f" of {path.contact_ratio:.3f}"
        warn(
            "loss-factor",
            f"ohlendorf: the pitch point lies {approach:.3f} base pitches after the entry, and "
            f"a single pair carries the load from {path.contact_ratio - 1.0:.3f} to 1.000 of a "
            f"contact ratio{zone}: the closed form does not hold there. Use gear_loss_factor, "
            "which integrates.",
        )
    ratio = pair.ratio
    factor /= math.cos(pair.base_helix_angle)
    return math.pi * (ratio + 1.0) / (pair.pinion.teeth * ratio) * factor


@dataclass(frozen=True)
class ShaftParts:
    """Parts of a shaft that lose power: bearings, shaft seals, and the oil bath of its gear.

    Parameters
    ----------
    bearing : RollingBearing, optional
        The bearings of the shaft, all of one type; none by default.
    bearings : int
        Number of them, which share the force of the teeth evenly.
    bearing_drag_factor : float
        V_M of bearings in an oil bath, see :func:`bearing_moments`.
    bearing_oil_level : float [m]
        H, the height of the oil above the lowest point of their outer raceway.
    seal_diameter : float [m]
        Diameter of the shaft under the lips of its seals; zero for no seals.
    seals : int
        Number of lips.
    immersion : float [m]
        Depth of the lowest point of the pitch circle under the oil; zero for no oil bath.

    Raises
    ------
    InputError
        If a value is negative or not finite.

    Examples
    --------
    >>> from tribodyn.losses import BEARINGS
    >>> ShaftParts(BEARINGS["NJ 406"], seal_diameter=30e-3).bearings
    2
    """

    bearing: RollingBearing | None = None
    bearings: int = 2
    bearing_drag_factor: float = 0.0
    bearing_oil_level: float = 0.0
    seal_diameter: float = 0.0
    seals: int = 1
    immersion: float = 0.0

    def __post_init__(self) -> None:
        """Check the fields."""
        require_between("bearings", self.bearings, 1, 16)
        require_between("seals", self.seals, 1, 16)
        require_between("bearing_drag_factor", self.bearing_drag_factor, 0.0, 0.01)
        for name in ("bearing_oil_level", "seal_diameter", "immersion"):
            require_between(name, getattr(self, name), 0.0, 10.0, "m")


@dataclass(frozen=True)
class Gearbox:
    """Both shafts of a gear stage and the oil around them.

    Parameters
    ----------
    pinion : ShaftParts
        Shaft of the pinion.
    wheel : ShaftParts
        Shaft of the wheel.
    oil_volume : float [m^3]
        Oil in the sump; needed where a gear is immersed.
    windage : bool
        Whether the gears are taken to turn in oil mist, as well as in their bath.

    Raises
    ------
    InputError
        If a gear is immersed without an oil volume, or that is negative or not finite.

    Examples
    --------
    >>> Gearbox(wheel=ShaftParts(immersion=20e-3), oil_volume=1.2e-3).pinion.immersion
    0.0
    """

    pinion: ShaftParts = field(default_factory=ShaftParts)
    wheel: ShaftParts = field(default_factory=ShaftParts)
    oil_volume: float = 0.0
    windage: bool = True

    def __post_init__(self) -> None:
        """Check that an oil bath has a volume."""
        require_between("oil_volume", self.oil_volume, 0.0, 100.0, "m^3")
        if (self.pinion.immersion or self.wheel.immersion) and not self.oil_volume:
            why = "Churning depends on the oil volume in the sump"
            remedy = "1.2 litres are 1.2e-3 m^3"
            raise InputError("oil_volume is missing", Argument("oil_volume"), why, remedy)


@record
class GearboxLosses(Record):
    """Power losses of a gear stage over torque and speed; made by :func:`gearbox_losses`.

    Parameters
    ----------
    pinion_torque : array (t,) [N*m]
        Torques on the pinion.
    pinion_speed : array (s,) [rad/s]
        Speeds of the pinion.
    gear : array (t, s) [W]
        Friction of the teeth.
    bearing_rolling, bearing_sliding, bearing_seal, bearing_drag : array (t, s) [W]
        Parts of the frictional moments of all bearings, times their speeds.
    seal : array (t, s) [W]
        Radial shaft seals.
    churning : array (t, s) [W]
        Gears in the oil bath.
    windage : array (t, s) [W]
        Gears in air and oil mist.
    torque_balance : str
        ``"load"`` where the torque is that of the load, so that the driver brings up the losses
        besides; else it is that of the driver.

    Examples
    --------
    >>> one = np.array([1.0])
    >>> found = GearboxLosses(150.0 * one, 100.0 * one, *np.zeros((8, 1, 1)))
    >>> float(found.efficiency[0, 0])
    1.0
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "total": Labels(_GRID, "W"),
        "efficiency": Labels(_GRID, "1"),
        "gear_efficiency": Labels(_GRID, "1"),
    }

    pinion_torque: Array = quantity("torque", unit="N*m", axis=True)
    pinion_speed: Array = quantity("speed", unit="rad/s", axis=True)
    gear: Array = quantity(*_GRID, unit="W")
    bearing_rolling: Array = quantity(*_GRID, unit="W")
    bearing_sliding: Array = quantity(*_GRID, unit="W")
    bearing_seal: Array = quantity(*_GRID, unit="W")
    bearing_drag: Array = quantity(*_GRID, unit="W")
    seal: Array = quantity(*_GRID, unit="W")
    churning: Array = quantity(*_GRID, unit="W")
    windage: Array = quantity(*_GRID, unit="W")
    torque_balance: str = fact(default="drive")

    @property
    def total(self) -> Array:
        """Sum of all parts (t, s) [W]."""
        return self.total_of(*PARTS)

    def total_of(self, *parts: str) -> Array:
        """Sum of some parts by name (t, s) [W].

        Parameters
        ----------
        *parts : str
            Names of fields.

        Returns
        -------
        array [W]
        """
        return np.asarray(sum(getattr(self, part) for part in parts))

    @property
    def transmitted_power(self) -> Array:
        """Torque times speed (t, s) [W]."""
        return np.outer(self.pinion_torque, self.pinion_speed)

    @property
    def efficiency(self) -> Array:
        """Output over input power with all parts that are counted (t, s)."""
        return self._efficiency(self.total)

    @property
    def gear_efficiency(self) -> Array:
        """Output over input power with the friction of the teeth alone (t, s)."""
        return self._efficiency(self.gear)

    def _efficiency(self, lost: Array) -> Array:
        power = self.transmitted_power
        return np.asarray(
            power / (power + lost) if self.torque_balance == "load" else 1.0 - lost / power
        )

    def __repr__(self) -> str:
        """One line."""
        least, most = 100.0 * self.efficiency.min(), 100.0 * self.efficiency.max()
        shape = f"{self.pinion_torque.size} torques, {self.pinion_speed.size} speeds"
        return f"GearboxLosses({shape}, efficiency {least:.4g} to {most:.4g} %)"


def gearbox_losses(
    pair: SpurPair | HypoidFlanks,
    gearbox: Gearbox,
    gear: ArrayLike,
    *,
    pinion_torque: ArrayLike,
    pinion_speed: ArrayLike,
    lubricant: Lubricant | None = None,
    torque_balance: str = "drive",
) -> GearboxLosses:
    """Losses of a gear stage for every torque at every speed.

    Parameters
    ----------
    pair : SpurPair or HypoidFlanks
        The gears.
    gearbox : Gearbox
        Shafts, seals and oil.
    gear : float or array (t, s) [W]
        Power lost by the friction of the teeth.
    pinion_torque : float or array (t,) [N*m]
        Torques on the pinion.
    pinion_speed : float or array (s,) [rad/s]
        Speeds of the pinion.
    lubricant : Lubricant, optional
        The oil, which bearings, an oil bath and mist need; without one there is no mist.
    torque_balance : str
        ``"load"`` where the torque is that of the load; else it is that of the driver.

    Raises
    ------
    InputError
        If bearings or an oil bath lack the oil, a gear is immersed to more than its pitch radius,
        or ``gear`` is of another shape.

    Warns
    -----
    ModelWarning
        Code ``windage-range`` beyond 200 m/s at the pitch circle.

    Notes
    -----
    Bearings carry the force of the nominal torque along the line of action; weights and friction
    of the teeth are left out. The thrust of a hypoid gear loads one of its bearings. Churning and
    windage are those of a cylinder: of hypoid gears with the outer pitch radius and the face width.
    Source: the single laws, each named in its function.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> box = Gearbox(pinion=ShaftParts(seal_diameter=30e-3), windage=False)
    >>> found = gearbox_losses(pair, box, 25.0, pinion_torque=100.0, pinion_speed=146.6)
    >>> round(float(found.seal[0, 0]), 2), round(float(found.efficiency[0, 0]), 5)
    (9.69, 0.99763)
    """
    torque, speed = one_or_more(pinion_torque=pinion_torque, pinion_speed=pinion_speed)
    shape = (torque.size, speed.size)
    teeth = np.asarray(gear, dtype=float)
    if teeth.size not in (1, torque.size * speed.size) or not np.all(teeth >= 0.0):
        why = "It is one power for each torque and speed, not negative"
        what = f"gear has the shape {teeth.shape}"
        raise InputError(what, Argument("gear"), why, "Give one value for each gear")
    lost: dict[str, Array] = {part: np.zeros(shape) for part in PARTS}
    lost["gear"] = np.array(np.broadcast_to(teeth, shape))
    for name, body in turning_bodies(pair).items():
        require_oil(getattr(gearbox, name), lubricant, name)
        for row, column in np.ndindex(shape):
            turning = body.speed_ratio * float(speed[column])
            shaft, force = getattr(gearbox, name), float(torque[row])
            loads = shared_loads(shaft.bearings, force * body.radial, force * body.axial)
            parts = shaft_losses(shaft, turning, loads, lubricant)
            parts |= oil_losses(body, gearbox, shaft.immersion, turning, lubricant)
            for part, power in parts.items():
                lost[part][row, column] += power
    return GearboxLosses(torque, speed, **lost, torque_balance=torque_balance)


def require_oil(shaft: ShaftParts, lubricant: Lubricant | None, gear: str) -> None:
    """Refuse bearings and an oil bath without oil."""
    for name in ("bearing", "immersion"):
        if lubricant is None and getattr(shaft, name):
            why = "Bearings and an oil bath lose by the viscosity of the oil"
            raise InputError("there is no oil", Argument(name, gear), why, "Give the oil")


class TurningBody(NamedTuple):
    """A gear as its bearings and the oil see it."""

    name: str
    speed_ratio: float  #: its speed over that of the pinion
    radial: float  #: force across its axis over the torque on the pinion [1/m]
    axial: float  #: force along its axis over the torque on the pinion [1/m]
    pitch_radius: float  #: of a cylinder that churns as much [m]
    face_width: float  #: [m]
    module: float  #: normal module [m]


def turning_bodies(pair: SpurPair | HypoidFlanks) -> dict[str, TurningBody]:
    """Both gears of a pair by name."""
    if isinstance(pair, HypoidFlanks):
        return _hypoid_bodies(pair)
    force, module = 1.0 / pair.pinion.base_radius, pair.pinion.normal_module
    # The operating pitch circles: that is where the two gears roll on each other.
    radius = abs(pair.center_distance / (1.0 + pair.ratio))
    widths = pair.pinion.face_width, pair.wheel.face_width
    turns = 1.0, 1.0 / abs(pair.ratio)
    return {
        name: TurningBody(name, turn, force, 0.0, radius / turn, width, module)
        for name, turn, width in zip(GEARS, turns, widths, strict=True)
    }


def outer_pitch_radius(blank: HypoidBlank, gear: str) -> float:
    """Pitch radius of pinion or wheel at the heel [m]."""
    cone, angle = (getattr(blank, f"{n}_{gear}") for n in ("outer_cone_distance", "pitch_angle"))
    return float(cone * math.sin(angle))


def _hypoid_bodies(flanks: HypoidFlanks) -> dict[str, TurningBody]:
    blank, touch = flanks.blank, flanks.conjugate.touch(np.zeros(2))
    force = blank.ratio / float(touch.lever)
    bodies = {}
    normal, axes = touch.contact.wheel.normal, (flanks.conjugate.axes.axis, np.eye(3)[2])
    for name, turn, axis in zip(GEARS, (1.0, 1.0 / blank.ratio), axes, strict=True):
        thrust = abs(float(normal @ axis))
        bodies[name] = TurningBody(
            name,
            turn,
            force * math.sqrt(1.0 - thrust**2),
            force * thrust,
            outer_pitch_radius(blank, name),
            getattr(blank, f"face_width_{name}"),
            blank.mean_normal_module,
        )
    return bodies


def shaft_losses(
    shaft: ShaftParts,
    speed: float,
    loads: Sequence[tuple[float, float]],
    lubricant: Lubricant | None,
) -> dict[str, float]:
    """Power of seals and of a bearing under each radial and axial load [N], at a speed [W]."""
    losses = {}
    if shaft.seal_diameter:
        losses["seal"] = shaft.seals * float(seal_loss(shaft.seal_diameter, speed))
    if shaft.bearing is not None and lubricant is not None:
        viscosity, bath = lubricant.kinematic_viscosity, shaft.bearing_oil_level
        for load, count in Counter(loads).items():
            moments = bearing_moments(
                shaft.bearing,
                speed,
                viscosity,
                *load,
                drag_factor=shaft.bearing_drag_factor,
                oil_level=bath,
            )
            for part, moment in vars(moments).items():
                key = f"bearing_{part}"
                losses[key] = losses.get(key, 0.0) + count * speed * moment
    return losses


def shared_loads(count: int, radial: float, thrust: float) -> list[tuple[float, float]]:
    """Loads of the bearings of a shaft, which share the radial force; the first has the thrust."""
    return [(radial / count, thrust), *[(radial / count, 0.0)] * (count - 1)]


def oil_losses(
    body: TurningBody, gearbox: Gearbox, depth: float, speed: float, lubricant: Lubricant | None
) -> dict[str, float]:
    """Churning at a depth in the bath, and windage, of one gear [W]."""
    losses = {}
    radius, width = body.pitch_radius, body.face_width
    if depth > radius:
        why = f"The gear is immersed to at most its pitch radius, {1e3 * radius:.4g} mm"
        what, where = f"immersion = {1e3 * depth:.4g} mm", Argument("immersion", body.name)
        raise InputError(what, where, why, "Give the depth of the lowest point of its pitch circle")
    if depth and lubricant is not None:
        module, volume = body.module, gearbox.oil_volume
        oil = (volume, lubricant.density, lubricant.kinematic_viscosity)
        losses["churning"] = churning_loss(radius, width, module, depth, speed, *oil)
    if gearbox.windage:
        mist = lubricant.dynamic_viscosity if lubricant else 0.0
        losses["windage"] = windage_loss(radius, width, speed, mist)
    return losses
