"""The oil film of a case over torques and speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError, Problem
from tribodyn.progress import SILENT, Progress
from tribodyn.study.operating_points import pinion_speeds, pinion_torques
from tribodyn.study.places import placed
from tribodyn.study.tooth_contact import model_settings

if TYPE_CHECKING:
    from tribodyn.mesh import FilmOverOperation
    from tribodyn.study.case import Case


def film_over_operation(
    case: Case,
    *,
    torque: Any = None,
    speed: Any = None,
    progress: Progress = SILENT,
) -> FilmOverOperation:
    """Find the films of a case along the path of contact, for every torque at every speed.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[film]`` says how the film is found.
    torque : float, str or list, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        That of the case where absent.
    speed : float, str or list, optional
        Speeds of that gear: floats in rad/s, or text with a unit. That of the case where absent.
    progress : Progress
        Told how many films are solved; silent by default.

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

    if case.film.model == "none":
        remedy = 'Choose one: case.replace({"film.model": "newton"})'
        raise InputError(Problem('film.model = "none"', "argument case", "No film", remedy))
    pair = case.gear_pair
    with placed(case):
        return compute(
            pair,
            pinion_torque=pinion_torques(case, torque),
            pinion_speed=pinion_speeds(case, speed),
            progress=progress,
            **model_settings(case),
        )
