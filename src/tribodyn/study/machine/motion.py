"""Motion of a machine under one load: forces, errors and accelerations of its parts by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError, no_such
from tribodyn.record import Record, fact, labels_of, quantity, record
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.machine.graph.clock import Phases

#: Highest harmonic of the fastest mesh among the lines, and least size of one over the largest.
_HIGHEST, _LEAST = 20, 1e-9
#: Most turns of a shaft in a phase or phases in a turn, and difference of equal rates.
_MOST_TURNS, _EQUAL = 10_000, 1e-9
#: Directions of forces and moments of a bearing.
DIRECTIONS = ("x", "y", "z", "theta_x", "theta_y", "theta_z")


class PeriodicSamples(Record):
    """Signals over a period, on samples with weights."""

    weight: Array

    def mean(self, signal: Array) -> Array:
        """Mean over the period.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.tensordot(self.weight, signal, axes=1))

    def rms(self, signal: Array) -> Array:
        """Root mean square about the mean.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.sqrt(np.maximum(self.mean((signal - self.mean(signal)) ** 2), 0.0)))


class MotionLine(NamedTuple):
    """A spectral line of a motion."""

    frequency: float  #: [Hz]
    amplitude: complex  #: of a cosine
    numbers: tuple[int, ...]  #: cycles of each phase in it; on one clock its order
    cause: str  #: in words: ``2 x first - 1 x second``


class Unit(NamedTuple):
    """What turns with a phase."""

    name: str  #: shaft, or gear on its carrier; empty where meshes alone follow the phase
    turns: Fraction  #: of it in a cycle of the phase

    @property
    def part(self) -> str:
        """Multiple of its turns that the phase is."""
        return self.name if self.turns == 1 else f"{self.turns} x {self.name}"


def unit_of(rates: Mapping[str, float], frequency: float) -> Unit:
    """Part of those with these rates of whose turns a frequency is the simplest multiple."""
    exact = {name: frequency / rate for name, rate in rates.items()}
    fractions = (Unit(n, Fraction(e).limit_denominator(_MOST_TURNS)) for n, e in exact.items())
    matches = [unit for unit in fractions if abs(unit.turns / exact[unit.name] - 1.0) < _EQUAL]
    none = Unit("random load" if rates else "", Fraction(1))
    return min(matches, key=lambda unit: sum(unit.turns.as_integer_ratio()), default=none)


def line_cause(
    numbers: Sequence[int], meshes: Mapping[str, Sequence[int]], units: Sequence[Unit] = ()
) -> str:
    """Cause of a line in words: multiples of meshes, and of what turns with the phases."""
    for name, cycles in meshes.items():
        axis = int(np.argmax(np.abs(cycles)))
        count, remainder = divmod(numbers[axis], cycles[axis])
        if not remainder and tuple(count * each for each in cycles) == tuple(numbers):
            return f"{count} x {name}"
    terms: dict[str, Fraction] = {}
    for axis, cycle_count in enumerate(numbers):
        number = Fraction(cycle_count)
        followers = [(name, cycles[axis]) for name, cycles in meshes.items() if cycles[axis]]
        unit = units[axis] if units else Unit("", Fraction(1))
        if followers:
            name, each = min(followers, key=lambda pair: abs(pair[1]))
            times = Fraction(round(number / each)) if unit.name else number
            number -= times * each if unit.name else number
            part = name if unit.name or abs(each) == 1 else f"{name} / {abs(each)}"
            terms[part] = terms.get(part, Fraction(0)) + times
        if number:
            terms[unit.name] = terms.get(unit.name, Fraction(0)) + number * unit.turns
    listed = [
        (" - " if count < 0 else " + ") + f"{abs(count)} x {name}"
        for name, count in sorted(terms.items(), key=lambda term: term[1] < 0)
        if count
    ]
    text = "".join(listed) or " + 0 x mean"
    return text[3:] if text.startswith(" + ") else f"-{text[3:]}"


def phase_units(machine: Machine, phases: Phases, driven: Sequence[str] = ()) -> tuple[Unit, ...]:
    """What turns with each phase: gears with waves or differing teeth, or driven shafts."""
    units = []
    for axis, frequency in enumerate(phases.frequency):
        names: dict[str, float] = {}
        for name, mesh in machine.meshes.items():
            cycles = machine.clock.cycles[name]
            gears = [turn.gear for turn in mesh.turning if phases.turns[cycles * turn.waves][axis]]
            differ = mesh.period > 1 and phases.cycles[name][axis]
            for gear in (*gears, *(mesh.gears if differ else ())):
                part = machine.gears[gear]
                turning = f"{gear} on {mesh.carrier}" if mesh.carrier else part.shaft
                names.setdefault(turning, cycles / abs(part.teeth))
        if any(cycles[axis] for cycles in phases.driven.values()):
            names = {shaft: float(machine.clock.turns[shaft]) for shaft in driven}
        units.append(unit_of(names, frequency / machine.clock.frequency))
    return tuple(units)


def phase_names(machine: Machine, phases: Phases, driven: Sequence[str] = ()) -> tuple[str, ...]:
    """Names of the phases: of the meshes, or of what turns."""
    names = []
    for axis, unit in enumerate(phase_units(machine, phases, driven)):
        meshes = [name for name, cycles in phases.cycles.items() if cycles[axis]]
        more = f" and {len(meshes) - 1} more" if len(meshes) > 1 else ""
        names.append(f"{meshes[0]}{more}" if meshes else unit.part)
        if meshes and unit.name:
            names[-1] += f" over {unit.part}"
    return tuple(names)


@record
class MachineMotion(PeriodicSamples):
    """Steady motion of a machine: over one period of its clock, or over independent phases.

    Over phases the samples follow a line that closes after whole numbers of cycles of all phases,
    nearly in the ratio of their frequencies, so that means, extremes and lines are those of all the
    motion. Orders and cycles count along this line, ``lines`` has the exact frequencies.

    Parameters
    ----------
    clock : (s,) array
        Phase of the clock, both ends and the middle of every step; over phases the part of the
        closed line.
    weight : (s,) array
        Weights of the samples for means over the period.
    mesh : tuple of str
        Names of the meshes.
    bearing : tuple of str
        Names of the bearings.
    node : tuple of str
        Names of the nodes of the housing.
    mesh_force : (s, meshes) array
        Force along the transverse line of action [N].
    compression : (s, meshes) array
        Compression of the teeth, from where rigid flanks touch [m].
    transmission_error : (s, meshes) array
        Rotation of the driving over that of the driven gear, on the line of action [m].
    open : (s, meshes) array
        1 where the driving flanks are apart.
    bearing_force : (s, bearings, 6) array
        Force and moment of the shaft on each bearing [N, N*m].
    acceleration : (s, nodes, 3) array
        Acceleration of the nodes of the housing [m/s^2].
    cycles : (meshes,) array
        Mesh cycles of each mesh in a period.
    frequency : float
        Periods of the clock per second [Hz].
    phase_frequency : (phases,) array, optional
        Frequency of each independent phase [Hz]; None on one clock.
    phase_turns : (phases,) array, optional
        Cycles of each phase along the closed line.
    mesh_phases : (meshes, phases) array, optional
        Mesh cycles of each mesh over each phase.
    units : tuple of Unit
        What turns with each phase, of a motion with faults.
    line_numbers : (lines, phases) array, optional
        Whole numbers of the strongest spectral line of the mesh forces at each order of the record.
    """

    clock: Array = quantity("clock", unit="1", axis=True)
    weight: Array = quantity("clock", unit="1")
    mesh: tuple[str, ...] = quantity("mesh", axis=True, unit="")
    bearing: tuple[str, ...] = quantity("bearing", axis=True, unit="")
    node: tuple[str, ...] = quantity("node", axis=True, unit="")
    mesh_force: Array = quantity("clock", "mesh", unit="N")
    compression: Array = quantity("clock", "mesh", unit="m")
    transmission_error: Array = quantity("clock", "mesh", unit="m")
    open: Array = quantity("clock", "mesh", unit="1")
    bearing_force: Array = quantity("clock", "bearing", "direction", unit="N or N*m")
    acceleration: Array = quantity("clock", "node", "axis", unit="m/s^2")
    cycles: Array = quantity("mesh", unit="1")
    frequency: float = fact()
    phase_frequency: Array | None = quantity("phase", unit="Hz", default=None)
    phase_turns: Array | None = quantity("phase", unit="1", default=None)
    mesh_phases: Array | None = quantity("mesh", "phase", unit="1", default=None)
    units: tuple[Unit, ...] = ()
    line_numbers: Array | None = quantity("line", "phase", unit="1", default=None)

    @property
    def mesh_frequency(self) -> Array:
        """Mesh cycles of each mesh per second (meshes,) [Hz]."""
        phases, frequency = self._phases
        return np.asarray(phases @ frequency)

    @property
    def _phases(self) -> tuple[Array, Array]:
        """Mesh cycles over each phase (meshes, phases), and frequencies; one clock is a phase."""
        if self.phase_frequency is None or self.mesh_phases is None:
            return self.cycles[:, None], np.array([self.frequency])
        return self.mesh_phases, self.phase_frequency

    def harmonics(self, signal: Array, orders: Array) -> ComplexArray:
        """Complex amplitudes at orders of the clock.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.
        orders : (k,) array
            Periods of the wave in a period of the clock.

        Returns
        -------
        (k, ...) complex array
            In the unit of the signal.
        """
        if self.phase_turns is not None:  # even samples
            lines = np.fft.rfft(signal, axis=0)[np.asarray(orders, dtype=np.int64)]
            return np.asarray(2.0 * lines / len(signal))
        waves = self.weight * np.exp(-2j * np.pi * np.multiply.outer(orders, self.clock))
        return np.asarray(2.0 * np.tensordot(waves, signal, axes=1))

    def lines(self, signal: Array, count: int = 20) -> list[MotionLine]:
        """Strongest spectral lines of a signal, with their exact frequencies and their causes.

        Parameters
        ----------
        signal : (s,) array
            On the samples.
        count : int
            Most lines.

        Returns
        -------
        list of MotionLine
            By rising frequency; amplitudes in the unit of the signal.
        """
        phases, frequency = self._phases
        highest = min(len(signal) // 2 - 1, _HIGHEST * int(self.cycles.max()))
        waves = self.harmonics(signal, np.arange(1.0, highest + 1))
        sizes = np.abs(waves)
        least = _LEAST * sizes.max(initial=0.0)
        chosen = np.argsort(-sizes, kind="stable")[:count] + 1
        numbers = self._numbers
        labels = dict(zip(self.mesh, phases.astype(int).tolist(), strict=True))
        lines = [
            MotionLine(
                float(np.dot(k, frequency)), waves[order - 1], k, line_cause(k, labels, self.units)
            )
            for order in chosen.tolist()
            if sizes[order - 1] > least and (k := numbers(order))
        ]
        return sorted(lines, key=lambda line: line.frequency)

    @property
    def _numbers(self) -> Callable[[int], tuple[int, ...]]:
        """Whole numbers of the phases by order; none where the motion has no line."""
        if self.phase_turns is None:
            return lambda order: (order,)
        if self.line_numbers is None:
            why = "An earlier version stored this motion"
            raise InputError("the lines have no whole numbers", "", why, "Compute the case again")
        orders = (self.line_numbers @ self.phase_turns).astype(int).tolist()
        numbers = dict(zip(orders, map(tuple, self.line_numbers.astype(int).tolist()), strict=True))
        return lambda order: numbers.get(order, ())

    def mesh_orders(self, count: int) -> dict[int, list[tuple[str, int]]]:
        """Orders of the clock that meshes excite.

        Parameters
        ----------
        count : int
            Harmonics of each mesh.

        Returns
        -------
        dict of int to list of (str, int)
            Meshes and their harmonics by order.
        """
        orders: dict[int, list[tuple[str, int]]] = {}
        for name, cycles in zip(self.mesh, self.cycles, strict=True):
            for harmonic in range(1, count + 1):
                orders.setdefault(int(cycles) * harmonic, []).append((name, harmonic))
        return dict(sorted(orders.items()))

    def line_frequency(self, meshes: Sequence[tuple[str, int]]) -> float:
        """Exact frequency of a line of :meth:`mesh_orders`.

        Parameters
        ----------
        meshes : sequence of (str, int)
            Meshes and their harmonics.

        Returns
        -------
        float
            [Hz]
        """
        name, harmonic = meshes[0]
        return float(harmonic * self.mesh_frequency[self.mesh.index(name)])

    def mesh_spectra(self, mesh: str, harmonics: int = 20) -> Any:
        """Peak amplitudes of all signals over the order of one mesh, as those of a pair.

        Parameters
        ----------
        mesh : str
            Name of the mesh whose frequency is order 1; lines of others are between its harmonics.
        harmonics : int
            Highest order.

        Returns
        -------
        xarray.Dataset
            ``meshes.NAME.mesh_force_spectrum``, ``meshes.NAME.transmission_error_spectrum``,
            ``bearings.NAME.force_y_spectrum`` and ``housing.NAME.acceleration_y_spectrum`` for x,
            y and z, over ``order``; ``mesh_frequency`` is an attribute.

        Raises
        ------
        InputError
            If there is no such mesh.
        """
        import xarray

        if mesh not in self.mesh:
            raise InputError(no_such("mesh", mesh, self.mesh, Argument("mesh")))
        cycles = int(self.cycles[self.mesh.index(mesh)])
        orders = np.arange(1.0, cycles * harmonics + 1.0)
        axes = "xyz"
        signals = {f"meshes.{n}.mesh_force": self.mesh_force[:, i] for i, n in enumerate(self.mesh)}
        error = self.transmission_error
        signals |= {f"meshes.{n}.transmission_error": error[:, i] for i, n in enumerate(self.mesh)}
        for kind, names, values in (
            ("bearings.{}.force_{}", self.bearing, self.bearing_force),
            ("housing.{}.acceleration_{}", self.node, self.acceleration),
        ):
            for i, name in enumerate(names):
                signals |= {kind.format(name, axes[k]): values[:, i, k] for k in range(3)}
        waves = np.abs(self.harmonics(np.stack(list(signals.values()), axis=1), orders))
        columns = {
            f"{name}_spectrum": (
                "order",
                waves[:, k],
                {"units": "m/s^2" if "accel" in name else "m" if "error" in name else "N"},
            )
            for k, name in enumerate(signals)
        }
        attributes = {"mesh_frequency": float(self.mesh_frequency[self.mesh.index(mesh)])}
        return xarray.Dataset(columns, {"order": orders / cycles}, attributes)

    @cached_property
    def radial_force(self) -> Array:
        """Size of the radial force of each bearing (s, bearings) [N]."""
        return np.hypot(self.bearing_force[..., 1], self.bearing_force[..., 2])


def joined(series: Mapping[str, Array], samples: int, width: tuple[int, ...] = ()) -> Array:
    """Series by name as one array (s, names, ...)."""
    none = np.zeros((samples, 0, *width))
    return np.stack(list(series.values()), axis=1) if series else none


def machine_motion(
    structure: MachineStructure, response: Response, phases: Phases | None = None
) -> MachineMotion:
    """Forces, errors and accelerations of the parts of a machine along its motion."""
    machine, fine = structure.machine, response.fine
    force, compression, error, separated = {}, {}, {}, {}
    samples, first = fine.phase.size, 0
    for name, mesh in machine.meshes.items():
        count = max(len(mesh.contacts), 1)
        force[name] = fine.contact_force[:, first : first + count].sum(axis=1)
        compression[name] = fine.deflection[:, first]
        separate = mesh.has_play & ((force[name] == 0.0) | (compression[name] < 0.0))
        separated[name] = separate.astype(float)
        error[name] = fine.position @ mesh_rotation(structure, name)
        first += count
    bearings = {
        name: structure.bearing_load(name, fine.position, fine.velocity)
        for name in machine.bearings
    }
    over = _over_phases(machine, response, phases or machine.phases)
    nodes = machine.housing.nodes if machine.housing is not None else {}
    accelerations = {n: fine.acceleration @ structure.housing_node(n)[:3].T for n in nodes or {}}
    return MachineMotion(
        clock=fine.phase - fine.phase[0],
        weight=fine.weight,
        mesh=tuple(force),
        bearing=tuple(bearings),
        node=tuple(accelerations),
        mesh_force=joined(force, samples),
        compression=joined(compression, samples),
        transmission_error=joined(error, samples),
        open=joined(separated, samples),
        bearing_force=joined(bearings, samples, (6,)),
        acceleration=joined(accelerations, samples, (3,)),
        **(
            over
            or {
                "cycles": np.array([machine.clock.cycles[name] for name in force]),
                "frequency": machine.clock.frequency,
            }
        ),
    )


def motion_from(data: Any) -> MachineMotion:
    """Motion from its data set in a file."""
    values: dict[str, Any] = {}
    for name, labels in labels_of(MachineMotion).items():
        if not labels.dims:
            values[name] = float(data.attrs[name])
        elif name in ("mesh", "bearing", "node"):
            values[name] = tuple(map(str, data[name].values)) if name in data else ()
        elif name in data:  # phases are those of motions over phases
            values[name] = np.asarray(data[name].values)
    return MachineMotion(**values)


def _over_phases(machine: Machine, response: Response, over: Phases) -> dict[str, Any]:
    """Facts of a motion over independent phases; none on one clock."""
    from tribodyn.dynamics import PhaseResponse

    if not isinstance(response, PhaseResponse):
        return {}
    turns, frequency = np.array(response.turns), np.asarray(response.frequencies)
    periods = np.array([mesh.period for mesh in machine.meshes.values()])
    phases = np.array([over.cycles[name] for name in machine.meshes]) * periods[:, None]
    fastest = int(np.argmax(frequency))
    _, amplitude, numbers = response.lines()
    largest = np.maximum(np.abs(amplitude).max(axis=0), np.finfo(float).tiny)
    size, order = (np.abs(amplitude) / largest).max(axis=1), numbers @ turns
    falling = np.argsort(-size, kind="stable")
    strongest = falling[np.unique(order[falling], return_index=True)[1]]
    return {
        "cycles": phases @ turns,
        "frequency": float(frequency[fastest] / turns[fastest]),
        "phase_frequency": frequency,
        "phase_turns": turns.astype(float),
        "mesh_phases": phases.astype(float),
        "line_numbers": numbers[strongest].astype(float),
    }


def mesh_rotation(structure: MachineStructure, mesh: str) -> Array:
    """Rotation of both gears, against their carrier, on the line of action (n,) [1 and m]."""
    gears, carrier = structure.machine.meshes[mesh].gears, structure.machine.meshes[mesh].carrier
    direction = structure.machine.directions[mesh].direction
    turns = [structure.gear(name)[3] for name in gears]
    if carrier:
        turned = structure.at(carrier, _carrier_position(structure, carrier))[3]
        turns = [turn - turned for turn in turns]
    return np.asarray(direction[3] * turns[0] + direction[9] * turns[1])


def _carrier_position(structure: MachineStructure, carrier: str) -> float:
    """Position of the planets on their carrier [m]."""
    bearings = structure.machine.bearings.values()
    return next((b.carrier_position for b in bearings if b.carrier == carrier), 0.0)
