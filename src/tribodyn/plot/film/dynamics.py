"""Oil films over time, and their frequency response to small vibration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import drawing
from tribodyn.errors import InputError
from tribodyn.plot.theme.curves import FROM_ZERO, curves
from tribodyn.plot.theme.labels import axis_label, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import MUTED, PAIR_COLORS, TOTAL
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.ehl import LineContactSolution, TransientLineContact

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
    logarithmic = {"type": "log", "exponentformat": "power"}
    crossing = {"zeroline": True, "zerolinecolor": MUTED, "exponentformat": "power"}
    rows: tuple[tuple[str, str, Any, dict[str, Any]], ...] = (
        ("compliance", "Compliance", compliance, logarithmic),
        ("film_stiffness", "Stiffness", stiffness, crossing),
        ("mesh_damping", "Damping", damping, crossing),
    )
    x = displayed("frequency", at)
    panels = [
        curves(quantity, label, x, [(label.lower(), values, TOTAL)], axis, 0.8)
        for quantity, label, values, axis in rows
    ]
    layout = {"xaxis": logarithmic, **marks}
    title = _response_title(at, stiffness, static)
    return stack(title, axis_label("frequency"), panels, layout).figure()


def _films(transient: TransientLineContact, time: Any, steady: ArrayLike | None) -> Panel:
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


def usual_films(film: Array) -> dict[str, Any]:
    """Axis of films without the thick film of a contact that carries little load."""
    thick = displayed("film_thickness", film)
    return {"range": [0.0, float(min(1.05 * np.max(thick), 4.0 * np.median(thick)))]}


@drawing(
    "film_transient",
    heading="Film over time",
    caption="Load, film and maximum pressure of a contact over time. Where the load rises, the "
    "squeeze effect delays the thinning of the film.",
    of="TransientLineContact",
    made_by="Call tribodyn.ehl.solve_transient_line_contact and its plot method.",
)
def film_transient(transient: TransientLineContact, *, steady: ArrayLike | None = None) -> Any:
    """Draw load, central and minimum film and the maximum pressure over time.

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

    def panel(quantity: str, label: str, values: Any) -> Panel:
        return curves(quantity, label, time, [(label, values, TOTAL)], FROM_ZERO, 0.6)

    at = int(np.argmin(transient.minimum_film))
    least = rounded("film_thickness", float(transient.minimum_film[at]))
    panels = [
        panel("load_per_width", "Load", transient.load_per_width),
        _films(transient, time, steady),
        panel("hertz_pressure", "Maximum pressure", transient.maximum_pressure),
    ]
    title = f"The film is thinnest, {least}, after {rounded('time', float(transient.time[at]))}"
    return stack(title, axis_label("time"), panels)
