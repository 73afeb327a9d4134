"""Static balance: hand statics, beams, shares, reciprocity, rolling bearings, housing."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import root

from tribodyn.arrays.memory import Memo
from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.machine import (
    AngularContactBallBearing,
    Bearing,
    CylindricalRollerBearing,
    DeepGrooveBallBearing,
    FaceLaw,
    Gear,
    Housing,
    Machine,
    Mesh,
    Operation,
    Section,
    Shaft,
    face_laws,
    static_balance,
)

DEG = math.pi / 180.0
TORQUE = 600.0


def sections(*rows):
    return Shaft([Section(length, outer, inner) for length, outer, inner in rows])


def helical_stage(bearings=None, torque=TORQUE, **mesh) -> Machine:
    """Geared shafts of docs: gears of FVA-1 on shafts of 55 to 90 mm."""
    radial = {"in": 4e8, "out": 5e8}
    supports = bearings or {
        f"{shaft} {name}": Bearing(
            shaft, place, radial_stiffness=radial[shaft], axial_stiffness=2e8 * (name == "left")
        )
        for shaft in radial
        for name, place in (("left", 0.02), ("right", 0.28))
    }
    data = {"helix_angle": 21 * DEG, "hand": "left", "center_distance": 0.19, "angle": 30 * DEG}
    return Machine(
        shafts={
            "in": sections((0.12, 0.055, 0.0), (0.05, 0.07, 0.0), (0.13, 0.055, 0.0)),
            "out": sections((0.125, 0.075, 0.02), (0.05, 0.09, 0.02), (0.125, 0.075, 0.02)),
        },
        gears={"z1": Gear("in", 0.145, 27, 0.05), "z2": Gear("out", 0.150, 51, 0.05)},
        meshes={"first": Mesh(("z1", "z2"), 4.5e-3, stiffness=5.2e8, **{**data, **mesh})},
        bearings=supports,
        operation=Operation("in", "out", 314.0, torque),
    )


def spur_stage(stiffness=1e9, torque=300.0, place=0.06, **more) -> Machine:
    """Two shafts of 200 mm with bearings at their ends and gears at ``place``."""
    shaft = sections((0.2, 0.04, 0.0))
    return Machine(
        shafts={"in": shaft, "out": shaft},
        gears={"z1": Gear("in", place, 20, 0.03), "z2": Gear("out", place, 40, 0.03)},
        meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
        bearings={
            f"{shaft} {end}": Bearing(
                shaft, end, radial_stiffness=stiffness, axial_stiffness=stiffness, **more
            )
            for shaft in ("in", "out")
            for end in (0.0, 0.2)
        },
        operation=Operation("in", "out", 100.0, torque),
    )


def test_bearing_loads_of_a_helical_stage_by_hand():
    machine = helical_stage()
    balance = static_balance(machine)
    working = 27 / 78 * 0.19  # radius of the pitch circle of the first gear
    tangential = TORQUE / working
    helix = math.atan(math.tan(21 * DEG) * working / (27 * 4.5e-3 / math.cos(21 * DEG) / 2))
    pressure = 22.806245 * DEG
    radial, axial = tangential * math.tan(pressure), tangential * math.tan(helix)
    # The force of the second gear on the first: against t, against c, and along x for a left-hand
    # gear that drives with positive speed: force on gear 2 along +x, on gear 1 along -x.
    c = np.array([0.0, math.cos(30 * DEG), math.sin(30 * DEG)])
    t = np.array([0.0, -c[2], c[1]])
    force = -tangential * t - radial * c - axial * np.array([1.0, 0.0, 0.0])
    moment = np.cross(working * c, force)
    left, right = (balance.bearings[f"in {end}"].load for end in ("left", "right"))
    span, arm = 0.26, 0.125
    expected_y = (force[1] * arm + moment[2]) / span
    expected_z = (force[2] * arm - moment[1]) / span
    assert right[1:3] == pytest.approx([expected_y, expected_z], rel=1e-7)
    assert left[:3] == pytest.approx(force - [0.0, *right[1:3]], abs=1e-3)
    assert right[0] == 0.0
    assert balance.meshes["first"].force == pytest.approx(tangential / math.cos(pressure), rel=1e-7)
    total = sum(b.load[:3] for n, b in balance.bearings.items())
    assert total == pytest.approx(0.0, abs=1e-7 * tangential)  # both gears load each other


def test_torque_ratio_of_three_stages():
    shaft = sections((0.2, 0.05, 0.0))
    names = ["a", "b", "c", "d"]
    gears = {
        "z1": Gear("a", 0.05, 19, 0.03),
        "z2": Gear("b", 0.05, 61, 0.03),
        "z3": Gear("b", 0.15, 23, 0.03),
        "z4": Gear("c", 0.15, 67, 0.03),
        "z5": Gear("c", 0.05, 21, 0.03),
        "z6": Gear("d", 0.05, 50, 0.03),
    }
    pairs = {"first": ("z1", "z2"), "second": ("z3", "z4"), "third": ("z5", "z6")}
    machine = Machine(
        shafts=dict.fromkeys(names, shaft),
        gears=gears,
        meshes={
            name: Mesh(pair, 3e-3, helix_angle=12 * DEG, angle=40 * DEG * k)
            for k, (name, pair) in enumerate(pairs.items())
        },
        bearings={f"{n}{x}": Bearing(n, x) for n in names for x in (0.0, 0.2)},
        operation=Operation("a", "d", -150.0, 100.0),
    )
    balance = static_balance(machine)
    ratio = 61 / 19 * 67 / 23 * 50 / 21
    # Input against x, output along x, held against it.
    assert balance.output_torque == pytest.approx(-100.0 * ratio, rel=1e-10)
    assert any("meshes.second.stiffness: 14" in note for note in balance.assumptions)
    assert any("bearings.a0.0 is stiff" in note for note in balance.assumptions)


def test_deflection_and_slope_of_a_supported_beam():
    """Timoshenko beam on two springs under a force; the slope is that without shear."""
    machine = spur_stage(torque=0.0)
    load = 2000.0
    balance = static_balance(machine, loads={"z1": [0.0, load, 0.0, 0.0, 0.0, 0.0]})
    span, a = 0.2, 0.06
    b = span - a
    inertia, area = math.pi * 0.04**4 / 64, math.pi * 0.04**2 / 4
    shear = 206e9 / 2.6 * area * 6 * 1.3 / (7 + 6 * 0.3)
    bending = load * a**2 * b**2 / (3 * 206e9 * inertia * span) + load * a * b / span / shear
    left, right = load * b / span / 1e9, load * a / span / 1e9
    springs = left + (right - left) * a / span
    deflection = balance.gears["z1"]
    # The mesh couples the other shaft; its share of the load is a result.
    mesh = balance.meshes["first"]
    share = load - mesh.force * machine.directions["first"].normal[1]
    assert deflection[1] == pytest.approx((bending + springs) * share / load, rel=1e-9)
    slope = load * a * b * (b - a) / (3 * 206e9 * inertia * span) + (right - left) / span
    assert deflection[5] == pytest.approx(slope * share / load, rel=1e-9)


def test_misalignment_is_the_slope_of_both_shafts_in_the_plane_of_action():
    balance = static_balance(machine := spur_stage())
    n = machine.directions["first"].normal
    tilts = [balance.gears[gear][3:] for gear in ("z1", "z2")]
    slopes = [tilt[2] * n[1] - tilt[1] * n[2] for tilt in tilts]  # of the shafts along n
    mesh = balance.meshes["first"]
    assert mesh.misalignment == pytest.approx(0.03 * (slopes[0] - slopes[1]), rel=1e-12)
    # Both gears are nearer to the ends at x = 0: shafts deflect away from each other towards +x,
    # so that the teeth are pressed less there.
    assert mesh.misalignment < 0.0
    centre = static_balance(spur_stage(place=0.1)).meshes["first"]
    assert centre.misalignment == pytest.approx(0.0, abs=1e-12)


def test_reciprocity_and_proportion():
    machine = helical_stage(torque=0.0)
    unit = np.eye(6)
    for i, j in ((1, 2), (0, 4), (3, 1), (5, 5)):
        forward = static_balance(machine, loads={"z1": unit[i]}).gears["z2"][j]
        back = static_balance(machine, loads={"z2": unit[j]}).gears["z1"][i]
        assert forward == pytest.approx(back, rel=1e-8, abs=1e-18)
    single, double = (static_balance(helical_stage(torque=t)) for t in (200.0, 400.0))
    for name, deflection in single.gears.items():
        assert double.gears[name] == pytest.approx(2.0 * deflection, rel=1e-7, abs=1e-15)


def test_a_split_of_power_follows_the_stiffness():
    """Two idlers between two gears; rigid shafts on stiff bearings share as their meshes."""
    first, second = 2e8, 5e8
    lines = {"upper": (60 * DEG, 120 * DEG, first), "lower": (-60 * DEG, -120 * DEG, second)}
    gears = {"sun": Gear("in", None, 20, 0.02), "end": Gear("out", None, 20, 0.02)}
    meshes = {}
    for name, (out, back, stiffness) in lines.items():
        gears[name] = Gear(name, None, 20, 0.02)
        meshes[f"{name} 1"] = Mesh(("sun", name), 3e-3, angle=out, stiffness=stiffness)
        meshes[f"{name} 2"] = Mesh((name, "end"), 3e-3, angle=back - 180 * DEG, stiffness=stiffness)
    for name in lines:  # the lines meet at the output: 60 mm along y
        out, _, stiffness = lines[name]
        meshes[f"{name} 2"] = Mesh((name, "end"), 3e-3, angle=-out, stiffness=stiffness)
    names = ["in", "upper", "lower", "out"]
    machine = Machine(
        shafts={name: Shaft() for name in names},
        gears=gears,
        meshes=meshes,
        bearings={
            n: Bearing(n, 0.0, radial_stiffness=1e15, axial_stiffness=1e15, tilting_stiffness=1e13)
            for n in names
        },
        operation=Operation("in", "out", 100.0, 90.0),
    )
    balance = static_balance(machine)
    forces = {name: mesh.force for name, mesh in balance.meshes.items()}
    assert forces["upper 1"] / forces["lower 1"] == pytest.approx(first / second, rel=1e-5)
    radius = 0.03 * math.cos(20 * DEG)
    assert forces["upper 1"] + forces["lower 1"] == pytest.approx(90.0 / radius, rel=1e-9)
    assert balance.output_torque == pytest.approx(-90.0, rel=1e-10)


def test_rigid_shafts_without_bearings_only_turn():
    machine = Machine(
        shafts={"in": Shaft(), "out": Shaft()},
        gears={"z1": Gear("in", None, 20, 0.02), "z2": Gear("out", None, 40, 0.02)},
        meshes={"first": Mesh(("z1", "z2"), 3e-3, helix_angle=10 * DEG, stiffness=3e8)},
        operation=Operation("in", "out", 100.0, 60.0),
    )
    balance = static_balance(machine)
    radius = machine.directions["first"].base_radius[0]
    assert balance.gears["z1"][3] == pytest.approx(60.0 / radius**2 / 3e8, rel=1e-9)
    assert balance.output_torque == pytest.approx(120.0, rel=1e-12)
    assert balance.meshes["first"].misalignment == 0.0


def test_a_loop_whose_errors_load_the_other_flank_warns():
    gears = {
        f"{shaft}{k}": Gear(shaft, 0.05 + 0.1 * k, teeth, 0.02)
        for k in (0, 1)
        for shaft, teeth in (("in", 20), ("out", 40))
    }
    shaft = sections((0.2, 0.05, 0.0))
    machine = Machine(
        shafts={"in": shaft, "out": shaft},
        gears=gears,
        meshes={
            f"m{k}": Mesh((f"in{k}", f"out{k}"), 3e-3, stiffness=3e8, error=40e-6 * k)
            for k in (0, 1)
        },
        bearings={f"{s}{x}": Bearing(s, x) for s in ("in", "out") for x in (0.0, 0.2)},
        operation=Operation("in", "out", 100.0, 20.0),
    )
    with pytest.warns(ModelWarning, match='mesh-tension.* mesh "m1" carries -'):
        balance = static_balance(machine)
    total = sum(mesh.force for mesh in balance.meshes.values())
    assert total == pytest.approx(20.0 / (0.03 * math.cos(20 * DEG)), rel=1e-9)
    separated = static_balance(machine, laws=face_laws(machine)).meshes
    assert separated["m1"].force == 0.0
    assert separated["m0"].force == pytest.approx(total, rel=1e-9)


def rolling_stage(**clearance) -> Machine:
    """Helical stage: deep groove and cylindrical roller bearings, angular contact pair."""
    ball = DeepGrooveBallBearing(bore_diameter=0.055, outer_diameter=0.12, **clearance)
    roller = CylindricalRollerBearing(
        bore_diameter=0.055, outer_diameter=0.1, width=0.021, **clearance
    )
    sizes = {"bore_diameter": 0.07, "outer_diameter": 0.125, "contact_angle": 25 * DEG}
    left, right = (
        AngularContactBallBearing(**sizes, direction=sign, preload=900.0) for sign in (-1, 1)
    )
    return helical_stage(
        {
            "A": Bearing("in", 0.02, rolling=ball),
            "B": Bearing("in", 0.28, rolling=roller),
            "C": Bearing("out", 0.02, rolling=left),
            "D": Bearing("out", 0.28, rolling=right),
        }
    )


@pytest.mark.parametrize("clearance", [0.0, 20e-6])
def test_rolling_bearings_balance_the_meshes(clearance):
    machine = rolling_stage(radial_clearance=clearance)
    balance = static_balance(machine)
    linear = static_balance(helical_stage())
    for shaft in ("in", "out"):
        bearings = [n for n, b in machine.bearings.items() if b.shaft == shaft]
        loads = sum(balance.bearings[n].load for n in bearings)
        expected = sum(b.load for n, b in linear.bearings.items() if n.startswith(shaft))
        assert loads[:3] == pytest.approx(expected[:3], rel=1e-7, abs=1e-6)
    for name, bearing in machine.bearings.items():
        part = balance.bearings[name]
        five = [0, 1, 2, 4, 5]
        assert part.load[five] == pytest.approx(bearing.rolling.load(part.displacement[five]))
        assert part.stiffness[3].any() == part.stiffness[:, 3].any() == False  # noqa: E712
        assert part.state.element_load.max() > 0.0
    assert balance.bearings["B"].load[0] == 0.0
    assert balance.bearings["A"].load[0] == pytest.approx(linear.bearings["in left"].load[0])
    # The thrust on the output gear is along +x: more load on the bearing with this direction.
    assert balance.bearings["D"].load[0] > -balance.bearings["C"].load[0] > 0.0
    assert balance.steps < 40


def test_a_rigid_shaft_on_two_rolling_bearings_by_another_solver():
    """Five displacements of the shaft, balanced by SciPy with the loads of the bearings alone."""
    machine = rolling_stage(radial_clearance=10e-6)
    machine = replace(machine, shafts={"in": Shaft(), "out": Shaft()})
    balance = static_balance(machine)
    push = machine.gear_loads["z1"]
    push = push + np.cross([0.145, 0, 0], push[:3]) @ np.eye(6)[3:]  # moved to the beginning

    def residual(scaled):
        x, y, z, turn_y, turn_z = 1e-5 * scaled * [1, 1, 1, 10, 10]
        left = push[[0, 1, 2, 4, 5]].copy()
        for name in ("A", "B"):
            bearing = machine.bearings[name]
            at = bearing.position
            load = bearing.rolling.load([x, y + at * turn_z, z - at * turn_y, turn_y, turn_z])
            left -= np.array([0, 0, 0, -at * load[2], at * load[1]]) + load
        return left * [1, 1, 1, 10, 10]

    origin = balance.bearings["A"].displacement - 0.02 * np.array(
        [0, balance.bearings["A"].displacement[5], -balance.bearings["A"].displacement[4], 0, 0, 0]
    )
    start = origin[[0, 1, 2, 4, 5]] / 1e-5 / [1, 1, 1, 10, 10]
    solution = root(residual, 1.05 * start, tol=1e-12)
    assert solution.x == pytest.approx(start, rel=1e-6, abs=1e-6)


def test_clearance_adds_its_half_to_the_displacement():
    tight, loose = (
        static_balance(rolling_stage(radial_clearance=c)).bearings["B"].displacement
        for c in (0.0, 20e-6)
    )
    gain = np.hypot(*loose[1:3]) - np.hypot(*tight[1:3])
    assert 10e-6 < gain < 14e-6  # fewer rollers carry


@pytest.mark.processor
def test_linearized_machine_has_the_stiffness_of_the_load():
    machine = rolling_stage()
    balance = static_balance(machine)
    springs = balance.linearized()
    for name, bearing in springs.bearings.items():
        assert bearing.stiffness_matrix == pytest.approx(balance.bearings[name].stiffness)
    force = [0.0, 1.0, -2.0, 0.0, 0.0, 0.0]
    changed = static_balance(machine, loads={"z2": force}).gears["z2"] - balance.gears["z2"]
    free = replace(springs, operation=replace(springs.operation, torque=0.0))
    assert static_balance(free, loads={"z2": force}).gears["z2"] == pytest.approx(
        changed, rel=1e-2, abs=1e-11
    )
    with pytest.warns(ModelWarning, match="carries no load"):
        static_balance(
            replace(
                rolling_stage(radial_clearance=20e-6),
                operation=replace(machine.operation, torque=0.0),
            )
        ).linearized()


def test_a_housing_gives_way_under_the_bearings():
    stiffness = 2e8
    housing = Housing(np.eye(3), stiffness * np.eye(3), nodes={"seat": [0, 1, 2, -1, -1, -1]})
    rigid = spur_stage()
    bearings = dict(rigid.bearings)
    bearings["in 0.0"] = replace(bearings["in 0.0"], node="seat")
    balance = static_balance(replace(rigid, bearings=bearings, housing=housing))
    load = balance.bearings["in 0.0"].load
    assert load == pytest.approx(static_balance(rigid).bearings["in 0.0"].load, rel=1e-8)
    assert balance.housing == pytest.approx(load[:3] / stiffness, rel=1e-9)


def test_slices_tilt_the_shafts_back_and_give_the_face_load_factor():
    """Slices: k delta, and k b^2/12 of the slope, while the full face carries."""
    width = 0.03
    machine = spur_stage(stiffness=4e8)
    free = static_balance(machine).meshes["first"]
    bound = static_balance(machine, laws=face_laws(machine)).meshes["first"]
    assert free.face_load_factor is None
    assert bound.force == pytest.approx(free.force, rel=1e-9)
    assert bound.moment == pytest.approx(3e8 * width / 12.0 * bound.misalignment, rel=1e-9)
    assert 0.3 < bound.misalignment / free.misalignment < 0.98
    factor = 1.0 + 3e8 * abs(bound.misalignment) / (2.0 * bound.force)
    assert bound.face_load_factor == pytest.approx(factor, rel=1e-9)


def test_a_mesh_without_load_has_no_distribution_of_it():
    stage = spur_stage()
    idle = replace(
        stage,
        shafts={**stage.shafts, "idle": sections((0.2, 0.04, 0.0))},
        gears={
            **stage.gears,
            "z3": Gear("out", 0.14, 30, 0.03),
            "z4": Gear("idle", 0.14, 25, 0.03),
        },
        meshes={**stage.meshes, "second": Mesh(("z3", "z4"), 3e-3, stiffness=3e8)},
        bearings={
            **stage.bearings,
            **{
                f"idle {end}": Bearing("idle", end, radial_stiffness=1e9, axial_stiffness=1e9)
                for end in (0.0, 0.2)
            },
        },
    )
    balance = static_balance(idle, laws=face_laws(idle))
    assert abs(balance.meshes["second"].force) < 1e-6
    assert balance.meshes["second"].face_load_factor is None
    assert 1.0 < balance.meshes["first"].face_load_factor < 2.0


@pytest.mark.parametrize("helix", [10e-6, 40e-6])
def test_face_load_factor_of_a_linear_gap(helix):
    """1 + F k/(2 N) while the full face carries, sqrt(2 F k/N) beyond (thin slices)."""
    stiffness, width, force = 4e8, 0.02, 3000.0
    law = FaceLaw(stiffness, width, gap=helix * np.linspace(0.0, 1.0, 81))
    low, high = 0.0, 1e-4
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if law(middle, 0.0)[0] > force else (middle, high)
    share = helix * stiffness / force
    expected = 1.0 + share / 2.0 if share < 2.0 else math.sqrt(2.0 * share)
    assert law.face_load_factor(low, 0.0) == pytest.approx(expected, rel=2e-3)
    step = 1e-9
    for k, change in enumerate(([step, 0.0], [0.0, step / width])):
        upper = law(low + change[0], change[1])
        lower = law(low - change[0], -change[1])
        slopes = (np.array(upper[:2]) - lower[:2]) / (2 * max(change))
        assert law(low, 0.0)[2][:, k] == pytest.approx(slopes, rel=0.02, abs=1e-5)


def test_unrestrained_coordinates_are_named():
    roller = CylindricalRollerBearing(bore_diameter=0.055, outer_diameter=0.1, width=0.021)
    machine = rolling_stage()
    loose = {**machine.bearings, "A": Bearing("in", 0.02, rolling=roller)}
    with pytest.raises(InputError, match=r"shafts\.in: no bearing holds the shaft along its axis"):
        replace(machine, bearings=loose)
    only_rollers = replace(
        spur_stage(),
        bearings={
            n: replace(loose["A"], shaft=n[:-4], position=float(n[-3:]))
            for n in spur_stage().bearings
        },
    )
    assert abs(static_balance(only_rollers).gears["z1"][0]) < 1e-9  # free along x, and unloaded
    loads = {"z1": [50.0, 0.0, 0.0, 0.0, 0.0, 0.0]}
    with pytest.raises(ComputationError, match=r"shafts\.in: nothing balances the load on x"):
        static_balance(only_rollers, loads=loads)
    both = {
        way: {
            n: replace(b, rolling=replace(b.rolling, direction=way)) if n in "CD" else b
            for n, b in machine.bearings.items()
        }
        for way in (1, -1)
    }
    with pytest.raises(InputError, match=r"shafts\.out: its bearings hold .* along -x only"):
        replace(machine, bearings=both[-1])
    loads = {"z2": [-8000.0, 0.0, 0.0, 0.0, 0.0, 0.0]}
    with pytest.raises(ComputationError, match=r"bearings\.[CD]\.direction.* along \+x only"):
        static_balance(replace(machine, bearings=both[1]), loads=loads)
    with pytest.raises(InputError, match='no gear "z9"'):
        static_balance(machine, loads={"z9": np.zeros(6)})
    with pytest.raises(InputError, match=r"shape \(5,\)"):
        static_balance(machine, loads={"z1": np.zeros(5)})


@pytest.mark.processor
@pytest.mark.parametrize("clearance", [0.0, 20e-6])
@pytest.mark.parametrize("torque", [0.0, 1e-9])
def test_forces_of_rounding_are_no_findings(torque, clearance):
    """Without a load all forces are rounding, of either sign."""
    machine = rolling_stage(radial_clearance=clearance) if clearance else rolling_stage()
    for idle in (machine, spur_stage(stiffness=4e8), helical_stage()):
        balance = static_balance(replace(idle, operation=replace(idle.operation, torque=torque)))
        assert all(abs(mesh.force) < 1e-6 for mesh in balance.meshes.values())


def test_a_balance_that_is_kept_is_that_of_its_own_loads_and_laws(monkeypatch):
    machine = helical_stage()
    faster = replace(machine, operation=replace(machine.operation, speed=500.0))
    crowned = FaceLaw(5.2e8, 0.05, 1e-5 * np.linspace(-1.0, 1.0, 81) ** 2)
    rolling = {n: replace(b, axial_stiffness=3e8) for n, b in machine.bearings.items()}
    stages = [
        (machine, {}), (faster, {}), (helical_stage(torque=500.0), {}),
        (machine, {"first": FaceLaw(5.2e8, 0.05)}), (machine, {"first": crowned}),
        (helical_stage(rolling), {}),
    ]  # fmt: skip
    kept = [static_balance(each, laws=laws) for each, laws in stages]
    moved = [balance.gears["z1"].tolist() for balance in kept]
    assert moved[1] == moved[0]
    assert kept[1].machine is faster
    assert len({*map(tuple, moved)}) == len(moved) - 1
    for (each, laws), before in zip(stages, moved, strict=True):
        monkeypatch.setattr("tribodyn.machine.static.balance._solved", Memo(1))
        assert static_balance(each, laws=laws).gears["z1"].tolist() == before
