"""A planetary stage in front view with moving planets, its natural modes and mesh forces."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.gear import gear_outline
from tribodyn.machine.planetary.positions import read_angles
from tribodyn.plot.theme.colors import COLORS, MUTED, PAIR_COLORS, PINION, WHEEL, translucent
from tribodyn.plot.theme.labels import axis_label, displayed, rounded, significant
from tribodyn.plot.theme.panels import (
    ROUNDING,
    Panel,
    Row,
    curve,
    curves,
    from_zero,
    stack,
    stack_rows,
)
from tribodyn.plot.theme.style import Trace, animated, choice, line, plane_figure, stems, strokes
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalGear
    from tribodyn.machine import PlanetaryModes, RingSensorSignal
    from tribodyn.study import MachineCase, MachineResult, PlanetaryMotion
    from tribodyn.study.planetary.tolerances import LoadShareStatistics
    from tribodyn.study.uncertain.ensemble import MachineEnsemble

#: Points of a tooth, those of them that are drawn, and pictures of the movement.
_POINTS, _DRAWN, _FRAMES = 40, [0, 5, 9, 13, 17, 21, 25, 29, 33], 24
_CARRIER = PAIR_COLORS[0]
#: Orders of the carrier on both sides of a harmonic.
_SIDEBANDS = 9
#: Distance of the mean place of the sun from the centre over its motion that is none.
_CENTRED = 1e-3


def _outline(gear: CylindricalGear) -> ComplexArray:
    """Closed outline of a gear with the middle of a tooth at angle 0 [mm]."""
    x, y = gear_outline(gear, _POINTS)[:, :-1]
    outline = (x + 1j * y).reshape(abs(gear.teeth), -1)[:, _DRAWN].ravel()
    outline = outline * cmath.exp(-0.5j * math.pi)
    return np.asarray(1e3 * np.append(outline, outline[:1]), dtype=complex)


def _trace(points: ComplexArray, name: str, color: str) -> Trace:
    x, y = points.real.astype(np.float32), points.imag.astype(np.float32)
    return strokes(x, y, color, name=name, hoverinfo="name")


def _start_angles(teeth: dict[str, int], angles: Array) -> tuple[float, list[float]]:
    """Rotations of the ring and of the planets in which their teeth engage, the sun's is 0."""
    planets = []
    for at in angles:
        # The sun has a tooth at angle 0; a planet has a gap where one meets it.
        phase = (at * teeth["sun"] / (2.0 * np.pi)) % 1.0
        planets.append(at + np.pi + (0.5 + phase) * 2.0 * np.pi / teeth["planet"])
    # The ring has a gap where the first planet has a tooth on the far side.
    tooth = (planets[0] - angles[0]) * teeth["planet"] / (2.0 * np.pi) % 1.0
    return float(angles[0] + (tooth + 0.5) * 2.0 * np.pi / teeth["ring"]), planets


def _not_drawn(result: MachineResult | MachineCase) -> str:
    case: Any = getattr(result, "case", result)
    single = any(stage.table.planet_type == "single" for stage in case.stages.values())
    return "" if single else "The machine has no stage of planets with one gear."


