"""Comparison of results: one table of what differs, and overlaid curves."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


@pytest.fixture(scope="module")
def results():
    case = td.load_case("time-varying-friction").replace({"friction.law": "none"})
    return [td.run(case.replace({"operation.torque": t})) for t in ("20 N*m", "40 N*m")]


def test_the_table_holds_the_differences_only(results) -> None:
    comparison = td.compare_results(*results, names=("20", "40"))
    assert comparison.values == {"operation.torque": (20.0, 40.0)}
    first, other = (each.summary() for each in results)
    table = comparison.to_dataframe()
    assert list(table.index) == ["20", "40"]
    # The static force is in proportion to the torque; the geometry does not know of it.
    assert table["static_mesh_force"]["40"] == pytest.approx(2 * table["static_mesh_force"]["20"])
    assert "transverse_contact_ratio" not in table
    for name in table:
        assert table[name]["20"] == first[name]
        assert table[name]["40"] == other[name]
    assert all(
        first[n] == pytest.approx(other[n], rel=1e-9) for n in first.keys() - comparison.figures
    )
    assert "+100 %" in comparison._repr_html_()
    assert "operation.torque" in comparison._repr_html_()


def test_curves_are_those_of_each_result(results) -> None:
    figure = td.compare_results(*results).plot()
    traces = [trace for trace in figure.data if trace.name.startswith("2: ")]
    alone = results[1].plot_transmission_error().data[0]
    np.testing.assert_array_equal(traces[0].y, alone.y)
    np.testing.assert_array_equal(traces[1].y, results[1].plot_mesh_force().data[0].y)
    assert figure.layout.title.text == "Changed: operation.torque"


def test_equal_results_differ_in_nothing(results) -> None:
    comparison = td.compare_results(results[0], results[0], names="ab")
    assert not comparison.values
    assert not comparison.figures


def test_wrong_input_is_refused(results) -> None:
    with pytest.raises(InputError, match="number of results = 1"):
        td.compare_results(results[0])
    with pytest.raises(InputError, match="Expected: 2 distinct names"):
        td.compare_results(*results, names=("a", "a"))
    with pytest.raises(InputError, match=r"results of tribodyn\.run"):
        td.compare_results(results[0], "fzg-report")
