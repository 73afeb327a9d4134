"""Matrices, reduction and natural modes of machines."""

from dataclasses import replace

import numpy as np
import pytest
from machines import DEGREE, RPM, split_path, two_stage_parts, two_stages
from scipy.linalg import eigh

from tribodyn.arrays.memory import Memo
from tribodyn.dynamics import natural_modes, spur6
from tribodyn.errors import InputError
from tribodyn.machine import (
    Bearing,
    DeepGrooveBallBearing,
    Gear,
    Housing,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Section,
    Shaft,
    machine_modes,
    machine_structure,
    reduce_structure,
    static_balance,
    system,
)
from tribodyn.machine.modes import machine_frequencies

#: Geared shafts at rest [Hz].
PRINTED = [414.96, 644.20, 693.93, 696.12, 795.98, 868.51, 1390.77, 1411.23, 2376.6, 2478.6, 3047.7]


def sections(*sizes):
    return Shaft([Section(*(1e-3 * size for size in section)) for section in sizes])


def geared_shafts(**changes):
    """Two shafts joined by one helical mesh."""
    parts = {
        "shafts": {
            "input": sections((120, 55), (50, 70), (130, 55)),
            "output": sections((125, 75, 20), (50, 90, 20), (125, 75, 20)),
        },
        "gears": {
            "z1": Gear("input", 0.145, 27, 0.050, 4.0, 0.006, 0.004),
            "z2": Gear("output", 0.150, 51, 0.050, 18.0, 0.140, 0.075),
        },
        "meshes": {
            "first": Mesh(("z1", "z2"), 4.5e-3, 21 * DEGREE, "left", 0.190, 30 * DEGREE,
                          stiffness=5.2e8),
        },
        "bearings": {
            "A": Bearing("input", 0.020, 4e8, 2e8), "B": Bearing("input", 0.280, 4e8),
            "C": Bearing("output", 0.020, 5e8, 2e8), "D": Bearing("output", 0.280, 5e8),
        },
        "operation": Operation("input", "output", 3000 * RPM, 600.0),
    }  # fmt: skip
    return Machine(**{**parts, **changes})


@pytest.fixture(scope="module")
def full():
    return MachineStructure(geared_shafts())


@pytest.fixture(scope="module")
def reduced(full):
    return reduce_structure(full, 5000.0)


def test_natural_frequencies_of_geared_shafts(reduced):
    at_rest = machine_modes(reduced, 0.0).frequency
    np.testing.assert_allclose(at_rest[:11], PRINTED, rtol=6e-4)
    turning = machine_modes(reduced).frequency
    np.testing.assert_allclose(turning[6:8], [1380.73, 1421.45], rtol=4e-4)
    np.testing.assert_allclose(
        np.delete(turning[:11], [6, 7]), PRINTED[:6] + PRINTED[8:], rtol=9e-4
    )


def test_frequencies_over_the_speed_are_those_of_the_modes(reduced):
    speeds = np.array([0.0, 0.4, 2.0]) * reduced.machine.operation.speed
    frequencies = machine_frequencies(reduced, speeds)
    for speed, frequency in zip(speeds, frequencies, strict=True):
        expected = machine_modes(reduced, float(speed)).frequency
        np.testing.assert_allclose(frequency, expected, rtol=1e-12)
    assert not np.array_equal(frequencies[0], frequencies[2])


def test_natural_frequencies_of_the_full_model(full):
    np.testing.assert_allclose(machine_modes(full, 0.0).frequency[:11], PRINTED, rtol=2e-4)
    np.testing.assert_allclose(machine_modes(full).frequency[6:8], [1380.73, 1421.45], rtol=5e-5)


def test_the_other_hand_has_other_frequencies():
    """The sign of the axial force matters: a wrong one is seen."""
    mesh = Mesh(("z1", "z2"), 4.5e-3, 21 * DEGREE, "right", 0.190, 30 * DEGREE, stiffness=5.2e8)
    other = machine_modes(geared_shafts(meshes={"first": mesh}), 0.0).frequency
    assert np.abs(other[:11] / PRINTED - 1.0).max() > 1e-3


