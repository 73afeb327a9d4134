"""Figures of basins, maps, sections, phase portraits and Lyapunov exponents."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from known_systems import hysteresis_system
from tribodyn.analysis import basins, lyapunov_exponents, parameter_map, phase_portrait, poincare
from tribodyn.dynamics import simulate, steady_state
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES
from tribodyn.record import Record

BEAT = 0.88 / (2.0 * np.pi)


def test_plane_of_starts_has_one_colour_for_each_attractor():
    basin_plane = basins(
        hysteresis_system(), BEAT, between=((-3.0, 3.0), (-2.0, 2.0)), points=(9, 7), steps=64,
        verdict=False,
    )  # fmt: skip
    figure = basin_plane.plot()
    plane, large, small = figure.data
    assert np.array_equal(plane.z, basin_plane.attractor.T)
    assert len({color for _, color in plane.colorscale}) == 3
    assert large.name.startswith("period 1, rms 0.667 m:")
    assert small.x[0] == pytest.approx(basin_plane.attractors[1].position[0, 0])
    assert figure.layout.xaxis.title.text == "Q0 [m]"
    assert figure.layout.yaxis.title.text == "Q0 velocity [m/s]"
    assert figure.layout.title.text.startswith("2 attractors coexist")
    assert basin_plane.to_xarray()["share"].values.sum() == pytest.approx(1.0)


def test_states_without_an_attractor_are_not_said_to_reach_it():
    plane = basins(
        hysteresis_system(), BEAT, between=((-3.0, 3.0), (-2.0, 2.0)), points=(3, 3), steps=64,
        verdict=False,
    )  # fmt: skip
    reached = np.where(plane.attractor == 0, 0, -1)
    lone = replace(plane, attractors=plane.attractors[:1], attractor=reached)
    title = lone.plot().layout.title.text
    assert title.startswith(f"{100.0 * plane.attractors[0].share:.3g} % of the initial states")
    assert "All" not in title


def test_map_shows_period_rms_and_loss():
    beats = np.array([0.7, 0.88, 1.0]) / (2.0 * np.pi)
    over = (("mesh_frequency", beats), ("force_scale", [0.5, 1.0]))
    map_result = parameter_map(hysteresis_system(), over=over)
    figure = map_result.plot()
    period, rms, loss = figure.data
    assert np.array_equal(period.z, np.zeros((2, 3)))
    assert rms.z == pytest.approx(map_result.rms.T)
    assert loss.z == pytest.approx(100.0 * map_result.contact_loss_share.T)
    assert rms.colorbar.title.text == "Rms [m]"
    assert period.customdata[0][0][1] == "physical"
    assert figure.layout.xaxis.title.text == "Mesh frequency [Hz]"


def test_section_of_an_orbit_is_one_point():
    section = poincare(hysteresis_system(), BEAT, steps=64)
    figure = section.plot("q0")
    assert Record.plot(section, "q0") == figure
    (points,) = figure.data
    assert len(points.x) == 1
    assert figure.layout.title.text == "Period of one mesh cycle: one point"
    low, high = figure.layout.xaxis.range
    assert low < points.x[0] < high


def test_portrait_marks_the_backlash():
    orbit = steady_state(hysteresis_system(), BEAT, steps=128)
    figure = phase_portrait(orbit, 0, gap=1.0).plot()
    assert figure.layout.xaxis.title.text == "Compression of the contact [m]"
    assert 1.0 in [shape.x0 for shape in figure.layout.shapes]
    motion = simulate(hysteresis_system(), BEAT, 2, ([0.0], [0.0]), steps=64)
    open_one = phase_portrait(motion, "q0").plot()
    assert len(open_one.layout.shapes) == 0
    assert len(open_one.data[1].x) == 2


def test_exponents_end_at_their_result():
    exponents = lyapunov_exponents(hysteresis_system(), BEAT, cycles=60, transient=60, steps=64)
    figure = exponents.plot()
    curves = [trace for trace in figure.data if trace.name == "exponent 1"]
    assert curves[0].y[-1] == pytest.approx(exponents.growth.mean(axis=0).max())
    assert figure.layout.title.text.startswith("Not chaotic")
    assert figure.layout.yaxis.title.text == "Exponent [1/s]"


@pytest.mark.parametrize(
    "name", ["basins", "parameter_map", "poincare", "phase_portrait", "lyapunov"]
)
def test_other_results_are_refused(name):
    with pytest.raises(InputError, match="This figure draws"):
        FIGURES[name](object())
