"""Tables made ready: gaps, outliers, smoothing, scaling and split."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.surrogate import prepare, split_rows

RANDOM = np.random.default_rng(2)
X, GROUP = RANDOM.normal(3.0, 2.0, 400), np.repeat(np.arange(40.0), 10)


def test_scaling_and_filling_know_the_training_rows_only():
    x, y = X.copy(), X**2
    parts = split_rows(400, seed=7)
    x[parts.test], x[parts.training[:5]] = 1e6, np.nan
    ready = prepare({"x": x, "y": y}, ["x"], ["y"], seed=7)
    scaled_rows = x[parts.training[5:]]
    assert ready.feature_scaling.high[0] == scaled_rows.max()
    assert np.allclose(ready.features[parts.training[:5], 0], scaled_rows.mean())
    assert np.array_equal(ready.split.test, parts.test)
    scaled = ready.feature_scaling.scaled(ready.features)
    assert scaled[parts.training].min() == 0.0
    assert scaled[parts.training].max() == 1.0


def test_groups_stay_together():
    parts = split_rows(400, seed=1, groups=GROUP)
    labels = [set(GROUP[rows]) for rows in vars(parts).values()]
    assert [len(each) for each in labels] == [32, 4, 4]
    assert not labels[0] & labels[1]
    assert not labels[0] & labels[2]
    assert not labels[1] & labels[2]
    assert sorted(np.concatenate(list(vars(parts).values()))) == list(range(400))


def test_outliers_leave_the_training_but_not_the_test():
    y = np.sin(X)
    parts = split_rows(400, seed=3)
    y[parts.training[4]], y[parts.test[0]] = 100.0, -100.0
    ready = prepare({"x": X, "y": y}, ["x"], ["y"], seed=3, outlier_limit=5.0)
    assert ready.outliers == 1
    assert ready.targets[ready.split.training].max() <= 1.0
    assert ready.targets[ready.split.test].min() == -100.0


def test_the_moving_average_is_that_of_numpy_and_ends_at_groups():
    data = {"x": X, "y": X + 1, "g": GROUP}
    ready = prepare(data, ["x"], ["y"], seed=1, groups="g", moving_average=3)
    inner = np.convolve(X[:10], np.ones(3) / 3, "valid")
    assert np.allclose(ready.features[1:9, 0], inner)
    assert np.allclose(ready.features[[0, 9], 0], [X[:2].mean(), X[8:10].mean()])


def test_a_missing_target_is_no_row():
    y = X.copy()
    y[:40] = np.nan
    ready = prepare({"x": X, "y": y, "g": GROUP}, ["x"], ["y"], seed=1, groups="g")
    assert len(ready.targets) == 360


def test_a_constant_feature_is_reported():
    with pytest.warns(ModelWarning, match="c does not vary"):
        prepare({"x": X, "c": np.ones(400), "y": X}, ["x", "c"], ["y"], seed=1)


@pytest.mark.parametrize(
    ("data", "features", "more", "match"),
    [
        ({"x": X, "y": X}, ["z"], {}, 'no column "z"'),
        ({"x": X, "y": X}, "x", {}, "list of names"),
        ({"x": X, "y": X}, ["y"], {}, "both feature and target"),
        ({"x": X, "y": X[:9]}, ["x"], {}, "shape"),
        ({"x": X, "y": np.where(X > 3, np.inf, X)}, ["x"], {}, "finite"),
        ({"x": X, "y": X, "g": np.zeros(400)}, ["x"], {"groups": "g"}, "1 group"),
        ({"x": X, "y": X}, ["x"], {"outlier_limit": 1e-9}, "Widen"),
        ({"x": X, "y": X}, ["x"], {"shares": (1, 0, 1)}, "shares"),
        (3, ["x"], {}, "arrays by name"),
        ({"x": X, "y": X}, None, {}, "list of names"),
        ({"x": X, "y": X}, ["x"], {"shares": "8:1:1"}, "real"),
    ],
)
def test_unsuitable_training_data_are_reported(data, features, more, match):
    with pytest.raises(InputError, match=match):
        prepare(data, features, ["y"], seed=1, **more)
