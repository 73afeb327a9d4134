"""The loaded tooth contact of a case at rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.study.case.derive import placed
from tribodyn.study.pipeline.tooth_contact import model_settings
from tribodyn.study.studies.axes import pinion_torques

if TYPE_CHECKING:
    from tribodyn.gear import SpurPair
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.case.case import Case
    from tribodyn.types import Array

_PHASES = 64  #: phases of a mesh cycle


def loaded_settings(case: Case) -> dict[str, Any]:
    """Provider, its options and the material of a case, as the loaded tooth contact has them."""
    settings = model_settings(case)
    options = dict(settings["stiffness_options"])
    return {
        "provider": settings["stiffness_model"],
        "extended_contact": bool(options.get("extended_contact", False)),
        "material": settings["material"],
        "options": options,
    }


def phases_of_turns(pair: SpurPair) -> Array:
    """Phases until all repeats: shorter than the hunting period where one gear is even."""
    gears = (pair.pinion, pair.wheel)
    turns = math.lcm(*(gear.teeth for gear in gears if gear.modification.teeth_differ))
    return np.arange(_PHASES * turns) / _PHASES


def loaded_contact(
    case: Case, *, torque: Any = None, phases: int | Array = _PHASES
) -> LoadedContact:
    """Find load sharing, transmission error and stiffness of a case under torques at rest.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[stiffness]`` says how the teeth give way.
    torque : float, str or list, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        That of the case where absent.
    phases : int or array (p,)
        Evenly spaced phases of a mesh cycle, or the phases themselves.

    Returns
    -------
    LoadedContact
        Torques in it are those of the pinion; without oil film.

    Raises
    ------
    InputError
        If a torque is out of range.
    ComputationError
        If the load is beyond what the tooth contact covers.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> mesh = loaded_contact(case, torque=["90 N*m", "150 N*m"])
    >>> mesh.peak_to_peak_transmission_error.shape
    (2,)
    """
    from tribodyn.stiffness import loaded_contact as compute

    values = pinion_torques(case, torque)
    single = torque is None or isinstance(torque, int | float | str)
    with placed(case):
        return compute(
            case.gear_pair, values[0] if single else values, phases=phases, **loaded_settings(case)
        )