@drawing(
    heading="The stage in front view",
    missing=_not_drawn,
    of=("MachineResult", "MachineCase"),
    made_by="Load or run a case with planets: tribodyn.load_case, tribodyn.run.",
)
def planetary_stage(result: MachineResult | MachineCase) -> Sketch:
    """Draw the first planetary stage of a machine with moving planets.

    Sun, planets and ring with their teeth in the transverse section, and the arms of the carrier,
    to scale, seen against the axis. Press Play to turn the stage: one step of the carrier from
    planet to planet, or the same time where the carrier is held.
    """
    source: Any = result
    case: MachineCase = getattr(source, "case", source)
    parts = next(s for s in case.stages.values() if s.table.planet_type == "single")
    machine, table = case.machine(), parts.table
    pairs = {mesh: parts.gear_pair(mesh) for mesh in ("sun", "ring")}
    sun_side = "pinion" if parts.names_of("sun")[0] == table.sun else "wheel"
    sun = _outline(getattr(pairs["sun"], sun_side))
    planet, ring = _outline(pairs["ring"].pinion), _outline(pairs["ring"].wheel)
    stage = machine.planets[parts.name]
    angles = read_angles(stage.count, stage.angles)
    teeth = {"sun": parts.gears[table.sun].teeth, "planet": parts.planet.teeth,
             "ring": abs(parts.gears[table.ring].teeth)}  # fmt: skip
    ring_start, planet_starts = _start_angles(teeth, angles)
    distance = 1e3 * parts.center_distance
    shafts = {role: parts.shaft_of(role) for role in ("sun", "ring", "carrier")}
    shafts["planet"] = f"{parts.name}_planet1"
    rates = {role: machine.kinematics.shafts[shaft].speed for role, shaft in shafts.items()}
    slowest = abs(rates["carrier"]) or abs(rates["ring"])
    duration = 2.0 * np.pi / angles.size / slowest

    def picture(time: float) -> list[Trace]:
        """Traces of the stage at a time."""
        pins = distance * np.exp(1j * (angles + rates["carrier"] * time))
        turned = [
            planet * cmath.exp(1j * (start + rates["planet"] * time)) + pin
            for start, pin in zip(planet_starts, pins, strict=True)
        ]
        arms = np.concatenate([[0.0, pin, np.nan] for pin in pins])
        return [
            _trace(ring * cmath.exp(1j * (ring_start + rates["ring"] * time)), "ring", WHEEL),
            _trace(np.concatenate([[*p, np.nan] for p in turned]), "planets", MUTED),
            _trace(sun * cmath.exp(1j * rates["sun"] * time), "sun", PINION),
            _trace(arms, "carrier", _CARRIER),
        ]

    frames = [picture(duration * k / _FRAMES) for k in range(_FRAMES)]
    play = {"frame": {"duration": 80, "redraw": False}, "transition": {"duration": 0}}
    stop = {"mode": "immediate", "frame": {"duration": 0}}
    steps = (("Play", None, {**play, "fromcurrent": True}), ("Stop", [None], stop))
    buttons = [{"label": name, "method": "animate", "args": [*args]} for name, *args in steps]
    place = {"x": 1.0, "xanchor": "right", "y": 1.0, "yanchor": "top"}
    menu = {"type": "buttons", "direction": "left", "buttons": buttons, **place}
    reach = 1.05 * float(np.abs(ring).max())
    axis = {"visible": False, "range": [-reach, reach]}
    turns = abs((rates["planet"] - rates["carrier"]) / rates["sun"])
    title = f"{angles.size} planets turn {turns:.3g} times about their pins in a turn of the sun"
    axes = (axis, {**axis, "scaleanchor": "x"})
    sketch = plane_figure(title, frames[0], *axes, height=620, updatemenus=[menu])
    return animated(sketch, frames)


@drawing(
    heading="Mesh forces of all planets",
    of=("PlanetaryMotion",),
    made_by="Run a case with planets: tribodyn.run(...).operation.stage().motion.",
)
def planetary_forces(motion: PlanetaryMotion) -> Sketch:
    """Draw the mesh forces of all planets and the motion of the sun over a mesh cycle.

    Force of each sun mesh and of each ring mesh along its line of action over a mesh cycle, and the
    motion of the sun about its mean place, which the axis names.
    """
    panels = []
    for mesh, force in (("Sun mesh", motion.sun_mesh_force), ("Ring mesh", motion.ring_mesh_force)):
        rows = [
            (f"planet {i + 1}", each, COLORS[i % len(COLORS)]) for i, each in enumerate(force.T)
        ]
        panels.append(curves("mesh_force", f"{mesh} force", motion.phase, rows))
    sun = motion.displacement[:, motion.member.index("sun"), :2]
    at = motion.mean(sun)
    size = float(np.abs(motion.displacement).max())
    mean = ", ".join(f"{k} = {rounded('deflection', v)}" for k, v in zip("xy", at, strict=True))
    centred = np.abs(at).max() <= max(ROUNDING * size, _CENTRED * np.ptp(sun))
    label = "Sun, about the centre" if centred else f"Sun, about<br>{mean}"
    orbit = [("xy"[k], sun[:, k] - at[k], COLORS[k]) for k in range(2)]
    panel = curves("deflection", label, motion.phase, orbit)
    panels.append(replace(panel, size=float(displayed("deflection", size))))
    peak = float(motion.sun_mesh_force.max())
    load = float(motion.mean(motion.sun_mesh_force).mean())
    is_constant = np.ptp(sun, axis=0).max() <= ROUNDING * size
    title = (
        f"Sun meshes carry {rounded('mesh_force', load)} in the mean and "
        f"{rounded('mesh_force', peak)} at most{'; the sun does not move' if is_constant else ''}"
    )
    return stack(
        title, f"Phase of the mesh cycle, 1 = {1e3 / motion.mesh_frequency:.4g} ms", panels
    )


