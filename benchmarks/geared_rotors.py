"""Natural frequencies and time response of two geared shafts, against ROSS on the same model.

Both have the same nodes, beam elements, discs, bearings and mesh stiffness; both models are built
before the race, tribodyn's by a reduction of the full one. ROSS has two ways to the time response:
the exact response of a linear system, and Newmark's method, which a varying mesh stiffness needs.
tribodyn integrates in modal coordinates the machine that is reduced up to 2.2 times the frequency
of its excitation. All take a peak of the motion to 1 %.
"""

from __future__ import annotations

import io
import math
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from itertools import pairwise
from typing import Any

# Everyone's linear algebra keeps to one core; NumPy reads this when it is loaded.
if "numpy" not in sys.modules:
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.dynamics import simulate
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Section,
    Shaft,
    machine_modes,
    reduce_structure,
    system,
)

__all__ = ["geared_shafts", "main", "ross_rotors"]

_SPEED, _STIFFNESS, _DAMPING = 100.0 * math.pi, 5.2e8, 2000.0
#: Highest frequency of interest [Hz]; amplitude of the torque at mesh frequency [N*m].
_LIMIT, _TORQUE = 6000.0, 60.0
#: Steps of the time response in a mesh cycle, of ROSS and of tribodyn.
_STEPS, _OWN_STEPS = 37, 20


def geared_shafts() -> Machine:
    """Two shafts of 300 mm, joined by a spur pair."""
    damped = {"radial_damping": _DAMPING}
    return Machine(
        shafts={
            "input": _shaft((0.12, 0.055), (0.05, 0.07), (0.13, 0.055)),
            "output": _shaft((0.125, 0.075, 0.02), (0.05, 0.09, 0.02), (0.125, 0.075, 0.02)),
        },
        gears={
            "z1": Gear("input", 0.145, 27, 0.05, 4.0, 0.006, 0.004),
            "z2": Gear("output", 0.150, 51, 0.05, 18.0, 0.140, 0.075),
        },
        meshes={"first": Mesh(("z1", "z2"), 4.5e-3, stiffness=_STIFFNESS)},
        bearings={
            "A": Bearing("input", 0.02, 4e8, 2e8, **damped),
            "B": Bearing("input", 0.28, 4e8, **damped),
            "C": Bearing("output", 0.02, 5e8, 2e8, **damped),
            "D": Bearing("output", 0.28, 5e8, **damped),
        },
        operation=Operation("input", "output", _SPEED, 600.0),
    )


def _shaft(*sections: tuple[float, ...]) -> Shaft:
    return Shaft([Section(*sizes) for sizes in sections])


def ross_rotors(structure: MachineStructure) -> Any:
    """The same two shafts as a ``MultiRotor`` of ROSS, or None where it is not installed."""
    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            import ross
    except (ImportError, ValueError):  # the latter where its figures do not suit Plotly
        return None
    model = structure.machine
    steel = ross.Material(name="shaft", rho=7850.0, E=206e9, Poisson=0.3)
    rotors, coupled = [], []
    for gear_name, gear in model.gears.items():
        shaft = structure.shafts[gear.shaft]
        body = model.gear_bodies[gear_name]
        nodes = [float(node) for node in shaft.nodes]
        elements = [
            ross.ShaftElement(L=right - left, idl=inner, odl=outer, material=steel)
            for left, right in pairwise(nodes)
            for outer, inner in [_diameters(shaft.shaft, 0.5 * (left + right))]
        ]
        coupled.append(_nearest(nodes, gear.node_position))
        disc = ross.GearElement(
            n=coupled[-1], m=body.mass, Id=body.transverse_moment_of_inertia,
            Ip=body.moment_of_inertia, n_teeth=gear.teeth, pitch_diameter=gear.teeth * 4.5e-3,
            pr_angle=math.radians(20.0),
        )  # fmt: skip
        bearings = [
            ross.BearingElement(
                n=_nearest(nodes, bearing.position), kxx=bearing.radial_stiffness,
                kyy=bearing.radial_stiffness, kzz=bearing.axial_stiffness, cxx=_DAMPING,
                cyy=_DAMPING,
            )
            for bearing in model.bearings.values() if bearing.shaft == gear.shaft
        ]  # fmt: skip
        rotors.append(ross.Rotor(elements, [disc], bearings))
    return ross.MultiRotor(*rotors, coupled_nodes=tuple(coupled), gear_mesh_stiffness=_STIFFNESS)


def _nearest(nodes: Sequence[float], position: float) -> int:
    return int(np.abs(np.asarray(nodes) - position).argmin())