def test_shares_of_the_strain_energy(reduced):
    modes = machine_modes(reduced)
    np.testing.assert_allclose(modes.strain_share.sum(axis=1), 1.0, rtol=1e-9)
    kinds = modes.share_by_kind()
    np.testing.assert_allclose(sum(kinds.values()), 1.0, rtol=1e-9)
    assert min(share.min() for share in kinds.values()) > -1e-9
    # the lowest is the axial motion of the output on bearing C, by hand 2e8 N/m on its mass
    output = modes.structure.shafts["output"]
    mass = 18.0 + output.mass[::6, ::6].sum()
    assert modes.frequency[0] == pytest.approx(np.sqrt(2e8 / mass) / (2 * np.pi), rel=0.02)
    assert modes.strain_share[0, modes.parts.index("bearings.C")] > 0.95


def test_modes_of_shafts_are_those_of_another_bearing_stiffness(full, reduced, monkeypatch):
    def refused(*_):
        raise AssertionError("computed again")

    bearings = full.machine.bearings
    soft = {n: replace(b, radial_stiffness=0.5 * b.radial_stiffness) for n, b in bearings.items()}
    other = MachineStructure(full.machine._with(bearings=soft))
    expected = np.sqrt(eigh(other.stiffness, other.mass, eigvals_only=True)[6:20])
    monkeypatch.setattr("tribodyn.machine.reduction._fixed_modes", refused)
    few = reduce_structure(other, 5000.0)
    got = np.sqrt(eigh(few.stiffness, few.mass, eigvals_only=True)[6:20])
    np.testing.assert_allclose(got, expected, rtol=1e-3)


def test_reductions_do_not_depend_on_those_before(full, monkeypatch):
    limits = (4000.0, 6000.0, 5000.0)
    kept = [reduce_structure(full, limit) for limit in limits]
    for limit, before in zip(limits, kept, strict=True):
        for name in ("_bases", "_natural", "_modes_of_shafts"):
            monkeypatch.setattr(f"tribodyn.machine.reduction.{name}", Memo(1))
        alone = reduce_structure(full, limit)
        assert alone.names == before.names
        assert alone.reduction.error == before.reduction.error
        np.testing.assert_array_equal(alone.basis, before.basis)


def test_reduction_against_the_full_model(full, reduced):
    limit = reduced.reduction.limit
    frequencies = []
    for structure in (full, reduced):
        direction = structure.mesh("first")
        stiffness = structure.stiffness + 5.2e8 * np.outer(direction, direction)
        squares = eigh(stiffness, structure.mass, eigvals_only=True)
        frequencies.append(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi))
    below = int(np.count_nonzero(frequencies[0] < limit))
    difference = np.abs(frequencies[1][1:below] / frequencies[0][1:below] - 1.0)
    assert below > 15
    assert reduced.size < 80
    assert difference.max() <= 4e-4
    assert reduced.reduction.error == pytest.approx(difference.max(), rel=1e-3)
    # gyroscopic moments and damping ratios too
    speed = 9000 * RPM
    modes = [machine_modes(structure, speed) for structure in (full, reduced)]
    np.testing.assert_allclose(
        modes[1].frequency[: below - 1], modes[0].frequency[: below - 1], rtol=1e-3
    )
    np.testing.assert_allclose(modes[1].damping_ratio[:10], modes[0].damping_ratio[:10], rtol=1e-2)


def test_a_finer_tolerance_keeps_more_modes(full, reduced):
    fine = reduce_structure(full, 5000.0, tolerance=1e-6)
    assert fine.reduction.error <= 1e-6
    assert fine.size > reduced.size
    with pytest.raises(InputError, match="reduced already"):
        reduce_structure(fine)
    for limit in (0.0, -5000.0):
        with pytest.raises(InputError, match="limit"):
            reduce_structure(full, limit)


