"""Trained models: errors, bands, range, files, baselines."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn import surrogate
from tribodyn.errors import InputError, ModelWarning, quiet

RANDOM = np.random.default_rng(4)
DATA = {name: RANDOM.uniform(-1.0, 1.0, 900) for name in ("a", "b")}
DATA["y"] = np.sin(3 * DATA["a"]) * DATA["b"] + RANDOM.normal(0.0, 0.02, 900)
DATA["z"] = 5.0 * np.exp(DATA["a"])
SMALL = surrogate.Training(hidden=(6, 6), epochs=60, shares=(6, 1, 3))
ASK = {"features": ["a", "b"], "targets": ["y", "z"]}


@pytest.fixture(scope="module")
def model():
    return surrogate.train(DATA, **ASK, seed=1, training=SMALL)


def test_errors_are_those_of_rows_that_were_not_trained(model):
    """The noise is the least error that a model can have on other rows."""
    error = model.errors["y"]
    assert error.rows == 270
    assert 0.8 * 0.02**2 < error.mean_square < 1.6 * 0.02**2
    assert model.errors["z"].determination > 0.9999
    test_rows = surrogate.split_rows(900, SMALL.shares, seed=1).test
    with quiet("surrogate-range"):
        again = model.predict({name: DATA[name][test_rows] for name in ("a", "b")})
    assert np.allclose(again["y"], model.predicted[0])
    assert np.array_equal(model.true[1], DATA["z"][test_rows])


def test_band_covers_new_values_at_its_stated_rate(model):
    a, b = RANDOM.uniform(-0.98, 0.98, (2, 4000))
    new = np.sin(3 * a) * b + RANDOM.normal(0.0, 0.02, 4000)
    low, high = model.predict_band({"a": a, "b": b})["y"]
    inside = np.mean((low <= new) & (new <= high))
    # 270 rows fix the level to within 0.013 (one standard deviation of a beta distribution)
    assert abs(inside - 0.95) < 0.04


def test_features_come_by_name_in_a_table_or_in_order(model):
    import pandas
    import xarray

    a, b = np.array([0.1, 0.2]), np.array([-0.3, 0.4])
    wanted = model.predict({"b": b, "a": a, "unused": 1.0})["z"]
    for features in (
        np.stack([a, b], axis=1),
        pandas.DataFrame({"b": b, "a": a}),
        xarray.Dataset({"a": ("row", a), "b": ("row", b)}),
    ):
        assert np.array_equal(model.predict(features)["z"], wanted)
    assert np.isclose(float(model.predict([0.1, -0.3])["z"]), wanted[0])
    assert model.predict({"a": a[:, None], "b": b})["y"].shape == (2, 2)


def test_inputs_beyond_the_training_are_reported(model):
    with pytest.warns(ModelWarning, match="1 of 2 rows are outside the training range: b = 3"):
        model.predict({"a": 0.0, "b": [0.0, 3.0]})


def test_a_model_comes_back_as_it_was(model, tmp_path):
    path = model.save(tmp_path / "model.nc")
    again = surrogate.load(path)
    assert again == model
    assert again.errors == model.errors
    rows = np.zeros((3, 2))
    assert np.array_equal(again.predict(rows)["y"], model.predict(rows)["y"])
    damaged = bytearray(path.read_bytes())
    at = bytes(damaged).index(model.networks[0][1][:4].tobytes())
    damaged[at] ^= 1
    path.write_bytes(damaged)
    with pytest.raises(InputError, match="damaged or changed after"):
        surrogate.load(path)
    other = model.to_xarray()
    other.to_netcdf(tmp_path / "less.nc")
    other.drop_vars("weights_1").to_netcdf(tmp_path / "fewer.nc")
    assert surrogate.load(tmp_path / "less.nc") == model
    with pytest.raises(InputError, match="incomplete"):
        surrogate.load(tmp_path / "fewer.nc")


def test_the_same_seed_gives_the_same_model(model):
    quick = surrogate.Training(hidden=(3,), activations=("tansig",), epochs=5)
    first, same, other = (
        surrogate.train(DATA, **ASK, seed=seed, training=quick) for seed in (2, 2, 3)
    )
    assert first == same
    assert not np.array_equal(first.true, other.true)


def test_the_size_of_the_networks_is_searched():
    model_, search = surrogate.bpnn_pl(DATA, **ASK, seed=1, neurons=(1, 5))
    assert search["y"].shape == (2, 3)
    assert search["y"][0, 1] > 4 * search["y"][1, 1]
    network, _ = model_.networks[0]
    assert (network.hidden, network.activations) == ((5, 5), ("tansig", "relu"))
    assert model_.errors["y"].determination > 0.99


def test_baselines_are_judged_by_the_same_rows():
    baselines = surrogate.baselines(DATA, **ASK, seed=1, table_over="a")
    parts = surrogate.split_rows(900, seed=1)
    mean = DATA["y"][parts.training].mean()
    assert np.isclose(
        baselines["mean"]["y"].mean_square, np.mean((DATA["y"][parts.test] - mean) ** 2)
    )
    assert baselines["table"]["z"].determination > 0.999
    assert baselines["linear"]["z"].determination < 0.97


@pytest.mark.slow
def test_baselines_of_scikit_learn():
    kinds = ["gaussian-process", "boosted-trees"]
    try:
        import sklearn  # noqa: F401
    except ImportError:
        with pytest.raises(InputError, match=r"tribodyn\[learn\]"):
            surrogate.baselines(DATA, **ASK, seed=1, kinds=kinds)
        return
    baselines = surrogate.baselines(DATA, **ASK, seed=1, kinds=kinds)
    assert all(each["z"].determination > 0.99 for each in baselines.values())
    # what vibrates within the range of a feature is no noise to either of them
    quick = {"a": DATA["a"], "y": np.sin(15.0 * DATA["a"])}
    baselines = surrogate.baselines(quick, features=["a"], targets=["y"], seed=1, kinds=kinds)
    assert baselines["gaussian-process"]["y"].determination > 0.999999
    assert baselines["boosted-trees"]["y"].determination > 0.99


@pytest.mark.parametrize(
    ("inputs", "match"),
    [
        ({"a": 1.0}, 'no column "b"'),
        ({"a": [0.0, 1.0], "b": [0.0, 1.0, 2.0]}, "shapes"),
        (np.zeros((3, 3)), "Wanted: 2 features"),
        ({"a": np.nan, "b": 0.0}, "not finite"),
        ("a", "real"),
    ],
)
def test_inputs_that_cannot_be_read_are_reported(model, inputs, match):
    with pytest.raises(InputError, match=match):
        model.predict(inputs)
