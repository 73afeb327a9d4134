"""Films over time and frequency, their temperatures, and waves in a contact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import InputError
from tribodyn.plot.film.line_contact import contact_scales, window
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import FROM_ZERO, Panel, curves, event_lines, from_zero, stack
from tribodyn.plot.theme.style import POWERS, Trace, heat, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.ehl import AmplitudeReduction, LineContactSolution, TransientLineContact

#: Range and number of the default frequencies, in multiples of the transit frequency.
_LOWEST, _HIGHEST, _POINTS = 0.01, 1.0, 81
#: Relative change of the stiffness that counts as significant.
_CHANGE = 0.1


def transit_frequency(solution: LineContactSolution) -> float:
    """Frequency ``u_e/(2 b)`` at which the oil passes the contact once per period."""
    return float(solution.entrainment_speed / (2.0 * solution.half_width))


def _frequencies(solution: LineContactSolution, frequencies: ArrayLike | None) -> Array:
    if solution.lubricant is None:
        what = "the contact is dimensionless and has no frequencies"
        why = "The Moes parameters do not determine speed and size"
        remedy = "Solve the contact with solve_line_contact"
        raise InputError(what, "argument solution", why, remedy)
    if frequencies is None:
        spread = np.geomspace(_LOWEST, _HIGHEST, _POINTS)
        return np.asarray(transit_frequency(solution) * spread)
    return np.atleast_1d(np.asarray(frequencies, dtype=float))


def _response_title(frequencies: Array, stiffness: Array, static: float) -> str:
    """Title: frequency up to which the stiffness equals the static stiffness."""
    deviating = np.flatnonzero(np.abs(stiffness / static - 1.0) > _CHANGE)
    phrase = f"within {100 * _CHANGE:.0f} % of its static value"
    if deviating.size == 0:
        return f"The film stiffness is {phrase} up to at least {_kilohertz(frequencies[-1])}"
    if deviating[0] == 0:
        return f"The film stiffness is not {phrase} at {_kilohertz(frequencies[0])}"
    change = np.abs(stiffness[: deviating[0] + 1] / static - 1.0)
    limit = np.interp(_CHANGE, change[-2:], frequencies[deviating[0] - 1 : deviating[0] + 1])
    return f"The film stiffness is {phrase} up to {_kilohertz(limit)}"


def _kilohertz(frequency: float) -> str:
    return f"{significant(1e-3 * float(frequency), 2)} kHz"


def film_response(
    solution: LineContactSolution, frequencies: ArrayLike | None = None, *, length: float = 1.0
) -> Any:
    """Draw compliance, stiffness and damping of the film over the frequency of a vibration.

    Parameters
    ----------
    solution : LineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns.
    frequencies : array, optional [Hz]
        Frequencies; by default from a hundredth of the transit frequency up to it.
    length : float [m]
        Length of the contact line.

    Returns
    -------
    plotly.graph_objects.Figure
        A dotted line marks the transit frequency ``u_e/(2 b)``. Where the stiffness is negative
        the film moves against the load; consider its compliance there.

    Raises
    ------
    InputError
        If the contact has no units.
    """
    at = np.sort(_frequencies(solution, frequencies))
    response, dampings = solution.frequency_response(np.concatenate(([0.0], at)), length)
    static, stiffness, damping = float(response[0]), response[1:], dampings[1:]
    compliance = 1.0 / np.abs(stiffness + 2j * np.pi * at * damping)
    transit = transit_frequency(solution)
    inside = int(at[0] <= transit <= at[-1])
    # On a logarithmic axis annotations take the logarithm, shapes the value.
    marks = event_lines([("transit", float(displayed("frequency", transit)))] * inside)
    for note in marks["annotations"]:
        note["x"] = float(np.log10(note["x"]))
    crossing = {"zeroline": True, "zerolinecolor": MUTED, "exponentformat": "power"}
    rows: tuple[tuple[str, str, Any, Trace], ...] = (
        ("compliance", "Compliance", compliance, POWERS),
        ("film_stiffness", "Stiffness", stiffness, crossing),
        ("mesh_damping", "Damping", damping, crossing),
    )
    x = displayed("frequency", at)
    panels = [
        curves(quantity, label, x, [(label.lower(), values, TOTAL)], axis, 0.8)
        for quantity, label, values, axis in rows
    ]
    layout = {"xaxis": POWERS, **marks}
    title = _response_title(at, stiffness, static)
    return stack(title, axis_label("frequency"), panels, layout).figure()


def _films(transient: TransientLineContact, time: object, steady: ArrayLike | None) -> Panel:
    rows: list[tuple[Any, ...]] = [
        ("in the centre", transient.central_film, PAIR_COLORS[2]),
        ("at its thinnest", transient.minimum_film, TOTAL),
    ]
    if steady is not None:
        films = np.asarray(steady, dtype=float)
        if films.shape != transient.time.shape:
            what = f"{films.size} steady films and {transient.time.size} instants"
            why = "Each instant has one steady film to be compared with"
            remedy = "Give the central films of solve_line_contacts at the same instants"
            raise InputError(what, "argument steady", why, remedy)
        rows.append(("in the centre, steady", films, MUTED, "dash"))
    return curves("film_thickness", "Film", time, rows, usual_films(transient.central_film))


def usual_films(film: Array) -> Trace:
    """Axis of films without the thick film of a contact that carries little load."""
    thick = displayed("film_thickness", film)
    return {"range": [0.0, float(min(1.05 * np.max(thick), 4.0 * np.median(thick)))]}


@drawing(
    heading="Film over time",
    of="TransientLineContact",
    made_by="Call tribodyn.ehl.solve_transient_line_contact and its plot method.",
)
def film_transient(transient: TransientLineContact, *, steady: ArrayLike | None = None) -> Sketch:
    """Draw load, central and minimum film and the maximum pressure over time.

    Load, film and maximum pressure of a contact over time. Where the load rises, the squeeze effect
    delays the thinning of the film.

    Parameters
    ----------
    transient : TransientLineContact
        What :func:`tribodyn.ehl.solve_transient_line_contact` returns.
    steady : array, optional [m]
        Central films of steady contacts under the load, radius and speed of every instant; the
        distance to them is the squeeze effect.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        If the steady films are not as many as the instants.
    """
    time = displayed("time", transient.time)

    def panel(quantity: str, label: str, values: object) -> Panel:
        return curves(quantity, label, time, [(label, values, TOTAL)], FROM_ZERO, 0.6)

    at = int(np.argmin(transient.minimum_film))
    least = rounded("film_thickness", transient.minimum_film[at])
    panels = [
        panel("load_per_width", "Load", transient.load_per_width),
        _films(transient, time, steady),
        panel("hertz_pressure", "Maximum pressure", transient.maximum_pressure),
    ]
    title = f"The film is thinnest, {least}, after {rounded('time', transient.time[at])}"
    return stack(title, axis_label("time"), panels)


#: Levels of the height, and height over the central film up to which it is drawn.
_LEVELS, _DRAWN = 61, 1.8
_ZERO, _UNIT = 273.15, display_unit("temperature")


def _in_film(solution: Any, inside: Array, position: Array, film_scale: float) -> Trace:
    """Temperature over position and height, empty outside of the film."""
    top = _DRAWN * solution.central_film
    height = np.linspace(0.0, top, _LEVELS)
    film, temperature = solution.film[inside], solution.film_temperature[inside] - _ZERO
    columns = [
        np.interp(height / thick, solution.height, column, right=np.nan)
        for thick, column in zip(film, temperature, strict=True)
    ]
    bar = {"title": {"text": _UNIT}, "len": 0.5, "y": 0.78, "thickness": 14}
    values, hover = np.array(columns).T, f"%{{z:.1f}} {_UNIT}"
    return heat(position, film_scale * height, values, "Inferno", hover, colorbar=bar)


def _temperatures(label: str, x: object, oil: Any, surfaces: Any, name: str) -> Panel:
    """Panel with the temperatures of the oil and of both surfaces [K]."""
    names = ("surface 1", "surface 2")
    rows = ((name, oil, TOTAL), *zip(names, surfaces, PAIR_COLORS, strict=False))
    traces = [line(x, values - _ZERO, name, color, unit=_UNIT) for name, values, color in rows]
    return Panel(axis_label("temperature", label), traces)


@drawing(
    heading="Temperature of the film",
    of="ThermalLineContactSolution",
    made_by="Call tribodyn.ehl.solve_line_contact with thermal=True, then this figure.",
)
def film_temperature(solution: Any) -> Sketch:
    """Draw the temperatures of a heated line contact, the inlet on the left.

    Temperature in the film over the position and the distance from surface 1, the inlet on the
    left; below it that of both surfaces and of the oil halfway between them.

    Parameters
    ----------
    solution : ThermalLineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns with ``thermal``.

    Returns
    -------
    plotly.graph_objects.Figure
        Temperature in the film, and along both surfaces and halfway between them.
    """
    (scales,) = contact_scales([solution], dimensionless=False)
    first, last = window(solution)
    inside = (solution.position >= first) & (solution.position <= last)
    position = scales.position * solution.position[inside]
    middle = solution.film_temperature[inside, solution.height.size // 2]
    surfaces = [each[inside] for each in solution.surface_temperatures]
    hottest = float(solution.film_temperature.max()) - _ZERO
    surface = float(solution.surface_temperatures.max()) - _ZERO
    marks = event_lines([("centre", 0.0), ("outlet", scales.position * solution.outlet)])
    height = axis_label("film_thickness", "Height in the film")
    panels = [
        Panel(height, [_in_film(solution, inside, position, scales.film)]),
        _temperatures("Temperature", position, middle, surfaces, "middle of the film"),
    ]
    title = f"The film gets {hottest:.0f} {_UNIT} hot, its surfaces {surface:.0f} {_UNIT}"
    return stack(title, scales.position_label, panels, marks)


@drawing(
    heading="Temperature of the film over time",
    of="ThermalTransientLineContact",
    made_by="Call tribodyn.ehl.solve_transient_line_contact with thermal=True and its plot method.",
)
def film_temperature_over_time(transient: Any) -> Sketch:
    """Draw film, temperatures and friction of a heated line contact over time.

    Film, highest temperature of the oil and of both surfaces, and friction of a contact over time.

    Parameters
    ----------
    transient : ThermalTransientLineContact
        What :func:`tribodyn.ehl.solve_transient_line_contact` returns with ``thermal``.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    time, oil = displayed("time", transient.time), transient.highest_film_temperature
    surfaces = transient.highest_surface_temperatures
    films = (
        ("film in the centre", transient.central_film, PAIR_COLORS[2]),
        ("film at its thinnest", transient.minimum_film, MUTED),
    )
    friction = line(time, transient.friction_coefficient, "friction", TOTAL, unit="1")
    panels = [
        curves("film_thickness", "Film", time, films, usual_films(transient.central_film)),
        _temperatures("Highest temperature", time, oil, surfaces, "oil"),
        from_zero(axis_label("friction_coefficient", "Friction"), [friction], height=0.6),
    ]
    hottest = int(np.argmax(oil))
    title = (
        f"The oil gets {oil[hottest] - _ZERO:.0f} {_UNIT} hot, after "
        f"{rounded('time', transient.time[hottest])}"
    )
    return stack(title, axis_label("time"), panels)


