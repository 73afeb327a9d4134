"""Figures of recorded signals: spectrogram and order map."""

import numpy as np
import pytest

from tribodyn.analysis import Spectrogram, order_map, spectrogram
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES, waterfall
from tribodyn.plot import order_map as draw_order_map
from tribodyn.plot import spectrogram as draw_spectrogram
from tribodyn.plot.signals.spectra import amplitude_heatmap, strongest_orders

RATE = 2000.0
TIME = np.arange(8001) / RATE
ROTATION = 2 * np.pi * (10.0 * TIME + 2.0 * TIME**2)
SIGNAL = 3.0 * np.cos(8 * ROTATION) + 0.5 * np.cos(ROTATION)


@pytest.fixture(scope="module")
def run_up():
    return order_map(SIGNAL, TIME, rotation=ROTATION, highest_order=12, unit="m/s^2")


def test_order_map_names_the_strongest_order(run_up):
    figure = draw_order_map(run_up)
    assert figure.layout.title.text.startswith("Order 8 is the strongest: 3.00 m/s²")
    assert figure.layout.xaxis.title.text == "Speed [rpm]"
    assert figure.layout.yaxis2.title.text == "Amplitude [m/s²]"
    surface, first, second = figure.data
    assert (first.name, second.name) == ("order 8", "order 1")
    assert np.asarray(first.y) == pytest.approx(3.0, rel=0.01)
    assert np.asarray(second.y) == pytest.approx(0.5, rel=0.01)
    assert np.asarray(surface.x)[0] == pytest.approx(run_up.speed[0] * 30 / np.pi)
    brightest = np.argmax(np.asarray(surface.z).max(axis=1))
    assert np.asarray(surface.y)[brightest] == 8.0
    assert np.asarray(surface.z).max() == 0.0


def test_order_map_over_time_where_the_speed_turns_back(run_up):
    back = 2 * np.pi * (30.0 * TIME - 4.0 * (TIME - 2.0) ** 3 / 3.0)
    turned = order_map(np.cos(4 * back), TIME, rotation=back, highest_order=6)
    figure = draw_order_map(turned)
    assert figure.layout.xaxis.title.text == "Time [s]"
    assert strongest_orders(turned) == [4.0]
    assert strongest_orders(run_up) == [8.0, 1.0]


def test_spectrogram_title_names_frequency_and_time():
    levels = spectrogram(np.where(TIME < 2.0, 0.1, 1.0) * np.cos(2 * np.pi * 250 * TIME), RATE)
    figure = draw_spectrogram(levels)
    assert "Hz after" in figure.layout.title.text
    assert figure.layout.yaxis.title.text == "Frequency [Hz]"
    assert figure.layout.xaxis.title.text == "Time [s]"
    surface, level = figure.data
    assert np.asarray(level.y)[-1] == pytest.approx(1.0 / np.sqrt(2.0), rel=0.01)
    assert np.asarray(surface.z).shape == levels.amplitude[1:].shape


def test_large_maps_keep_their_peaks():
    size = np.full((1000, 1500), 1e-6)
    size[777, 1234] = 2.0
    heatmap = amplitude_heatmap(np.arange(1500.0), np.arange(1000.0), size, "N", "")
    line, column = np.unravel_index(np.argmax(heatmap["z"]), heatmap["z"].shape)
    assert max(heatmap["z"].shape) <= 480
    assert heatmap["x"][column] == pytest.approx(1234, abs=2)
    assert heatmap["y"][line] == pytest.approx(777, abs=2)
    assert heatmap["z"].min() == -3.0


def test_waterfall_of_an_order_map_stacks_its_spectra(run_up):
    figure = waterfall(run_up)
    assert figure.layout.title.text.startswith("The highest peak is 3.00 m/s², order 8 at ")
    first, second = figure.data[:2]
    assert np.asarray(first.y).min() == pytest.approx(0.0, abs=0.01)
    assert np.asarray(second.y).min() == pytest.approx(1.0, abs=0.01)
    assert np.asarray(first.customdata).max() == pytest.approx(3.0, rel=0.01)
    assert np.asarray(first.x)[np.argmax(first.y)] == 8.0
    assert figure.layout.yaxis.ticktext[0].endswith("rpm")
    assert sum(trace.line.width > 2.0 for trace in figure.data) == 1


def test_waterfall_of_a_spectrogram_is_over_frequency():
    levels = spectrogram(np.cos(2 * np.pi * 250 * TIME), RATE, block_length=200, unit="N")
    figure = waterfall(levels)
    assert "1.00 N, 250 Hz at" in figure.layout.title.text
    assert figure.layout.xaxis.title.text == "Frequency [Hz]"
    assert len(figure.data) == 40


@pytest.mark.parametrize("draw", [draw_order_map, draw_spectrogram, waterfall])
def test_other_results_have_no_such_figure(draw):
    assert draw.name in FIGURES
    with pytest.raises(InputError, match=r"tribodyn\.analysis"):
        draw(object())


def test_silence_is_drawn():
    quiet = Spectrogram(np.arange(4.0), np.arange(3.0), np.zeros((4, 3)), 1.0, 6.0, 1.0)
    assert np.asarray(draw_spectrogram(quiet).data[0].z).max() <= 0.0