def _diameters(shaft: Shaft, position: float) -> tuple[float, float]:
    begin = 0.0
    for section in shaft.sections:
        if position < begin + section.length:
            return section.diameters((position - begin) / section.length)
        begin += section.length
    raise ValueError(position)


def main(words: Sequence[str] | None = None) -> None:
    """Print frequencies, amplitudes and times of both programs."""
    quick = arguments(__doc__, words).quick
    rounds, cycles = (1, 4) if quick else (3, 270)
    print(machine())
    structure = MachineStructure(geared_shafts(), damping_ratio=0.0)
    rotors = ross_rotors(structure)
    if rotors is None:
        print('ROSS: not installed (pip install ross-rotordynamics "plotly<6")\n')
        return
    difference = _frequency_difference(structure, rotors)
    amplitudes, times = _race(structure, rotors, cycles, rounds)
    ours = times["tribodyn"]
    rows = [
        (
            name,
            f"{times[name].best:.3g}",
            f"{times[name].faster_than(ours) ** -1:.3g}",
            f"{peak:.5g}",
        )
        for name, peak in amplitudes.items()
    ]
    print_table((f"time response, {cycles} mesh cycles", "CPU s", "x ours", "peak y, um"), rows)
    if not quick:
        print_goals([
            Goal("frequencies against ROSS", 0.5, 100.0 * difference, "%", at_least=False),
            Goal("time response over Newmark of ROSS", 100.0,
                 ours.faster_than(times["ROSS, Newmark"]), "x", at_least=True),
        ])  # fmt: skip


def _frequency_difference(structure: MachineStructure, rotors: Any) -> float:
    """Greatest relative difference of the natural frequencies up to the limit."""
    ours = machine_modes(reduce_structure(structure, _LIMIT)).frequency
    theirs = np.sort(rotors.run_modal(_SPEED, num_modes=60).wn) / (2.0 * np.pi)
    theirs = theirs[theirs > 1.0]
    count = int(np.count_nonzero(theirs < _LIMIT))
    difference = np.abs(ours[:count] / theirs[:count] - 1.0)
    rows = [
        (f"{number + 1}", f"{ours[number]:.2f}", f"{theirs[number]:.2f}",
         f"{100 * difference[number]:.4f}")
        for number in range(count)
    ]  # fmt: skip
    print_table(("mode at 3000 rpm", "tribodyn Hz", "ROSS Hz", "difference %"), rows)
    return float(difference.max())


def _race(
    structure: MachineStructure, rotors: Any, cycles: int, rounds: int
) -> tuple[dict[str, float], Any]:
    """Peaks of the motion of the first gear [um], and the times of all."""
    frequency = structure.machine.kinematics.meshes["first"].mesh_frequency
    time = np.arange(cycles * _STEPS) / (_STEPS * frequency)
    force = np.zeros((time.size, rotors.ndof))
    force[:, 5] = _TORQUE * np.sin(2.0 * np.pi * frequency * time)
    gear = _nearest(structure.shafts["input"].nodes.tolist(), 0.145)
    peaks: dict[str, float] = {}
    reduced = reduce_structure(structure, 2.2 * frequency, tolerance=1e-3)
    along, still = reduced.at("input", 0.0)[3], np.zeros(reduced.size)
    excited = replace(
        system(reduced),
        balance=None,
        force=lambda phase: _TORQUE * np.multiply.outer(np.sin(2.0 * np.pi * phase), along),
    )

    def ours() -> float:
        response = simulate(
            excited, frequency, cycles, (still, still), steps=_OWN_STEPS, method="modal"
        )
        moved = response.fine.position @ reduced.gear("z1")[1:3].T
        peaks["tribodyn"] = 1e6 * float(np.hypot(*moved.T).max())
        return 1.0

    def theirs(name: str, method: str, share: float) -> Callable[[], float]:
        def run() -> float:
            rows = max(int(share * time.size), 2)
            with redirect_stdout(io.StringIO()):
                response = rotors.run_time_response(
                    _SPEED, force[:rows], time[:rows], method=method
                )
            moved = np.asarray(response.yout)[:, 6 * gear : 6 * gear + 2]
            peaks[name] = 1e6 * float(np.hypot(*moved.T).max())
            return rows / time.size

        return run

    runners = {
        "tribodyn": ours,
        "ROSS, linear": theirs("ROSS, linear", "default", 1.0),
        # its time is that of a part of the mesh cycles, times their number
        "ROSS, Newmark": theirs("ROSS, Newmark", "newmark", min(1.0, 14 / cycles)),
    }
    times = race(runners, rounds)
    return peaks, times


if __name__ == "__main__":
    main()
