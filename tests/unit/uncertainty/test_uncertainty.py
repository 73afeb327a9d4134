"""Samples, bands and shares of the variance, against SciPy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.uncertainty import bootstrap_band, distribution, sample, sobol_indices

METHODS = ("monte-carlo", "latin-hypercube", "sobol")


@pytest.mark.parametrize("method", METHODS)
def test_samples_follow_their_distributions(method: str) -> None:
    distributions = {
        "mu": "0.05 +- 0.83 %",
        "operation.torque": "90 N*m +- 4.5 N*m",
        "gears.composite_roughness": "0.4 um .. 0.6 um",
        "k": "lognormal 2.0 +- 20 %",
        "own": stats.gumbel_r(3.0, 0.2),
        "lubricant.temperature": "60 degC +- 2 K",
    }
    samples = sample(distributions, 4096, method=method, seed=3)
    assert list(samples) == list(distributions)
    expected = {
        "mu": stats.truncnorm(-3, 3, 0.05, 0.0083 * 0.05),
        "operation.torque": stats.truncnorm(-3, 3, 90.0, 4.5),
        "gears.composite_roughness": stats.uniform(0.4e-6, 0.2e-6),
        "own": distributions["own"],
        "lubricant.temperature": stats.truncnorm(-3, 3, 333.15, 2.0),
    }
    for name, law in expected.items():
        assert stats.kstest(samples[name], law.cdf).pvalue > 0.01, name
    assert np.mean(samples["k"]) == pytest.approx(2.0, rel=0.02)
    assert np.std(samples["k"]) == pytest.approx(0.4, rel=0.05)
    again = sample(distributions, 4096, method=method, seed=3)
    assert all(np.array_equal(samples[name], again[name]) for name in samples)
    assert not np.array_equal(
        samples["mu"], sample(distributions, 4096, method=method, seed=4)["mu"]
    )


def test_even_samples_are_better_than_random_ones() -> None:
    distributions = dict.fromkeys("abc", "0 .. 1")
    errors = {}
    for method in METHODS:
        draws = [sample(distributions, 256, method=method, seed=seed) for seed in range(30)]
        means = [np.mean(np.prod(list(columns.values()), axis=0)) for columns in draws]
        errors[method] = np.sqrt(np.mean((np.array(means) - 0.125) ** 2))
    assert errors["sobol"] < 0.3 * errors["latin-hypercube"] < 0.3 * errors["monte-carlo"]


def test_a_latin_hypercube_has_one_value_in_every_part() -> None:
    samples = sample({"a": "0 .. 1", "b": "0 .. 1"}, 50, method="latin-hypercube", seed=0)
    for values in samples.values():
        assert np.array_equal(np.sort((50 * values).astype(int)), np.arange(50))


def test_data_one_value_and_the_cut() -> None:
    samples = sample({"a": [1.0, 2.0, 4.0], "b": 7.0, "mu": "0.1 +- 1 %"}, 20000, seed=0,
                     method="latin-hypercube")  # fmt: skip
    assert np.median(samples["a"]) == pytest.approx(2.0, abs=1e-3)
    assert np.mean(samples["a"]) == pytest.approx(2.25, abs=1e-3)
    assert np.all(samples["b"] == 7.0)
    assert samples["mu"].max() <= 0.103
    assert samples["mu"].min() >= 0.097
    free = sample({"mu": "normal 0.1 +- 1 %"}, 20000, seed=0)["mu"]
    assert free.max() > 0.103


@pytest.mark.parametrize("skew", [False, True])
def test_band_covers_the_mean_at_its_stated_rate(skew: bool) -> None:
    random = np.random.default_rng(5)
    trials, repeats = 500, 30
    draw = random.exponential if skew else random.normal
    values = draw(1.0, size=(trials, repeats)) if skew else draw(1.0, 1.0, (trials, repeats))
    covered = [
        band.low < 1.0 < band.high
        for band in (bootstrap_band(row, seed=n, resamples=600) for n, row in enumerate(values))
    ]
    deviation = np.sqrt(0.95 * 0.05 / trials)
    assert abs(np.mean(covered) - 0.95) < (4.0 if skew else 3.0) * deviation


def test_the_simultaneous_band_holds_whole_curves() -> None:
    random = np.random.default_rng(6)
    coverage = {False: 0, True: 0}
    for trial in range(200):
        curves = random.normal(size=(20, 40))
        for simultaneous in coverage:
            band = bootstrap_band(curves, seed=trial, simultaneous=simultaneous, resamples=400)
            coverage[simultaneous] += bool(np.all((band.low < 0.0) & (band.high > 0.0)))
    assert 0.9 < coverage[True] / 200 <= 1.0
    assert coverage[False] / 200 < 0.5


def test_a_band_of_equal_curves_has_no_width() -> None:
    band = bootstrap_band(np.tile([1.0, 2.0], (5, 1)), seed=0, unit="N")
    np.testing.assert_array_equal(band.low, band.high)
    assert band.to_xarray()["mean"].units == "N"


def test_the_indices_of_ishigami() -> None:
    """T. Ishigami and T. Homma 1990, with a = 7, b = 0.1: closed forms."""

    def ishigami(x):
        return np.sin(x["a"]) + 7.0 * np.sin(x["b"]) ** 2 + 0.1 * x["c"] ** 4 * np.sin(x["a"])

    distributions = {name: stats.uniform(-np.pi, 2.0 * np.pi) for name in "abc"}
    indices = sobol_indices(ishigami, distributions, 4096, seed=2)
    a, b = 7.0, 0.1
    variance = a**2 / 8 + b * np.pi**4 / 5 + b**2 * np.pi**8 / 18 + 0.5
    first = np.array([0.5 * (1 + b * np.pi**4 / 5) ** 2, a**2 / 8, 0.0]) / variance
    interaction = 8.0 * b**2 * np.pi**8 / 225 / variance
    np.testing.assert_allclose(indices.first_order, first, atol=0.02)
    np.testing.assert_allclose(
        indices.total_order, first + np.array([interaction, 0.0, interaction]), atol=0.02
    )
    assert indices.evaluations == 4096 * 5


@pytest.mark.parametrize(
    "text",
    ["", "0.05 +- ", "0.05 +- 0 %", "0.05 +- -1 %", "2 .. 1", "x", None, True, [], [np.nan],
     "lognormal -1 +- 10 %", "0.05 +- 3 N", object()],
)  # fmt: skip
def test_invalid_distributions_are_refused(text: object) -> None:
    with pytest.raises(InputError):
        distribution("mu", text)


def test_units_belong_to_the_quantity() -> None:
    for text in ("90 +- 2 %", "90 mm +- 2 %", "90 N*m +- 2 mm"):
        with pytest.raises(InputError, match=r"operation\.torque"):
            distribution("operation.torque", text)


def test_refusals() -> None:
    with pytest.raises(InputError, match="size"):
        sample({"a": "0 .. 1"}, 0, seed=0)
    with pytest.raises(InputError, match="method"):
        sample({"a": "0 .. 1"}, 4, method="grid", seed=0)
    with pytest.raises(InputError, match="no uncertain quantity"):
        sample({}, 4, seed=0)
    with pytest.warns(ModelWarning, match="sobol-size"):
        sample({"a": "0 .. 1"}, 100, method="sobol", seed=0)
    with pytest.raises(ComputationError, match="not finite"):
        sample({"a": stats.norm(np.nan, 1.0)}, 4, seed=0)
    with pytest.raises(InputError, match="three repeats"):
        bootstrap_band([1.0, 2.0], seed=0)
    with pytest.raises(InputError, match="names to distributions"):
        sobol_indices(lambda x: x["a"], ["a"], 4, seed=0)
    with pytest.raises(InputError, match="power"):
        sobol_indices(lambda x: x["a"], {"a": "0 .. 1"}, 100, seed=0)
    with pytest.raises(InputError, match="shape"):
        sobol_indices(lambda x: 1.0, {"a": "0 .. 1"}, 4, seed=0)
    with pytest.raises(ComputationError, match="does not vary"):
        sobol_indices(lambda x: 0.0 * x["a"], {"a": "0 .. 1"}, 4, seed=0)