@drawing(
    heading="Sensor on the ring",
    of=("RingSensorSignal",),
    made_by="Call ring_sensor() of a result at one load, or tribodyn.machine.ring_sensor_signal.",
)
def ring_sensor(signal: RingSensorSignal) -> Sketch:
    """Draw the sidebands of a sensor on the ring.

    Lines of a sensor on the ring about the first two harmonics of the mesh frequency, over the
    order of the carrier: planets that pass modulate their mesh forces. Dotted: the harmonics
    themselves.
    """
    panels, teeth = [], signal.ring_teeth
    for harmonic in (1, 2):
        lines = signal.sidebands(harmonic, _SIDEBANDS)
        order = np.array(list(lines), dtype=float) + harmonic * teeth
        height = np.array(list(lines.values()))
        rows = curve("mesh_force", *stems(order, height), "lines", COLORS[0])
        ends = np.full(2, float(harmonic * teeth)), np.array([0.0, height.max()])
        mark = curve("mesh_force", *ends, "harmonic", MUTED, dash="dot")
        panel = from_zero(axis_label("mesh_force", f"Harmonic {harmonic}"), [mark, rows])
        panels.append(Row("Order of the carrier relative to the ring", panel))
    first = signal.sidebands(1, _SIDEBANDS)
    largest = max(first, key=lambda m: first[m])
    hertz = (teeth + largest) * signal.carrier_frequency
    place = "the harmonic itself" if largest == 0 else f"{largest:+d} from the harmonic"
    title = (
        f"The largest line about the mesh frequency is order {teeth + largest}, {place}, at "
        f"{rounded('frequency', hertz)}"
    )
    return stack_rows(title, panels)


def _load_factors(statistics: LoadShareStatistics | MachineEnsemble) -> Array:
    """Mesh load factor of every stage at rest; empty for variants of a machine."""
    if not hasattr(statistics, "figures"):
        return statistics.load_factor
    columns = statistics.figures().items()
    factors = [values[1:] for key, values in columns if key.endswith(".load_factor")]
    return np.asarray(factors[0] if factors else [])


def _without_factors(statistics: LoadShareStatistics | MachineEnsemble) -> str:
    if _load_factors(statistics).size:
        return ""
    return "It is the ensemble of a machine without planets; draw machine_ensemble."


@drawing(
    heading="Load sharing over tolerances",
    missing=_without_factors,
    of=("LoadShareStatistics", "MachineEnsemble"),
    made_by="Call tribodyn.study.load_share_statistics(...) or tribodyn.ensemble(stage, seed=1).",
)
def load_share_statistics(statistics: LoadShareStatistics | MachineEnsemble) -> Sketch:
    """Draw the distribution of the mesh load factor.

    Part of the stages whose mesh load factor K_gamma does not exceed a value. The steeper the
    curve, the less the tolerances matter.
    """
    factor = np.sort(_load_factors(statistics))
    part = 100.0 * (np.arange(factor.size) + 0.5) / factor.size
    curve = line(factor, part, "stages", PINION, unit="%")
    marks = [(f"{p:g} %", float(np.quantile(factor, 0.01 * p))) for p in (50.0, 95.0)]
    row = Row("Mesh load factor K_gamma", Panel("Stages [%]", [curve]), marks=marks)
    title = f"95 % of {factor.size} stages have a load factor of at most {marks[1][1]:.4g}"
    return stack_rows(title, [row])


