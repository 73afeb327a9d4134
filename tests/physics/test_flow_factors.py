"""Flow factors of rough surfaces: printed values, and what they do to a film."""

from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import (
    FlowFactors,
    LineContactSolution,
    mean_gap,
    pressure_flow_factor,
    shear_flow_factor,
    solve_line_contact,
)
from tribodyn.errors import ComputationError, InputError
from tribodyn.lubricant import Lubricant

OIL, SPEED = Lubricant(0.082, 880.0, 2.19e-8), 3.0722
ORIENTATIONS = (1 / 9, 1 / 6, 1 / 3, 1.0, 3.0, 6.0, 9.0)
GRID: dict[str, Any] = {"nodes": 1025, "domain": (-12.0, 1.6)}


def solve(speed: float = SPEED, **options: Any) -> LineContactSolution:
    return solve_line_contact(147802.0, 8e-3, speed, OIL, 2.2e11, **(GRID | options))


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_the_parts_of_the_shear_factor_meet(orientation: float) -> None:
    """Seven rows of five printed constants: a wrong digit opens a gap at a film ratio of 5."""
    before, after = shear_flow_factor(np.array([5.0, np.nextafter(5.0, 6.0)]), orientation)
    assert after == pytest.approx(before, rel=1.2e-3)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_pressure_factors_agree_with_a_fit_over_the_orientation(orientation: float) -> None:
    """Fit of the printed constants in a program for cold rolling (R. Boman, EHD)."""
    ratio = np.array([1.0, 2.0, 4.0])
    if orientation <= 1.0:
        C = 0.89679 - 0.26591 * np.log(orientation)
        r = 0.43006 - 0.10828 * orientation + 0.23821 * orientation**2
        expected = 1.0 - C * np.exp(-r * ratio)
    else:
        expected = 1.0 + (0.1075 * orientation - 0.10667) * ratio**-1.5
    assert pressure_flow_factor(ratio, orientation) == pytest.approx(expected, abs=0.02)


def test_the_mean_gap_is_that_of_gaussian_heights() -> None:
    heights = np.linspace(-8.0, 8.0, 160_001)
    density = np.exp(-0.5 * heights**2) / np.sqrt(2.0 * np.pi)
    for ratio in (0.5, 1.0, 3.0):
        gap = np.trapezoid(np.maximum(ratio + heights, 0.0) * density, heights)
        assert float(mean_gap(ratio)) == pytest.approx(gap / ratio, rel=1e-7)


def test_a_constant_pressure_factor_is_a_faster_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    def constant(self: FlowFactors, film: Any, slide: float = 0.0) -> tuple[Any, Any]:
        return np.full(film.shape, 0.8), np.ones(film.shape)

    monkeypatch.setattr(FlowFactors, "flow", constant)
    rough, faster = solve(flow_factors=FlowFactors(1e-7)), solve(SPEED / 0.8)
    # but for the inlet before the grid, which is smooth
    assert rough.central_film == pytest.approx(faster.central_film, rel=1e-3)
    assert rough.minimum_film == pytest.approx(faster.minimum_film, rel=1e-3)
    assert faster.central_film > 1.1 * solve().central_film


def test_ridges_across_the_flow_thicken_the_film_and_ridges_along_thin_it() -> None:
    smooth = solve().central_film
    assert solve(flow_factors=FlowFactors(1e-9)).central_film == pytest.approx(smooth, rel=1e-6)
    films = [solve(flow_factors=FlowFactors(3e-7, g)).central_film for g in (1 / 9, 1, 3, 9)]
    assert np.all(np.diff(films) < -0.01 * smooth)
    assert films[1] > smooth > films[2]


def test_a_rough_surface_carries_oil_in_its_valleys() -> None:
    """The flow of the inlet fixes the sum: what valleys carry, the mean film does not."""
    options = {"first_share": 1.0}
    faster, slower = (
        solve(flow_factors=FlowFactors(3e-7, **options), sliding_speed=sign * SPEED).central_film
        for sign in (1.0, -1.0)
    )
    assert slower > 1.05 * faster
    mirrored = FlowFactors(3e-7, first_share=0.0)
    other = solve(flow_factors=mirrored, sliding_speed=-SPEED).central_film
    assert other == pytest.approx(faster, rel=1e-9)
    equal = solve(flow_factors=FlowFactors(3e-7), sliding_speed=SPEED).central_film
    assert equal == pytest.approx(solve(flow_factors=FlowFactors(3e-7)).central_film, rel=1e-9)


def test_what_the_factors_do_not_cover_is_refused() -> None:
    with pytest.raises(ComputationError, match=r"least film of .* Use mixed_line_contact"):
        solve(flow_factors=FlowFactors(3e-6))
    with pytest.raises(InputError, match="Leave one of them out"):
        solve(flow_factors=FlowFactors(1e-7), thermal=True)
    with pytest.raises(InputError, match="or flow_factors"):
        solve(sliding_speed=1.0)
    with pytest.raises(InputError, match=r"film_ratio = 0\.6"):
        pressure_flow_factor(0.6, 0.25)