def test_statics_of_the_reduced_machine_are_exact(full, reduced):
    """Constraint modes: deflections under mesh and torque are those of the full model."""
    deflections = []
    for structure in (full, reduced):
        direction, load = structure.mesh("first"), structure.force
        stiffness = structure.stiffness + 5.2e8 * np.outer(direction, direction)
        bordered = np.block([[stiffness, structure.balance[:, None]], [structure.balance, 0.0]])
        moved = np.linalg.solve(bordered, np.append(load, 0.0))
        assert abs(moved[-1]) < 1e-6  # the torques balance already
        deflections.append([structure.gear(gear) @ moved[:-1] for gear in ("z1", "z2")])
    np.testing.assert_allclose(deflections[1], deflections[0], rtol=1e-6, atol=1e-12)


def test_large_machines_are_reduced():
    structure = machine_structure(geared_shafts())
    assert structure.reduction.error <= 4e-4
    assert structure.reduction.limit == pytest.approx(6 * 27 * 50.0)
    assert repr(structure).startswith("MachineStructure(")
    assert "Reduction(276 to" in repr(structure)


def test_matrices_are_symmetric_and_skew(full):
    for matrix, sign in ((full.mass, 1), (full.stiffness, 1), (full.damping, 1),
                         (full.gyroscopic(), -1)):  # fmt: skip
        np.testing.assert_allclose(matrix, sign * matrix.T, atol=1e-9 * np.abs(matrix).max())
    np.testing.assert_allclose(sum(full.elements.values()), full.stiffness)
    axes = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
    assert full.names[:6] == tuple(f"input@0mm_{axis}" for axis in axes)
    assert "input@145mm_theta_z" in full.names
    axial = np.array([name.endswith("mm_x") for name in full.names], dtype=float)
    shafts = sum(shaft.mass[::6, ::6].sum() for shaft in full.shafts.values())
    assert axial @ full.mass @ axial == pytest.approx(22.0 + shafts)


@pytest.mark.parametrize(("shaft", "ratio", "polar"), [("input", 1.0, 0.006),
                                                        ("output", -27 / 51, 0.140)])  # fmt: skip
def test_angular_momentum_turns_with_the_axis_of_each_shaft(full, shaft, ratio, polar):
    """A shaft that tilts as a rigid body, about its beginning."""
    matrices, speed = full.shafts[shaft], 100.0
    names = [f"{shaft}@{1e3 * node:.6g}mm" for node in matrices.nodes]
    tilts = []
    for axis, across, sign in (("theta_y", "z", -1.0), ("theta_z", "y", 1.0)):
        motion = dict.fromkeys(full.names, 0.0)
        motion |= {f"{name}_{axis}": 1.0 for name in names}
        motion |= {f"{name}_{across}": sign * x
                   for name, x in zip(names, matrices.nodes, strict=True)}  # fmt: skip
        tilts.append(np.array([motion[name] for name in full.names]))
    total = polar + matrices.mass[3::6, 3::6].sum()
    assert tilts[0] @ full.gyroscopic(speed) @ tilts[1] == pytest.approx(total * ratio * speed)


def test_modal_damping(full):
    """Every mode of the structure without its meshes has the ratio."""
    squares, shapes = eigh(full.stiffness, full.mass)
    elastic = squares > 1e-9 * squares.max()
    modal = np.diag(shapes.T @ full.damping @ shapes)
    np.testing.assert_allclose(
        modal[elastic], 2.0 * 0.02 * np.sqrt(squares[elastic]), rtol=1e-6
    )  # fmt: skip
    np.testing.assert_allclose(modal[~elastic], 0.0, atol=1e-6 * modal.max())
    bare = MachineStructure(full.machine, damping_ratio=0.0)
    assert not bare.damping.any()
    damper = Bearing("input", 0.02, 4e8, 2e8, radial_damping=(300.0, 500.0))
    damped = geared_shafts(bearings={**full.machine.bearings, "A": damper})
    structure = MachineStructure(damped, damping_ratio=0.0)
    motion = structure.bearing("A")
    np.testing.assert_allclose(
        structure.damping, motion.T @ np.diag([0, 300.0, 500.0, 0, 0, 0]) @ motion
    )


