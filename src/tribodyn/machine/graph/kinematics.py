"""Speeds, torques and power of all shafts and meshes, without losses or with those of meshes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from tribodyn.errors import Problem
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.mobility import Drive, Mobility, ShaftGraph, listed
from tribodyn.machine.mesh import Mesh, mean_over_phase

#: Mesh stiffness per face width by which loops share where none is given [Pa].
_USUAL_STIFFNESS = 14e9


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
        Power that it transmits, of a planet relative to its carrier (rolling power); negative
        while the output drives [W].

    Notes
    -----
    The torque of a shaft that is held is that of its support.
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
        Power from the driving to the driven gear, relative to their carrier [W].
    sense : int
        Sign of the torque of the first gear about x: which flank carries.
    shared : bool
        Whether the mesh is in a loop, where torques are shared by stiffness: that of the mean
        meshes on rigid shafts, or in a result that of everything in the loop.
    speeds : (float, float)
        Speeds of both gears, relative to the carrier of the mesh where it has one [rad/s].
    """

    mesh_frequency: float
    driver: str
    driven: str
    torque: tuple[float, float]
    force: float
    power: float
    sense: int
    shared: bool
    speeds: tuple[float, float]


@dataclass(frozen=True)
class PowerFlow:
    """Loads of all shafts and meshes by name.

    Parameters
    ----------
    shafts : mapping of str to ShaftLoad
        Shafts.
    meshes : mapping of str to MeshLoad
        Meshes.
    couplings : mapping of str to float
        Torque about x that the first shaft of each coupling gives to the second [N*m].
    """

    shafts: Mapping[str, ShaftLoad]
    meshes: Mapping[str, MeshLoad]
    couplings: Mapping[str, float] = field(default_factory=dict)


def ratio_problems(mobility: Mobility, meshes: Mapping[str, Mesh], speed: float) -> list[Problem]:
    """Loops of meshes whose ratios contradict each other, and speeds that nothing determines."""
    graph, gears, ratios, problems = mobility.graph, mobility.gears, mobility.ratios, []
    for mesh in mobility.contradictions:
        pair = meshes[mesh].gears if mesh in meshes else ()
        where = f"meshes.{mesh}.gears" if pair else f"couplings.{mesh}"
        teeth = ", ".join(f"{gear} has {gears[gear].teeth}" for gear in pair)
        remedy = f"Correct teeth ({teeth}), or remove one of these" if pair else "Remove it"
        first, second = graph.edges[mesh]
        if mobility.has_carriers:
            what = f"the speeds of shafts {first} and {second} contradict it"
            why = "The other meshes and the shafts that are held determine them"
            problems.append(Problem(what, where, why, remedy))
            continue
        factors = mobility.rows[mesh]
        ratio = Fraction(-factors[first], factors[second])
        stated = [
            display(float(ratio) * speed, "rad/s")
            if speed
            else f"{float(ratio):.6g} times the input"
            for ratio in (ratios[second], ratios[first] * ratio)
        ]
        path = graph.path(second)
        by_path = f"by {listed(path)}" if path else "as the input"
        problems.append(
            Problem(
                f'shaft "{second}" turns at {stated[0]} {by_path}, and at {stated[1]} by '
                f"{listed([*graph.path(first), mesh])}",
                where,
                "All meshes of a loop must give one speed",
                remedy,
            )
        )
    return problems or list(mobility.problems())


def kinematics(
    mobility: Mobility,
    meshes: Mapping[str, Mesh],
    drive: Drive,
    efficiency: Mapping[str, float] | None = None,
) -> PowerFlow:
    """Speeds and torques at speed and torque of the input, with the efficiency of some meshes."""
    graph, gears, ratios = mobility.graph, mobility.gears, mobility.ratios
    speed, torque = drive.speed, drive.torque
    sense = -1.0 if speed < 0.0 else 1.0
    weight = {}
    for name, mesh in meshes.items():
        pair = gears[mesh.gears[0]], gears[mesh.gears[1]]
        lever = base_radius(mesh, pair[0]) / pair[0].teeth
        weight[name] = mean_stiffness(mesh, pair) * lever**2
    weight |= drive.couplings
    rows: Mapping[str, Mapping[str, float]] = mobility.rows
    loads = mobility.loads(sense * torque, weight, rows)
    first_loads: dict[str, float] = {}
    if drive.sharing:
        first_loads = {name: load for name, (load, _) in loads.items()}
        for name, share in drive.sharing.items():
            first_loads[name] = -share * sense * torque / next(iter(rows[name].values()))
        loads = mobility.loads(sense * torque, weight, rows, first_loads)
    if efficiency:
        rows = mobility.rows_with_losses(loads, sense, efficiency)
        loads = mobility.loads(sense * torque, weight, rows, first_loads)
    mesh_loads = {}
    for name, mesh in meshes.items():
        load, shared = loads[name]
        factors, torques = ([*r[name].values()] for r in (mobility.rows, rows))
        relative = [float(mobility.relative(name, gears[gear].shaft)) for gear in mesh.gears]
        about = -torques[0] * load, torques[1] * load
        flow = about[0] * relative[0]
        first = sense * flow > 0.0 or (flow == 0.0 and _leads(graph, name))
        drives, follows = mesh.gears if first else mesh.gears[::-1]
        turn = int(math.copysign(1.0, sense * relative[0] * (1.0 if first else -1.0)))
        mesh_loads[name] = MeshLoad(
            mesh_frequency=abs(relative[0] * factors[0] * speed) / (2.0 * math.pi),
            driver=drives,
            driven=follows,
            torque=about,
            force=abs(about[0]) / base_radius(mesh, gears[mesh.gears[0]], turn),
            power=abs((about if first else about[::-1])[0] * relative[0 if first else 1] * speed),
            sense=turn,
            shared=shared,
            speeds=(relative[0] * speed, relative[1] * speed),
        )
    sign = -1.0 if torque < 0.0 else 1.0
    shaft_loads = {}
    for name, ratio in ratios.items():
        parts = {mesh: r[name] * loads[mesh][0] for mesh, r in rows.items() if name in r}
        carried = [mesh for mesh in parts if mesh in meshes and meshes[mesh].carrier == name]
        pins = sum(parts.pop(mesh) for mesh in carried)  # of one body, whatever their signs
        total = abs(pins + sum(parts.values()))
        entering = sign * 0.5 * (abs(pins) + sum(map(abs, parts.values())) + total)
        turning = float(ratio) * speed
        shaft_loads[name] = ShaftLoad(ratio, turning, entering, entering * abs(turning))
    return PowerFlow(shaft_loads, mesh_loads, {name: -loads[name][0] for name in drive.couplings})


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
