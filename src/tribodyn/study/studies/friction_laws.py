"""Comparison of all friction laws at points of the path of contact of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, collected

if TYPE_CHECKING:
    from tribodyn.friction import TribologicalContact
    from tribodyn.study.case.pair import PairCase

#: Compared points of the path of contact, in the order of roll of FZG type A.
PLACES = ("A", "C", "after B", "middle", "before D", "E")


def friction_laws(case: PairCase) -> list[dict[str, Any]]:
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
