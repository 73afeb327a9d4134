"""Gears that several folders share, and results to draw: a motion whose harmonics are known."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from known_pairs import pair_of
from known_systems import reference_system
from tribodyn.cases import load_case
from tribodyn.dynamics import FineSamples, Response, natural_modes
from tribodyn.gear import BasicRack, Material, SpurPair, spur_pair
from tribodyn.mesh import MeshTable, build
from tribodyn.study import Case
from tribodyn.study.case.provenance import assumptions

Array = NDArray[np.float64]

#: Peak amplitudes of mesh harmonics 1, 2, ... of every signal of the known motion.
AMPLITUDES = (4.0, 0.0, 1.0, 0.25)
NAMES = ("pinion_x", "pinion_y", "pinion_theta", "wheel_x", "wheel_y", "wheel_theta")


class Computed(SimpleNamespace):
    """Stand-in for what a case was computed to."""

    def transmission_error_at_rest(self, phase: Array | None = None) -> Array:
        error = "transmission_error_at_rest"
        return getattr(self.mesh, error) if phase is None else self.mesh.at(error, phase)


class PairResult(Computed):
    """Stand-in for the result of a run, drawn by the figures of its class."""

    rating = None  # its case has no [rating]


def mesh_of(case: Case, film_model: str = "none") -> MeshTable:
    """Mesh table of a case at a coarse step."""
    oil = case.lubricant_properties
    assert oil is not None
    return build(
        case.gear_pair,
        material=case.material_properties,
        stiffness_model="rectangular",
        stiffness_options={"pair_stiffness": 2e8},
        lubricant=oil,
        friction_law="constant",
        friction_options={"coefficient": 0.05},
        composite_roughness=0.5e-6,
        film_model=film_model,
        pinion_speed=94.0,
        pinion_torque=90.0,
        steps=64,
    )


def wave(phase: Array, scale: float) -> Array:
    """Signal with the known harmonics."""
    parts = [
        size * np.cos(2.0 * np.pi * order * phase + order)
        for order, size in enumerate(AMPLITUDES, start=1)
    ]
    return np.asarray(scale * np.sum(parts, axis=0))


def response_of(mesh: MeshTable, names: tuple[str, ...], *, periods: int, steady: bool) -> Response:
    """Motion with known harmonics in every signal, the coordinates in powers of ten."""
    steps = 128 * periods
    phase = (np.arange(steps)[:, None] + np.array([0.0, 0.5, 1.0])).reshape(-1) / 128
    weight = np.tile(np.array([1.0, 4.0, 1.0]) / (6.0 * steps), steps)
    motion = np.stack([wave(phase, 10.0**power) for power in range(len(names))], axis=1)
    fine = FineSamples(
        phase=phase,
        time=phase / mesh.mesh_frequency,
        weight=weight,
        position=1e-9 * motion,
        velocity=1e-6 * motion,
        acceleration=motion,
        deflection=(11e-6 + wave(phase, 1e-6))[:, None],
        contact_force=(mesh.total_normal_force + wave(phase, 100.0))[:, None],
    )
    left = slice(None, None, 3)
    return Response(
        time=fine.time[left],
        phase=fine.phase[left] % 1.0,
        position=fine.position[left],
        velocity=fine.velocity[left],
        acceleration=fine.acceleration[left],
        deflection=fine.deflection[left],
        contact_force=fine.contact_force[left],
        names=names,
        mesh_frequency=mesh.mesh_frequency,
        periods=periods,
        fine=fine,
        step_number=0.1,
        error=1e-10 if steady else float("nan"),
        converged=steady,
        floquet_multipliers=np.full(2 * steady, 0.1 + 0.0j),
    )


@pytest.fixture(scope="session")
def drawable() -> Any:
    """Make results: ``drawable(driver="wheel", film_model="moes", names=..., steady=False)``."""

    def make(
        driver: str = "pinion",
        film_model: str = "none",
        names: tuple[str, ...] = NAMES,
        periods: int = 1,
        steady: bool = True,
        changes: dict[str, Any] | None = None,
    ) -> Any:
        case = load_case("fzg-roughness").replace({"gears.driver": driver, **(changes or {})})
        mesh = mesh_of(case, film_model)
        return PairResult(
            coupling=None,
            friction=None,
            case=case,
            mesh=mesh,
            response=response_of(mesh, names, periods=periods, steady=steady),
            natural_modes=natural_modes(reference_system()),
            system=SimpleNamespace(
                stiffness=1e9 * np.eye(6),
                damping=np.zeros((6, 6)),
                contacts=(SimpleNamespace(gap=1e-6),),
            ),
            half_backlash=1e-6,
            static_error=np.zeros_like,
            warnings=(),
            assumptions=assumptions(case),
            summary=lambda: {"mesh_frequency": mesh.mesh_frequency},
            cite=lambda: "An author (2020): A title.",
        )

    return make


@pytest.fixture(scope="session")
def amplitudes() -> tuple[float, ...]:
    """Peak amplitudes of the mesh harmonics of every signal of a drawable result."""
    return AMPLITUDES


@pytest.fixture(scope="session")
def steel() -> Material:
    return Material()


@pytest.fixture(scope="session")
def fzg() -> Callable[..., SpurPair]:
    """FZG type A with any change; its thin tip and undercut are known and not the matter here."""
    return pair_of


@pytest.fixture(scope="session")
def high_contact_pair() -> SpurPair:
    """A pair with a contact ratio between two and three."""
    rack = BasicRack(
        addendum_coefficient=1.4, dedendum_coefficient=1.65, tip_radius_coefficient=0.2
    )
    return spur_pair(
        pinion_teeth=45,
        wheel_teeth=60,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=30e-3,
        pinion_bore_diameter=60e-3,
        wheel_bore_diameter=60e-3,
        pinion_rack=rack,
        wheel_rack=rack,
    )
