"""Types of the natural modes of a planetary stage."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tribodyn.checks import require_number
from tribodyn.dynamics.linear.natural_modes import NaturalModes
from tribodyn.errors import Argument, InputError
from tribodyn.machine.planetary.plane_model import CENTRAL

ModeType = Literal["rotational", "translational", "planet", "mixed"]


def planetary_mode_types(modes: NaturalModes, tolerance: float = 1e-6) -> tuple[ModeType, ...]:
    """Classify the natural modes of a plane model by their shapes.

    Parameters
    ----------
    modes : NaturalModes
        Modes of a system of :func:`planetary_plane_model`.
    tolerance : float
        Amplitude, over that of the mode, below which carrier, ring and sun are at rest;
        amplitudes are weighted by the root of the mass.

    Returns
    -------
    tuple of str
        ``rotational`` where carrier, ring and sun only turn, ``translational`` where they only
        translate, ``planet`` where they are at rest, ``mixed`` where they turn and translate.

    Raises
    ------
    InputError
        If the modes are not those of a plane model.

    Examples
    --------
    >>> import tribodyn as td
    >>> stage = td.machine.planetary_plane_model(
    ...     planets=4, carrier_mass=5.43, carrier_inertia=6.29, ring_mass=2.35, ring_inertia=3.0,
    ...     sun_mass=0.4, sun_inertia=0.39, planet_mass=0.66, planet_inertia=0.61,
    ...     sun_mesh_stiffness=5e8, ring_mesh_stiffness=5e8, pin_stiffness=1e8,
    ...     carrier_support=1e8, ring_support=1e8, sun_support=1e8, ring_torsional_support=1e9,
    ...     sun_pressure_angle=0.4294, ring_pressure_angle=0.4294)
    >>> td.machine.planetary_mode_types(td.dynamics.natural_modes(stage))[5:8]
    ('rotational', 'planet', 'translational')
    """
    limit = require_number("tolerance", tolerance)
    expected = tuple(f"{member}_{axis}" for member in CENTRAL for axis in "xyu")
    if modes.names[:9] != expected:
        what = f"the coordinates are {', '.join(modes.names[:3])}, ..."
        why = f"A plane model begins with {', '.join(expected[:3])}"
        remedy = "Give natural_modes(planetary_plane_model(...))"
        raise InputError(what, Argument("modes"), why, remedy)
    amplitude = np.sqrt(np.abs(modes.kinetic_share[:, :9]))
    turns = amplitude[:, 2::3].max(axis=1) > limit
    moves = np.maximum(amplitude[:, 0::3], amplitude[:, 1::3]).max(axis=1) > limit
    types: dict[tuple[bool, bool], ModeType] = {
        (True, False): "rotational",
        (False, True): "translational",
        (False, False): "planet",
        (True, True): "mixed",
    }
    return tuple(types[bool(turn), bool(move)] for turn, move in zip(turns, moves, strict=True))
