"""Every class of results has a figure: what ``.plot()`` of each of them draws."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import tribodyn
from known_figures import curve
from tribodyn.analysis import (
    OrderCut,
    OverallLevel,
    SynchronousAverage,
    envelope_spectrum,
    sidebands,
    spectrum,
    time_synchronous_average,
)
from tribodyn.analysis import Spectrum as HarmonicSpectrum
from tribodyn.cases import PaperComparison
from tribodyn.drawing import FIGURES, Drawing, draw, drawing, load_figures
from tribodyn.dynamics import AdaptiveSolution
from tribodyn.ehl import AmplitudeReduction, MixedLineContact, amplitude_reduction
from tribodyn.errors import InputError
from tribodyn.gear import HypoidKinematics
from tribodyn.record import Record
from tribodyn.study import DataSet
from tribodyn.study.heat_balance import HeatBalance
from tribodyn.uncertainty import Band, SobolIndices

RATE = 5000.0
TIME = np.arange(10_000) / RATE
TURN = 2.0 * np.pi * 12.5 * TIME


def classes() -> Iterator[type[Any]]:
    """All records of the package, and all public classes with a plot method."""
    types: dict[type[Any], None] = {}
    for module in pkgutil.walk_packages(tribodyn.__path__, "tribodyn."):
        if module.name.split(".")[1] in ("app", "cli", "__main__"):
            continue
        names = vars(importlib.import_module(module.name))
        types |= {each: None for each in names.values() if isinstance(each, type)}
    for each in types:
        drawable = issubclass(each, Record) or callable(getattr(each, "plot", None))
        if drawable and each.__module__.startswith("tribodyn.") and each is not Record:
            yield each


def undrawn(kinds: list[type[Any]]) -> list[str]:
    """Classes that no figure draws; a base of other results counts as they do."""
    load_figures()
    figures = [FIGURES[name] for name in FIGURES]
    names = {place for each in figures if isinstance(each, Drawing) for place in each.of}
    return [
        f"{each.__module__}.{each.__name__}"
        for each in kinds
        if not names & {kind.__name__ for kind in each.__mro__}
        and not any(other is not each and issubclass(other, each) for other in kinds)
    ]


def test_every_result_has_its_plot() -> None:
    kinds = list(classes())
    assert len(kinds) > 55
    assert undrawn(kinds) == []


def test_a_result_without_a_figure_would_be_detected() -> None:
    class Lonely(Record):
        pass

    assert undrawn([Lonely, SobolIndices]) == [f"{__name__}.Lonely"]
    with pytest.raises(InputError, match="no figure draws a Lonely"):
        draw(Lonely())


def axes(figure: Any) -> list[str]:
    layout = figure.layout
    keys = sorted(key for key in layout if key.startswith(("xaxis", "yaxis")))
    return [layout[key].title.text for key in keys]


def test_a_spectrum_marks_its_peaks_between_the_lines() -> None:
    wave = 4.0 + 3.0 * np.cos(2 * np.pi * 500.3 * TIME) + 1.0 * np.cos(2 * np.pi * 1200.0 * TIME)
    figure = spectrum(wave, RATE, window="hann", unit="m/s^2").plot()
    assert axes(figure) == ["Frequency [Hz]", "Amplitude [m/s²]"]
    peaks = curve(figure, "largest peaks")
    assert peaks.x == pytest.approx([500.3, 1200.0], abs=1e-3)
    assert peaks.y == pytest.approx([3.0, 1.0], rel=1e-3)
    assert curve(figure, "spectrum").x[0] > 0.0, "the mean is no line"


def test_the_spectrum_of_an_envelope_is_drawn_without_its_mean() -> None:
    wave = (2.0 + 1.5 * np.cos(2 * np.pi * 30.0 * TIME)) * np.cos(2 * np.pi * 800.0 * TIME)
    figure = envelope_spectrum(wave, RATE, unit="g").plot()
    assert figure.layout.title.text == "Strongest at 30.00 Hz: 1.50 g"


def test_a_density_is_drawn_on_a_logarithmic_scale() -> None:
    noise = np.random.default_rng(0).standard_normal(TIME.size)
    figure = spectrum(noise, RATE, scaling="density", block_length=500, unit="N").plot()
    assert figure.layout.yaxis.type == "log"
    assert figure.layout.yaxis.title.text == "Spectral density [(N)²/Hz]"


def test_a_long_spectrum_loses_no_peak() -> None:
    time = np.arange(200_000) / RATE
    figure = spectrum(np.cos(2 * np.pi * 333.325 * time), RATE).plot()
    lines = curve(figure, "spectrum")
    assert len(lines.x) <= 8000
    assert max(lines.y) == pytest.approx(1.0, rel=2e-3)


def test_harmonics_are_bars_over_the_order() -> None:
    lines = HarmonicSpectrum(
        240.0 * np.arange(1, 4), np.arange(1.0, 4), np.array([2.0, 5.0, 1.0]), "N"
    )
    figure = lines.plot()
    assert figure.layout.title.text == "Harmonic 2 (480 Hz) is the strongest: 5.00 N"
    assert list(figure.data[0].y) == [2.0, 5.0, 1.0]


def test_sidebands_lie_on_both_sides_of_their_carrier() -> None:
    wave = (1.0 + 0.4 * np.cos(TURN)) * 5.0 * np.cos(32 * TURN)
    figure = sidebands(wave, RATE, 400.0, 12.5, count=2, unit="m/s^2").plot()
    assert "amplitude modulation 40.0 %" in figure.layout.title.text
    assert list(curve(figure, "carrier").x) == [400.0]
    assert curve(figure, "sidebands").y == pytest.approx([0.0, 1.0, 1.0, 0.0], abs=1e-6)


def test_orders_and_levels_are_drawn_over_the_speed_in_rpm() -> None:
    speed, size = np.array([10.0, 20.0, 30.0]) * np.pi, np.array([1.0, 4.0, 2.0])
    cut = OrderCut(29.0, speed, size, "m/s^2").plot()
    level = OverallLevel(np.arange(3.0), speed, size, "N").plot()
    assert cut.layout.title.text == "Order 29 reaches 4.00 m/s² at 600.0 rpm"
    assert level.layout.title.text == "Highest level at 600.0 rpm: 4.00 N rms"
    for figure in (cut, level):
        assert list(figure.data[0].x) == pytest.approx([300.0, 600.0, 900.0])
        assert axes(figure)[0] == "Speed [rpm]"


def average_with_bump(at: float) -> SynchronousAverage:
    wave = 2.0 * np.cos(20 * TURN) + 0.5 * np.cos(21 * TURN + 0.4)
    bump = np.exp(-(((np.mod(TURN, 2 * np.pi) - at) / 0.03) ** 2))
    return time_synchronous_average(
        wave + bump * np.cos(60 * (np.mod(TURN, 2 * np.pi) - at)), TIME, teeth=20, speed=25 * np.pi,
        unit="m/s^2",
    )  # fmt: skip


def test_the_mean_revolution_shows_where_a_tooth_differs() -> None:
    average = average_with_bump(np.radians(200.0))
    figure = average.plot()
    assert axes(figure) == ["Angle of the shaft [°]", "Mean [m/s²]", "Residual [m/s²]",
                            "Difference [m/s²]"]  # fmt: skip
    assert figure.layout.title.text.startswith("25 revolutions: ")
    mean = curve(figure, "mean revolution")
    step = len(mean.x) // average.angle.size
    assert np.asarray(mean.y)[::step] == pytest.approx(average.signal, abs=1e-9)
    for name, values, axis in (
        ("residual", average.residual(), "y2"),
        ("difference", average.difference(), "y3"),
    ):
        trace = curve(figure, name, axis)
        assert np.asarray(trace.y)[::step] == pytest.approx(values, abs=1e-9)
    bump = curve(figure, "difference", "y3")
    assert np.asarray(bump.x)[np.argmax(np.abs(bump.y))] == pytest.approx(200.0, abs=2.0)
    band = [np.asarray(each.y) for each in figure.data if each.name in ("standard error",
            "2 standard errors")]  # fmt: skip
    assert (band[0] - band[1])[::step] == pytest.approx(4.0 * average.scatter, abs=1e-9)


def test_sobol_indices_are_bars_in_percent_with_the_largest_on_top() -> None:
    indices = SobolIndices(
        np.array(["torque", "relief", "bore"]),
        np.array([0.2, 0.5, 0.1]),
        np.array([0.25, 0.65, 0.1]),
        5120,
    )
    figure = indices.plot()
    assert axes(figure) == ["Share of the variance [%]", "Input"]
    first, total = curve(figure, "first order"), curve(figure, "total order")
    assert list(first.y) == list(total.y) == ["bore", "torque", "relief"]
    assert list(first.x) == pytest.approx([10.0, 20.0, 50.0])
    assert list(total.x) == pytest.approx([10.0, 25.0, 65.0])
    assert figure.layout.title.text.startswith("50.0 % of the variance comes from relief alone")


@pytest.mark.parametrize("unit", ["N", ""])
def test_a_band_is_plotted_about_its_mean(unit: str) -> None:
    mean = np.array([1.0, 2.0, 3.0])
    figure = Band(mean, mean - 0.5, mean + 1.5, 0.95, 12, True, unit).plot()
    low, high, middle = figure.data
    assert (low.y[1], middle.y[1], high.y[1]) == (1.5, 2.0, 3.5)
    assert high.name == "95 % band of the curve"
    assert axes(figure) == ["Point", "Mean [N]" if unit else "Mean"]
    single = Band(np.array(2.0), np.array(1.5), np.array(3.5), 0.9, 5, False, unit).plot()
    assert single.data[0].error_y.array[0] == 1.5


def test_places_of_a_band_fit_its_points() -> None:
    mean = np.arange(3.0)
    band = Band(mean, mean, mean, 0.95, 12, False, "m")
    assert list(band.plot([0.0, 0.1, 0.2], "Time [s]").data[2].x) == [0.0, 0.1, 0.2]
    with pytest.raises(InputError, match="x has 2 places"):
        band.plot([0.0, 0.1])


def test_a_table_is_drawn_over_the_column_of_that_name() -> None:
    data = DataSet(
        {"torque": np.array([1.0, 2.0]), "peak_force": np.array([10.0, 30.0])},
        {"torque": "N*m", "peak_force": "N"},
        "", "{}", "1",
    )  # fmt: skip
    figure = data.plot()
    assert axes(figure) == ["Torque [N·m]", "Peak force<br>[N]"]
    assert list(figure.data[0].y) == [10.0, 30.0]
    assert list(data.plot("peak_force").data[0].x) == [10.0, 30.0]
    with pytest.raises(InputError, match='Did you mean "torque"'):
        data.plot("torqe")


def test_a_response_is_drawn_with_forces_and_accelerations() -> None:
    time = np.arange(4) / 1000.0
    motion = np.arange(8.0).reshape(4, 2)
    force = np.array([[0.0], [100.0], [300.0], [200.0]])
    run = type("Response", (SimpleNamespace,), {})(
        time=time, periods=1, mesh_frequency=250.0, floquet_multipliers=np.zeros(0),
        names=("pinion_y", "pinion_theta"), acceleration=motion,
        deflection=1e-6 * force, contact_force=force,
    )  # fmt: skip
    figure = draw(run)
    assert axes(figure) == ["Time [ms]", "Contact force [N]", "Compression [µm]",
                            "Acceleration [m/s²]", "Angular acceleration [rad/s²]"]  # fmt: skip
    assert list(figure.data[0].y) == [0.0, 100.0, 300.0, 200.0]
    assert list(figure.data[2].y) == [0.0, 2.0, 4.0, 6.0]
    assert figure.layout.title.text.endswith("contact force 0 to 300 N")


def test_an_adaptive_motion_shows_its_steps() -> None:
    time = np.array([0.0, 0.1, 0.4, 1.4])
    state = np.zeros((4, 4))
    state[:, 1] = 1.0, 2.0, 3.0, 4.0
    run = AdaptiveSolution(time, time, state, ("x", "theta"), 1.0, 1e-6, np.zeros(4), 2, 5, 0.0,
                           np.zeros(0))  # fmt: skip
    figure = run.plot()
    assert figure.layout.xaxis.title.text == "Time [s]"
    assert list(curve(figure, "step", "y3").y) == pytest.approx([0.1, 0.1, 0.3, 1.0])
    assert list(curve(figure, "theta", "y2").y) == [1.0, 2.0, 3.0, 4.0]
    assert "3 steps" in figure.layout.title.text


def test_mixed_contacts_stand_over_the_film_ratio() -> None:
    share = np.array([0.9, 0.2])
    load, half = np.array([2e5, 2e5]), np.array([1e-4, 1e-4])
    contact = MixedLineContact(load, share, 1e-6 * share, 1e-6 * share, np.array([2.0, 0.3]),
                               np.array([1e9, 1e9]), half, "dowson-higginson")  # fmt: skip
    figure = contact.plot()
    assert list(figure.data[0].x) == [0.3, 2.0]
    assert list(curve(figure, "oil film").y) == pytest.approx([20.0, 90.0])
    pressure = curve(figure, "mean of the asperities", "y3")
    assert list(pressure.y) == pytest.approx([0.8, 0.1], rel=1e-12), "GPa"
    assert figure.layout.title.text == "The oil film carries 20.0 to 90.0 % of the load"


def test_hypoid_flanks_are_drawn_by_their_contact_lines() -> None:
    speed = np.array([[1.0, 3.0], [2.0, 6.0], [4.0, 4.0]])
    vectors = np.zeros((3, 2, 3))
    motion = HypoidKinematics(np.radians([0.0, 5.0, 10.0]), vectors, speed, speed, speed, speed,
                              speed, 1e-3 * speed, vectors, vectors, vectors, 100.0, "contact",
                              SimpleNamespace())  # type: ignore[arg-type]  # fmt: skip
    figure = motion.plot()
    radius = next(each for each in figure.data if each.name == "radius" and each.hovertemplate)
    assert list(radius.x) == pytest.approx([0.0, 5.0, 10.0])
    assert list(radius.y) == pytest.approx([2.0, 4.0, 4.0]), "mm"
    means = [each for each in figure.data if each.name == "sliding" and each.hovertemplate]
    assert list(means[0].y) == [2.0, 4.0, 4.0]
    assert "slide at 1.00 to 6.00 m/s with the pinion at 954.9 rpm" in figure.layout.title.text


def test_heat_is_balanced_where_the_line_meets_the_loss() -> None:
    loss = np.array([120.0, 105.0, 100.0])
    balance = HeatBalance(np.arange(1.0, 4.0), 293.15 + np.array([10.0, 30.0, 20.0]), loss,
                          5.0 * np.array([10.0, 30.0, 20.0]), 5.0, 293.15)  # fmt: skip
    figure = balance.plot()
    assert figure.layout.title.text == "Gears and oil settle at 40.00 °C with a loss of 100 W"
    assert axes(figure) == ["Temperature of gears and oil [°C]", "Power [W]"]
    given_off = curve(figure, "dissipated heat")
    assert np.interp(40.0, given_off.x, given_off.y) == pytest.approx(100.0)
    assert list(curve(figure, "loss of the gearbox").x) == pytest.approx([30.0, 40.0, 50.0])


def test_printed_numbers_are_drawn_by_their_deviation() -> None:
    row = {"table": "Table 1", "row": "k", "unit": "1", "printed": 2.0, "reason": ""}
    rows = tuple(
        {**row, "computed": 2.0 + 2.0 * away, "deviation": away, "verdict": verdict}
        for away, verdict in ((0.0, "value"), (0.005, "value"), (-0.3, "cannot-reproduce"))
    )
    none = {**row, "computed": "rises", "printed": "falls", "deviation": None, "verdict": "trend"}
    figure = PaperComparison(("a",), (*rows, none), (), 0).plot()
    assert figure.layout.title.text == "2 of 3 printed values agree within 1 %"
    value, other = figure.data
    assert list(value.y) == pytest.approx([1e-3, 0.5])
    assert list(value.marker.symbol) == ["circle", "triangle-up"]
    assert (list(other.x), list(other.marker.symbol)) == ([3], ["triangle-down"])
    assert "-30 %" in other.customdata[0]
    with pytest.raises(InputError, match="No row"):
        PaperComparison(("a",), (none,), (), 0).plot()


def test_waves_stand_over_their_number_with_the_fit() -> None:
    waves = AmplitudeReduction(np.array([2e-4, 1e-4]), np.array([0.3, 0.6]), np.array([0.3, 0.6]),
                               np.array([6.0, 3.0]), 1e-4, 5e-7, 0.5, 20.0, 10.0)  # fmt: skip
    figure = waves.plot()
    assert list(curve(figure, "transient solution").x) == [3.0, 6.0]
    fit = curve(figure, "fit for pure rolling")
    # 20^(3/4)/sqrt(10) b is a wave of the number 3 here: the fit is drawn over the number
    length = fit.x[0] * 1e-4 / 3.0
    assert fit.y[0] == pytest.approx(float(amplitude_reduction(length, 1e-4, 20.0, 10.0)))
    assert "0.30 to 0.60 of their amplitude in a slide-to-roll ratio of 0.5" in (
        figure.layout.title.text
    )


def test_the_caption_of_a_figure_is_the_second_paragraph_of_its_docstring() -> None:
    def level(values: Any) -> str:
        """Draw the level.

        A line that rises
        is louder.

        Parameters
        ----------
        values : Level
        """
        return f"{values}"

    def bare(values: Any) -> str:
        """Draw the level.

        Parameters
        ----------
        values : Level
        """
        return f"{values}"

    before = FIGURES.names()
    try:
        drawn = drawing("level-with-docstring", heading="Level")(level)
        assert drawn.caption_of(1.0) == "A line that rises is louder."
        with pytest.raises(TypeError, match="bare has no caption"):
            drawing("level-without-caption", heading="Level")(bare)
    finally:
        FIGURES._items.pop("level-with-docstring", None)
    assert FIGURES.names() == before