_TICKS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]


@drawing(
    heading="Waves in the contact",
    of="AmplitudeReduction",
    made_by="Call tribodyn.ehl.solve_amplitude_reduction(...) and its plot method.",
)
def amplitude_reduction(waves: AmplitudeReduction) -> Sketch:
    """Draw the amplitude that waves keep over their length, with the curve of pure rolling.

    Amplitude of waves in the film over that of the free surface. Waves that are short against the
    inlet pass the contact as they are; long ones are flattened by the pressure. The curve is the
    fit of Venner, Couhier, Lubrecht and Greenwood to pure rolling.
    """
    from tribodyn.ehl import amplitude_reduction as fitted

    order = np.argsort(waves.wave_number, kind="stable")
    number = waves.wave_number[order]
    curve = np.geomspace(0.5 * number[0], 2.0 * number[-1], 200)
    per_number = waves.wavelength[0] / waves.wave_number[0]
    ratio = fitted(curve * per_number, waves.half_width, waves.moes_load, waves.moes_viscosity)
    solved = line(number, waves.amplitude_ratio[order], "transient solution", PINION)
    slide = waves.slide_to_roll_ratio
    motion = "pure rolling" if slide == 0.0 else f"a slide-to-roll ratio of {slide:g}"
    least, most = (significant(f(waves.amplitude_ratio), 2) for f in (np.min, np.max))
    title = f"Waves keep {least} to {most} of their amplitude in {motion}"
    fit = line(curve, ratio, "fit for pure rolling", MUTED, dash="dash")
    solved |= {"mode": "markers", "marker": {"size": 9}}
    panel = Panel("Amplitude over that of the free surface", [fit, solved], {"range": [0.0, 1.02]})
    label = "Wavelength / half width · M<sup>3/4</sup> L<sup>-1/2</sup>"
    axis = {"type": "log", "tickvals": _TICKS, "tickformat": "~g"}
    return stack(title, label, [panel], {"xaxis": axis})
