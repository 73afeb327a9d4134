"""Variants of a case in one batch: each is the run of its own case."""

from __future__ import annotations

import json

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError, ModelWarning
from tribodyn.plot.signals.bands import banded
from tribodyn.study import load_data
from tribodyn.study.uncertain.cycles import steady_cycles
from tribodyn.study.uncertain.lanes import lanes_of

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

CASE = td.load_case("fzg-film").replace(
    {"film.model": "none", "stiffness.model": "analytic", "solver.steps_per_mesh_cycle": 512}
)
LINEAR = CASE.replace({"stiffness.model": "rectangular", "stiffness.pair_stiffness": 2e8})
SCALES = {"stiffness_scale": "1 +- 2 %", "friction_scale": "1 +- 5 %"}


@pytest.fixture(scope="module")
def cycles():
    spread = {
        "friction.coefficient": np.array([0.0692, 0.04]),
        "dynamics.mesh_damping_ratio": np.array([0.04, 0.06]),
        "operation.speed": np.array([CASE.operation.speed, 0.8 * CASE.operation.speed]),
    }
    lanes = lanes_of(CASE, spread)
    return spread, lanes, steady_cycles(lanes, 64)


def test_lanes_share_one_structure(cycles):
    _, lanes, _ = cycles
    assert lanes.members[0] is lanes.members[1]
    assert np.allclose(lanes.factors["friction_scale"], [1.0, 0.04 / 0.0692])
    assert np.allclose(lanes.factors["damping_scale"], [1.0, 1.5])


@pytest.mark.parametrize("lane", [0, 1])
def test_a_lane_is_the_run_of_its_case(cycles, lane):
    spread, _, bands = cycles
    result = td.run(CASE.replace({key: float(values[lane]) for key, values in spread.items()}))
    summary = result.summary()
    mean, rms, _, high = (figure[lane] for figure in bands.figures["mesh_force"])
    assert np.isclose(mean, summary["mean_mesh_force"], rtol=1e-5)
    assert np.isclose(rms, summary["rms_mesh_force"], rtol=1e-5)
    assert np.isclose(high, summary["peak_mesh_force"], rtol=1e-3)
    swing = bands.figures["dynamic_transmission_error"]
    value = summary["peak_to_peak_dynamic_transmission_error"]
    assert np.isclose(swing[3][lane] - swing[2][lane], value, rtol=1e-3)
    phase = result.response.phase
    force = np.interp(bands.phase, phase, result.response.contact_force.sum(axis=1))
    inner = np.abs(bands.signals["mesh_force"][lane] - force) < 1e-2 * force.max()
    assert inner.mean() > 0.95  # but at the events, where neighbours are joined by a line


def test_a_torque_is_a_factor_only_where_the_contact_is_the_same():
    torque = {"operation.torque": np.array([140.0, 160.0])}
    assert set(lanes_of(LINEAR, torque).factors) == {"force_scale"}
    built = lanes_of(CASE, torque)
    assert not built.factors
    assert built.members[0].case.operation.torque == 140.0


def test_bands_narrow_with_the_number_of_variants(tmp_path):
    ensembles = td.ensemble(CASE, SCALES, 16, seed=1)
    band, spread = ensembles.band(), ensembles.spread()
    assert np.all(band.low <= band.mean)
    assert np.all(band.high <= spread[1] + 1e-9)
    lines = ensembles.band(harmonics=5)
    assert np.allclose(lines.mean, ensembles.spectrum(harmonics=5).mean(axis=0))
    figure = ensembles.plot()
    assert {trace.name for trace in figure.data if trace.showlegend is not False} == {
        "95% of the variants", "95% band of the mean", "mean",
    }  # fmt: skip
    assert td.ensemble(CASE, SCALES, 16, seed=1) == ensembles


