"""A pair that loses contact near its resonance: every steady state ends, with an orbit or a word.

With the force law of the teeth its ramps open and close together, which once made the search for
their crossings go on for ever.
"""

import random
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.ehl import solve_line_contacts
from tribodyn.errors import ComputationError, ModelWarning, quiet
from tribodyn.study import read_case

Draws = Callable[[int], Iterator[random.Random]]

PAIR = """
[gears]
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
driver = "pinion"
[gears.pinion]
teeth = 25
face_width = "30 mm"
bore_diameter = "30 mm"
[gears.wheel]
teeth = 57
bore_diameter = "30 mm"
[operation]
speed = "9700 rpm"
torque = "60 N*m"
[friction]
law = "none"
[dynamics]
model = "torsional"
mesh_damping_ratio = 0.02
backlash = "0.05 mm"
"""


def computed(changes: dict[str, Any]) -> td.Result:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # the flanks do part
        return td.run(read_case(PAIR).replace(changes))


def solved(changes: dict[str, Any]) -> dict[str, Any]:
    return computed(changes).summary()


@pytest.mark.parametrize("law", ["force-law", "tangent"])
@pytest.mark.parametrize("speed", [9100, 9600, 9700, 9800, 10800])
def test_the_orbit_is_that_of_finer_steps(speed: int, law: str) -> None:
    def orbit(steps: int) -> dict[str, Any]:
        return solved(
            {
                "operation.speed": f"{speed} rpm",
                "dynamics.mesh_law": law,
                "solver.steps_per_mesh_cycle": steps,
            }
        )

    coarse, fine = orbit(512), orbit(1024)
    assert coarse["steady_state_error"] < 1e-6
    assert fine["steady_state_error"] < 1e-6
    assert coarse["rms_mesh_force"] == pytest.approx(fine["rms_mesh_force"], rel=1e-4)


def near_resonance(chance: random.Random) -> dict[str, Any]:
    changes = {
        "gears.pinion.teeth": chance.randint(18, 40),
        "gears.wheel.teeth": chance.randint(41, 80),
        "operation.torque": f"{chance.uniform(20, 300):.4g} N*m",
        "dynamics.mesh_damping_ratio": round(chance.uniform(0.01, 0.06), 4),
        "dynamics.backlash": f"{chance.uniform(0.02, 0.2):.3g} mm",
        "dynamics.mesh_law": chance.choice(["force-law", "tangent", "stiffness"]),
    }
    with quiet():
        modes = td.natural_modes(read_case(PAIR).replace(changes))
    natural_frequency = modes.frequency[int(np.argmax(modes.contact_share))]
    speed = natural_frequency * chance.uniform(0.4, 1.2) / changes["gears.pinion.teeth"] * 60.0
    return {**changes, "operation.speed": f"{speed:.6g} rpm"}


def relief(chance: random.Random) -> dict[str, Any]:
    return {
        f"gears.{gear}.modification.tip_relief": f"{chance.uniform(2, 25):.3g} um"
        for gear in ("pinion", "wheel")
    }


@pytest.mark.slow
def test_random_pairs_near_resonance_end(draws: Draws) -> None:
    errors: list[str] = []
    for chance in draws(6):
        changes = near_resonance(chance)
        if chance.random() < 0.5:
            changes |= relief(chance)
        print(changes)
        try:
            summary = solved(changes)
        except ComputationError as error:
            errors.append(str(error))
            continue
        assert np.isfinite(summary["rms_mesh_force"])
        assert summary["steady_state_error"] < 1e-6
    # A motion that never repeats has no orbit, and that is what it says.
    assert all("period" in text or "orbit" in text for text in errors), errors


OILS = ("ISO VG 46", "ISO VG 100", "ISO VG 220", "ISO VG 460")


def film(chance: random.Random) -> dict[str, Any]:
    return {
        "lubricant.name": chance.choice(OILS),
        "lubricant.temperature": f"{chance.uniform(40, 90):.3g} degC",
        "film.model": "newton",
        "film.stiffness": chance.choice(["none", "approach", "tangent"]),
        "film.positions": chance.choice([12, 30, 60]),
    }


def deviations(result: td.Result, chance: random.Random) -> dict[str, float]:
    """Greatest deviation of films from those of the very contacts that they stand at.

    At the places that the figures of the summary come from, and at some others.
    """
    mesh, case, summary = result.mesh, result.case, result.summary()
    oil, steel = case.lubricant_properties, case.material_properties
    modulus = steel.youngs_modulus / (1.0 - steel.poissons_ratio**2)
    columns = {
        "central_film": (mesh.central_film, np.nanargmin),
        "minimum_film_over_path": (mesh.minimum_film, np.nanargmin),
        "maximum_film_pressure": (mesh.film_pressure, np.nanargmax),
    }
    places = chance.sample(list(np.argwhere(mesh.in_contact & np.isfinite(mesh.central_film))), 12)
    for name, (column, extreme) in columns.items():
        values = np.where(mesh.in_contact, column, np.nan)
        place = np.unravel_index(extreme(values), values.shape)
        assert summary[name] == values[place]
        places.append(np.array(place))
    index = tuple(np.array(places).T)
    contacts = (mesh.load_per_width, mesh.equivalent_radius, mesh.entrainment_speed)
    with quiet():
        films = solve_line_contacts(
            *(column[index] for column in contacts), oil, modulus, nodes=513, keep_solutions=True
        )
    pressure = np.array([solution.pressure.max() for solution in films.solutions])
    solved = (films.central_film, films.minimum_film, pressure)
    return {
        name: float(np.nanmax(np.abs(column[index] / exact - 1.0)))
        for (name, (column, _)), exact in zip(columns.items(), solved, strict=True)
    }


@pytest.mark.slow
def test_films_of_random_pairs_near_resonance_are_those_of_their_contacts(draws: Draws) -> None:
    messages: list[str] = []
    for chance in draws(1):
        changes = {**near_resonance(chance), **relief(chance), **film(chance)}
        print(changes)
        try:
            result = computed(changes)
        except ComputationError as error:
            messages.append(str(error))
            continue
        errors = deviations(result, chance)
        print(errors)
        assert max(errors.values()) < 0.02
    assert all(any(term in text for term in ("period", "orbit", "film")) for text in messages), (
        messages
    )
