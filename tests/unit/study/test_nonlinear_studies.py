"""Lyapunov exponents, basins, branches and Sobol indices of a case, against single runs of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn import analysis
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.errors import ComputationError, InputError
from tribodyn.nonlinear.basins import MESH_PLANE, start_plane

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_CHANGES = {"stiffness.model": "analytic", "film.model": "none", "friction.law": "none"}

_TWO = {"operation.torque": "9 N*m +- 2 %", "operation.speed": "900 rpm +- 2 %"}


@pytest.fixture(scope="module")
def case() -> Any:
    changes = {**_CHANGES, "dynamics.backlash": "0.1 mm"}
    return td.load_case("fzg-roughness").replace(changes)


def test_a_case_gives_its_system(case: Any) -> None:
    system, mesh_frequency = td.build_system(case)
    result = td.run(case)
    assert mesh_frequency == pytest.approx(result.mesh.mesh_frequency, rel=1e-12)
    assert tuple(system.names) == tuple(result.response.names)
    assert td.natural_modes(case).frequency == pytest.approx(result.natural_modes.frequency)


def test_exponents_of_a_case_are_those_of_its_system(case: Any) -> None:
    options = {"cycles": 20, "transient": 60, "steps": 256, "verdict": False}
    exponents = td.lyapunov_exponents(case, **options)
    system, mesh_frequency = td.build_system(case)
    assert exponents == analysis.lyapunov_exponents(system, mesh_frequency, **options)
    assert exponents.rotating == ("pinion_theta", "wheel_theta")
    assert exponents.largest < 0.0


def test_coordinates_of_basins_are_those_of_the_transmission_error(case: Any) -> None:
    """The motion that all starts come to passes the plane where a single run is at phase 0."""
    basins = td.basins(case, ("0 um", "40 um"), ("-1e4 um/s", 0.01), points=2, steps=512,
                       verdict=False)  # fmt: skip
    assert basins.coordinates == MESH_PLANE
    assert basins.first.tolist() == pytest.approx([0.0, 40e-6])
    assert basins.second.tolist() == pytest.approx([-0.01, 0.01])
    (attractor,) = basins.attractors
    result = td.run(case.replace({"solver.steps_per_mesh_cycle": 512}))
    data = result.to_xarray()["dynamic_transmission_error"].values
    assert attractor.section is not None
    assert attractor.section[0, 0] == pytest.approx(float(data[0]), rel=1e-4)
    along = np.asarray(td.build_system(case)[0].contacts[0].direction)
    rate = float(along @ result.response.velocity[0])
    assert attractor.section[0, 1] == pytest.approx(rate, rel=1e-4)
    figure = basins.plot()
    assert figure.layout.xaxis.title.text == "Dynamic transmission error [µm]"
    assert figure.layout.yaxis.title.text == "Dynamic transmission error rate [µm/s]"
    cross = next(trace for trace in figure.data if trace.name and "period 1" in trace.name)
    assert float(cross.x[0]) == pytest.approx(1e6 * attractor.section[0, 0])
    assert float(cross.y[0]) == pytest.approx(1e6 * attractor.section[0, 1])


def test_starts_of_a_mesh_plane_give_a_free_rotation_no_momentum() -> None:
    """Also where the direction of the contact turns with the mesh phase."""

    def direction(phase: Any) -> Any:
        return np.stack((1.0 + 0.1 * np.sin(2.0 * np.pi * phase), -1.5 + 0.0 * phase), axis=1)

    mesh = Contact(direction, stiffness=4.0, gap=0.5)
    mass = np.array([[2.0, 0.3], [0.3, 6.0]])
    system = System(mass, np.zeros((2, 2)), np.diag([0.0, 1e-6]), [1.0, -1.5], [mesh])
    compiled = compile_for(system, 0.2, 64)
    plane = start_plane(compiled, 0.2, MESH_PLANE)
    position = np.array([0.4, -0.2, 0.1, 0.3])
    axes = np.array([-0.3, 0.2, 0.9]), np.array([-1.0, 2.0])
    starts = plane.starts(axes, position)
    grid = [[x, y] for x in axes[0] for y in axes[1]]
    assert plane.section(starts) == pytest.approx(np.array(grid), abs=1e-12)
    along, slope = np.array([1.0, -1.5]), np.array([0.2 * np.pi, 0.0])
    assert plane.section(starts)[:, 0] == pytest.approx(starts[:, :2] @ along - 0.5)
    rate = starts[:, 2:] @ along + 0.2 * starts[:, :2] @ slope
    assert plane.section(starts)[:, 1] == pytest.approx(rate, abs=1e-8)
    # The free motion across the contact in the metric of the mass has no part in the change.
    free = np.array([1.5, 1.0])
    assert (starts[:, 2:] - position[2:]) @ mass @ free == pytest.approx(np.zeros(6), abs=1e-8)
    assert (starts[:, :2] - position[:2]) @ mass @ free == pytest.approx(np.zeros(6), abs=1e-8)


def test_a_branch_of_a_case_ends_at_a_single_run(case: Any) -> None:
    branch = td.continuation(case, between=("1500 rpm", "1560 rpm"), steps=512, longest_step=0.5)
    assert branch.name == "operation.speed"
    assert branch.complete
    run = td.run(case.replace({"operation.speed": "1560 rpm", "solver.steps_per_mesh_cycle": 512}))
    swing = run.summary()["peak_to_peak_dynamic_transmission_error"]
    assert branch.peak_to_peak[-1, 0] == pytest.approx(swing, rel=1e-5)
    assert branch.plot().layout.xaxis.title.text == "Rotational speed [rpm]" or "rpm" in str(
        branch.plot().layout
    )


@pytest.mark.slow
def test_a_branch_over_the_torque(case: Any) -> None:
    branch = td.continuation(case, "operation.torque", ("100 N*m", "101 N*m"), steps=256,
                             longest_step=1.0)  # fmt: skip
    assert branch.complete
    assert branch.parameter[[0, -1]].tolist() == pytest.approx([100.0, 101.0])
    assert np.all(np.diff(branch.mean[:, 0]) > 0.0)


def test_shares_of_a_figure_that_follows_one_tolerance(case: Any) -> None:
    spread = {"operation.torque": "100 N*m +- 5 %", "operation.speed": "1500 rpm +- 5 %"}
    names = ["tangential_force", "pitch_line_velocity"]
    shares = td.sobol_indices(case, names, spread, 2, seed=2)
    assert len(shares.value) == 8
    assert shares.total_order[0, 1] == pytest.approx(0.0, abs=1e-12)
    assert shares.total_order[1, 0] == pytest.approx(0.0, abs=1e-12)
    radius = shares.sample[:, 0] / shares.value[:, 0]
    assert np.ptp(radius) < 1e-9 * radius[0]
    assert np.all(shares.total_order_band[:, 0] <= shares.total_order_band[:, 1])
    labels = [str(label) for label in shares.plot().data[0].y[1]]
    assert labels == [*spread, *spread]
    assert "operation.torque" in repr(shares)
    again = td.sobol_indices(case, names[:1], spread, 2, seed=2)
    assert again.total_order_band[0] == pytest.approx(shares.total_order_band[0])


def test_one_input_causes_all_of_the_variance() -> None:
    from tribodyn.uncertainty import sobol_indices

    shares = sobol_indices(lambda x: x["a"] ** 2, {"a": "0 .. 1"}, 8, seed=1, level=0.9)
    assert (shares.first_order.tolist(), shares.total_order.tolist()) == ([1.0], [1.0])


def test_intervals_hold_the_shares_of_a_sum() -> None:
    """Shares of ``a + 2 b`` are 1/5 and 4/5; intervals narrow with the root of the sample."""
    from tribodyn.uncertainty import sobol_indices

    spread = {"a": "0 .. 1", "b": "0 .. 1"}
    widths = []
    for size in (64, 1024):
        shares = sobol_indices(lambda x: x["a"] + 2.0 * x["b"], spread, size, seed=3, level=0.95)
        assert shares.total_order_band is not None
        low, high = shares.total_order_band
        assert np.all((low < [0.2, 0.8]) & (high > [0.2, 0.8]))
        widths.append(float(np.mean(high - low)))
    assert widths[0] / widths[1] == pytest.approx(4.0, rel=0.3)
    plain = sobol_indices(lambda x: x["a"] + 2.0 * x["b"], spread, 64, seed=3)
    assert plain.total_order_band is None


def test_pure_numbers_take_tolerances() -> None:
    constant = {"friction.law": "constant", "friction.coefficient": 0.05}
    changed = td.load_case("time-varying-friction").replace(constant)
    for text in ("0.06 +- 10 %", "0.05 .. 0.07"):
        spread = changed.replace({"friction.coefficient": text})
        assert spread.uncertain == {"friction.coefficient": text}
        assert spread.friction.coefficient == pytest.approx(0.06)


@pytest.mark.parametrize(
    ("compute", "message"),
    [
        (lambda c: td.sobol_indices(c, seed=1), "nothing is spread"),
        (lambda c: td.sobol_indices(c, "peak_force", _TWO, seed=1),
         'no figure "peak_force"'),
        (lambda c: td.sobol_indices(c, None, {**_TWO, "force_scale": "1 +- 2 %"}, seed=1),
         "force_scale cannot be spread"),
        (lambda c: td.sobol_indices(c, None, {**_TWO, "operation.torqe": "9 N*m +- 2 %"}, seed=1),
         "torqe"),
        (lambda c: td.sobol_indices(c, None, _TWO, 12, seed=1),
         "size = 12"),
        (lambda c: td.sobol_indices(c, None, {"operation.torque": "9 N*m +- 2 %"}, seed=1),
         "only operation.torque is spread"),
        (lambda c: td.continuation(c), "between"),
        (lambda c: td.continuation(c, between=("9 rpm", "9 rpm")), "two different"),
        (lambda c: td.continuation(c, "friction.law", ("none", "xu-2007")), "no values in between"),
        (lambda c: td.basins(c, ("5 um", "1 um")), "from the smaller value to the larger"),
        (lambda c: td.basins(c, ("5 kg", "9 kg")), "transmission_error"),
        (lambda c: td.basins(c, points=1), "two ranges of at least two values"),
        (lambda c: td.lyapunov_exponents(c, cycles=0), "cycles = 0"),
    ],
)  # fmt: skip
def test_wrong_input_is_refused(case: Any, compute: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        compute(case)


def test_a_constant_figure_is_refused(case: Any) -> None:
    spread = {"operation.torque": "100 N*m +- 2 %", "operation.speed": "1500 rpm +- 2 %"}
    with pytest.raises(ComputationError, match="transverse_contact_ratio does not vary"):
        td.sobol_indices(case, "transverse_contact_ratio", spread, 2, seed=1)