def test_rows_over_time_are_those_of_the_transient_run():
    data = td.vibration_data(
        CASE, seed=1, distributions={"stiffness_scale": 1.0}, trajectories=2, samples=3,
        redraw=False,
    )  # fmt: skip
    cycles = 18
    case = CASE.replace({"solver.method": "transient", "solver.cycles": cycles})
    response = td.run(case).response
    assert np.allclose(data["time"][:3], [0.01, 0.02, 0.03])
    force = np.interp(data["time"][:3], response.time, response.contact_force.sum(axis=1))
    assert np.allclose(data["mesh_force"][:3], force, rtol=2e-4)
    acceleration = response.acceleration[:, response.index("pinion_y")]
    shaking = [_cubic(response.time, acceleration, time) for time in data["time"][:3]]
    assert np.allclose(data["acceleration"][:3], shaking, atol=5e-4 * np.abs(shaking).max())
    elastic = data["mesh_stiffness"] * data["backlash_function"]
    damped = data["mesh_force"] - elastic
    assert np.abs(damped).max() < 0.2 * data["mesh_force"].max()


def _cubic(time, signal, at):
    """Signal between its samples, which are coarse for the motion in the bearings."""
    nearest = np.argsort(np.abs(time - at))[:4]
    return np.polyval(np.polyfit(time[nearest] - at, signal[nearest], 3), 0.0)


def test_a_table_states_its_provenance(tmp_path):
    with pytest.warns(ModelWarning, match="5.6 mesh cycles lie between two rows"):
        data = td.vibration_data(CASE, seed=3, trajectories=5, samples=4)
    assert data.rows == 20
    assert np.unique(data["stiffness_scale"]).size == 20  # drawn for every row
    again = load_data(data.save(tmp_path / "data.nc"))
    assert again == data
    assert td.study.read_case(again.case) == CASE
    settings = json.loads(again.settings)
    assert (settings["made_by"], settings["seed"]) == ("vibration_data", 3)
    assert data.where(data["time"] > 0.02).rows == 10
    try:
        import pyarrow.parquet as parquet
    except ImportError:
        with pytest.raises(InputError, match="pyarrow is not installed"):
            data.to_parquet(tmp_path / "data.parquet")
        return
    table = parquet.read_table(data.to_parquet(tmp_path / "data.parquet"))
    assert np.array_equal(table["mesh_force"].to_numpy(), data["mesh_force"])


def test_operating_points_are_rows():
    data = td.operating_data(LINEAR, {"operation.torque": "80 N*m .. 220 N*m"}, 4, seed=1)
    assert (data.units["operation.torque"], data.units["rms_mesh_force"]) == ("N*m", "N")
    # The springs of closed teeth are linear: force over torque is the same.
    for name in ("mean_mesh_force", "rms_mesh_force", "rms_acceleration_loa_pinion"):
        ratio = data[name] / data["operation.torque"]
        assert np.allclose(ratio, ratio[0], rtol=1e-6)


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: td.ensemble(CASE, seed=1), "nothing is spread"),
        (lambda: td.ensemble(CASE, {"gears.driver": 1.0}, seed=1), "cannot be spread"),
        (lambda: td.ensemble(CASE, {"operation.torqe": 1.0}, seed=1), "torque"),
        (lambda: td.ensemble(CASE, {"friction.coefficient": "0.05 +- 900 %"}, seed=1), "coeff"),
        (lambda: td.vibration_data(CASE, seed=1, interval=1e-4), "mesh cycle takes"),
        (lambda: td.vibration_data(CASE, seed=1, over="phase"), "over"),
        (
            lambda: td.vibration_data(CASE, seed=1, distributions={"operation.torque": "150 N*m"}),
            "cannot change while",
        ),
        (lambda: td.ensemble(CASE, SCALES, 3, seed=1).band("speed"), "signal"),
    ],
)
def test_keys_that_cannot_be_spread_are_reported(make, match):
    with pytest.raises(InputError, match=match):
        make()


