"""Losses of a case over torque and speed, power flow of a rig, all friction laws compared."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import InputError, ModelWarning, collected, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.pipeline.preview import gearbox_losses_of
from tribodyn.study.pipeline.tooth_contact import mesh_of, read_speeds, read_torques
from tribodyn.study.studies.needs import mesh_pair, require
from tribodyn.study.studies.runner import run_each
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.friction import TribologicalContact
    from tribodyn.losses import GearboxLosses, RigPowerFlow
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase

#: Torques and speeds of a map relative to those of the case, which is one of the points.
STEPS = np.linspace(0.25, 2.0, 8)


def loss_map(
    case: AnyCase,
    *,
    torque: object = None,
    speed: object = None,
    mesh: str | None = None,
    progress: Progress = SILENT,
) -> GearboxLosses:
    """Find the losses and the efficiency of a case for every torque at every speed.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`. Teeth lose by its ``[friction]``, shafts and oil by its
        ``[losses]``; without that table the teeth alone are counted.
    torque, speed : float, str or list, optional
        Torques [N*m] and speeds [rad/s] of the gear named by ``operation.speed_of``, or text with
        a unit. By default 8 of each up to twice those of the case.
    mesh : str, optional
        Mesh of a machine or a stage, whose pair of gears is studied as its shafts are deflected at
        the operating point; torques and speeds are then those of its pinion.
    progress : Progress
        Receives the number of finished torques; silent by default.

    Returns
    -------
    GearboxLosses
        Torques and speeds in it are those of the pinion. Loads of the teeth are quasi-static.

    Raises
    ------
    InputError
        If a value is out of range, or the case has a mesh table instead of gears.
    ComputationError
        If the tooth contact cannot be computed at a point.

    Warns
    -----
    ModelWarning
        Warnings of the models, each code once, with the number of points that raised it.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"friction.law": "schlenk"})
    >>> losses = loss_map(case, torque=["50 N*m", "300 N*m"], speed="900 rpm")
    >>> losses.gear_efficiency.round(4).tolist()
    [[0.9889], [0.9841]]
    """
    case = mesh_pair("losses", case, mesh).pair
    torques, speeds = read_torques(case, torque), read_speeds(case, speed)
    torques = torques if torque is not None else list(STEPS * torques[0])
    speeds = speeds if speed is not None else list(STEPS * speeds[0])
    turns = case.speed_ratio

    def lost_under(torque: float) -> list[tuple[float, dict[str, ModelWarning]]]:
        lost = []
        for turning in speeds:  # one after the other: they share the teeth under their load
            keys = {"operation.torque": torque * turns, "operation.speed": turning / turns}
            with locate_errors(case), collected() as point_warnings:
                mesh = mesh_of(case.replace(keys), friction_alone=True)
            lost.append((mesh.mean_friction_power, {each.code: each for each in point_warnings}))
        return lost

    rows = run_each(lost_under, torques, task="Tooth contact", progress=progress)
    points = [point for row in rows for point in row]
    _warn_once([each for _, warned in points for each in warned.values()], len(points))
    lost = np.array([[value for value, _ in row] for row in rows])
    with locate_errors(case):
        return gearbox_losses_of(case, lost, pinion_torque=torques, pinion_speed=speeds)


def _warn_once(model_warnings: Iterable[ModelWarning], points: int) -> None:
    """Raise each warning once, with the message of its first point and the number of points."""
    first: dict[str, list[ModelWarning]] = {}
    for warning in model_warnings:
        first.setdefault(warning.code, []).append(warning)
    for code, repeated in first.items():
        count_text = f" This holds at {len(repeated)} of {points} points." if points > 1 else ""
        warn(code, repeated[0].message + count_text, stacklevel=3)


def rig_power_flow(case: PairCase, slave: PairCase | None = None) -> RigPowerFlow:
    """Find the power flow of a back-to-back rig that tests the gears of a case.

    Parameters
    ----------
    case : PairCase
        The test gearbox with its ``[losses]``.
    slave : PairCase, optional
        The gearbox that closes the loop, at the same torque and speed of the pinion; by default
        the same as the test gearbox.

    Raises
    ------
    InputError
        If both cases are not at one torque and speed, or one has a mesh table instead of gears.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"friction.law": "schlenk"})
    >>> rig_power_flow(case)
    RigPowerFlow(motor 211.92 W for 8482.3 W in the loop)
    """
    from tribodyn.losses import rig_power_flow as compute

    require("losses --rig", case)
    gearboxes = []
    for gearbox_case in (case, case if slave is None else slave):
        with locate_errors(gearbox_case), collected() as model_warnings:
            gearboxes.append(
                gearbox_losses_of(
                    gearbox_case, mesh_of(gearbox_case, friction_alone=True).mean_friction_power
                )
            )
        _warn_once(model_warnings, 1)
    return compute(*gearboxes)


#: Compared points of the path of contact, in the order of roll of FZG type A.
PLACES = ("A", "C", "after B", "middle", "before D", "E")


def friction_laws(case: PairCase) -> list[Tree]:
    """List each law with meaning, source, options, coefficients at PLACES and range check."""
    from tribodyn.friction import LAWS

    contact = _contacts(case)
    rows = []
    for name in LAWS:
        law = LAWS[name]
        coefficients, inside, missing = None, None, ""
        with collected() as warnings:
            try:
                coefficients = [round(float(value), 6) for value in law(contact)]
                inside = not warnings
            except InputError as error:
                solved = 'needs a solved film: film.model = "newton"'
                reason = "; ".join(problem.what for problem in error.problems)
                missing = solved if law.needs_film else reason
        rows.append(
            {
                "law": name,
                "meaning": law.meaning,
                "source": law.source,
                "options": ", ".join(law.case_options),
                "coefficients": coefficients,
                "in_range": inside,
                "missing": missing,
            }
        )
    return rows


def _contacts(case: PairCase) -> TribologicalContact:
    """Contacts of a tooth pair at PLACES; pairs in contact share the load equally."""
    from tribodyn.contact import effective_modulus, equal_share, hertz_line, path_of_contact
    from tribodyn.ehl import FILM_MODELS
    from tribodyn.friction import TribologicalContact, pitch_point

    pair, oil = case.gear_pair, case.film_lubricant
    assert oil is not None
    path = path_of_contact(pair)
    step = 1e-9 * path.direction * pair.base_pitch
    where = [path.A, path.C, path.B + step, 0.5 * (path.B + path.D), path.D - step, path.E]
    positions = np.array(where)
    inside = np.clip(positions, min(path.A, path.E) + abs(step), max(path.A, path.E) - abs(step))
    motion = path.kinematics(inside, case.operating_point[0])
    point = pitch_point(pair, *case.operating_point)
    load = point.load_per_width * equal_share(path, inside)
    modulus = effective_modulus(case.material_properties, case.material_properties)
    film = FILM_MODELS["dowson-higginson"].films(
        load,
        motion.equivalent_radius,
        motion.entrainment_speed,
        oil,
        modulus,
        length=pair.common_face_width,
    )
    return TribologicalContact(
        load_per_width=load,
        hertz_pressure=hertz_line(load, motion.equivalent_radius, modulus).maximum_pressure,
        sliding_speed=motion.sliding_speed,
        entrainment_speed=motion.entrainment_speed,
        slide_to_roll_ratio=motion.slide_to_roll_ratio,
        equivalent_radius=motion.equivalent_radius,
        dynamic_viscosity=oil.dynamic_viscosity,
        composite_roughness=case.composite_roughness or 0.0,
        oil_density=oil.density,
        film_thickness=film.minimum_film,
        pitch=point,
        central_film=film.central_film,
    )
