"""Kinematic frequencies of all parts of a case, before anything is computed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.analysis.part_frequencies import (
    PartFrequency,
    bearing_frequencies,
    mesh_frequencies,
    stage_frequencies,
)
from tribodyn.faults import BearingImpacts
from tribodyn.nomenclature import PAIR_MESH, require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.faults.machine_section import defects_of
from tribodyn.study.studies.needs import PAIRS, kind_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import AnyCase

_TURN = 2.0 * math.pi


@record
class KinematicFrequencies(Record):
    """Frequencies of shafts, meshes, bearings and planets.

    Parameters
    ----------
    part : tuple of str
        Kind and name of each part.
    symbol : tuple of str
        Short names of the trade: GMF (gear mesh), HTF (hunting tooth), APF (assembly phase),
        BPFO, BPFI, BSF, FTF (bearings), PPF (passing planets), TF (damaged tooth), f (shaft).
    meaning : tuple of str
        What repeats.
    frequency : (n,) array
        Frequencies [Hz].
    order : (n,) array
        The same in turns of the input shaft.
    input_frequency : float
        Turns of the input shaft per second [Hz].
    without_elements : tuple of str
        Bearings without dimensions of their elements, whose frequencies are unknown.
    """

    part: tuple[str, ...] = quantity("line", unit="")
    symbol: tuple[str, ...] = quantity("line", unit="")
    meaning: tuple[str, ...] = quantity("line", unit="")
    frequency: Array = quantity("line", unit="Hz")
    order: Array = quantity("line", unit="1")
    input_frequency: float = fact()
    without_elements: tuple[str, ...] = ()

    def near(self, frequency: float, within: float = 0.01) -> list[PartFrequency]:
        """Lines whose first ten harmonics lie near a frequency, the nearest first.

        Parameters
        ----------
        frequency : float
            Frequency of a peak [Hz].
        within : float
            Largest distance over the frequency.

        Returns
        -------
        list of PartFrequency
            With the harmonic in its symbol.
        """
        columns = self.part, self.symbol, self.frequency.tolist(), self.meaning
        close = [
            PartFrequency(part, symbol if k == 1 else f"{k} {symbol}", k * value, meaning)
            for part, symbol, value, meaning in zip(*columns, strict=True)
            for k in range(1, 11)
            if abs(k * value - frequency) <= within * frequency
        ]
        return sorted(close, key=lambda line: abs(line.frequency - frequency))


def kinematic_frequencies(case: AnyCase, *, sidebands: int = 1) -> KinematicFrequencies:
    """Frequencies that follow from speeds, numbers of teeth and bearings of a case.

    Parameters
    ----------
    case : case
        Of a pair of gears, a machine or a planetary stage, at its speed.
    sidebands : int
        Sidebands on each side of each mesh frequency.

    Returns
    -------
    KinematicFrequencies

    Raises
    ------
    InputError
        If the number of sidebands is not a whole number from 0.

    Examples
    --------
    >>> import tribodyn as td
    >>> lines = td.kinematic_frequencies(td.load_case("fzg-roughness"))
    >>> float(lines.frequency[lines.symbol.index("GMF")].round(3))
    240.0
    """
    count = require_whole("sidebands", sidebands, 0)
    missing: list[str] = []
    parts: Any = case
    if kind_of(case) in PAIRS:
        lines, turning = list(_pair_lines(parts, count)), parts.pinion_speed / _TURN
    else:
        machine = parts.machine()
        lines = list(_machine_lines(parts, machine, count, missing))
        turning = machine.operation.speed / _TURN
    part, symbol, frequency, meaning = zip(*lines, strict=True)
    values = np.array(frequency)
    return KinematicFrequencies(
        part, symbol, meaning, values, values / abs(turning), abs(turning), tuple(missing)
    )


def _pair_lines(case: Any, sidebands: int) -> Iterator[PartFrequency]:
    """Lines of a pair of gears, and of bearings whose defects its case describes."""
    turning = abs(case.pinion_speed) / _TURN
    shafts = {"pinion": turning, "wheel": turning / case.gear_ratio}
    teeth = {name: getattr(case.gears, name).teeth for name in shafts}
    yield from _shaft_lines(shafts)
    gears = {name: (teeth[name], shafts[name]) for name in shafts}
    mesh = turning * teeth["pinion"]
    yield from mesh_frequencies(f"mesh {PAIR_MESH}", mesh, gears, sidebands)
    for gear, impacts in defects_of(case):
        yield from bearing_frequencies(f"bearing of {gear}", impacts, shafts[gear])


def _machine_lines(
    case: Any, machine: Machine, sidebands: int, missing: list[str]
) -> Iterator[PartFrequency]:
    """Lines of a machine; of equal planets those of the first."""
    flow, repeated = machine.kinematics, _further_planets(machine)
    turning = {name: load.speed / _TURN for name, load in flow.shafts.items()}
    yield from _shaft_lines({s: abs(f) for s, f in turning.items() if s not in repeated})
    for name, mesh in machine.meshes.items():
        if name not in repeated:
            load = flow.meshes[name]
            speeds = zip(mesh.gears, load.speeds, strict=True)
            gears = {gear: (machine.gears[gear].teeth, speed / _TURN) for gear, speed in speeds}
            about = f" (turns relative to {mesh.carrier})" if mesh.carrier else ""
            part, frequency = f"mesh {name}", load.mesh_frequency
            yield from mesh_frequencies(part, frequency, gears, sidebands, about)
    for name, bearing in machine.bearings.items():
        outer = turning[bearing.carrier] if bearing.carrier else 0.0
        rolling = turning[bearing.shaft] - outer
        if rolling and name not in repeated:
            if (impacts := _dimensions(case, name, bearing.rolling)) is None:
                missing.append(name)
            else:
                yield from bearing_frequencies(f"bearing {name}", impacts, rolling)
    for name, stage in machine.planets.items():
        meshes = {kind: flow.meshes[m[0]] for kind, m in stage.mesh_names(name).items()}
        teeth = {g: machine.gears[getattr(stage, g)].teeth for g in ("sun", "ring")}
        gears = {g: (teeth[g], meshes[g].mesh_frequency) for g in teeth}
        gears["planet"] = stage.planet.teeth, meshes["sun"].mesh_frequency
        if stage.ring_planet is not None:
            gears["ring planet"] = stage.ring_planet.teeth, meshes["ring"].mesh_frequency
        passing = turning[stage.carrier] - turning[machine.gears[stage.ring].shaft]
        yield from stage_frequencies(f"stage {name}", stage.count, passing, gears)


def _dimensions(case: Any, name: str, ring: Any) -> BearingImpacts | None:
    """Dimensions of a bearing by its type, or by a defect of it; None where none are known."""
    if ring is not None:
        return BearingImpacts(
            place="outer", rolling_elements=ring.elements, element_diameter=ring.element_diameter,
            pitch_diameter=ring.pitch, contact_angle=abs(ring.contact_angle),
        )  # fmt: skip
    return dict(defects_of(case)).get(name)


def _shaft_lines(shafts: dict[str, float]) -> Iterator[PartFrequency]:
    for name, turning in shafts.items():
        if turning:
            yield PartFrequency(f"shaft {name}", f"f({name})", turning, "a turn")


def _further_planets(machine: Machine) -> set[str]:
    """Shafts, meshes and bearings of the second and further planets of each stage."""
    further: set[str] = set()
    for name, stage in machine.planets.items():
        parts = stage.parts(name, machine.gears)
        for group in parts.values():
            further.update(part for part in group if part[-1].isdigit() and not _of_first(part))
    return further


def _of_first(part: str) -> bool:
    return part.rstrip("0123456789") + "1" == part