def rigid_pair(**mesh):
    return Machine(
        shafts={"input": Shaft(), "output": Shaft()},
        gears={"a": Gear("input", 0.0, 16, 0.02, 0.7, 4e-4, 3e-4),
               "b": Gear("output", 0.0, 24, 0.02, 1.1, 1.2e-3, 9e-4)},
        meshes={"mesh": Mesh(("a", "b"), 4.5e-3, **{"stiffness": 3e8, **mesh})},
        bearings={"A": Bearing("input", 0.0, 2e8), "B": Bearing("output", 0.0, 3e8)},
        operation=Operation("input", "output", 100.0, 90.0),
    )  # fmt: skip


class ConstantMesh:
    """A spur pair with a constant stiffness for the builder of pairs."""

    event_phases = (0.0,)

    @staticmethod
    def stiffness(phase):
        return np.full(np.shape(phase), 3e8)

    @staticmethod
    def friction_sum(phase):
        return np.zeros(np.shape(phase))

    friction_moment_pinion = friction_moment_wheel = friction_sum


def test_a_rigid_spur_pair_is_the_pair_of_six_coordinates():
    machine = rigid_pair(damping_ratio=0.05)
    structure = machine_structure(machine)
    assert structure.names == tuple(
        f"{shaft}_{axis}" for shaft in ("input", "output") for axis in ("y", "z", "theta_x")
    )
    radii = machine.directions["mesh"].base_radius
    pair = spur6(
        ConstantMesh, mass=(0.7, 1.1), moment_of_inertia=(4e-4, 1.2e-3), base_radius=radii,
        torque=(90.0, 135.0), bearing_stiffness=(2e8, 3e8),
    )  # fmt: skip
    expected = natural_modes(pair).frequency
    motion = system(structure)
    modes = natural_modes(motion)
    np.testing.assert_allclose(modes.frequency[1:], expected[1:], rtol=1e-9)
    np.testing.assert_allclose(motion.force[[2, 5]], [90.0, 135.0])
    assert motion.gyroscopic is None  # nothing tilts
    # damping ratio of the gears that turn on fixed axes
    reduced_mass = 1.0 / (radii[0] ** 2 / 4e-4 + radii[1] ** 2 / 1.2e-3)
    contact = motion.contacts[0]
    assert contact.damping == pytest.approx(2 * 0.05 * np.sqrt(3e8 * reduced_mass))


def test_motions_of_a_rigid_shaft():
    def names(*bearings):
        machine = rigid_pair()
        supports = {str(number): bearing for number, bearing in enumerate(bearings)}
        parts = (machine.shafts, machine.gears, machine.meshes, supports)
        structure = MachineStructure(Machine(*parts, operation=machine.operation))
        return [name.removeprefix("input_") for name in structure.names[:-1]]

    assert names() == ["theta_x"]
    assert names(Bearing("input", 0.0, axial_stiffness=1e8)) == ["x", "theta_x"]
    # one bearing beside the gear holds the shaft, but not against tilting
    assert names(Bearing("input", 0.03, 1e8)) == ["y", "z", "theta_x"]
    two = Bearing("input", 0.03, 1e8), Bearing("input", -0.03, 1e8)
    assert names(*two) == ["y", "z", "theta_x", "theta_y", "theta_z"]


