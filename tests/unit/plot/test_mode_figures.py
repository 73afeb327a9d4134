"""Figures of natural modes, of the Campbell diagram and of the response to an error."""

import numpy as np
import pytest

from known_figures import curve
from known_systems import reference_system
from tribodyn import plot
from tribodyn.dynamics import campbell, forced_response, fzg12, natural_modes
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES
from tribodyn.study import MachineCampbell
from tribodyn.study.machine.modes import nearest_first


def test_bars_are_the_energy_shares() -> None:
    modes = natural_modes(reference_system())
    figure = modes.plot()
    assert "77 % of the strain at 5276 Hz" in figure.layout.title.text
    moving, mesh = curve(figure, "pinion"), curve(figure, "mesh", "y2")
    np.testing.assert_allclose(moving.y, 100.0 * modes.body_share()["pinion"][1:])
    np.testing.assert_allclose(mesh.y, 100.0 * modes.strain_share[1:, -1])
    assert len(set(mesh.x)) == 5
    assert figure.layout.barmode == "stack"


def test_ramps_of_a_force_law_are_one_mesh() -> None:
    from tribodyn.dynamics import Contact, System

    def ramp(stiffness: float, gap: float) -> Contact:
        return Contact([1.0, -1.0], stiffness=stiffness, gap=gap)

    ramps = [ramp(2e8, 0.0), ramp(1e8, 1e-6), ramp(5e7, 2e-6)]
    pair = System(
        np.diag([1.0, 2.0]), np.zeros((2, 2)), np.diag([1e7, 0.0]), [900.0, -900.0], ramps
    )
    modes = natural_modes(pair)
    names = {trace.name for trace in modes.plot().data if trace.yaxis == "y2"}
    assert modes.contacts == 3
    assert "mesh" in names
    assert not [name for name in names if name.startswith("contact")]
    np.testing.assert_allclose(
        curve(modes.plot(), "mesh", "y2").y, 100.0 * modes.contact_share[modes.rigid :]
    )


def test_the_operating_speed_is_marked() -> None:
    import tribodyn as td

    case = td.load_case("fzg-roughness")
    diagram = td.campbell(case, ("1000 rpm", "5000 rpm"))
    (mark,) = diagram.plot().layout.shapes
    assert mark.x0 == pytest.approx(case.operation.speed * 30.0 / np.pi)
    # a harmonic of z teeth meets a mode at 60 f / (order z)
    teeth = case.gears.pinion.teeth
    for met in diagram.resonances:
        expected = 60.0 * met.frequency / (met.order * teeth)
        assert met.speed * 30.0 / np.pi == pytest.approx(expected, rel=1e-12)
    assert diagram.resonances


def test_modes_of_one_frequency_keep_a_bar_each() -> None:
    modes = natural_modes(fzg12())
    figure = FIGURES["mode_shapes"](modes)
    assert len(set(curve(figure, "wheel").x)) == 11
    looks = [
        (trace.marker.color, trace.marker.pattern.shape)
        for trace in figure.data
        if trace.yaxis == "y2"
    ]
    assert len(set(looks)) == len(looks) == 11
    strains = [np.asarray(trace.y) for trace in figure.data if trace.yaxis == "y2"]
    np.testing.assert_allclose(sum(strains), 100.0, atol=0.5)


def test_campbell_diagram_in_display_units() -> None:
    diagram = campbell(reference_system(), np.linspace(50.0, 1500.0, 8), teeth=16, orders=(1, 4))
    figure = diagram.plot()
    rising = curve(figure, "harmonic 4")
    assert np.asarray(rising.x)[-1] == pytest.approx(1500.0 * 30.0 / np.pi)
    assert np.asarray(rising.y)[-1] == pytest.approx(4 * 16 * 1500.0 / (2.0 * np.pi))
    met = curve(figure, "resonance")
    assert len(met.x) == len(diagram.resonances)
    np.testing.assert_allclose(met.y, [each.frequency for each in diagram.resonances])
    assert "Harmonic 4 meets 5276 Hz, 77 % mesh, at 4947 rpm" in figure.layout.title.text
    assert [label for label in rising.text if label] == ["4"]
    none = campbell(reference_system(), [1.0, 2.0], teeth=16, orders=(1,)).plot()
    assert none.layout.title.text == "None of 1 mesh harmonics meets a natural frequency"


