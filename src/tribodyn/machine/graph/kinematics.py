"""Speeds, torques and power of all shafts and meshes, without losses."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.shaft_graph import ShaftGraph, listed
from tribodyn.machine.mesh import Mesh, mean_over_phase
from tribodyn.machine.shaft import Coupling

#: Mesh stiffness per face width by which loops share where none is given [Pa].
_USUAL_STIFFNESS = 14e9
#: Share of the torque below which a mesh of a loop is unloaded.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class ShaftLoad:
    """Speed, torque and power of a shaft.

    Parameters
    ----------
    ratio : Fraction
        Speed over that of the input, negative where it turns the other way; exact.
    speed : float
        Speed; a positive one turns y towards z [rad/s].
    torque : float
        Torque that enters the shaft and leaves it again, negative while the output drives [N*m].
    power : float
        Power that it transmits, negative while the output drives [W].
    """

    ratio: Fraction
    speed: float
    torque: float
    power: float


@dataclass(frozen=True)
class MeshLoad:
    """Load of a mesh.

    Parameters
    ----------
    mesh_frequency : float
        Mesh cycles per second [Hz].
    driver, driven : str
        Names of the driving and the driven gear.
    torque : (float, float)
        Torque about x that the first gear puts into the mesh, and that the second gear takes out
        of it [N*m].
    force : float
        Force along the transverse line of action, on crossed axes along the normal [N].
    power : float
        Power from the driving to the driven gear [W].
    sense : int
        Sign of the torque of the first gear about x: which flank carries.
    shared : bool
        Whether the mesh is in a loop, where torques are shared by stiffness: the value is that of
        rigid shafts with the mean mesh stiffnesses.
    """

    mesh_frequency: float
    driver: str
    driven: str
    torque: tuple[float, float]
    force: float
    power: float
    sense: int
    shared: bool


@dataclass(frozen=True)
class Kinematics:
    """Loads of all shafts and meshes by name.

    Parameters
    ----------
    shafts : mapping of str to ShaftLoad
        Shafts.
    meshes : mapping of str to MeshLoad
        Meshes.
    """

    shafts: Mapping[str, ShaftLoad]
    meshes: Mapping[str, MeshLoad]


def shaft_ratios(
    graph: ShaftGraph, gears: Mapping[str, Gear], meshes: Mapping[str, Mesh]
) -> dict[str, Fraction]:
    """Speed of each shaft over that of the input, by the meshes and couplings of the tree."""

    def step(link: str, forward: bool, ratio: Fraction) -> Fraction:
        return ratio * _ratio(link, gears, meshes) ** (1 if forward else -1)

    return graph.propagate(Fraction(1), step)


def _ratio(link: str, gears: Mapping[str, Gear], meshes: Mapping[str, Mesh]) -> Fraction:
    """Ratio of a mesh; 1 of a coupling."""
    if link not in meshes:
        return Fraction(1)
    mesh = meshes[link]
    return mesh.ratio((gears[mesh.gears[0]], gears[mesh.gears[1]]))


def ratio_problems(
    graph: ShaftGraph,
    gears: Mapping[str, Gear],
    meshes: Mapping[str, Mesh],
    speed: float,
) -> list[Problem]:
    """Loops of meshes whose ratios contradict each other."""
    ratios = shaft_ratios(graph, gears, meshes)
    problems = []
    for mesh in graph.loops:
        first, second = graph.edges[mesh]
        by_mesh = ratios[first] * _ratio(mesh, gears, meshes)
        if by_mesh == ratios[second]:
            continue
        stated = [
            display(float(ratio) * speed, "rad/s")
            if speed
            else f"{float(ratio):.6g} times the input"
            for ratio in (ratios[second], by_mesh)
        ]
        path = graph.path(second)
        by_path = f"by {listed(path)}" if path else "as the input"
        pair = meshes[mesh].gears if mesh in meshes else ()
        teeth = ", ".join(f"{gear} has {gears[gear].teeth}" for gear in pair)
        problems.append(
            Problem(
                f'shaft "{second}" turns at {stated[0]} {by_path}, and at {stated[1]} by '
                f"{listed([*graph.path(first), mesh])}",
                f"meshes.{mesh}.gears" if pair else f"couplings.{mesh}",
                "All meshes of a loop must give one speed",
                f"Correct teeth ({teeth}), or remove one of these" if pair else "Remove it",
            )
        )
    return problems


def kinematics(
    graph: ShaftGraph,
    gears: Mapping[str, Gear],
    meshes: Mapping[str, Mesh],
    ends: tuple[str, str],
    operation: tuple[float, float],
    couplings: Mapping[str, Coupling],
) -> Kinematics:
    """Speeds and torques of a machine between (input, output) at (speed, torque) of the input."""

    def conductance(link: str) -> float:
        if link in couplings:
            return couplings[link].torsional_stiffness * float(ratios[graph.edges[link][0]]) ** 2
        return _conductance(meshes[link], gears, ratios)

    (start, _), (speed, torque) = ends, operation
    ratios = shaft_ratios(graph, gears, meshes)
    sense = -1.0 if speed < 0.0 else 1.0
    flows = _flows(graph, ends, torque, conductance)
    mesh_loads = {}
    inflow = dict.fromkeys(ratios, 0.0)
    inflow[start if torque >= 0.0 else ends[1]] = abs(torque)
    for name, (flow, shared) in flows.items():
        shafts = graph.edges[name]
        inflow[shafts[flow > 0.0]] += abs(flow)
        if name in couplings:
            continue
        first = flow > 0.0 or (flow == 0.0 and _leads(graph, name))
        mesh, ratio = meshes[name], [float(ratios[shaft]) for shaft in shafts]
        about = (sense * flow / ratio[0], sense * flow / ratio[1])
        drives, follows = mesh.gears if first else mesh.gears[::-1]
        turn = int(math.copysign(1.0, sense * ratio[0] * (1.0 if first else -1.0)))
        mesh_loads[name] = MeshLoad(
            mesh_frequency=abs(ratio[0] * gears[mesh.gears[0]].teeth * speed) / (2.0 * math.pi),
            driver=drives,
            driven=follows,
            torque=about,
            force=abs(about[0]) / base_radius(mesh, gears[mesh.gears[0]], turn),
            power=abs(flow * speed),
            sense=turn,
            shared=shared,
        )
    sign = -1.0 if torque < 0.0 else 1.0
    shaft_loads = {
        name: ShaftLoad(
            ratio=ratio,
            speed=float(ratio) * speed,
            torque=sign * inflow[name] / abs(float(ratio)),
            power=sign * inflow[name] * abs(speed),
        )
        for name, ratio in ratios.items()
    }
    return Kinematics(shaft_loads, mesh_loads)


def base_radius(mesh: Mesh, gear: Gear, sense: int = 1) -> float:
    """Lever of the mesh force about a gear [m]; on crossed axes about the first, by its sense."""
    if mesh.crossing is not None:
        return mesh.crossing.levers(sense)[0]
    radius = 0.5 * abs(gear.teeth) * mesh.transverse_module
    return radius * math.cos(mesh.transverse_pressure_angle)


def _leads(graph: ShaftGraph, mesh: str) -> bool:
    """Whether the first gear of an unloaded mesh is the one nearer to the input."""
    first, second = graph.edges[mesh]
    return len(graph.path(first)) <= len(graph.path(second))


def mean_stiffness(mesh: Mesh, gears: tuple[Gear, Gear]) -> float:
    """Mean mesh stiffness [N/m]; without data the usual 14 N/(mm um) over the common face."""
    if mesh.stiffness is None:
        return _USUAL_STIFFNESS * min(gear.face_width for gear in gears)
    return mean_over_phase(mesh.stiffness)


def _conductance(mesh: Mesh, gears: Mapping[str, Gear], ratios: Mapping[str, Fraction]) -> float:
    """Torsional stiffness of a mesh, referred to the input."""
    first, second = (gears[gear] for gear in mesh.gears)
    lever = base_radius(mesh, first) * float(ratios[first.shaft])
    return mean_stiffness(mesh, (first, second)) * lever**2


def _flows(
    graph: ShaftGraph,
    ends: tuple[str, str],
    torque: float,
    conductance: Callable[[str], float],
) -> dict[str, tuple[float, bool]]:
    """Torque from first to second gear, referred to the input, and whether loops share it."""
    flows, loops = {}, []
    for mesh, (first, second) in graph.edges.items():
        side = graph.side(mesh, first)
        if second in side:
            loops.append(mesh)
            continue
        flow = torque * ((ends[0] in side) - (ends[1] in side))
        flows[mesh] = (flow, False)
    if loops:
        shafts = list(dict.fromkeys(shaft for ends in graph.edges.values() for shaft in ends))
        incidence = np.zeros((len(shafts), len(graph.edges)))
        for column, (first, second) in enumerate(graph.edges.values()):
            incidence[shafts.index(first), column] = 1.0
            incidence[shafts.index(second), column] = -1.0
        weight = np.array([conductance(mesh) for mesh in graph.edges])
        source = np.zeros(len(shafts))
        source[shafts.index(ends[0])] += torque
        source[shafts.index(ends[1])] -= torque
        laplacian = (incidence * weight) @ incidence.T
        potential = np.zeros(len(shafts))
        potential[1:] = np.linalg.solve(laplacian[1:, 1:], source[1:])
        shared = weight * (incidence.T @ potential)
        shared[np.abs(shared) < _ROUNDING * abs(torque)] = 0.0
        numbers = dict(zip(graph.edges, shared.tolist(), strict=True))
        flows.update({mesh: (numbers[mesh], True) for mesh in loops})
    return {mesh: flows[mesh] for mesh in graph.edges}
