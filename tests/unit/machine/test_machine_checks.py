"""Machines that cannot be built: every message names the part, the value and the remedy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from machines import DEGREE, pair, split_path, two_stage_parts, two_stages

from tribodyn.errors import InputError
from tribodyn.machine import (
    Bearing,
    Coupling,
    DeepGrooveBallBearing,
    Gear,
    Housing,
    Machine,
    Mesh,
    Operation,
    Section,
    Shaft,
    TaperedRollerBearing,
    machine_structure,
    static_balance,
)
from tribodyn.machine.bearing import held_by

Parts = dict[str, Any]


def broken(change: Callable[[Parts], Any], machine: Machine | None = None) -> str:
    """Message of a machine with a change of its parts."""
    parts = two_stage_parts()
    if machine is not None:
        parts = {key: getattr(machine, key) for key in parts}
    parts = {key: dict(value) if key != "operation" else value for key, value in parts.items()}
    change(parts)
    with pytest.raises(InputError) as error:
        Machine(**parts)
    return str(error.value)


def put(group: str, name: str, **values: Any) -> Callable[[Parts], Any]:
    """Change of fields of one part."""

    def change(parts: Parts) -> None:
        parts[group][name] = replace(parts[group][name], **values)

    return change


def test_names_of_parts_that_do_not_exist_are_all_listed() -> None:
    def change(parts: Parts) -> None:
        put("gears", "z1", shaft="inputt")(parts)
        put("bearings", "input left", shaft="center", node="seat")(parts)
        put("meshes", "first", gears=("z1", "z9"))(parts)
        parts["operation"] = replace(parts["operation"], output="exit")

    message = broken(change)
    assert 'gears.z1.shaft: there is no shaft "inputt"' in message
    assert 'Did you mean "input"?' in message
    assert 'bearings.input left.shaft: there is no shaft "center"' in message
    assert (
        'bearings.input left.node: there is no node of the housing "seat". Known: none' in message
    )
    assert 'meshes.first.gears: there is no gear "z9". Known: z1, z2, z3, z4' in message
    assert 'operation.output: there is no shaft "exit"' in message


def test_contradicting_ratios_name_the_meshes_and_both_speeds() -> None:
    message = broken(put("gears", "lower wheel", teeth=41), split_path())
    assert message.startswith("meshes.l2.gears: ")
    assert '"output" turns at 238.732 rpm by meshes u1 and u2, and at 232.91 rpm' in message
    assert "by meshes l1 and l2" in message
    assert "lower pinion has 20, bull has 40" in message


def test_contradicting_ratios_at_rest_are_those_to_the_input() -> None:
    def change(parts: Parts) -> None:
        put("gears", "lower wheel", teeth=41)(parts)
        parts["operation"] = replace(parts["operation"], speed=0.0)

    assert "turns at 0.25 times the input by meshes u1 and u2" in broken(change, split_path())


def test_axes_of_an_open_loop_state_what_closes_them() -> None:
    message = broken(put("meshes", "l2", center_distance=0.1205), split_path())
    assert "meshes.l2.center_distance: center_distance = 120.5 mm and angle = 60 deg" in message
    assert '"output" 0.5 mm from where meshes u1, l1 and u2 put it' in message
    assert "Give center_distance 120 mm and angle 60 deg" in message


def test_faces_of_a_loop_that_are_not_in_one_plane() -> None:
    message = broken(put("gears", "lower pinion", position=0.110), split_path())
    assert "gears.bull.position: gear bull lies 10 mm along x from gear lower pinion" in message
    assert "overlap by 20 mm of 30 mm" in message
    assert "do not overlap" in broken(put("gears", "lower pinion", position=0.2), split_path())


def test_shafts_that_nothing_drives_and_outputs_that_nothing_reaches() -> None:
    message = broken(lambda parts: parts["meshes"].pop("second"))
    assert 'operation.output: no mesh joins the output "output" to the input "input"' in message
    assert "shafts.output: nothing drives this shaft. The meshes join the input" in message
    spare = Shaft([Section(0.1, 0.02)])
    message = broken(lambda parts: parts["shafts"].update(spare=spare))
    assert message.startswith("shafts.spare: nothing drives this shaft")


@pytest.mark.parametrize("keep", [True, False])
def test_the_input_is_no_output(keep: bool) -> None:
    def change(parts: Parts) -> None:
        parts["operation"] = replace(parts["operation"], output="input")
        if not keep:
            parts["shafts"] = {"input": parts["shafts"]["input"]}
            parts["gears"], parts["meshes"], parts["bearings"] = {}, {}, {}

    assert 'operation.output: output = "input" is the input too' in broken(change)


@pytest.mark.parametrize(
    ("distance", "reason"),
    [
        (0.150, "base circles of z1 and z2 need more than 175.146 mm"),
        (0.198, "gears z1 and z2 do not reach each other"),
        (-0.190, "Only internal gears have a negative centre distance"),
    ],
)
def test_centre_distances_at_which_no_teeth_engage(distance: float, reason: str) -> None:
    message = broken(put("meshes", "first", center_distance=distance))
    assert f"meshes.first.center_distance: center_distance = {distance * 1e3:g} mm" in message
    assert reason in message
    assert "Without profile shift it is 187.986 mm" in message


def test_centre_distances_of_a_ring() -> None:
    assert pair((21, -72), center_distance=0.052).directions["mesh"].working_radius[1] < 0.0
    for distance in (0.04, 0.0555):
        with pytest.raises(InputError, match=r"meshes\.mesh\.center_distance"):
            pair((21, -72), center_distance=distance)


@pytest.mark.parametrize("teeth", [(-30, -60), (60, -30), (40, -40)])
def test_gears_that_cannot_mesh(teeth: tuple[int, int]) -> None:
    with pytest.raises(InputError, match=rf"meshes.mesh.gears: .* a {teeth[0]} and b {teeth[1]}"):
        pair(teeth)


def test_gears_of_one_mesh_are_on_two_shafts() -> None:
    message = broken(put("gears", "z2", shaft="input", position=0.2))
    assert 'meshes.first.gears: both gears are on shaft "input"' in message


def test_two_gears_have_one_mesh() -> None:
    message = broken(lambda p: p["meshes"].update(again=Mesh(("z2", "z1"), 4.5e-3)))
    assert "meshes.again.gears: mesh first has the same gears" in message


def test_teeth_of_a_gear_in_two_meshes_are_cut_once() -> None:
    def idler(**mesh: Any) -> Callable[[Parts], Any]:
        rack = {"normal_module": 4.5e-3, "helix_angle": 21 * DEGREE, "hand": "left", **mesh}

        def change(parts: Parts) -> None:
            parts["shafts"]["end"] = Shaft()
            parts["gears"]["z5"] = Gear("end", 0.0, 40, 0.05)
            parts["meshes"]["third"] = Mesh(("z2", "z5"), **rack)

        return change

    for change, key, text in (
        (idler(normal_module=4e-3), "normal_module", "4 mm, and mesh first has 4.5 mm"),
        (idler(helix_angle=0.2), "helix_angle", "11.4592 deg, and mesh first has 21 deg"),
        (idler(hand="right"), "hand", '"right" makes gear z2 a right-hand gear'),
    ):
        message = broken(change)
        assert message.startswith(f"meshes.third.{key}: {key} = {text}")
    parts = two_stage_parts()
    idler()(parts)
    assert Machine(**parts).kinematics.meshes["third"].force == 0.0


def test_parts_outside_their_shaft_or_in_one_place_are_refused() -> None:
    message = broken(put("bearings", "middle right", position=0.350))
    assert message.startswith("bearings.middle right.position: position = 350 mm is off the shaft")
    assert 'Shaft "middle" reaches from 0 to 300 mm' in message
    assert "gears.z1.position: position = -1 mm" in broken(put("gears", "z1", position=-0.001))
    message = broken(put("gears", "z3", position=0.14))
    assert "gears.z3.position: position = 140 mm: gears z2 and z3 are in one place" in message
    assert "overlap by 22 mm" in message
    assert "at least 62 mm apart" in message
    assert "gears.z3.position: the position is missing" in broken(put("gears", "z3", position=None))


def test_shafts_that_nothing_holds() -> None:
    def remove(*names: str) -> Callable[[Parts], Any]:
        return lambda parts: [parts["bearings"].pop(f"input {name}") for name in names]

    assert broken(remove("left", "right")).startswith("shafts.input: the shaft has no bearing")
    message = broken(remove("right"))
    assert "shafts.input: its bearings, at 20 mm, do not hold the shaft" in message
    message = broken(put("bearings", "input left", axial_stiffness=0.0))
    assert message.startswith("shafts.input: no bearing holds the shaft along its axis")
    assert "push it with 2689.97 N" in message
    only_y = put("bearings", "input left", radial_stiffness=(4e8, 0.0))
    assert "shafts.input: its bearings" in broken(only_y)
    # tapered rollers of one direction: the meshes push with 2689.97 N, and radial loads likewise
    taper = {"bore_diameter": 0.03, "outer_diameter": 0.062, "width": 0.018, "contact_angle": 0.25}
    force = float(Machine(**two_stage_parts()).gear_loads["z1"][0])
    for ways, held in (((1, 1), force > 0.0), ((-1, -1), force < 0.0), ((1, -1), True)):
        parts = two_stage_parts()
        for name, way in zip(("left", "right"), ways, strict=True):
            rolling = TaperedRollerBearing(**taper, direction=way)
            bearing = parts["bearings"][f"input {name}"]
            place = Bearing("input", bearing.position, rolling=rolling)
            parts["bearings"][f"input {name}"] = place
        if held:
            assert len(Machine(**parts).bearings) == 6
        else:
            with pytest.raises(InputError, match=r"x only, .* by its direction"):
                Machine(**parts)
    # tilting stiffness holds a shaft at one place, and a rolling bearing is one that holds
    parts = two_stage_parts()
    remove("right")(parts)
    put("bearings", "input left", tilting_stiffness=1e5)(parts)
    assert len(Machine(**parts).bearings) == 5


@pytest.mark.parametrize("stiffness", [1e3, 4e8, 1e13])
def test_a_rolling_bearing_and_a_spring_hold_a_shaft(stiffness: float) -> None:
    ball = DeepGrooveBallBearing(bore_diameter=0.04, outer_diameter=0.08, width=0.018)
    parts = two_stage_parts()
    parts["bearings"]["input left"] = Bearing("input", 0.02, rolling=ball)
    parts["bearings"]["input right"] = Bearing("input", 0.28, radial_stiffness=stiffness)
    parts["bearings"]["input middle"] = Bearing("input", 0.15, rolling=ball)  # three in a row
    Machine(**parts)
    parts["bearings"].pop("input middle")
    machine = Machine(**parts)
    held = [held_by(bearing) for bearing in machine.bearings.values() if bearing.shaft == "input"]
    np.testing.assert_allclose(held, [np.diag([1, 1, 1, 0, 0, 0]), np.diag([0, 1, 1, 0, 0, 0])])
    put("bearings", "input right", radial_stiffness=(0.0, stiffness))(parts)
    with pytest.raises(InputError, match="at 20 mm, 280 mm, do not hold the shaft"):
        Machine(**parts)


def test_a_rigid_shaft_tilts_alike_at_rest_and_in_motion() -> None:
    ball = DeepGrooveBallBearing(bore_diameter=0.04, outer_diameter=0.08, width=0.018)
    parts = two_stage_parts()
    parts["shafts"]["input"] = Shaft()
    parts["meshes"] = {name: replace(m, stiffness=4e8) for name, m in parts["meshes"].items()}
    parts["bearings"]["input left"] = Bearing("input", 0.02, rolling=ball)
    parts["bearings"]["input right"] = Bearing("input", 0.28, radial_stiffness=4e8)
    balance = static_balance(Machine(**parts))
    moving = [name for name in machine_structure(balance.linearized()).names if "input_" in name]
    assert moving == [f"input_{axis}" for axis in ("x", "y", "z", "theta_x", "theta_y", "theta_z")]
    assert np.count_nonzero(balance.gears["z1"]) == 6


def test_a_shaft_without_bearings_names_its_meshes_only_where_it_has_some() -> None:
    sections = [Section(0.3, 0.05)]
    with pytest.raises(InputError) as error:
        Machine(
            shafts={"a": Shaft(sections), "b": Shaft(sections)},
            gears={},
            meshes={},
            couplings={"c": Coupling(("a", "b"), 1e5)},
            operation=Operation("a", "b", 100.0, 10.0),
        )
    assert "Nothing holds it" in str(error.value)
    assert "meshes" not in str(error.value)
    unheld = broken(lambda parts: [parts["bearings"].pop(f"input {s}") for s in ("left", "right")])
    assert "Its meshes would push it away" in unheld


def test_a_shaft_is_thinner_than_its_gear() -> None:
    message = broken(lambda p: p["shafts"].update(input=Shaft([Section(0.3, 0.140)])))
    assert message.startswith("gears.z1.position: the shaft has a diameter of 140 mm")
    assert "reference diameter, 130.144 mm" in message


def test_a_gear_without_a_mesh_needs_its_mass() -> None:
    disc = Gear("input", 0.25, 40, 0.01)
    message = broken(lambda parts: parts["gears"].update(disc=disc))
    assert message.startswith("gears.disc: the gear is in no mesh")
    heavy = replace(disc, mass=3.0, moment_of_inertia=0.01)
    machine = two_stages(gears={**two_stages().gears, "disc": heavy})
    assert machine.gear_bodies["disc"].mass == 3.0


def test_parts_of_another_kind_are_refused() -> None:
    assert "shafts.input" in broken(lambda parts: parts["shafts"].update(input=3.0))
    with pytest.raises(InputError, match="operation"):
        two_stages(operation=None)
    with pytest.raises(InputError, match="meshes"):
        two_stages(meshes=[])


@pytest.mark.parametrize(
    ("part", "where"),
    [
        (lambda: Section(-0.1, 0.05), "Section.length: length = -100 mm"),
        (lambda: Section(0.1, 0.05, 0.05), "Section.inner_diameter: inner_diameter = 50 mm"),
        (lambda: Section(0.1, 0.05, 0.02, 0.015), "Section.end_inner_diameter"),
        (lambda: Section(0.1, math.nan), "outer_diameter"),
        (lambda: Gear("a", 0.0, cast("Any", 20.5), 0.02), "Gear.teeth"),
        (lambda: Gear("a", 0.0, 2, 0.02), "Gear.teeth: teeth = 2"),
        (lambda: Gear("a", 0.0, 20, 0.02, mass=-1.0), "Gear.mass: mass = -1 kg"),
        (lambda: Mesh(("a", "a"), 2e-3), "Mesh.gears"),
        (lambda: Mesh(("a", "b"), 0.0), "Mesh.normal_module: normal_module = 0 mm"),
        (lambda: Mesh(("a", "b"), 2e-3, 1.2), "Mesh.helix_angle: helix_angle = 68.7549 deg"),
        (lambda: Mesh(("a", "b"), 2e-3, hand=cast("Any", "up")), "hand"),
        (lambda: Mesh(("a", "b"), 2e-3, stiffness=0.0), "Mesh.stiffness: stiffness = 0 N/m"),
        (lambda: Mesh(("a", "b"), 2e-3, gap=-1e-5), "Mesh.gap: gap = -0.01 mm"),
        (lambda: Mesh(("a", "b"), 2e-3, events=(1.5,)), "Mesh.events"),
        (lambda: Bearing("a", 0.0, radial_stiffness=-1e8), "Bearing.radial_stiffness"),
        (lambda: Bearing("a", 0.0, 1e8, stiffness=np.eye(6)), "radial_stiffness and stiffness"),
        (lambda: Bearing("a", 0.0, stiffness=np.eye(4)), "Bearing.stiffness"),
        (lambda: Bearing("a", 0.0, stiffness=-np.eye(5)), "negative eigenvalue"),
        (lambda: Housing(np.eye(3), np.eye(4)), "Housing.stiffness"),
        (lambda: Housing([[1.0, 0.5], [0.0, 1.0]], np.eye(2)), "mass is not symmetric"),
        (lambda: Housing(np.eye(3), np.eye(3), nodes={"A": [0, 1, 3, 0, 0, 0]}), 'node "A"'),
        (lambda: Operation("a", "b", math.inf, 1.0), "speed"),
        (lambda: Operation("", "b", 1.0, 1.0), "Operation.input"),
    ],
)
def test_fields_out_of_range_are_named(part: Callable[[], Any], where: str) -> None:
    with pytest.raises(InputError) as error:
        part()
    assert where in str(error.value)


def test_matrices_of_bearings() -> None:
    five = np.diag([1.0, 2.0, 3.0, 4.0, 5.0])
    matrix = Bearing("a", 0.0, stiffness=five).stiffness_matrix
    assert matrix.diagonal().tolist() == [1.0, 2.0, 3.0, 0.0, 4.0, 5.0]
    supports = Bearing("a", 0.0, (1.0, 2.0), 3.0, (4.0, 5.0), radial_damping=6.0)
    assert supports.stiffness_matrix.diagonal().tolist() == [3.0, 1.0, 2.0, 0.0, 4.0, 5.0]
    assert supports.damping_matrix.diagonal().tolist() == [0.0, 6.0, 6.0, 0.0, 0.0, 0.0]
    assert Bearing("a", 0.0).is_default
    assert Bearing("a", 0.0).stiffness_matrix.diagonal().tolist() == [1e9, 1e9, 1e9, 0.0, 0.0, 0.0]
