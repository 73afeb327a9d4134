"""Speeds, torques, rolling power and efficiency of a planetary stage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from tribodyn.errors import Argument, InputError, require_between, require_one_of
from tribodyn.machine.planetary.positions import (
    PlanetTeeth,
    PlanetType,
    planetary_positions,
    read_teeth,
)
from tribodyn.nomenclature import require_number

Member = Literal["sun", "ring", "carrier"]

_MEMBERS = ("sun", "ring", "carrier")


@dataclass(frozen=True)
class PlanetaryKinematics:
    """Speeds and torques of a planetary stage.

    Parameters
    ----------
    held, input, output : str
        Member that is held, that drives and that is driven: ``sun``, ``ring`` or ``carrier``.
    speeds : mapping of str to float
        Speed of sun, ring and carrier, and of ``planet``, or ``sun_planet`` and ``ring_planet``,
        where their teeth are known, in the unit of the input speed [rad/s].
    relative_speeds : mapping of str to float
        The same relative to the carrier; that of a planet is about its pin [rad/s].
    ratio : float
        Speed of the input over that of the output, negative where it turns the other way.
    torques : mapping of str to float
        External torque on sun, ring and carrier; their sum is zero [N*m].
    power : mapping of str to float
        Power that enters by each member, negative where it leaves, at speeds in rad/s [W].
    rolling_power : float
        Power that the meshes transmit relative to the carrier, which alone causes losses [W].
    efficiency : float
        Power of the output over that of the input.
    mesh_frequency : float
        Mesh cycles per second at speeds in rad/s [Hz].
    """

    held: str
    input: str
    output: str
    speeds: Mapping[str, float]
    relative_speeds: Mapping[str, float]
    ratio: float
    torques: Mapping[str, float]
    power: Mapping[str, float]
    rolling_power: float
    efficiency: float
    mesh_frequency: float

    @property
    def output_speed(self) -> float:
        """Speed of the output, the input speed of a stage that follows [rad/s]."""
        return self.speeds[self.output]

    @property
    def output_torque(self) -> float:
        """Torque that the output puts out, the input torque of a stage that follows [N*m]."""
        return -self.torques[self.output]


def planetary_kinematics(
    *,
    sun_teeth: int,
    ring_teeth: int,
    held: Member,
    input: Member,
    input_speed: float,
    input_torque: float | None = None,
    planet_teeth: int | tuple[int, int] | None = None,
    planet_type: PlanetType = "single",
    sun_efficiency: float = 1.0,
    ring_efficiency: float = 1.0,
    planet_efficiency: float = 1.0,
    planets: int | None = None,
) -> PlanetaryKinematics:
    """Compute speeds, torques and efficiency of a stage with one held member.

    Parameters
    ----------
    sun_teeth, ring_teeth : int
        Numbers of teeth; that of the ring with or without its minus sign.
    held, input : {"sun", "ring", "carrier"}
        Member that is held, and member that drives; the third one is driven.
    input_speed : float
        Speed of the input [rad/s]. Speeds are proportional to it and come out in its unit;
        power and mesh frequency need rad/s.
    input_torque : float, optional
        Torque on the input, with the sign of its speed [N*m]; 1 N*m by default.
    planet_teeth : int or (int, int), optional
        Teeth of a planet; of double planets the gear at the sun first.
    planet_type : {"single", "stepped", "meshed"}
        Planets with one gear, with two gears on one shaft, or pairs that mesh with each other.
    sun_efficiency, ring_efficiency, planet_efficiency : float
        Efficiencies of the sun mesh, the ring mesh, and the mesh between the gears of a meshed
        pair, with the carrier at rest, greater than 0 and at most 1 [1].
    planets : int, optional
        Number of equally spaced planets, to check that they can be assembled and do not touch.

    Raises
    ------
    InputError
        If an argument is out of range, the held member drives, the planets do not fit, or
        the stage locks itself.

    Notes
    -----
    After Willis ``(n_s - n_c)/(n_r - n_c) = i_0``, the basic ratio: ``-z_r/z_s`` for single,
    ``-z_1 z_r/(z_s z_2)`` for stepped and ``z_r/z_s`` for meshed planets. Losses are those of
    the rolling power ``T_s (n_s - n_c)``: ``T_r = -i_0 eta^w T_s`` with w = 1 where it flows from
    the sun to the ring and w = -1 where it flows back.

    Examples
    --------
    >>> stage = planetary_kinematics(sun_teeth=17, ring_teeth=61, held="ring", input="sun",
    ...                              input_speed=157.08, sun_efficiency=0.985,
    ...                              ring_efficiency=0.992)
    >>> round(stage.ratio, 6), round(stage.efficiency, 6)
    (4.588235, 0.982107)

    Stages in a row: the output of the first drives the second.

    >>> second = planetary_kinematics(sun_teeth=21, ring_teeth=75, held="ring", input="sun",
    ...                               input_speed=stage.output_speed,
    ...                               input_torque=stage.output_torque)
    >>> round(stage.ratio * second.ratio, 6)
    20.97479
    """
    teeth = read_teeth(sun_teeth, ring_teeth, planet_teeth, planet_type)
    require_one_of("held", held, _MEMBERS)
    require_one_of("input", input, _MEMBERS)
    if held == input:
        why = "Power enters by one member and leaves by another one, while the third is held"
        free = " or ".join(f'"{member}"' for member in _MEMBERS if member != held)
        raise InputError(f'input = "{input}" is held', Argument("input"), why, f"Let {free} drive")
    between = planet_efficiency if planet_type == "meshed" else 1.0
    efficiency = _product(sun=sun_efficiency, ring=ring_efficiency, planet=between)
    if planets is not None:
        planetary_positions(
            sun_teeth=sun_teeth, ring_teeth=ring_teeth, planets=planets,
            planet_teeth=planet_teeth, planet_type=planet_type,
        )  # fmt: skip
    output = next(member for member in _MEMBERS if member not in (held, input))
    unit = _speeds(teeth.basic_ratio, held, input)
    torques, rolling = _torques(teeth.basic_ratio, efficiency, unit, (input, output))
    share = -torques[output] * unit[output]
    if share <= 0.0:
        raise InputError(
            f"the stage locks itself: with the {input} driving, {share * 100:.4g} % of its power "
            f"would reach the {output}",
            Argument("input"),
            f"The rolling power is {rolling:.4g} times the power of the input, and "
            f"{(1.0 - efficiency) * 100:.4g} % of it is lost",
            f"Let the {output} drive, or reduce the losses of the meshes",
        )
    speed = require_number("input_speed", input_speed)
    torque = _driving_torque(input_torque, speed)
    speeds = {name: ratio * speed for name, ratio in (unit | _planet_speeds(teeth, unit)).items()}
    loads = {name: ratio * torque for name, ratio in torques.items()}
    relative = {name: value - speeds["carrier"] for name, value in speeds.items()}
    return PlanetaryKinematics(
        held=held,
        input=input,
        output=output,
        speeds=speeds,
        relative_speeds=relative,
        ratio=1.0 / unit[output],
        torques=loads,
        power={name: loads[name] * speeds[name] for name in _MEMBERS},
        rolling_power=rolling * abs(speed * torque),
        efficiency=share,
        mesh_frequency=teeth.sun * abs(relative["sun"]) / (2.0 * math.pi),
    )


def _product(**efficiencies: float) -> float:
    for mesh, value in efficiencies.items():
        require_between(f"{mesh}_efficiency", value, 1e-3, 1.0)
    return math.prod(efficiencies.values())


def _driving_torque(value: float | None, speed: float) -> float:
    if value is None:
        return math.copysign(1.0, speed)
    torque = require_number("input_torque", value)
    if speed * torque < 0.0:
        what = f"input_torque = {torque:.6g} N*m brakes the input, whose speed is {speed:.6g} rad/s"
        why = "The input drives: its torque has the sign of its speed"
        remedy = "Change one sign, or make the driving member the input"
        raise InputError(what, Argument("input_torque"), why, remedy)
    return torque


def _speeds(ratio: float, fixed: str, input: str) -> dict[str, float]:
    """Speeds over that of the input, by ``n_s - i n_r - (1 - i) n_c = 0``."""
    weight = {"sun": 1.0, "ring": -ratio, "carrier": ratio - 1.0}
    output = next(member for member in _MEMBERS if member not in (fixed, input))
    return {fixed: 0.0, input: 1.0, output: -weight[input] / weight[output]}


def _planet_speeds(teeth: PlanetTeeth, speeds: Mapping[str, float]) -> dict[str, float]:
    """Speeds of the planets, the gear at the sun first."""
    if not teeth.planets:
        return {}
    carrier = speeds["carrier"]
    first = carrier - (speeds["sun"] - carrier) * teeth.sun / teeth.planets[0]
    if teeth.type != "meshed":
        return {"planet": first}
    second = carrier + (speeds["ring"] - carrier) * teeth.ring / teeth.planets[1]
    return {"sun_planet": first, "ring_planet": second}


def _torques(
    ratio: float, efficiency: float, speeds: Mapping[str, float], ends: tuple[str, str]
) -> tuple[dict[str, float], float]:
    """Torques over that of the input, and rolling power over the power of the input."""
    # Near a basic ratio of 1 both directions of the rolling power are in balance, and power leaves
    # by the output in one of them.
    driver, output = ends
    solutions = []
    for exponent in (1, -1):  # rolling power from the sun to the ring, or back
        weight = {"sun": 1.0, "ring": -ratio * efficiency**exponent}
        weight["carrier"] = -sum(weight.values())
        torques = {name: weight[name] / weight[driver] for name in _MEMBERS}
        rolling = torques["sun"] * (speeds["sun"] - speeds["carrier"])
        if rolling * exponent >= 0.0:
            solutions.append((torques, abs(rolling)))
    return max(solutions, key=lambda solution: -solution[0][output] * speeds[output])
