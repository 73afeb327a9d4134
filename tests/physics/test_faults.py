"""Faults over whole turns: closed forms, limits, and lines at the frequencies of kinematics."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from references.cracked_tooth import CRACKS, RADII, SHALLOW, SHALLOW_GEAR
from references.gear_compliance import MODULUS, POISSON, outline_of
from tribodyn.errors import InputError
from tribodyn.faults import (
    BearingDefect,
    BrokenTooth,
    Crack,
    Fault,
    FlankDeviations,
    FlankTopographies,
    InclinedFlanks,
    PitchDeviations,
    Spall,
    TurningMesh,
    Waviness,
    crack_compliance,
    eccentricity,
    pitch_tolerances,
    slope_tolerances,
    turning_mesh,
    turns_of,
)
from tribodyn.faults.cracked_tooth import (
    GREATEST_TANGENT,
    LEAST_TANGENT,
    CrackLine,
    _sound_ring,
    crack_rows,
    ring_displacement,
)
from tribodyn.gear import (
    FlankModification,
    Material,
    ProfileMap,
    SpurGear,
    SpurPair,
    cylindrical_pair,
    spur_pair,
)
from tribodyn.stiffness import loaded_contact
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize
from tribodyn.study.faults.section import FaultTable

TORQUE = 90.0


@pytest.fixture(scope="module")
def pair() -> SpurPair:
    return spur_pair(
        pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3, pinion_face_width=0.02,
        normal_pressure_angle=math.radians(20.0), pinion_bore_diameter=0.03,
        wheel_bore_diameter=0.03, pinion_profile_shift_coefficient=0.18,
        wheel_profile_shift_coefficient=0.17,
    )  # fmt: skip


def mesh_with(pair: SpurPair, *faults: Fault, phases: int = 64) -> TurningMesh:
    return turning_mesh(pair, TORQUE, faults, provider="analytic", phases=phases)


def lines(mesh: TurningMesh) -> np.ndarray:
    """Amplitudes of the static transmission error at multiples of the frequency of all turns."""
    values = mesh.transmission_error[:-1]
    return 2.0 * np.abs(np.fft.rfft(values)) / values.size


def test_a_fault_of_no_size_changes_nothing(pair: SpurPair) -> None:
    healthy = mesh_with(pair, eccentricity("pinion", 0.0))
    for fault in (
        Crack(tooth=2, depth=0.0),
        Spall(tooth=2, depth=0.0, start=0.2, end=0.8),
        Spall(tooth=2, depth=1e-4, start=0.5, end=0.5),
        Waviness(amplitude=0.0, order=5),
        BrokenTooth(tooth=2, remaining=1.0),
    ):
        mesh = mesh_with(pair, fault)
        np.testing.assert_array_equal(mesh.transmission_error, healthy.transmission_error)
        np.testing.assert_array_equal(
            mesh.force_law.knot_stiffness, healthy.force_law.knot_stiffness
        )


@pytest.mark.parametrize(
    ("gear", "order", "turns"), [("pinion", 1, 16), ("wheel", 1, 24), ("wheel", 31, 24)]
)
def test_waves_make_one_line_of_their_amplitude(
    pair: SpurPair, gear: str, order: int, turns: int
) -> None:
    healthy = lines(mesh_with(pair, Waviness(gear=gear, amplitude=0.0, order=1)))  # type: ignore[arg-type]
    wave = Waviness(gear=gear, amplitude=5e-6, order=order, phase=0.7)  # type: ignore[arg-type]
    mesh = mesh_with(pair, wave)
    assert mesh.cycles == turns
    added = lines(mesh) - healthy
    assert abs(added[order] - 5e-6) < 1e-12  # all pairs in contact have the same deviation
    added[order] = 0.0
    assert np.abs(added[1:]).max() < 1e-12


def test_a_slope_that_all_teeth_share_is_the_modification(pair: SpurPair) -> None:
    alike = FlankDeviations(profile_slopes=(6e-6,) * 16, helix_slopes=(9e-6,) * 16)
    modification = FlankModification(profile_slope=6e-6, lead_slope=9e-6)
    modified = replace(pair, pinion=replace(pair.pinion, modification=modification))
    mesh = mesh_with(pair, alike, phases=32)
    assert mesh.cycles == 16
    expected = loaded_contact(modified, TORQUE, provider="analytic", phases=32)
    np.testing.assert_allclose(
        mesh.transmission_error[:-1], np.tile(expected.transmission_error, 16), atol=1e-15
    )


def test_slopes_of_a_class(pair: SpurPair) -> None:
    drawn = FlankDeviations(gear="wheel", accuracy_class=8, seed=4)
    slopes = drawn.slopes(pair.wheel)
    tolerances = slope_tolerances(pair.wheel, 8)
    for values, tolerance in zip(slopes, tolerances, strict=True):
        assert values.size == 24
        assert abs(np.abs(values).max() - tolerance) < 1e-18
    listed = FlankDeviations(
        gear="wheel", profile_slopes=tuple(slopes[0]), helix_slopes=tuple(slopes[1])
    )
    meshes = [mesh_with(pair, each, phases=32) for each in (drawn, listed)]
    np.testing.assert_array_equal(*(each.transmission_error for each in meshes))
    with pytest.raises(InputError, match="The pinion has 16 teeth"):
        mesh_with(pair, FlankDeviations(profile_slopes=(1e-6, 0.0)))
    with pytest.raises(InputError, match="neither slopes nor"):
        FlankDeviations()


def test_measured_teeth(pair: SpurPair) -> None:
    values = 1e-6 * np.random.default_rng(3).normal(0.0, 4.0, (3, 9, 2))
    maps = tuple(
        ProfileMap(tuple(np.linspace(0.0, 0.04, 9)), (-0.01, 0.01), tuple(map(tuple, rows)))
        for rows in values
    )
    # the same map on all teeth is the modification of the gear
    modified = replace(
        pair, pinion=replace(pair.pinion, modification=FlankModification(profile_map=maps[0]))
    )
    expected = loaded_contact(modified, TORQUE, provider="analytic", phases=32).transmission_error
    shared = FlankTopographies(teeth=(5,), maps=maps[:1], other_teeth="nearest")
    mesh = mesh_with(pair, shared, phases=32)
    np.testing.assert_allclose(mesh.transmission_error[:-1], np.tile(expected, 16), atol=1e-15)
    # of a single tooth that deviates, the error is that of sound teeth where it does not touch
    alone = mesh_with(pair, FlankTopographies(teeth=(5,), maps=maps[:1]), phases=32)
    sound = loaded_contact(pair, TORQUE, provider="analytic", phases=32).transmission_error
    differs = np.abs(alone.transmission_error[:-1].reshape(16, 32) - sound).max(axis=1) > 1e-12
    assert alone.cycles == 16
    assert np.flatnonzero(differs).tolist() == [3, 4, 5]  # it touches a little before the path
    # teeth between two measured ones are those of the nearest
    three = FlankTopographies(teeth=(9, 1, 5), maps=maps, other_teeth="nearest")
    assert three.maps_of_teeth(16).tolist() == [1, 1, 1, 2, 2, 2, 2, 0, 0, 0, 0, 0, 1, 1, 1, 1]
    late = replace(three, first_tooth=4, other_teeth="nominal").maps_of_teeth(16)
    assert late[[1, 5, 13]].tolist() == [2, 0, 1]
    assert np.count_nonzero(late >= 0) == 3
    for wrong, message in (
        ({"teeth": (17,)}, "The pinion has 16 teeth"),
        (
            {"maps": (replace(maps[0], position=tuple(np.linspace(0.02, 0.021, 9))),)},
            "not extrapolated",
        ),
        ({"teeth": (1, 1)}, "Each measured tooth has one map"),
    ):
        with pytest.raises(InputError, match=message):
            mesh_with(pair, replace(shared, **wrong))  # type: ignore[arg-type]


def test_inclined_crests_cancel_over_the_face(pair: SpurPair) -> None:
    """The mean of a wave over the face is its sinc, which a soft mesh of equal slices takes."""
    wave = {"gear": "wheel", "amplitude": 1e-7, "order": 31}
    half = 0.5 * pair.common_face_width
    ratios = []
    for turned in (0.0, 0.5 * np.pi, np.pi):  # phase at the end of the face against its middle
        angle = math.atan(turned / 31 * pair.wheel.base_radius / half)
        inclined = lines(mesh_with(pair, Waviness(**wave, lead_angle=angle + 1e-12)))  # type: ignore[arg-type]
        ratios.append(inclined[31])
    assert abs(ratios[0] - 1e-7) < 1e-12
    # the mean of the slices is that of the face to (phase/slices)^2/6
    assert abs(ratios[1] / ratios[0] - 2.0 / np.pi) < 2e-3
    assert ratios[2] / ratios[0] < 2e-3


def helical(pair: SpurPair, degrees: float) -> SpurPair:
    return cylindrical_pair(
        pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3, pinion_face_width=0.02,
        normal_pressure_angle=math.radians(20.0), pinion_bore_diameter=0.03,
        wheel_bore_diameter=0.03, pinion_profile_shift_coefficient=0.18,
        wheel_profile_shift_coefficient=0.17, helix_angle=math.radians(degrees),
    )  # fmt: skip


def test_a_misaligned_gear_is_a_misaligned_pair(pair: SpurPair) -> None:
    def error(pair: SpurPair, *faults: Fault) -> np.ndarray:
        return mesh_with(pair, *faults, phases=16).transmission_error[:-1]

    aligned, expected = error(pair), error(replace(pair, misalignment=40e-6))
    inclined = error(pair, InclinedFlanks(gear="wheel", amplitude=40e-6))
    assert abs(inclined.mean() - aligned.mean()) > 1e-6
    np.testing.assert_allclose(inclined, np.resize(expected, inclined.size), rtol=5e-3)
    turning = mesh_with(pair, InclinedFlanks(gear="wheel", amplitude=40e-6, order=1), phases=16)
    once, twice = lines(turning)[1:3]
    assert once < 1e-3 * twice  # both ends of the face are alike
    assert twice > 1e-8


def test_faults_of_helical_teeth(pair: SpurPair) -> None:
    slanted = helical(pair, 18.0)
    healthy = mesh_with(slanted, eccentricity("pinion", 0.0), phases=16)
    broken = mesh_with(slanted, BrokenTooth(tooth=4, remaining=0.5), phases=16)
    spalled = mesh_with(
        slanted, Spall(tooth=4, depth=1e-4, start=0.4, end=0.6, face_share=0.4), phases=16
    )
    np.testing.assert_allclose(broken.load_share.sum(axis=1), 1.0, rtol=1e-9)
    changes = [
        np.abs(mesh.transmission_error - healthy.transmission_error)[:-1].reshape(16, 16).max(1)
        for mesh in (broken, spalled)
    ]
    for change in changes:
        assert change.max() > 1e-7
        assert change[np.r_[0:2, 8:16]].max() < 1e-12
    assert changes[0].max() > changes[1].max()
    error = lines(mesh_with(slanted, Waviness(amplitude=2e-6, order=5), phases=16))
    added = error - lines(healthy)
    assert abs(added[5] - 2e-6) < 1e-12
    spall = Spall(tooth=4, depth=1e-4, start=0.4, end=0.6)
    small = mesh_with(helical(pair, 0.02), spall, phases=16)
    straight = turning_mesh(
        pair, TORQUE, [spall], provider="analytic", phases=16, extended_contact=False
    )
    inside = np.abs(small.transmission_error - straight.transmission_error)
    assert np.median(inside) < 0.01 * np.ptp(straight.transmission_error)
    with pytest.raises(InputError, match="cracked tooth is helical"):
        mesh_with(slanted, Crack(tooth=4, depth=1e-3))


def test_an_eccentric_gear_is_one_with_run_out(pair: SpurPair) -> None:
    modification = FlankModification(run_out=20e-6, run_out_phase=0.4)
    out = replace(pair, wheel=replace(pair.wheel, modification=modification))
    mesh = mesh_with(pair, eccentricity("wheel", 10e-6, -0.4))
    np.testing.assert_allclose(
        mesh.transmission_error, mesh_with(out).transmission_error, rtol=0.0, atol=1e-15
    )


def test_a_longer_clock_repeats_the_shorter_one(pair: SpurPair) -> None:
    crack = Crack(gear="pinion", tooth=3, depth=1.5e-3)
    short = mesh_with(pair, crack)
    longer = mesh_with(pair, crack, eccentricity("wheel", 0.0))
    assert (short.cycles, longer.cycles) == (16, 48)
    np.testing.assert_allclose(
        longer.transmission_error[:-1], np.tile(short.transmission_error[:-1], 3), rtol=1e-12
    )


def test_pitch_deviations_of_a_class(pair: SpurPair) -> None:
    drawn = PitchDeviations(gear="pinion", accuracy_class=7, seed=3)
    single = drawn.single(pair.pinion)
    tolerances = pitch_tolerances(pair.pinion, 7)
    assert abs(single.sum()) < 1e-18
    assert np.abs(single).max() <= tolerances[0] * (1.0 + 1e-12)
    assert np.ptp(np.cumsum(single)) <= tolerances[1] * (1.0 + 1e-12)
    coarser = pitch_tolerances(pair.pinion, 9)
    np.testing.assert_allclose(coarser, 2.0 * np.array(tolerances), rtol=1e-14)
    # a pair in single contact is late by the cumulative deviation of its tooth
    mesh = mesh_with(pair, drawn)
    healthy = mesh_with(pair, eccentricity("pinion", 0.0))
    places = np.cumsum(single) - single[0]
    alone = int(np.median(np.flatnonzero(healthy.load_share[:64].max(axis=1) > 1.0 - 1e-9)))
    phase = alone + 64 * np.arange(16)
    difference = mesh.transmission_error[phase] - healthy.transmission_error[phase]
    older = int(np.argmax(healthy.load_share[alone])) - 1  # one contact more before A
    np.testing.assert_allclose(difference, np.roll(places, older), atol=1e-12)


def test_the_rest_of_the_turns_is_the_sound_mesh(pair: SpurPair) -> None:
    phase = np.arange(64) / 64
    sound = loaded_contact(pair, TORQUE, provider="analytic", phases=phase)
    mesh = mesh_with(pair, Crack(gear="wheel", tooth=5, depth=2e-3))
    cycles = mesh.transmission_error[:-1].reshape(24, 64)
    touched = np.abs(cycles - sound.transmission_error).max(axis=1) > 1e-12
    # tooth 5 enters in cycle 4 and may touch in the one before it and the two after it
    assert touched[4]
    assert not touched[np.r_[0:3, 8:24]].any()
    assert np.all(cycles >= sound.transmission_error - 1e-12)  # a crack is softer


def test_a_spall_leaves_less_face_to_carry(pair: SpurPair) -> None:
    shares = []
    for face_share in (0.0, 0.25, 0.5):
        spall = Spall(tooth=4, depth=200e-6, start=0.0, end=1.0, face_share=face_share)
        mesh = mesh_with(pair, spall, Spall(tooth=9, depth=0.0, start=0.0, end=1.0, face_share=0.5))
        shares.append(mesh.mesh_stiffness_tangent.min() / mesh.mesh_stiffness_tangent.max())
    assert shares[0] > shares[1] > shares[2] > 0.2


def test_a_broken_tooth_hands_its_load_to_the_neighbours(pair: SpurPair) -> None:
    mesh = mesh_with(pair, BrokenTooth(tooth=4))
    cycle, number = 3, 1  # tooth 4 enters in cycle 3; contact 0 is the tooth that enters next
    inside = slice(64 * cycle + 8, 64 * cycle + 56)
    assert mesh.load_share[inside, number].max() == 0.0
    np.testing.assert_allclose(mesh.load_share.sum(axis=1), 1.0, rtol=1e-9)
    healthy = mesh_with(pair, eccentricity("pinion", 0.0))
    assert mesh.peak_to_peak_transmission_error > 3.0 * healthy.peak_to_peak_transmission_error


def test_crack_compliance_grows_with_depth(pair: SpurPair) -> None:
    gear, steel = pair.pinion, Material()
    # a shallow crack: energy release 2 K^2/E with K ~ sqrt(a): compliance ~ depth squared
    depths = (4e-4, 8e-4, 2e-3, 3e-3)
    added = [crack_compliance(gear, steel, depth, refined=1.0)[1] for depth in depths]
    assert 1.7 < math.log2(added[1][-1] / added[0][-1]) < 2.2
    assert np.all(np.diff(added, axis=0) > 0.0)


SLOW = [pytest.param(crack, marks=pytest.mark.slow) for crack in list(CRACKS)[2:]]


@pytest.mark.parametrize("crack", [*list(CRACKS)[:2], *SLOW], ids=str)
def test_crack_compliance_against_triangles_of_the_whole_gear(
    crack: tuple[str, float, float, float],
) -> None:
    np.testing.assert_allclose(computed_cracks(*crack), CRACKS[crack], rtol=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("depth", list(SHALLOW))
def test_shallow_cracks_are_as_exact_as_deep_ones(depth: float) -> None:
    computed = computed_cracks(SHALLOW_GEAR, depth, 90.0, 30.0)
    np.testing.assert_allclose(computed, SHALLOW[depth], rtol=0.015)


@pytest.mark.slow
def test_shallowest_cracks_have_the_stress_intensity_of_a_half_plane() -> None:
    """Square to the surface: K = 1.1215 s sqrt(pi a), so that ds/dF is 1.1215^2 pi s^2 a^2/E."""
    gear, tangent = gear_of(SHALLOW_GEAR), math.radians(30.0)
    line = CrackLine(4e-5, math.radians(60.0), tangent)
    mesh, others = _sound_ring(gear, 0.3, MeshSize().refined(1.0), (line.start(gear), 0.005))
    radius = 1e-3 * np.array(RADII)
    forces = flank_loads(gear, mesh, radius).forces
    moved = ring_displacement(mesh, forces, 0.3, others)
    ((row, _),) = crack_rows(gear, mesh, line)
    flank = mesh.tooth[0, row - 2 : row + 3]
    place = mesh.nodes[flank]
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(place, axis=0).T)))
    slope = np.array([np.polyfit(along - along[2], x, 3)[2] for x in place.T])
    stretch = [
        sum(slope[i] * np.polyfit(along - along[2], moved[2 * flank + i, k], 3)[2] for i in (0, 1))
        for k in range(radius.size)
    ]
    stress = np.array(stretch) / (slope @ slope) / (1e3 * gear.normal_module)  # per N/mm, E of 1
    ratio = []
    for depth in (4e-5, 8e-5):
        places, added = crack_compliance(
            gear, Material(youngs_modulus=1.0, poissons_ratio=0.3), depth,
            angle=math.radians(60.0), root_tangent=tangent, refined=1.0,
        )  # fmt: skip
        limit = 1.1215**2 * math.pi * stress**2 * (1e3 * depth) ** 2
        ratio.append(np.interp(radius, places, added) / limit)
    np.testing.assert_allclose(2.0 * ratio[0] - ratio[1], 1.0, atol=0.03)


def test_limits_of_the_tangent_are_those_of_the_message_and_the_key() -> None:
    option = FaultTable.fields["root_tangent"]
    assert (option.low, option.high) == (LEAST_TANGENT, GREATEST_TANGENT)  # type: ignore[union-attr]
    for name in ("type C pinion", "type A wheel", SHALLOW_GEAR):
        gear = gear_of(name)
        with pytest.raises(InputError) as fault:
            CrackLine(1e-3, root_tangent=0.25 * math.pi).check(gear)
        low, high = map(float, re.findall(r"of (-?[\d.]+) to ([\d.]+) deg", str(fault.value))[0])
        assert math.degrees(LEAST_TANGENT) < low < high < math.degrees(GREATEST_TANGENT)
        for tangent in (low, high):
            CrackLine(1e-4, root_tangent=math.radians(tangent)).check(gear)
        with pytest.raises(InputError, match="root_tangent"):
            CrackLine(1e-4, root_tangent=math.radians(high + 0.1)).check(gear)


def gear_of(name: str | tuple[int, float, float]) -> SpurGear:
    """Gear of the reference."""
    outline = outline_of(name)
    return SpurGear(
        teeth=outline.teeth, normal_module=1e-3 * outline.module, face_width=0.02,
        normal_pressure_angle=math.radians(20.0), profile_shift_coefficient=outline.shift,
        tip_diameter=2e-3 * outline.tip_radius, bore_diameter=2e-3 * outline.bore_radius,
    )  # fmt: skip


def computed_cracks(
    name: str | tuple[int, float, float], depth: float, angle: float, tangent: float
) -> Any:
    """Compliance of a crack at the loads of the reference [1e-6 mm^2/N]."""
    radius, added = crack_compliance(
        gear_of(name), Material(youngs_modulus=1e6 * MODULUS, poissons_ratio=POISSON), 1e-3 * depth,
        angle=math.radians(angle), root_tangent=math.radians(tangent),
    )  # fmt: skip
    return 1e12 * np.interp(1e-3 * np.array(RADII), radius, added)


@pytest.mark.parametrize("place", ["outer", "inner", "element"])
def test_bearing_impacts_repeat_at_their_frequency(place: str) -> None:
    bearing = BearingDefect(
        place=place, rolling_elements=9, element_diameter=7.94e-3, pitch_diameter=39.04e-3,  # type: ignore[arg-type]
        acceleration=1.0, resonance=3000.0, slip=0.0,
    )  # fmt: skip
    rate, shaft = 20_000.0, 30.0
    time = np.arange(int(4 * rate)) / rate
    impacts = np.abs(bearing.signal(shaft, time, seed=2))
    spectrum = np.abs(np.fft.rfft(impacts - impacts.mean()))
    frequency = np.arange(spectrum.size) / 4.0
    expected = bearing.frequency(shaft)
    near = np.abs(frequency - expected) < 0.3
    assert spectrum[near].max() > 0.6 * spectrum[frequency > 2.5 * shaft].max()
    # the elements roll: outer and inner passings share the turns of the shaft
    total = [replace(bearing, place=each).frequency(shaft) for each in ("outer", "inner")]
    assert math.isclose(sum(total), 9 * shaft, rel_tol=1e-14)


def test_what_does_not_fit_is_refused(pair: SpurPair) -> None:
    with pytest.raises(InputError, match="16 teeth"):
        mesh_with(pair, Crack(tooth=17, depth=1e-3))
    with pytest.raises(InputError, match="a fifth has to be left"):
        mesh_with(pair, Crack(tooth=1, depth=9e-3))
    with pytest.raises(InputError, match="tangents of"):
        mesh_with(pair, Crack(tooth=1, depth=1e-3, root_tangent=math.radians(60.0)))
    with pytest.raises(InputError, match=r"45 to 90 deg"):
        mesh_with(pair, Crack(tooth=1, depth=1e-3, angle=math.radians(30.0)))
    with pytest.raises(InputError, match="no tooth pair is left"):
        mesh_with(pair, *(BrokenTooth(tooth=tooth) for tooth in range(1, 17)))
    with pytest.raises(InputError, match="mesh cycles"):
        turning_mesh(pair, TORQUE, [eccentricity("pinion", 1e-6)], phases=10**6)
    assert turns_of(pair) == 1
