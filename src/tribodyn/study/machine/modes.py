"""Natural modes of a machine over the speed, and what excites them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from tribodyn.machine import MachineModes, MachineStructure, machine_modes
from tribodyn.machine.modes import machine_frequencies
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from tribodyn.machine import Machine

_Row = TypeVar("_Row")

#: Speeds of a diagram, its top speed over that of the operation, and harmonics of each mesh.
_SPEEDS, _TOP, _HARMONICS = 6, 1.3, 3
#: Modes above this many times the highest excitation are left out of tables and figures.
_BEYOND = 1.5
_LEAST_SHARE = 0.05
#: Share of the strain energy of a mode in a mesh from which the mesh excites the mode.
STRAINED = 1e-3
#: Modes nearest to an excitation with which a table begins.
_NEAREST = 10
#: Relative difference of frequencies that is rounding.
_ROUNDING = 1e-6
#: Letters of the types of modes of a stage, and harmonics of a lone stage in tables and
#: in the diagram.
_TYPES = {"rotational": "R", "translational": "T", "planet": "P", "mixed": "RT"}
_TYPED, _DRAWN = 12, 5
#: Motion of a shaft along its axis over that of all shafts across, from which it is axial.
_ALONG = 5.0
MODES_HEAD = ("Mode", "Frequency [Hz]", "Damping [%]", "Energy in", "Nearest excitation")


class MeshOrder(NamedTuple):
    """A mesh harmonic: waves in a turn of the input, and what it strains of each mode."""

    mesh: str
    harmonic: int
    order: float
    share: Array  #: of the strain energy of each mode (m,)


class Meeting(NamedTuple):
    """A mesh harmonic that meets a mode which it strains."""

    mode: int  #: column of the diagram
    excitation: str
    speed: float  #: of the input [rad/s]
    frequency: float  #: [Hz]
    share: float  #: share of the strain energy of the mode that the excitation feeds


@record
class MachineCampbell(Record):
    """Natural frequencies and excitations of a machine over the speed of its input.

    Parameters
    ----------
    speed : (n,) array
        Speed of the input [rad/s].
    frequency : (n, m) array
        Natural frequencies with the gyroscopic moments at that speed [Hz].
    excitation : tuple of str
        ``mesh first x 1``, ``shaft input``, ...
    order : (k,) array
        Frequency of each excitation over the rotational frequency of the input [1].
    operating_speed : float
        Speed of the operation [rad/s].
    share : (m, k) array, optional
        Share of the strain energy of a mode that an excitation feeds; NaN for turning shafts.
    """

    speed: Array = quantity("speed", unit="rad/s", axis=True)
    frequency: Array = quantity("speed", "mode", unit="Hz")
    excitation: tuple[str, ...] = quantity("excitation", axis=True, unit="")
    order: Array = quantity("excitation", unit="1")
    operating_speed: float = fact()
    share: Array | None = quantity("mode", "excitation", unit="1", default=None)

    def meetings(self) -> list[Meeting]:
        """Crossings of the modes by mesh harmonics that strain them.

        Returns
        -------
        list of Meeting
            Within the diagram, by the distance from the operating speed.
        """
        meetings = []
        for row, curve in enumerate(self.frequency.T):
            for column, (name, order) in enumerate(zip(self.excitation, self.order, strict=True)):
                share = 1.0 if self.share is None else float(self.share[row, column])
                if not (name.startswith("mesh ") and share > STRAINED):
                    continue
                above = float(order) * self.speed / (2.0 * np.pi) - curve
                for k in np.flatnonzero((above[:-1] < 0.0) & (above[1:] >= 0.0)):
                    part = above[k] / (above[k] - above[k + 1])
                    speed = self.speed[k] + part * (self.speed[k + 1] - self.speed[k])
                    hertz = curve[k] + part * (curve[k + 1] - curve[k])
                    meetings.append(Meeting(row, name, float(speed), float(hertz), share))
        return sorted(meetings, key=lambda met: abs(met.speed - self.operating_speed))

    def excited(self, hertz: float) -> list[tuple[str, float]]:
        """Excitations that meet a frequency within the diagram.

        Parameters
        ----------
        hertz : float
            Frequency [Hz].

        Returns
        -------
        list of (str, float)
            Name of the excitation and speed of the input [rad/s].
        """
        speeds = 2.0 * np.pi * hertz / self.order
        inside = speeds <= self.speed[-1]
        pairs = zip(self.excitation, speeds, inside, strict=True)
        return [(name, float(speed)) for name, speed, within in pairs if within]


def excitations(structure: MachineStructure, harmonics: int | None = None) -> dict[str, float]:
    """Orders of the input at which meshes and turning shafts excite a machine."""
    machine = structure.machine
    turning = abs(machine.operation.speed) / (2.0 * np.pi)
    flow = machine.kinematics
    harmonics = _harmonics(structure) if harmonics is None else harmonics
    of_planets, orders = _of_planets(machine), {}
    for name, mesh in flow.meshes.items():
        if name not in of_planets:
            for k in range(1, harmonics + 1):
                orders[f"mesh {name} x {k}"] = k * mesh.mesh_frequency / turning
    for label, (_, order) in stage_orders(machine, harmonics).items():
        orders[label] = order / turning
    turned = {f"shaft {n}": abs(float(shaft.ratio)) for n, shaft in flow.shafts.items()}
    return {**orders, **{name: ratio for name, ratio in turned.items() if ratio}}


def _harmonics(structure: MachineStructure) -> int:
    """Harmonics of each mesh: of a lone stage all whose types are listed."""
    return _HARMONICS if structure.frame is None else _TYPED


def _of_planets(machine: Machine) -> set[str]:
    """Meshes of all stages."""
    return set().union(*(stage._meshes(name) for name, stage in machine.planets.items()))


def stage_orders(machine: Machine, harmonics: int) -> dict[str, tuple[str, float]]:
    """Stage and frequency [Hz] of the mesh harmonics of stages, named with what they excite."""
    # By the phases of the planets a harmonic excites modes of certain types: R rotational, in
    # which central members turn, T translational, and P of the planets alone.
    orders = {}
    for name, stage in machine.planets.items():
        phases, flow = stage.phases(machine.gears), machine.kinematics.meshes
        kinds: dict[float, str] = {}
        for kind, meshes in stage.mesh_names(name).items():
            kinds.setdefault(flow[meshes[0]].mesh_frequency, kind)
        for frequency, kind in kinds.items():
            place = f"{name} {kind}" if len(kinds) > 1 else name
            for k in range(1, harmonics + 1):
                types = phases.excitation(k, kind).types
                orders[f"mesh {place} x {k} ({types})"] = name, k * frequency
    return orders


def mode_types(modes: MachineModes) -> dict[str, tuple[str, ...]]:
    """Types of all modes as motions of each stage."""
    return {name: modes.of_stage(name).types for name in modes.structure.machine.planets}


def excited_share(modes: MachineModes, orders: Iterable[str]) -> Array:
    """Share of each mode (m, k) that an excitation strains; NaN for turning shafts."""
    # Harmonics of a stage excite all of some types of modes, and nothing of others.
    unknown = np.full(len(modes.frequency), np.nan)
    stages, types = stage_orders(modes.structure.machine, _TYPED), mode_types(modes)
    columns = []
    for order in orders:
        kind, _, name = order.partition(" ")
        if order in stages:
            letters = {*order.rpartition("(")[2]}
            excited = [bool({*_TYPES[each]} & letters) for each in types[stages[order][0]]]
            columns.append(np.array(excited, dtype=float))
        elif kind == "mesh":
            part = f"meshes.{name.rpartition(' x ')[0]}"
            columns.append(modes.strain_share[:, modes.parts.index(part)])
        else:
            columns.append(unknown)
    return np.stack(columns, axis=1)


def nearest_first(rows: Sequence[_Row], distances: Iterable[float]) -> list[_Row]:
    """Rows with the few first that are nearest to an excitation; a short table as it is."""
    if len(rows) <= _NEAREST:
        return list(rows)
    order = np.argsort(np.abs(list(distances)), kind="stable")
    return [rows[k] for k in (*order[:_NEAREST], *sorted(order[_NEAREST:]))]


def campbell_of(
    structure: MachineStructure, speeds: Array | None = None, modes: MachineModes | None = None
) -> MachineCampbell:
    """Campbell diagram of a machine with the mesh stiffness of its operating point."""
    now = abs(structure.machine.operation.speed)
    if speeds is None:
        speeds = np.linspace(0.0, _TOP * now, _SPEEDS)
    orders = excitations(structure, _HARMONICS if structure.frame is None else _DRAWN)
    top = _BEYOND * max(orders.values()) * float(speeds[-1]) / (2.0 * np.pi)
    rows = machine_frequencies(structure, speeds)
    count = min(int((row <= top).sum()) for row in rows)
    frequency = np.array([row[:count] for row in rows])
    share = excited_share(modes or machine_modes(structure), orders)[:count]
    values = np.array(list(orders.values()))
    return MachineCampbell(speeds, frequency, tuple(orders), values, now, share)


def modes_in_reach(modes: MachineModes) -> int:
    """Number of modes in reach of an excitation at the speed of the operation."""
    turning = abs(modes.structure.machine.operation.speed) / (2.0 * np.pi)
    top = _BEYOND * max(excitations(modes.structure).values()) * turning
    return int((modes.frequency <= top).sum())


def energy_shares(modes: MachineModes, number: int) -> str:
    """Parts with at least 5 % of the strain energy of a mode, the largest first."""
    shares = modes.strain_share[number]
    order = [int(i) for i in np.argsort(-shares) if shares[i] >= _LEAST_SHARE]
    return ", ".join(f"{modes.parts[i]} {100.0 * shares[i]:.0f} %" for i in order)


def axial_shaft(modes: MachineModes, number: int) -> str | None:
    """Shaft that a mode moves along its axis as a whole; None of any other mode."""
    structure, shape = modes.structure, modes.shape[number]
    along, across = {}, 0.0
    for name, shaft in structure.machine.shafts.items():
        moved = [np.abs(structure.at(name, s * shaft.length) @ shape)[:3] for s in (0.0, 0.5, 1.0)]
        along[name] = float(min(each[0] for each in moved))
        across = max(across, *(float(each[1:].max()) for each in moved))
    name = max(along, key=lambda each: along[each])
    return name if along[name] > _ALONG * across else None


def axial_notes(modes: MachineModes) -> list[str]:
    """Sentences on modes in which a shaft moves along its axis, and the bearings that hold it."""
    notes = []  # bearings without axial load hold little or nothing, so that such a mode is slow
    for number in range(modes_in_reach(modes)):
        shaft = axial_shaft(modes, number)
        if shaft is None:
            continue
        parts = modes.structure.machine.bearings.items()
        stiffness = {n: b.stiffness_matrix[0, 0] for n, b in parts if b.shaft == shaft}
        supports = [(n, float(f"{1e-6 * k:.3g}")) for n, k in stiffness.items() if k > 0.0]
        free = [name for name, k in stiffness.items() if not k > 0.0]
        springs = ", ".join(f"{name} with {k:g} N/um" for name, k in supports) or "no bearing"
        mode = f"Mode {number + 1} ({modes.frequency[number]:.4g} Hz)"
        text = f"{mode} moves shaft {shaft} along its axis; {springs} holds it at this load"
        notes.append(f"{text}, {', '.join(free)} not at all." if free else f"{text}.")
    return notes


def mode_rows(modes: MachineModes) -> list[list[str]]:
    """Rows of the table of modes under :data:`MODES_HEAD`."""
    orders, types = excitations(modes.structure), mode_types(modes)
    turning = abs(modes.structure.machine.operation.speed) / (2.0 * np.pi)
    hertz = turning * np.array(list(orders.values()))
    # Meshes reach the modes that they strain, turning shafts any.
    reaches = ~(excited_share(modes, orders) <= STRAINED)
    rows, distances = [], []
    for k in range(modes_in_reach(modes)):
        distance = hertz / modes.frequency[k] - 1.0
        nearest = int(np.argmin(np.where(reaches[k], np.abs(distance), np.inf)))
        axial = axial_shaft(modes, k)
        distances.append(float(distance[nearest]))
        rows.append(
            [
                f"{k + 1}",
                f"{modes.frequency[k]:.5g}",
                f"{100.0 * modes.damping_ratio[k]:.3g}",
                "; ".join(
                    [energy_shares(modes, k)]
                    + [f"{axial} along its axis"] * bool(axial)
                    + [f"{stage} {of_modes[k]}" for stage, of_modes in types.items()]
                ),
                f"{list(orders)[nearest]}, {100.0 * distance[nearest]:+.1f} %",
            ]
        )
    return nearest_first(rows, distances)


def mesh_orders(modes: MachineModes) -> tuple[MeshOrder, ...]:
    """Mesh harmonics of a machine with the shares of the meshes in its modes."""
    # All meshes of a stage act together, under the name of the first one: by their phases they
    # strain some modes and not others.
    machine = modes.structure.machine
    turning = abs(machine.operation.speed) / (2.0 * np.pi)
    flow = machine.kinematics.meshes
    return tuple(
        MeshOrder(
            group[0][0],
            harmonic,
            harmonic * flow[group[0][0]].mesh_frequency / turning,
            _strained(modes, group, harmonic),
        )
        for group in _in_step(machine)
        for harmonic in range(1, _HARMONICS + 1)
    )


def _in_step(machine: Machine) -> list[list[tuple[str, ...]]]:
    """Meshes that act together, those of a stage by kind; others alone."""
    of_stages = [stage.mesh_names(name).values() for name, stage in machine.planets.items()]
    planets = _of_planets(machine)
    groups: list[list[tuple[str, ...]]] = [[(m,)] for m in machine.meshes if m not in planets]
    for kinds in of_stages:
        same: dict[float, list[tuple[str, ...]]] = {}
        for names in kinds:
            frequency = machine.kinematics.meshes[names[0]].mesh_frequency
            same.setdefault(frequency, []).append(names)
        groups += same.values()
    return groups


def _strained(modes: MachineModes, group: list[tuple[str, ...]], harmonic: int) -> Array:
    """Shares of the energy of the modes (m,) that a harmonic of meshes in step strains."""
    if group[0] == group[0][:1] and len(group) == 1:
        return modes.strain_share[:, modes.parts.index(f"meshes.{group[0][0]}")]
    structure, frequency = modes.structure, modes.frequency
    total = np.zeros(frequency.size)
    for names in group:
        stiffness = np.sqrt([structure.mesh_stiffness(name) for name in names])
        offsets = np.array([structure.machine.meshes[name].offset for name in names])
        waves = np.exp(2j * np.pi * harmonic * offsets) * stiffness
        along = np.array([structure.mesh(name) for name in names])
        total += np.abs((modes.shape @ along.T) @ waves) ** 2
    modal = np.einsum("mi,ij,mj->m", modes.shape.conj(), structure.mass, modes.shape).real
    count = sum(map(len, group))
    share = 2.0 * total / count / (modal * (2.0 * np.pi * frequency) ** 2)
    # Modes of one frequency are one resonance: the shares of all of them count.
    first = np.flatnonzero(np.diff(frequency, prepend=-1.0) > _ROUNDING * frequency)
    together = np.zeros(frequency.size)
    together[first] = np.add.reduceat(share, first)
    return together


def modes_facts(modes: MachineModes, campbell: MachineCampbell) -> dict[str, Any]:
    """Modes and excitations in SI for JSON."""
    structure, count = modes.structure, modes_in_reach(modes)
    turning = abs(structure.machine.operation.speed) / (2.0 * np.pi)
    types = mode_types(modes)
    stages = {
        name: {str(k): stage.phases(structure.machine.gears).excitation(k).types
               for k in range(1, _TYPED + 1)}
        for name, stage in structure.machine.planets.items()
    }  # fmt: skip
    return {
        **({"excited_types": stages} if stages else {}),
        "speed": structure.machine.operation.speed,
        "excitations": {n: float(o) * turning for n, o in excitations(structure).items()},
        "modes": [
            {
                "number": k + 1,
                "frequency": float(modes.frequency[k]),
                "damping_ratio": float(modes.damping_ratio[k]),
                "strain_share": dict(zip(modes.parts, modes.strain_share[k].tolist(), strict=True)),
                **({"types": {name: each[k] for name, each in types.items()}} if types else {}),
                "speeds": dict(campbell.excited(float(modes.frequency[k]))),
            }
            for k in range(len(modes.frequency))
        ],
        "in_reach": count,
    }