def test_a_case_may_hold_spread_values():
    error = "dynamics.transmission_error_amplitude"
    case = LINEAR.replace({"operation.torque": "150 N*m +- 2 %", error: "1 um .. 2 um"})
    assert case.operation.torque == 150.0
    assert np.isclose(case.dynamics.transmission_error_amplitude, 1.5e-6)
    assert set(case.uncertain) == {"operation.torque", error}
    again = td.study.read_case(case.to_toml())
    assert again == case
    assert again.uncertain == case.uncertain
    assert again != LINEAR.replace({error: 1.5e-6})
    settled = case.replace({"operation.torque": "140 N*m"})
    assert list(settled.uncertain) == [error]
    result = td.ensemble(settled, size=4, seed=2)
    assert 1e-6 <= result.value.min() < result.value.max() <= 2e-6
    with pytest.raises(InputError, match="wrong kind of quantity"):
        case.replace({"operation.torque": "150 N*m +- 2 mm"})
    with pytest.raises(InputError, match="whole number"):
        case.replace({"gears.pinion.teeth": "16 +- 1"})


def test_every_figure_of_a_run_takes_bands() -> None:
    """The band is that of the runs themselves; what does not vary has none."""
    spread = {"operation.torque": "80 N*m +- 3 %", "operation.speed": "1400 rpm +- 0.5 %"}
    result = td.ensemble(LINEAR, spread, 5, seed=1)
    middle, *variants = result.results
    torques = result.value[:, 0]
    assert middle.case.operation.torque == np.median(torques)
    assert [each.case.operation.torque for each in variants] == torques.tolist()
    peaks = result.figures()["peak_mesh_force"]
    np.testing.assert_allclose(peaks[1:], result.mesh_force.max(axis=1), rtol=2e-3)
    curve, _, high, low, *_ = result.plot("mesh_force").data
    assert low.fill == "tonexty"
    assert np.all(low.y <= high.y)
    assert np.mean((low.y <= curve.y) & (curve.y <= high.y)) > 0.9
    bars = result.plot("spectrum").data[0]
    harmonics = result.spectrum("dynamic_transmission_error", 3)
    ends = np.quantile(harmonics, (0.025, 0.975), axis=0) * 1e6
    np.testing.assert_allclose((bars.y + bars.error_y.array)[:3], ends[1], rtol=0.02)
    np.testing.assert_allclose((bars.y - bars.error_y.arrayminus)[:3], ends[0], rtol=0.02)
    names = [heading for heading, *_ in banded(result, ("gear_pair", "mesh_force", "spectrum"))]
    assert names == ["Mesh force", "Spectra"]
    with pytest.raises(InputError, match="stiffness_scale: of no case"):
        td.ensemble(LINEAR, {"stiffness_scale": "1 +- 2 %"}, 3, seed=1).plot("mesh_force")


@pytest.mark.parametrize(
    ("text", "ends", "remedy"),
    [
        ("90 N*m +- 200 %", "from -450 N.m to 630 N.m", "at most 33.3 %: it is cut at three"),
        ("90 N*m +- 45 N*m", "from -45 N.m to 225 N.m", 'at most 29.9 N.m.*"lognormal 90 N'),
        ("normal 90 N*m +- 45 N*m", "from -123.9 N.m to 303.9 N.m", "at most 18.9 N"),
        ("-5 N*m .. 9 N*m", "from -5 N.m to 9 N.m", "Correct the ends"),
        ("lognormal 90 N*m +- 1e9 %", "to .*e\\+.* N", "smaller standard deviation"),
    ],
)
def test_a_spread_beyond_the_range_of_its_key_is_refused(text: str, ends: str, remedy: str) -> None:
    """A case that passes its check has only variants that can be computed."""
    message = rf"operation\.torque: .*{ends}.*Allowed: 1e-06 N\*m to 100000000 N\*m.*{remedy}"
    with pytest.raises(InputError, match=message):
        LINEAR.replace({"operation.torque": text})
    with pytest.raises(InputError, match=message):
        td.ensemble(LINEAR, {"operation.torque": text}, 4, seed=1)


def test_the_standard_deviation_of_the_remedy_is_accepted() -> None:
    for text in ("90 N*m +- 33.3 %", "90 N*m +- 29.9 N*m", "normal 90 N*m +- 18.9 N*m"):
        assert LINEAR.replace({"operation.torque": text}).uncertain == {"operation.torque": text}
