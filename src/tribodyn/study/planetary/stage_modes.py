"""Natural modes of a planetary stage over its speed, and the mesh harmonics that excite them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics import natural_modes
from tribodyn.machine import planetary_modes, planetary_plane_model
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.modes import MachineCampbell, MeshOrder, nearest_first
from tribodyn.study.machine.run import warn_of_meshes
from tribodyn.study.planetary.stage import stage_data, stage_teeth
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import MeshPhases, PlanetaryKinematics, PlanetaryModes
    from tribodyn.study.machine.load_cases import LoadCase
    from tribodyn.study.planetary.case import PlanetaryCase

MODES_HEAD = ("Mode", "Frequency [Hz]", "Multiplicity", "Type", "Excited by mesh harmonics")
#: Harmonics of the table of modes, of the resonances, and of the diagram over the speed.
_HARMONICS, _MET, _DRAWN = 12, 3, 5
#: Relative difference of frequencies that is rounding.
_EQUAL = 1e-6
#: Speeds of a diagram, and its top speed over that of the operation.
_SPEEDS, _TOP = 6, 1.3
_TYPES = {"rotational": "R", "translational": "T", "planet": "P", "mixed": "RT"}


class StageModes(NamedTuple):
    """Natural modes of a stage under one load, with the mean stiffness of its meshes."""

    load: LoadCase
    kinematics: PlanetaryKinematics
    data: Mapping[str, Any]  #: arguments of the plane model
    modes: PlanetaryModes

    @property
    def phases(self) -> MeshPhases:
        """Phases of all meshes."""
        phases: MeshPhases = self.data["phases"]
        return phases

    def orders(self, harmonics: int = _MET) -> tuple[MeshOrder, ...]:
        """Shares of the strain energy of each mode that the mesh harmonics excite."""
        frequency, shape = self.modes.frequency, np.asarray(self.modes.shape)
        contacts = planetary_plane_model(**self.data).contacts
        stiffness = np.array([float(each.stiffness) for each in contacts])  # type: ignore[arg-type]
        along = np.array([np.asarray(each.direction) for each in contacts])
        offsets = np.append(self.phases.sun_offset, self.phases.ring_offset)
        turn = 2.0 * np.pi * self.kinematics.mesh_frequency / abs(self.load.speed)
        energy = np.where(frequency > 0.0, (2.0 * np.pi * frequency) ** 2, np.inf)
        first = np.flatnonzero(np.diff(frequency, prepend=-1.0) > _EQUAL * frequency)
        orders = []
        for harmonic in range(1, harmonics + 1):
            waves = np.exp(2j * np.pi * harmonic * offsets) * np.sqrt(stiffness)
            sides = ((shape @ along.T) * waves).reshape(len(shape), 2, -1).sum(axis=2)
            share = 2.0 * (np.abs(sides) ** 2).sum(axis=1) / stiffness.size / energy
            # Modes of one frequency are one resonance: the shares of all of them count.
            total = np.zeros(len(shape))
            total[first] = np.add.reduceat(share, first)
            orders.append(MeshOrder("mesh", harmonic, harmonic * turn, total))
        return tuple(orders)

    def campbell(self, speeds: Array | None = None) -> MachineCampbell:
        """Natural frequencies and excitations over the speed of the input [rad/s]."""
        stage, now = self.kinematics, abs(self.load.speed)
        at = np.linspace(0.0, _TOP * now, _SPEEDS) if speeds is None else np.asarray(speeds)
        turning = self.data["carrier_speed"] / now
        rows = [
            natural_modes(
                planetary_plane_model(**{**self.data, "carrier_speed": turning * float(speed)})
            ).frequency
            for speed in at
        ]
        elastic = min(int(np.count_nonzero(row)) for row in rows)
        order = 2.0 * np.pi * stage.mesh_frequency / now
        orders = {
            f"mesh x {k} ({self.phases.excitation(k).types})": k * order
            for k in range(1, _DRAWN + 1)
        }
        orders |= {
            f"shaft {role}": abs(stage.speeds[role]) / now
            for role in ("sun", "ring", "carrier")
            if stage.speeds[role]
        }
        frequency = np.array([row[len(row) - elastic :] for row in rows])
        share = np.full((elastic, len(orders)), np.nan)
        for column, met in enumerate(self.orders(_DRAWN)):
            share[:, column] = met.share[len(met.share) - elastic :]
        values = np.array(list(orders.values()))
        return MachineCampbell(at, frequency, tuple(orders), values, now, share)

    def rows(self) -> list[list[str]]:
        """Rows of the table of modes under :data:`MODES_HEAD`."""
        harmonics = {k: self.phases.excitation(k).types for k in range(1, _HARMONICS + 1)}
        mesh_frequency = self.kinematics.mesh_frequency
        rows: list[list[str]] = []
        distances: list[float] = []
        last = (-1.0, "")
        for frequency, kind in zip(self.modes.frequency.tolist(), self.modes.types, strict=True):
            if kind == last[1] and abs(frequency - last[0]) <= _EQUAL * frequency:
                rows[-1][2] = str(int(rows[-1][2]) + 1)
                continue
            last = frequency, kind
            exciting = [k for k, types in harmonics.items() if set(types) & set(_TYPES[kind])]
            text, distance = ", ".join(map(str, exciting)) or "none", np.inf
            if exciting and frequency > 0.0:
                nearest = min(exciting, key=lambda k: abs(k * mesh_frequency - frequency))
                distance = nearest * mesh_frequency / frequency - 1.0
                text += f"; nearest {nearest}, {100.0 * distance:+.1f} %"
            rows.append([str(len(rows) + 1), f"{frequency:.5g}", "1", kind, text])
            distances.append(distance)
        return nearest_first(rows, distances)

    def frame_effect(self) -> str:
        """Sentence on what the rotation of the carrier changes of the natural frequencies."""
        speed = float(self.data["carrier_speed"])
        rpm = f"{abs(speed) * 30.0 / np.pi:.5g} rpm"
        if not speed:
            return "The carrier is at rest: its frame has no Coriolis and centripetal forces."
        still = planetary_plane_model(**{**self.data, "carrier_speed": 0.0})
        unturned = natural_modes(still).frequency
        frequency = self.modes.frequency
        change = frequency / np.where(unturned > 0.0, unturned, np.inf) - (unturned > 0.0)
        most = int(np.abs(change).argmax())
        return (
            f"The Coriolis and centripetal forces of the carrier at {rpm} change the natural "
            f"frequencies by at most {100.0 * abs(change[most]):.2g} %: mode {most + 1} from "
            f"{unturned[most]:.6g} to {frequency[most]:.6g} Hz."
        )

    def excitation_text(self) -> str:
        """Types of modes that each harmonic of the mesh frequency excites."""
        harmonics = range(1, _HARMONICS + 1)
        return ", ".join(f"{k}: {self.phases.excitation(k).types}" for k in harmonics)

    def facts(self) -> dict[str, Any]:
        """Modes and excitations in SI for JSON."""
        modes, frequency = self.modes, self.kinematics.mesh_frequency
        harmonics = range(1, _HARMONICS + 1)
        return {
            "speed": self.load.speed,
            "carrier_speed": float(self.data["carrier_speed"]),
            "mesh_frequency": frequency,
            "excited_types": {str(k): self.phases.excitation(k).types for k in harmonics},
            "modes": [
                {"number": number, "frequency": hertz, "type": kind}
                for number, (hertz, kind) in enumerate(
                    zip(modes.frequency.tolist(), modes.types, strict=True), 1
                )
            ],
        }


def stage_modes(case: PlanetaryCase, progress: Progress = SILENT) -> StageModes:
    """Compute the tooth contacts and natural modes of a stage; no motion is computed."""
    load = case.operating_point
    progress.start(f"Tooth contact: {load.name}")
    teeth = stage_teeth(case, load)
    warn_of_meshes(teeth.warnings)
    progress.finish()
    data = stage_data(case, load, teeth.tables, case.phases(load))
    modes = planetary_modes(planetary_plane_model(**data))
    return StageModes(load, case.kinematics(load), data, modes)
