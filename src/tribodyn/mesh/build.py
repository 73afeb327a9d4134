"""From a gear pair, its oil and its load to the mesh table of one mesh cycle."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import Kinematics, effective_modulus, hertz_line, path_of_contact
from tribodyn.errors import ComputationError, Problem, require_between, require_positive
from tribodyn.friction import LAWS, TribologicalContact
from tribodyn.gear import Material, SpurPair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.film import film_columns
from tribodyn.mesh.grid import phase_grid
from tribodyn.mesh.table import MeshTable
from tribodyn.stiffness import MODELS

__all__ = ["build"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Largest composite roughness that is a roughness and not a slip of the unit [m].
_LARGEST_ROUGHNESS = 1e-4
_NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})


def build(
    pair: SpurPair,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: Mapping[str, Any] = _NO_OPTIONS,
    lubricant: Lubricant,
    friction_law: str,
    friction_options: Mapping[str, Any] = _NO_OPTIONS,
    composite_roughness: float,
    film_model: str = "none",
    pinion_speed: float,
    pinion_torque: float,
    steps: int = 512,
) -> MeshTable:
    """Compute everything that happens in the tooth contact over one mesh cycle.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position, and which one drives.
    material : Material
        Material of both gears.
    stiffness_model : str
        Name in ``tribodyn.stiffness.MODELS``.
    stiffness_options : mapping
        Options of the stiffness model.
    lubricant : Lubricant
        Oil at working temperature.
    friction_law : str
        Name in ``tribodyn.friction.LAWS``.
    friction_options : mapping
        Options of the friction law.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses; zero for ideal flanks.
    film_model : str
        Name in ``tribodyn.ehl.FILM_MODELS``.
    pinion_speed : float [rad/s]
        Speed of the pinion in the running sense.
    pinion_torque : float [N*m]
        Magnitude of the torque on the pinion.
    steps : int
        Wanted number of phase intervals, at least 16.

    Returns
    -------
    MeshTable

    Raises
    ------
    InputError
        If a value is out of range or a model unknown.
    ComputationError
        If the load share does not settle, or a pair in contact has no stiffness.

    Notes
    -----
    Loads are quasi-static: pairs deflect alike, so each carries a share in proportion to its
    secant stiffness. Hertz pressure, film and friction of a pair come from its own share. Source:
    the single laws, each named in its function.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> build(pair, material=Material(), stiffness_model="rectangular",
    ...       stiffness_options={"pair_stiffness": 5e8}, lubricant=Lubricant(0.08, 880.0, 2e-8),
    ...       friction_law="constant", friction_options={"coefficient": 0.05},
    ...       composite_roughness=0.0, pinion_speed=100.0, pinion_torque=90.0)  # doctest: +ELLIPSIS
    MeshTable(contact ratio 1.5477, mesh frequency 270.6 Hz, mean stiffness 7.739e+08 N/m, ...)
    """
    require_positive("pinion_speed", pinion_speed, "rad/s")
    require_positive("pinion_torque", pinion_torque, "N*m")
    require_between("composite_roughness", composite_roughness, 0.0, _LARGEST_ROUGHNESS, "m")
    contact = path_of_contact(pair)
    grid = phase_grid(contact.event_phases(), steps)
    middle, in_contact = contact.pair_paths(grid.middle)
    # Advance from the middle of the segment, so that both of its ends keep its pairs.
    path = middle + contact.direction * pair.base_pitch * (grid.phase - grid.middle)[:, None]
    total_force = pinion_torque / pair.pinion.base_radius
    stiffness = MODELS[stiffness_model](
        pair, material, path, in_contact, grid.phase, total_force, **stiffness_options
    )
    share = _load_share(stiffness, in_contact, stiffness_model)
    load = total_force * share[in_contact] / pair.common_face_width
    motion = contact.kinematics(path[in_contact], pinion_speed)
    tribology = _tribology(motion, load, material, lubricant, composite_roughness)
    touching: dict[str, FloatArray] = {
        **_motion_columns(motion),
        # A pair slides one way throughout a segment; at the pitch point itself it would be 0.
        "sliding_direction": contact.sliding_direction(middle[in_contact]),
        "load_per_width": tribology.load_per_width,
        "hertz_pressure": tribology.hertz_pressure,
        "friction_coefficient": LAWS[friction_law](tribology, **friction_options),
        **film_columns(film_model, tribology, material, lubricant),
    }
    return MeshTable(
        grid=grid,
        path=path,
        in_contact=in_contact,
        stiffness=stiffness,
        load_share=share,
        normal_force=total_force * share,
        gear_pair=pair,
        pinion_speed=float(pinion_speed),
        pinion_torque=float(pinion_torque),
        composite_roughness=float(composite_roughness),
        stiffness_model=stiffness_model,
        friction_law=friction_law,
        film_model=film_model,
        **_spread(touching, in_contact),
    )


def _load_share(stiffness: FloatArray, in_contact: BoolArray, model: str) -> FloatArray:
    """Share of each pair; models of third parties are checked here once for all."""
    found = np.asarray(stiffness)
    sound = found.shape == in_contact.shape and bool(
        np.all(np.where(in_contact, np.isfinite(found) & (found > 0.0), found == 0.0))
    )
    if not sound:
        raise ComputationError(
            Problem(
                what=f'the stiffness model "{model}" gave no usable pair stiffness',
                where="stiffness of the tooth pairs",
                why="It must be finite and positive where a pair is in contact, zero elsewhere",
                remedy="Check the options of the model, or choose another",
            )
        )
    share: FloatArray = found / found.sum(axis=1, keepdims=True)
    return share


def _tribology(
    motion: Kinematics,
    load_per_width: FloatArray,
    material: Material,
    lubricant: Lubricant,
    composite_roughness: float,
) -> TribologicalContact:
    modulus = effective_modulus(material, material)
    hertz = hertz_line(load_per_width, motion.equivalent_radius, modulus)
    return TribologicalContact(
        load_per_width=load_per_width,
        hertz_pressure=hertz.maximum_pressure,
        sliding_speed=motion.sliding_speed,
        entrainment_speed=motion.entrainment_speed,
        slide_to_roll_ratio=motion.slide_to_roll_ratio,
        equivalent_radius=motion.equivalent_radius,
        dynamic_viscosity=lubricant.dynamic_viscosity,
        composite_roughness=composite_roughness,
    )


def _motion_columns(motion: Kinematics) -> dict[str, FloatArray]:
    return {
        "sliding_speed": motion.sliding_speed,
        "entrainment_speed": motion.entrainment_speed,
        "slide_to_roll_ratio": motion.slide_to_roll_ratio,
        "equivalent_radius": motion.equivalent_radius,
        "pinion_curvature_radius": motion.pinion_curvature_radius,
        "wheel_curvature_radius": motion.wheel_curvature_radius,
    }


def _spread(touching: dict[str, FloatArray], in_contact: BoolArray) -> dict[str, Any]:
    """Put the values of the touching pairs in their places, with zeros elsewhere."""
    columns: dict[str, Any] = dict.fromkeys(("central_film", "minimum_film", "film_ratio"))
    for name, values in touching.items():
        columns[name] = np.zeros(in_contact.shape)
        columns[name][in_contact] = values
    return columns
