"""Force laws of the meshes of machines and stages: the tangent about the load, and the law."""

from __future__ import annotations

import pytest

import tribodyn as td

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")]


def test_a_tangent_about_the_load_carries_as_the_law_does() -> None:
    """Without loss of contact both have one mean force, and nearly one motion."""
    case = td.load_case("planetary-stage").replace({"film.model": "none", "friction.law": "none"})
    laws = ("tangent", "force-law")
    tangent, law = (
        td.run(case.replace({"dynamics.mesh_law": each, "load_cases": None})).summary()
        for each in laws
    )
    for mesh in ("low_sun1", "low_ring1"):
        mean, peak = f"meshes.{mesh}.mean_mesh_force", f"meshes.{mesh}.peak_mesh_force"
        assert tangent[mean] == pytest.approx(law[mean], rel=1e-4)
        assert tangent[mean] == pytest.approx(tangent[f"meshes.{mesh}.static_mesh_force"], rel=1e-4)
        assert tangent[peak] == pytest.approx(law[peak], rel=0.05)