def test_contacts_follow_the_clock_and_the_torques_balance():
    meshes = two_stage_parts()["meshes"]
    meshed = {
        "first": Mesh(meshes["first"].gears, 4.5e-3, 21 * DEGREE, "right", 0.190, 30 * DEGREE,
                      stiffness=lambda x: 4e8 * (1.0 + 0.1 * np.cos(2 * np.pi * x)),
                      error=1e-6, gap=4e-5),
        "second": Mesh(meshes["second"].gears, 6.5e-3, 10 * DEGREE, "left", 0.190, -20 * DEGREE,
                       stiffness=5e8, damping=2600.0, offset=0.31, events=(0.0, 0.4)),
    }  # fmt: skip
    machine = two_stages(meshes=meshed)
    motion = system(machine)
    first, second = motion.contacts
    assert [first.cycles, second.cycles, second.offset] == [51, 23, 0.31]
    assert (first.error, first.gap, second.damping, second.events) == (1e-6, 4e-5, 2600.0, (0, 0.4))
    structure = machine_structure(machine)
    ratios = {name: float(load.ratio) for name, load in machine.kinematics.shafts.items()}
    # rotation of the whole drive: no mesh is compressed and the torques do no work
    rotation = np.array([
        ratios[name.partition("@")[0]] if name.endswith("theta_x") else 0.0
        for name in structure.names
    ])  # fmt: skip
    for name in machine.meshes:
        assert abs(structure.mesh(name) @ rotation) < 1e-9
    assert abs(structure.force @ rotation) < 1e-6
    assert np.abs(structure.stiffness @ rotation).max() < 1e-3


def test_a_mesh_without_stiffness_is_named():
    with pytest.raises(InputError, match=r"meshes\.mesh\.stiffness: the mesh has no stiffness"):
        machine_modes(rigid_pair(stiffness=None))


def test_a_rolling_bearing_needs_its_load():
    machine = geared_shafts()
    ball = DeepGrooveBallBearing(bore_diameter=0.055, outer_diameter=0.1, width=0.021)
    bearings = {**machine.bearings, "A": Bearing("input", 0.02, rolling=ball)}
    machine = geared_shafts(bearings=bearings)
    with pytest.raises(InputError, match=r"bearings\.A\.rolling.*depends on its load"):
        MachineStructure(machine)
    # the structure of a machine takes the stiffness at the working load
    balance = static_balance(machine)
    structure = machine_structure(machine)
    motion = structure.bearing("A")
    np.testing.assert_allclose(
        structure.elements["bearings.A"],
        motion.T @ balance.bearings["A"].stiffness @ motion,
        atol=1e-6 * np.abs(structure.stiffness).max(),
    )


def test_loops_of_meshes():
    """Four shafts and two power paths: one free rotation."""
    modes = machine_modes(split_path())
    assert len(modes.frequency) == 3
    np.testing.assert_allclose(modes.share_by_kind()["meshes"], 1.0)


def test_friction_acts_on_both_gears():
    class Friction:
        friction_sum = staticmethod(lambda x: 0.1 + 0.0 * x)
        friction_moment_pinion = staticmethod(lambda x: 2e-3 + 0.0 * x)
        friction_moment_wheel = staticmethod(lambda x: 1e-3 + 0.0 * x)

    machine = rigid_pair(friction=Friction)
    structure, motion = machine_structure(machine), system(machine)
    phase = np.linspace(0.0, 0.9, 5)
    expected = machine.directions["mesh"].friction(0.1, 2e-3, 1e-3)
    gears = np.vstack([structure.gear(gear) for gear in ("a", "b")])
    np.testing.assert_allclose(
        motion.contacts[0].friction(phase), np.tile(expected @ gears, (5, 1))
    )


def frame(stiffness=1e9):
    """A housing of two seats that move along y and z."""
    nodes = {"seat A": [-1, 0, 1, -1, -1, -1], "seat B": [-1, 2, 3, -1, -1, -1]}
    springs = stiffness * (np.eye(4) + np.array([[1, 0, -1, 0], [0, 1, 0, -1],
                                                 [-1, 0, 1, 0], [0, -1, 0, 1]]))  # fmt: skip
    return Housing(8.0 * np.eye(4), springs, nodes=nodes)


def on_housing(housing):
    bearings = {
        "A": Bearing("input", 0.0, 2e8, node="seat A"),
        "B": Bearing("output", 0.0, 3e8, node="seat B"),
    }
    machine = rigid_pair()
    return Machine(
        machine.shafts, machine.gears, machine.meshes, bearings, housing,
        operation=machine.operation,
    )  # fmt: skip


