"""The one pipeline: case, gear pair, mesh cycle, motion, result."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from tribodyn.progress import SILENT, Progress
from tribodyn.study import derive
from tribodyn.study.assembly import mesh_law_of, system_of
from tribodyn.study.cautions import case_cautions, mesh_cautions, motion_cautions, teeth_cautions
from tribodyn.study.collect import collected
from tribodyn.study.damping import damping_of
from tribodyn.study.motion import motion_of
from tribodyn.study.options import TABLE_FORMS, model_options
from tribodyn.study.places import placed
from tribodyn.study.provenance import effective
from tribodyn.study.result import Result

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case import Case

__all__ = ["model_settings", "run"]


def run(case: Case, progress: Progress = SILENT, *, stacklevel: int = 2) -> Result:
    """Compute a case.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    progress : Progress
        Told how far the run has come; silent by default.
    stacklevel : int
        Frames to skip in warnings, as in :func:`warnings.warn`.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        If the case cannot be computed as it stands.
    ComputationError
        If no steady motion is found.

    Warns
    -----
    ModelWarning
        Everything that the models said, once each; also kept in ``Result.warnings``.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> result = run(case)  # doctest: +SKIP
    """
    with placed(case), collected() as found:
        progress.start("tooth contact")
        mesh = _mesh(case, progress)
        damping = damping_of(case, mesh)
        system = system_of(case, mesh, damping)
        progress.finish()
        response = motion_of(case, system, mesh.mesh_frequency, progress)
    noticed = (*mesh_cautions(mesh), *motion_cautions(case, system, response))
    everything = (*case_cautions(case), *teeth_cautions(case), *found, *noticed)
    told = tuple({str(warning): warning for warning in everything}.values())
    for warning in told:
        warnings.warn(warning, stacklevel=stacklevel)
    return Result(case, mesh, system, response, damping, told)


def _options(case: Case, section: str, name: str) -> dict[str, Any]:
    """Options in force of a film model, stiffness model or friction law, as the model has them."""
    values = effective(case)
    found = {key: values[f"{section}.{key}"] for key in model_options(section, name)}
    given = {key: value for key, value in found.items() if value is not None}
    if section == "stiffness" and name == "table":
        form = next(form for form in TABLE_FORMS if form in given)
        given[TABLE_FORMS[form]] = given.pop("values")
    return given


def model_settings(case: Case) -> dict[str, Any]:
    """Material, oil, stiffness and film of a case, as the mesh asks for them.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    dict of str to object
        Keywords of :func:`tribodyn.mesh.build`.
    """
    return {
        "material": case.material_properties,
        "stiffness_model": case.stiffness.model,
        "stiffness_options": _options(case, "stiffness", case.stiffness.model),
        "lubricant": case.lubricant_properties or derive.unused_lubricant(),
        "composite_roughness": case.composite_roughness or 0.0,
        "film_model": case.film.model,
        "film_options": _options(case, "film", case.film.model),
    }


def _mesh(case: Case, progress: Progress = SILENT) -> MeshTable:
    """Compute the tooth contact of a case over one mesh cycle."""
    from tribodyn.mesh import build

    return build(
        case.gear_pair,
        friction_law=case.friction.law,
        friction_options=_options(case, "friction", case.friction.law),
        pinion_speed=case.pinion_speed,
        pinion_torque=case.pinion_torque,
        force_law=mesh_law_of(case) == "force-law",
        progress=progress,
        **model_settings(case),
    )
