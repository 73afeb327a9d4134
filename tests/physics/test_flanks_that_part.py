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
from tribodyn.errors import ComputationError, ModelWarning, quiet
from tribodyn.study import read_case

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


def solved(changes: dict[str, Any]) -> dict[str, Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # the flanks do part
        return td.run(read_case(PAIR).replace(changes)).summary()


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


def test_random_pairs_near_resonance_end(draws: Callable[[int], Iterator[random.Random]]) -> None:
    told: list[str] = []
    for chance in draws(6):
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
        own = modes.frequency[int(np.argmax(modes.contact_share))]
        speed = own * chance.uniform(0.4, 1.2) / changes["gears.pinion.teeth"] * 60.0
        changes["operation.speed"] = f"{speed:.6g} rpm"
        print(changes)
        try:
            found = solved(changes)
        except ComputationError as error:
            told.append(str(error))
            continue
        assert np.isfinite(found["rms_mesh_force"])
        assert found["steady_state_error"] < 1e-6
    # A motion that never repeats has no orbit, and that is what it says.
    assert all("period" in words or "orbit" in words for words in told), told