def test_response_shows_amplitudes_in_display_units() -> None:
    response = forced_response(reference_system(), np.linspace(500.0, 9000.0, 18), error=2e-6)
    figure = response.plot()
    np.testing.assert_allclose(curve(figure, "mesh force").y, np.abs(response.mesh_force))
    approach = 1e6 * np.abs(response.transmission_error[:, 0])
    np.testing.assert_allclose(curve(figure, "approach", "y2").y, approach)
    assert figure.layout.title.text.startswith("An error of 2.00 µm causes up to ")


@pytest.mark.parametrize("name", ["campbell", "mode_shapes", "forced_response"])
def test_results_of_other_kinds_are_refused(name: str) -> None:
    with pytest.raises(InputError, match=r"Call tribodyn\.dynamics"):
        FIGURES[name](object())


def _diagram(frequency: list[float], shares: list[list[float]]) -> MachineCampbell:
    """Modes that do not change with the speed, and two harmonics of a mesh of 10 teeth."""
    speed = np.linspace(0.0, 400.0, 5)
    return MachineCampbell(
        speed, np.tile(frequency, (5, 1)), ("mesh first x 1", "mesh first x 2", "shaft input"),
        np.array([10.0, 20.0, 1.0]), 300.0, np.array(shares),
    )  # fmt: skip


def test_only_modes_that_a_mesh_strains_and_meets_are_emphasised():
    nothing = float("nan")
    diagram = _diagram(
        [300.0, 500.0, 2000.0], [[0.4, 0.4, nothing], [0.0, 0.0, nothing], [0.9, 0.9, nothing]]
    )
    met = diagram.meetings()
    # Constant frequencies are met at 2 pi f / order, the nearest to the operation first.
    assert [each.speed for each in met] == pytest.approx(
        [2.0 * np.pi * 300.0 / 10.0, 2.0 * np.pi * 300.0 / 20.0]
    )
    assert [each.frequency for each in met] == pytest.approx([300.0] * 2)
    figure = plot.machine_campbell(diagram)
    modes = [trace for trace in figure.data if trace.name == "natural mode"]
    widths = [trace.line.width for trace in modes]
    assert widths[0] > widths[1]  # the second mode does not strain the mesh
    assert "300.0 Hz at 1800 rpm" in figure.layout.title.text
    still = plot.machine_campbell(_diagram([500.0], [[0.0, 0.0, nothing]]))
    assert still.layout.title.text.startswith("No mesh meets")


@pytest.mark.parametrize("count", [8, 25])
def test_a_table_of_modes_begins_with_those_nearest_to_an_excitation(count):
    distance = np.random.default_rng(count).normal(size=count)
    rows = nearest_first(list(range(count)), distance)
    assert sorted(rows) == list(range(count))
    if count <= 10:
        assert rows == list(range(count))
    else:
        nearest = np.abs(distance)[rows[:10]]
        assert np.all(np.diff(nearest) >= 0.0)
        assert nearest.max() <= np.abs(distance)[rows[10:]].min()
        assert rows[10:] == sorted(rows[10:])


def test_modes_that_are_close_keep_readable_numbers():
    nothing = float("nan")
    diagram = _diagram([300.0, 301.0, 500.0], [[0.4, 0.4, nothing]] * 3)
    figure = plot.machine_campbell(diagram)
    numbers = [trace.text[0] for trace in figure.data if trace.name == "natural mode"]
    assert [text.strip() for text in numbers] == ["1", "2", "3"]
    # The number of the second stands beside that of the first, that of the third by itself.
    assert len(numbers[0]) < len(numbers[1]) > len(numbers[2])
    # Names at the ends of the lines have room within the axis.
    assert figure.layout.xaxis.range[1] > 400.0 * 30.0 / np.pi
    assert len([t for t in figure.data if t.name == "turning shafts" and t.showlegend]) == 1


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_rigid_shafts_have_no_shapes_to_draw() -> None:
    from tribodyn.cases.load import load_case
    from tribodyn.machine import machine_modes
    from tribodyn.study.machine.run import structure_at_rest

    modes = machine_modes(structure_at_rest(load_case("planetary-stage")))
    assert "rigid" in plot.machine_modes.missing(modes)
