"""Figures of hypoid pairs show the numbers of their results."""

import math

import numpy as np
import pytest

from known_hypoids import eased, h1043
from tribodyn.errors import InputError, quiet
from tribodyn.gear import EaseOff, hypoid_flanks, tooth_contact
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import hypoid_friction, hypoid_loaded_contact
from tribodyn.plot import FIGURES

EASE = EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6, bias=6e-6)


@pytest.fixture(scope="module")
def flanks():
    return hypoid_flanks(h1043(), ease_off=EASE, points=15)


@pytest.fixture(scope="module")
def contact(flanks):
    return tooth_contact(flanks, rotations_per_pitch=8, cells=31)


@pytest.mark.parametrize("side", ["drive", "coast"])
@pytest.mark.parametrize("hand", ["left", "right"])
def test_the_pair_has_its_teeth_between_root_and_tip(side, hand):
    blank = h1043(hand_pinion=hand)
    figure = hypoid_flanks(blank, side, EASE, points=5).plot()
    pinion, wheel = (trace for trace in figure.data if trace.type == "mesh3d")
    radius = np.hypot(wheel.x, wheel.y)
    assert 2e-3 * radius.max() == pytest.approx(blank.outer_tip_diameter_wheel, rel=0.01)
    origin = -blank.offset * (1e3 if hand == "left" else -1e3)
    radius = np.hypot(np.subtract(pinion.x, origin), pinion.z)
    assert 2e-3 * radius.max() == pytest.approx(blank.outer_tip_diameter_pinion, rel=0.03)
    for trace, teeth in ((pinion, 10), (wheel, 43)):
        assert len(trace.x) % teeth == 0
    # A tooth is thicker than nothing and thinner than the pitch: its sides do not cross.
    skin = np.stack([wheel.x, wheel.y, wheel.z], axis=-1)[: len(wheel.x) // 43]
    skin = skin.reshape(11, 22, 3)
    angle = np.unwrap(np.arctan2(skin[..., 1], skin[..., 0]), axis=1)
    width = np.abs(angle[5, 5] - angle[5, -6])
    assert 0.2 < width / (2.0 * math.pi / 43) < 0.8
    root = np.abs(angle[5, 0] - angle[5, -1])
    tip = np.abs(angle[5, 10] - angle[5, 11])
    assert root > tip


def test_the_ease_off_is_drawn_with_its_numbers(flanks):
    surface, dots = flanks.plot_ease_off().data
    assert np.asarray(surface.z) == pytest.approx(1e6 * flanks.gap)
    assert np.asarray(surface.y) == pytest.approx(1e3 * flanks.across)
    assert len(dots.x) == flanks.active.sum()


def test_the_pattern_and_the_path_are_those_of_the_contact(contact):
    figure = contact.plot()
    curves = {trace.name: trace for trace in figure.data}
    path, pattern = curves["path of contact"], curves["marked at 6.35 µm"]
    assert np.asarray(path.x) == pytest.approx(1e3 * contact.along[contact.leads])
    inside = contact.marked & contact.leads[:, None]
    # The compound ends between the last marked cell and the next one, or at the end of a line.
    for ends, cells in (
        (pattern.x, contact.cell_along),
        (-np.array(pattern.y), -contact.cell_across),
    ):
        beyond = 1e-3 * max(ends) - cells[inside].max()
        assert 0.0 <= beyond + 1e-12 < np.abs(np.diff(cells, axis=1)).max()
    middle = curves["this pair"]
    pitch = 360.0 / 43
    assert np.subtract(curves["pair after"].x, middle.x) == pytest.approx(pitch)
    assert f"{contact.peak_to_peak * 1e6:.3g} µrad" in figure.layout.title.text


def test_figures_under_load_show_their_figures():
    loaded = hypoid_loaded_contact(eased(), 500.0, steps=16, cells=12)
    (heat, outline) = loaded.plot_pressure().data
    assert 0.9 < np.nanmax(heat.z) * 1e9 / loaded.maximum_pressure <= 1.0
    # What is drawn lies within the flank.
    assert min(outline.x) <= min(heat.x) < max(heat.x) <= max(outline.x)
    assert f"{loaded.maximum_pressure * 1e-9:.3g} GPa" in loaded.plot_pressure().layout.title.text
    shares = [each for each in loaded.plot_load().data if each.name.startswith("pair")]
    assert np.sum([each.y for each in shares], axis=0) == pytest.approx(100.0)
    oil = Lubricant(0.01, 769.0, 2e-8)
    for roughness, names in (
        (0.4e-6, ["friction coefficient", "film ratio", "regimes"]),
        (0.0, ["friction coefficient", "film"]),
    ):
        with quiet():
            rubbed = hypoid_friction(loaded, 314.0, lubricant=oil, composite_roughness=roughness)
        figure = rubbed.plot_friction()
        assert [each.name for each in figure.data if "flank" not in each.name] == names
        assert "inf" not in figure.layout.title.text  # smooth flanks have a film, no ratio


def test_figures_of_other_results_are_refused(contact):
    for name in ("hypoid_pair", "ease_off", "hypoid_blank"):
        with pytest.raises(InputError, match=r"tribodyn\.gear\.hypoid"):
            FIGURES[name](contact)
