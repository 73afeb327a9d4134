"""Studies of a case at rest: transmission error over torque, best flanks, teeth and film."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, shortened
from tribodyn.nomenclature import GEARS, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.record import record
from tribodyn.stiffness import LeadOptimum, TipReliefOptimum
from tribodyn.study.case.gears import Modification
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.mesh_inputs import mesh_inputs, model_settings
from tribodyn.study.pipeline.tooth_contact import (
    hypoid_loaded_contact_of,
    loaded_settings,
    read_speeds,
    read_torques,
)
from tribodyn.study.studies.needs import mesh_pair
from tribodyn.types import Tree
from tribodyn.units import format_quantity

if TYPE_CHECKING:
    from tribodyn.mesh import ComprehensiveStiffness, FilmOverOperation
    from tribodyn.stiffness import HarrisMap
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase


#: Torques of a map over those of the case.
_RANGE = (0.1, 2.0)
_TORQUES = 20
#: Phases of a mesh cycle of a hypoid pair, least and most.
_PHASES = (16, 2000)
#: Significant digits of an optimal relief or lead: finer ones can neither be drawn nor ground.
_DIGITS = 4


@dataclass(frozen=True, repr=False, eq=False)
class OptimumOfCase(ABC):
    """Best flanks of a case: ``case`` is the case with them."""

    studied: Any = None
    tables: tuple[str, str] = ("gears.pinion", "gears.wheel")

    def _of_gears(self, gears: str, values: dict[str, str]) -> dict[str, str]:
        """Values of the modification of one gear or of both, by key of the case."""
        tables = dict(zip(GEARS, self.tables, strict=True))
        modified = tables.values() if gears == "both" else (tables[gears],)
        return {f"{gear}.modification.{n}": v for gear in modified for n, v in values.items()}

    @property
    @abstractmethod
    def changes(self) -> dict[str, str]:
        """Modification by key of the case, as text in the units of the file."""

    @property
    def case(self) -> AnyCase:
        """The case that was studied, with its best flanks."""
        changed: AnyCase = self.studied.replace(self.changes)
        return changed


@record
class CaseTipReliefOptimum(OptimumOfCase, TipReliefOptimum):
    """Best tip relief of a case."""

    @property
    def changes(self) -> dict[str, str]:
        """Relief by key of the case, as text in the units of the file."""
        values = {
            "tip_relief": format_quantity(self.amount, "m", "um"),
            "tip_relief_length": format_quantity(self.length, "m", "mm"),
            "tip_relief_shape": self.shape,
        }
        return self._of_gears(self.gears, values)


@record
class CaseLeadOptimum(OptimumOfCase, LeadOptimum):
    """Best crowning and lead slope of a case."""

    @property
    def changes(self) -> dict[str, str]:
        """Crowning and lead slope by key of the case, as text in the units of the file."""
        values = {name: getattr(self, name) for name in ("crowning", "lead_slope")}
        return self._of_gears(
            self.gear, {name: format_quantity(value, "m", "um") for name, value in values.items()}
        )


def harris_map(
    case: AnyCase, torque: object = None, *, phases: int | None = None, mesh: str | None = None
) -> HarrisMap:
    """Find the static transmission error of a case over phase and torque (Harris map).

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[stiffness]`` sets the compliance of the teeth,
        ``gears.line_stiffness`` that of hypoid gears.
    torque : list of float or str, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        By default 20 of them up to twice that of the case.
    phases : int, optional
        Evenly spaced phases of a mesh cycle; 256 by default, or 64 where flanks vary over the face
        width or from tooth to tooth, and 100 of hypoid gears.
    mesh : str, optional
        Mesh of a machine or a stage, whose pair of gears is studied as its shafts are deflected at
        the operating point; torques and speeds are then those of its pinion.

    Returns
    -------
    HarrisMap
        Torques in it are those of the pinion; without oil film.

    Raises
    ------
    InputError
        If a torque is out of range.
    ComputationError
        If a load is beyond what the tooth contact covers.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> errors = harris_map(case, torque=["60 N*m", "120 N*m"])
    >>> bool(errors.peak_to_peak_transmission_error[0] < errors.peak_to_peak_transmission_error[1])
    True
    """
    from tribodyn.stiffness import transmission_error_over_torque

    case = mesh_pair("harris", case, mesh).pair
    torques = read_torques(case, torque)
    if torque is None:
        torques = list(np.linspace(*_RANGE, _TORQUES) * torques[0])
    if case.hypoid_flanks is not None:
        return _hypoid_map(case, torques, phases)
    with locate_errors(case):
        return transmission_error_over_torque(
            case.gear_pair, torques, phases=phases, **loaded_settings(case)
        )


def _hypoid_map(case: PairCase, torques: list[float], phases: int | None) -> HarrisMap:
    from tribodyn.mesh.hypoid.table import hypoid_transmission_error_over_torque

    if phases is not None:
        require_between("phases", require_whole("phases", phases), *_PHASES)
    steps: Tree = {} if phases is None else {"steps": phases}
    loaded = hypoid_loaded_contact_of(mesh_inputs(case), **steps)
    return hypoid_transmission_error_over_torque(loaded, torques)


def optimize_tip_relief(
    case: AnyCase,
    torque: object = None,
    *,
    amount: object = None,
    length: object = None,
    mesh: str | None = None,
    **options: object,
) -> CaseTipReliefOptimum:
    """Find the tip relief of a case that leaves least transmission error over a torque range.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    torque : tuple or list, optional
        Two ends of a range, or more torques, on the gear named by ``operation.speed_of``: floats
        in N*m, or text with a unit. By default from half the torque of the case to all of it.
    amount, length : tuple, optional
        Least and greatest amount and roll length: floats in m, or text with a unit.
    mesh : str, optional
        Mesh of a machine or a stage, whose pair of gears is studied as its shafts are deflected at
        the operating point; torques and speeds are then those of its pinion.
    **options : object
        ``gears``, ``shape``, ``objective``, ``weight``, ``grid``, ``phases`` and ``digits`` of
        :func:`tribodyn.stiffness.optimize_tip_relief`; amount and length have four significant
        digits by default.

    Returns
    -------
    TipReliefOptimum
        Torques in it are those of the pinion; ``case`` is the case with the relief.

    Raises
    ------
    InputError
        If a value is out of range, or a relief longer than the flank.
    ComputationError
        If a load is beyond what the tooth contact covers.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> best = optimize_tip_relief(case, ("60 N*m", "120 N*m"), phases=16)
    >>> bool(best.objective < best.objective_before)
    True
    """
    from tribodyn.stiffness import optimize_tip_relief as compute

    pair, tables = mesh_pair("relief", case, mesh)
    torques = read_torques(pair, torque)
    if torque is None:
        torques = [0.5 * torques[0], torques[0]]
    with locate_errors(pair):
        optimum = compute(
            pair.gear_pair,
            torques,
            amount=_lengths("amount", amount),
            length=_lengths("length", length),
            **{**loaded_settings(pair), "digits": _DIGITS, **options},
        )
    return CaseTipReliefOptimum(**vars(optimum), studied=case, tables=tables)


def optimize_lead(
    case: AnyCase,
    torque: object = None,
    *,
    crowning: object = None,
    lead_slope: object = None,
    misalignment: object = None,
    mesh: str | None = None,
    progress: Progress = SILENT,
    **options: object,
) -> CaseLeadOptimum:
    """Find the crowning and the lead slope of a case that spread its load most evenly.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    torque : tuple or list, optional
        Two ends of a range, or more torques, on the gear named by ``operation.speed_of``: floats
        in N*m, or text with a unit. By default that of the case.
    crowning, lead_slope : tuple, optional
        Least and greatest value: floats in m, or text with a unit.
    misalignment : float or str, optional
        Misalignment at the greatest torque besides that of the case, which grows with the torque:
        a float in m, or text with a unit.
    mesh : str, optional
        Mesh of a machine or a stage, whose pair of gears is studied as its shafts are deflected at
        the operating point; torques and speeds are then those of its pinion.
    progress : Progress
        Receives every form of the face that is examined; silent by default.
    **options : object
        ``gear``, ``objective``, ``weight``, ``phases`` and ``slices`` of
        :func:`tribodyn.stiffness.optimize_lead`.

    Returns
    -------
    LeadOptimum
        Torques in it are those of the pinion; ``case`` is the case with the better face, with four
        significant digits.

    Raises
    ------
    InputError
        If a value is out of range.
    ComputationError
        If a load is beyond what the tooth contact covers.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "iso6336"})
    >>> best = optimize_lead(case, misalignment="10 um", slices=8)
    >>> bool(best.face_load_factor_after.max() < best.face_load_factor_before.max())
    True
    """
    from tribodyn.stiffness import optimize_lead as compute

    pair, tables = mesh_pair("lead", case, mesh)
    ranges = {"crowning": crowning, "lead_slope": lead_slope}
    lengths = {name: _lengths(name, ends) for name, ends in ranges.items() if ends is not None}
    lean = 0.0 if misalignment is None else _length("misalignment", "lead_slope", misalignment)
    settings = loaded_settings(pair)
    del settings["extended_contact"]  # the path of contact does not depend on the face
    with locate_errors(pair):
        optimum = compute(
            pair.gear_pair,
            read_torques(pair, torque),
            misalignment=lean,
            progress=progress,
            **{**lengths, **settings, **options},
        )
    rounded = {name: float(f"{getattr(optimum, name):.{_DIGITS}g}") for name in ranges}
    return CaseLeadOptimum(**{**vars(optimum), **rounded}, studied=case, tables=tables)


def _length(name: str, key: str, value: object) -> float:
    """Read a length with the limits of a key of a modification."""
    try:
        return float(read_value(dict(Modification.specs())[key], name, Plain(value)))
    except FaultError as fault:
        raise InputError(replace(fault.problem, where=f"argument {name}")) from None


def _lengths(name: str, ends: Any) -> tuple[float, float] | None:
    """Read the two ends of a range of lengths."""
    if ends is None:
        return None
    key = {"amount": "tip_relief", "length": "tip_relief_length"}.get(name, name)
    try:
        low, high = ends
    except (TypeError, ValueError):
        what, why = f"{name} = {shortened(repr(ends))}", "It is a range of lengths"
        raise InputError(what, Argument(name), why, 'Give ("0 um", "40 um")') from None
    return _length(name, key, low), _length(name, key, high)


def comprehensive_stiffness(
    case: AnyCase,
    *,
    torque: object = None,
    speed: object = None,
    kind: str | None = None,
    steps: int = 128,
    mesh: str | None = None,
    progress: Progress = SILENT,
) -> ComprehensiveStiffness:
    """Find the stiffness of oil film and teeth of a case over torques and speeds.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[film]`` says how the film is found.
    torque : float, str or list, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        By default that of the case.
    speed : float, str or list, optional
        Speeds of that gear: floats in rad/s, or text with a unit. By default that of the case.
    kind : str, optional
        ``"approach"``, ``"tangent"``, ``"secant"`` or ``"seed"``; by default ``film.stiffness`` of
        the case. Where that is ``"none"``, the first of these that the film model has.
    steps : int
        Phase intervals of a mesh cycle.
    mesh : str, optional
        Mesh of a machine or a stage, whose pair of gears is studied as its shafts are deflected at
        the operating point; torques and speeds are then those of its pinion.
    progress : Progress
        Receives the number of solved films; silent by default.

    Returns
    -------
    ComprehensiveStiffness
        Torques and speeds in it are those of the pinion.

    Raises
    ------
    InputError
        If a torque or speed is out of range, or the case has no film model.
    ComputationError
        If a film cannot be solved.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-film").replace({"film.model": "moes"})
    >>> stiffness = comprehensive_stiffness(case, torque=["50 N*m", "300 N*m"])
    >>> bool(stiffness.mean_mesh_stiffness[0, 0] < stiffness.mean_mesh_stiffness[1, 0])
    True
    """
    from tribodyn.ehl import FILM_MODELS
    from tribodyn.mesh import comprehensive_stiffness as compute

    case = mesh_pair("film", case, mesh).pair
    settings = model_settings(case)
    settings.pop("composite_roughness")
    kinds = [case.film.stiffness, *FILM_MODELS[case.film.model].stiffness_kinds]
    with locate_errors(case):
        return compute(
            case.gear_pair,
            pinion_torque=read_torques(case, torque),
            pinion_speed=read_speeds(case, speed),
            kind=kind or next((name for name in kinds if name != "none"), "none"),
            steps=steps,
            progress=progress,
            **settings,
        )


def film_over_operation(
    case: AnyCase,
    *,
    torque: object = None,
    speed: object = None,
    mesh: str | None = None,
    progress: Progress = SILENT,
) -> FilmOverOperation:
    """Find the films of a case along the path of contact, for every torque at every speed.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[film]`` says how the film is found.
    torque, speed, mesh, progress
        As :func:`comprehensive_stiffness` takes them.

    Returns
    -------
    FilmOverOperation
        Torques and speeds in it are those of the pinion.

    Raises
    ------
    InputError
        If a torque or speed is out of range, or the case has no film model.
    ComputationError
        If a film cannot be solved.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"film.model": "moes"})
    >>> films = film_over_operation(case, torque=["50 N*m", "150 N*m"], speed=[90.0, 180.0])
    >>> films.central_film.shape
    (2, 2, 30)
    """
    from tribodyn.mesh import film_over_operation as compute

    case = mesh_pair("film", case, mesh).pair
    if case.film.model == "none":
        remedy = 'Choose one: case.replace({"film.model": "newton"})'
        raise InputError('film.model = "none"', "argument case", "No film", remedy)
    pair = case.gear_pair
    with locate_errors(case):
        return compute(
            pair,
            pinion_torque=read_torques(case, torque),
            pinion_speed=read_speeds(case, speed),
            progress=progress,
            **model_settings(case),
        )
