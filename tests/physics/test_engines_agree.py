"""Newton and multigrid are different roads to the same discrete film."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact_moes

_NAMED = {
    "M20 L10": (20.0, 10.0, (-4.5, 1.5)),
    "M5 L5": (5.0, 5.0, (-4.5, 1.5)),
    "M100 L10": (100.0, 10.0, (-3.0, 1.5)),
    "M5 L20": (5.0, 20.0, (-4.5, 1.5)),
    "M5 L0": (5.0, 0.0, (-4.5, 1.5)),
}
_ENGINES = ("newton", "multigrid")


def random_contacts(count: int) -> list[dict[str, Any]]:
    generator, contacts = np.random.default_rng(20), []
    while len(contacts) < count:
        load = math.exp(generator.uniform(0.0, math.log(300.0)))
        viscosity, alpha = generator.uniform(0.0, 25.0), generator.uniform(1.2e-8, 3e-8)
        if viscosity * math.sqrt(load / (2.0 * math.pi)) / alpha <= 2e9:
            index = generator.uniform(0.45, 0.75)
            contacts.append(
                {"M": load, "L": viscosity, "pressure_viscosity_coefficient": alpha,
                 "pressure_viscosity_index": index, "domain": "auto", "inlet": "flooded"}
            )  # fmt: skip
    return contacts


def test_random_contacts_agree_by_default() -> None:
    for contact in random_contacts(60):
        first, other = (
            solve_line_contact_moes(**contact, nodes=513, method=engine) for engine in _ENGINES
        )
        assert (first.method, other.method) == _ENGINES
        assert first.attempts == other.attempts == ()
        assert other.central_film == pytest.approx(first.central_film, rel=3e-4)


@pytest.mark.parametrize("name", _NAMED)
@pytest.mark.parametrize("nodes", [513, 2049])
def test_named_contacts_agree_when_tight(name: str, nodes: int) -> None:
    M, L, domain = _NAMED[name]
    limits = {"newton": 1e-9, "multigrid": 1e-6}
    first, other = (
        solve_line_contact_moes(
            M, L, domain=domain, nodes=nodes, method=engine, tolerance=1e-9,
            flux_tolerance=limits[engine],
        )
        for engine in _ENGINES
    )  # fmt: skip
    assert other.central_film == pytest.approx(first.central_film, rel=1e-6)
    assert other.minimum_film == pytest.approx(first.minimum_film, rel=1e-6)
    for solution, load in ((first, 1e-8), (other, 1e-6)):
        assert solution.flux_error <= limits[solution.method]
        assert solution.load_error <= load
        assert solution.pressure.min() >= 0.0
        assert solution.cavity_residual >= -1e-8


def test_cycles_do_not_grow_with_the_grid() -> None:
    cycles = [
        solve_line_contact_moes(
            20.0, 10.0, nodes=nodes, method="multigrid", tolerance=1e-8, flux_tolerance=1e-6
        ).iterations
        for nodes in (513, 1025, 2049, 4097)
    ]
    assert max(cycles) <= 16
    assert cycles[-1] <= cycles[0] + 2


def test_five_levels_of_the_source() -> None:
    five = solve_line_contact_moes(
        20.0, 10.0, nodes=1025, method="multigrid", levels=5, domain=(-2.5, 1.5)
    )
    newton = solve_line_contact_moes(20.0, 10.0, nodes=1025, domain=(-2.5, 1.5))
    assert five.central_film == pytest.approx(newton.central_film, rel=3e-4)
    assert five.domain == (-2.5, 1.5)