#: Colour of each type of mode.
MODE_COLORS = {
    "rotational": PINION,
    "translational": WHEEL,
    "planet": PAIR_COLORS[0],
    "mixed": PAIR_COLORS[1],
}
#: Colour of the stage at rest.
_REST = translucent(MUTED, 0.4)
#: Largest displacement over the radius of the pins, largest radius of a planet, points of a circle.
_SIZE, _PLANET, _CIRCLE = 0.16, 0.4, 72
_TURN = np.linspace(0.0, 2.0 * np.pi, _CIRCLE + 1)


def _outlines(angles: Array, motion: Array) -> tuple[list[float], list[float]]:
    """Pitch circles with a mark each, and the arms of the carrier, displaced by a motion."""
    gaps = np.diff(np.sort(angles), append=np.sort(angles)[0] + 2.0 * np.pi)
    planet = min(_PLANET, 0.9 * np.sin(min(float(gaps.min()), np.pi) / 2.0))
    carrier, ring, sun = motion[:9].reshape(3, 3)
    pins = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    bodies = [(np.zeros(2), 1.0 - planet, sun), (np.zeros(2), 1.0 + planet, ring)]
    bodies += [(p, planet, m) for p, m in zip(pins, motion[9:].reshape(-1, 3), strict=True)]
    lines = []
    for at, radius, (dx, dy, turn) in bodies:
        # A mark inside the rim of a gear, and outside that of the ring.
        start = 1.0 if radius > 1.0 else 0.6
        end = 1.08 if radius > 1.0 else 1.0
        mark = radius * np.exp(1j * turn / radius) * np.array([start, end])
        circle = radius * np.exp(1j * _TURN)
        outline = np.concatenate([circle, [np.nan], mark, [np.nan]])
        lines.append(outline + complex(*at) + dx + 1j * dy)
    turned = np.exp(1j * (angles + carrier[2])) + carrier[0] + 1j * carrier[1]
    middle, gap = complex(carrier[0], carrier[1]), complex(np.nan, np.nan)
    lines += [np.array([middle, pin, gap]) for pin in turned]
    points = np.concatenate(lines)
    return points.real.tolist(), points.imag.tolist()


def _mode_trace(angles: Array, motion: Array, color: str, width: float, visible: bool) -> Trace:
    x, y = _outlines(angles, motion)
    return strokes(x, y, color, width, showlegend=False, visible=visible)


@drawing(
    heading="Natural modes of the planetary stage",
    of=("PlanetaryModes",),
    made_by="Call tribodyn.machine.planetary_modes on a plane model.",
)
def planetary_modes(modes: PlanetaryModes) -> Sketch:
    """Draw the natural modes of a planetary stage, one at a time.

    Choose a mode: pitch circles of sun, ring and planets and the arms of the carrier, at rest
    (grey) and displaced, in the colour of the type of the mode. A mark on each gear shows its
    rotation. The displacements have one scale; the radii are schematic.
    """
    angles = np.asarray(modes.angles)
    count = modes.frequency.size
    labels = [
        f"{i + 1}: {significant(modes.frequency[i], 5)} Hz, {modes.types[i]}" for i in range(count)
    ]
    first = next((i for i in range(count) if modes.frequency[i] > 0.0), 0)
    traces = [_mode_trace(angles, np.zeros(len(modes.names)), _REST, 2.0, True)]
    for i in range(count):
        motion = np.real(modes.shape[i])
        motion = _SIZE * motion / np.abs(motion).max()
        traces.append(_mode_trace(angles, motion, MODE_COLORS[modes.types[i]], 1.6, i == first))
    visible = [[True, *(k == i for k in range(count))] for i in range(count)]
    menu = {**choice(labels, labels, visible, first), "bordercolor": MUTED}
    axis = {"visible": False, "range": [-1.7, 1.7]}
    more: Trace = {"height": 620, "hovermode": False, "updatemenus": [menu]}
    return plane_figure(labels[first], traces, axis, {**axis, "scaleanchor": "x"}, **more)
