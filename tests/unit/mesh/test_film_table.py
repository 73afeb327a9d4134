"""The table of films: its values do not depend on earlier calls, and where it has none."""

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import quiet
from tribodyn.mesh.film.film_table import FilmTable

EXACT = 1e-4


def surface(log_m: np.ndarray, log_l: np.ndarray) -> np.ndarray:
    """Smooth but for a bend along a line; without value beyond ``ln L`` of 3.3."""
    bend = 0.05 * np.log(np.cosh((log_m - 0.3 * log_l) / 0.05))
    smooth = np.sin(0.4 * log_m) * np.exp(0.2 * log_l)
    return np.where(log_l > 3.3, np.nan, np.stack([smooth + bend, 1e3 * np.sin(50.0 * log_m)]))


def table(tolerance: float = EXACT) -> FilmTable:
    return FilmTable(surface, np.array([tolerance, np.inf]), np.array([True, False]))


def places(count: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(5)
    return random.uniform(-3.0, 3.0, count), random.uniform(1.1, 2.9, count)


def test_checked_tolerance_is_met_and_cells_are_fine_only_at_the_bend() -> None:
    films, at = table(), places(400)
    assert np.abs(films(*at)[0] - surface(*at)[0]).max() < 3.0 * EXACT
    assert films.solved < 2500  # 24 smooth cells have 500 nodes; 0.5 x 0.5 everywhere 3000
    coarse = table(np.inf)
    assert np.abs(coarse(*at)[0] - surface(*at)[0]).max() > 100.0 * EXACT
    assert coarse.solved < films.solved / 2


def test_a_value_does_not_depend_on_earlier_calls() -> None:
    log_m, log_l = places(60)
    at_once, one_by_one = table(), table()
    each = [one_by_one(log_m[k : k + 1], log_l[k : k + 1]) for k in range(60)[::-1]]
    assert np.array_equal(at_once(log_m, log_l), np.concatenate(each[::-1], axis=1))
    before = at_once.solved
    at_once(log_m, log_l)
    assert at_once.solved == before


def test_no_value_without_solutions_and_an_extrapolation_next_to_them() -> None:
    films = table()
    log_l = np.array([3.05, 3.2, 3.35])
    film = films(np.zeros(3), log_l)[0]
    assert np.isfinite(film).tolist() == [True, True, False]
    assert film[:2] == pytest.approx(surface(np.zeros(2), log_l[:2])[0], abs=3.0 * EXACT)


FILMS = {
    "central_film": 1e-3,
    "central_film_pitch_point": 1e-3,
    "minimum_film_over_path": 1e-3,
    "minimum_film_load_share": 1e-3,
    "maximum_film_pressure": 0.02,
    "oil_film_stiffness_pitch_point": 0.02,
    "rms_mesh_force": 1e-3,
    "peak_to_peak_static_transmission_error": 2e-3,
}


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", ["approach", "tangent"])
def test_a_sweep_has_the_films_of_single_runs(stiffness: str) -> None:
    case = td.load_case("fzg-film").replace({"film.stiffness": stiffness, "film.nodes": 129})
    torques = ["180 N*m", "190 N*m", "210 N*m", "220 N*m"]
    sweep = td.sweep(case, {"operation.torque": torques})
    assert not sweep.failed.any()
    with quiet():
        alone = td.run(case.replace({"operation.torque": "210 N*m"})).summary()
    for name, tolerance in FILMS.items():
        assert sweep[name][2] == pytest.approx(alone[name], rel=tolerance), name