def test_bearings_on_a_housing():
    structure = machine_structure(on_housing(frame()))
    assert structure.names[-4:] == (
        "housing_seat A_y", "housing_seat A_z", "housing_seat B_y", "housing_seat B_z",
    )  # fmt: skip
    names = list(structure.names)
    y, seat = names.index("input_y"), names.index("housing_seat A_y")
    assert structure.stiffness[y, y] == 2e8
    assert structure.stiffness[y, seat] == -2e8
    assert structure.stiffness[seat, seat] == pytest.approx(2e9 + 2e8)
    modes = machine_modes(structure)
    np.testing.assert_allclose(sum(modes.share_by_kind().values()), 1.0)
    assert modes.share_by_kind()["housing"].max() > 0.5
    # a very stiff housing is a rigid wall
    stiff = machine_modes(on_housing(frame(1e14))).frequency[:5]
    np.testing.assert_allclose(stiff, machine_modes(rigid_pair()).frequency, rtol=1e-4)


def test_a_reduced_machine_on_a_housing():
    bearings = {
        name: Bearing(b.shaft, b.position, b.radial_stiffness, b.axial_stiffness, node=node)
        for (name, b), node in zip(
            geared_shafts().bearings.items(), ("seat A", "seat A", "seat B", "seat B"), strict=True
        )
    }
    full = MachineStructure(geared_shafts(bearings=bearings, housing=frame()))
    small = reduce_structure(full, 3000.0)
    modes = [machine_modes(structure) for structure in (full, small)]
    np.testing.assert_allclose(modes[1].frequency[:12], modes[0].frequency[:12], rtol=1e-3)
    np.testing.assert_allclose(
        modes[1].share_by_kind()["housing"][:6], modes[0].share_by_kind()["housing"][:6], atol=1e-3
    )


def test_a_singular_housing_is_named():
    free = 1e9 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    nodes = {"left": [0, -1, -1, -1, -1, -1], "right": [1, -1, -1, -1, -1, -1]}
    with pytest.raises(
        InputError, match=r"Housing\.stiffness.*singular.*housing_left_x.*no strain"
    ):
        Housing(np.eye(2), free, nodes=nodes)
    with pytest.raises(InputError, match=r"Housing\.mass.*housing_1 has no kinetic energy"):
        Housing(np.diag([1.0, 0.0]), np.eye(2))


def test_a_rigid_shaft_without_inertia_is_named():
    machine = rigid_pair()
    gears = {**machine.gears, "a": Gear("input", 0.0, 16, 0.02, 0.0, 0.0, 0.0)}
    light = Machine(
        machine.shafts, gears, machine.meshes, machine.bearings, operation=machine.operation
    )
    with pytest.raises(InputError, match=r"shafts\.input: input_y has no inertia.*gears alone"):
        system(light)


def test_a_slender_shaft_has_sixty_elements():
    machine = geared_shafts(shafts={"input": sections((300, 6)), "output": sections((300, 60))})
    structure = MachineStructure(machine)
    assert len(structure.shafts["input"].nodes) - 1 in range(60, 64)
    assert len(structure.shafts["output"].nodes) - 1 in range(20, 24)


def test_fixed_modes_below_the_limit_are_never_left_out():
    """A fast mesh has its limit above many modes of the parts between the gears."""
    slim = {"input": sections((300, 20)), "output": sections((300, 24))}
    machine = geared_shafts(shafts=slim, operation=Operation("input", "output", 1400.0, 5.0))
    structure = machine_structure(machine)
    assert structure.reduction.limit == pytest.approx(6 * 27 * 1400.0 / (2.0 * np.pi))
    assert structure.reduction.error <= 4e-4
    assert structure.size < 0.4 * structure.basis.shape[0]
    # rotation of the drive, whose frequency is rounding, is not taken for an error
    assert reduce_structure(MachineStructure(machine), 300.0).reduction.error <= 4e-4
