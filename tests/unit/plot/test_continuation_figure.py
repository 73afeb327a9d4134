"""The figure and the data set of a branch."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, continuation
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES


@pytest.fixture(scope="module")
def branch():
    contact = Contact([1.0], lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [contact])
    return continuation(system, between=(0.13, 0.15), steps=128, longest_step=0.1)


def test_curves_are_the_branch_in_display_units(branch):
    figure = branch.plot()
    traces = {trace.name: trace for trace in figure.data if (trace.yaxis or "y") == "y"}
    stable, unstable = traces["stable"], traces["unstable"]
    is_stable = np.isfinite(stable.y)
    assert is_stable[branch.stable].all()
    np.testing.assert_allclose(stable.y[is_stable], branch.rms[is_stable, 0])
    assert figure.layout.yaxis.title.text == "Alternating rms of deflection [m]"
    assert unstable.line.dash == "dash"
    # Both parts meet: no gap is left between them.
    assert (np.isfinite(unstable.y) | is_stable)[1:].all()
    assert (np.isfinite(unstable.y) & is_stable).sum() == 2
    folds = [point.parameter for point in branch.special("fold")]
    assert list(traces["fold"].x) == pytest.approx(folds)
    assert figure.layout.xaxis.title.text == "Mesh frequency [Hz]"
    assert figure.layout.title.text == "The branch turns back at 0.1443 Hz and 0.1328 Hz"


def test_a_stable_branch_has_one_curve():
    linear = System([[1.0]], [[0.3]], [[1.0]], [1.0])
    calm = continuation(lambda p: linear, 1.0, parameter="p", between=(0.0, 1.0), steps=64)
    figure = FIGURES["continuation"](calm)
    assert [trace.name for trace in figure.data] == ["stable", "stable", "limit"]
    assert figure.layout.title.text == "The orbit is stable from p 0 to p 1.000"
    with pytest.raises(InputError, match="continuation"):
        FIGURES["continuation"](object())


def test_data_set_has_units_and_special_points(branch):
    data = branch.to_xarray()
    assert data.rms.attrs["units"] == "m or rad"
    np.testing.assert_array_equal(data.rms.values, branch.rms)
    assert list(data.special_kind.values) == [point.kind for point in branch.special_points]
    assert data.attrs["period"] == 1
    assert repr(branch).startswith(f"Branch({branch.parameter.size} orbits of 1 mesh cycle")
