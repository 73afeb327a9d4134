"""Beam elements and shafts against closed forms."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.machine import STEEL, Section, Shaft
from tribodyn.machine.beam import BeamElement, carried_along, shear_coefficient
from tribodyn.machine.shaft_matrices import ShaftMatrices

SHEAR = STEEL.youngs_modulus / 2.6
CONE = Section(0.08, 0.05, 0.01, 0.03, 0.02)


def fixed(matrices, clamped):
    """Matrices without the coordinates that are held."""
    free = np.setdiff1d(np.arange(matrices[0].shape[0]), clamped)
    return [matrix[np.ix_(free, free)] for matrix in matrices]


def supported_in_plane(shaft):
    """Stiffness and mass of bending in the plane of x and y, both ends supported."""
    plane = np.arange(shaft.size).reshape(-1, 6)[:, [1, 5]].ravel()
    matrices = [matrix[np.ix_(plane, plane)] for matrix in (shaft.stiffness, shaft.mass)]
    return fixed(matrices, [0, plane.size - 2])


def frequencies(matrices):
    return np.sqrt(eigh(*matrices, eigvals_only=True)) / (2.0 * np.pi)


def supported_beam(mode, length, diameter):
    """Natural frequency of a simply supported Timoshenko beam [Hz]."""
    area, second = np.pi * diameter**2 / 4.0, np.pi * diameter**4 / 64.0
    wave = mode * np.pi / length
    bending, rho = STEEL.youngs_modulus * second, STEEL.density
    sheared = shear_coefficient(0.0, 0.3) * SHEAR * area
    # rho I rho w^4/(kappa G) - w^2 (rho A + wave^2 (rho I + EI rho A/(kappa G A))) + EI wave^4 = 0
    square = rho * second * rho * area / sheared
    linear = rho * area + wave**2 * (rho * second + bending * rho * area / sheared)
    roots = np.roots([square, -linear, bending * wave**4])
    return float(np.sqrt(roots.min()) / (2.0 * np.pi))


def test_uniform_supported_beam():
    exact = [supported_beam(mode, 0.5, 0.04) for mode in (1, 2, 3)]
    np.testing.assert_allclose(exact, [319.405, 1249.67, 2717.30], rtol=3e-6)
    errors = [
        frequencies(supported_in_plane(ShaftMatrices(Shaft((Section(0.5, 0.04),)),
                                                     element_length=0.5 / count)))[:3] / exact - 1.0
        for count in (20, 40)
    ]  # fmt: skip
    assert np.abs(errors[1]).max() < 3e-4
    # consistent mass: from above; the shear of an element is constant, so of second order
    assert np.all(errors[1] > 0.0)
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, rtol=0.05)


def test_default_elements_are_fine_enough():
    matrices = supported_in_plane(ShaftMatrices(Shaft((Section(0.5, 0.04),))))
    exact = [supported_beam(mode, 0.5, 0.04) for mode in range(1, 4)]
    np.testing.assert_allclose(frequencies(matrices)[:3], exact, rtol=2e-4)


def test_euler_bernoulli_limit():
    length, diameter = 2.0, 0.002
    shaft = ShaftMatrices(Shaft((Section(length, diameter),)), element_length=0.05)
    exact = (np.pi / length) ** 2 * np.sqrt(STEEL.youngs_modulus / STEEL.density) * diameter / 4.0
    first = frequencies(supported_in_plane(shaft))[:3]
    np.testing.assert_allclose(first, exact / (2.0 * np.pi) * np.array([1, 4, 9]), rtol=2e-5)


def test_hollow_beam_in_the_limit_of_a_thin_wall():
    assert shear_coefficient(1.0, 0.3) == pytest.approx(2.0 * 1.3 / (4.0 + 3.0 * 0.3))
    length, outer, inner = 3.0, 0.04, 0.03
    shaft = ShaftMatrices(Shaft((Section(length, outer, inner),)), element_length=0.1)
    radius = np.sqrt((outer**2 + inner**2) / 16.0)
    exact = np.pi / 2.0 / length**2 * np.sqrt(STEEL.youngs_modulus / STEEL.density) * radius
    slender = 0.5 * (np.pi * radius / length) ** 2 * (1.0 + 2.6 / shear_coefficient(0.75, 0.3))
    first = frequencies(supported_in_plane(shaft))[0]
    assert first == pytest.approx(exact * (1.0 - slender), rel=1e-6)


def test_stepped_beam_of_two_sections():
    """Continuity of deflection, slope, moment and shear at the step, without shear flexibility."""
    lengths, diameters = (0.5, 0.8), (0.0008, 0.001)
    shaft = ShaftMatrices(
        Shaft(tuple(map(Section, lengths, diameters))), element_length=0.05
    )  # fmt: skip
    stiff = [STEEL.youngs_modulus * np.pi * d**4 / 64.0 for d in diameters]
    heavy = [STEEL.density * np.pi * d**2 / 4.0 for d in diameters]

    def determinant(frequency):
        rows = []
        for (length, bending, mass), sign in zip(zip(lengths, stiff, heavy, strict=True), (1, -1),
                                                 strict=True):  # fmt: skip
            b = ((2.0 * np.pi * frequency) ** 2 * mass / bending) ** 0.25
            sine, cosine = np.sin(b * length), np.cos(b * length)
            growing, even = np.sinh(b * length), np.cosh(b * length)
            # from its support each part is sin and sinh; the slopes have opposite signs
            rows += [[value * (1 if order % 2 == 0 else sign) for order, value in enumerate(
                (v1, b * v2, bending * b**2 * v3, bending * b**3 * v4))]
                for v1, v2, v3, v4 in ((sine, cosine, -sine, -cosine),
                                       (growing, even, growing, even))]  # fmt: skip
        matrix = np.array(rows).T
        matrix[:, 2:] *= -1.0
        scale = np.abs(matrix).max(axis=1, keepdims=True)
        return np.linalg.det(matrix / scale)

    computed = frequencies(supported_in_plane(shaft))[:3]
    for frequency in computed:
        exact = brentq(determinant, 0.98 * frequency, 1.02 * frequency)
        assert frequency == pytest.approx(exact, rel=1e-4)


def test_cantilever_bends_shears_stretches_and_twists():
    length, diameter = 0.1, 0.04
    stiffness = BeamElement(Section(length, diameter), STEEL).stiffness[6:, 6:]
    area, second = np.pi * diameter**2 / 4.0, np.pi * diameter**4 / 64.0
    moved = np.linalg.solve(stiffness, np.diag([3.0, 5.0, 7.0, 11.0, 13.0, 17.0]))
    bent = length**3 / (3.0 * STEEL.youngs_modulus * second)
    bent += length / (shear_coefficient(0.0, 0.3) * SHEAR * area)
    turned = length**2 / (2.0 * STEEL.youngs_modulus * second)
    assert moved[0, 0] == pytest.approx(3.0 * length / (STEEL.youngs_modulus * area))
    assert [moved[1, 1], moved[2, 2]] == pytest.approx([5.0 * bent, 7.0 * bent])
    assert moved[3, 3] == pytest.approx(11.0 * length / (SHEAR * 2.0 * second))
    # a force along y turns about +z, one along z about -y
    assert [moved[5, 1], moved[4, 2]] == pytest.approx([5.0 * turned, -7.0 * turned])
    slope = length / (STEEL.youngs_modulus * second)
    assert [moved[4, 4], moved[5, 5]] == pytest.approx([13.0 * slope, 17.0 * slope])


def test_solid_cone_against_its_closed_form():
    """Tip of a cone that is held at its thick end; Timoshenko, Strength of Materials I."""
    length, thick, thin = 0.12, 0.05, 0.03
    flexibility = np.linalg.inv(
        BeamElement(Section(length, thick, 0.0, thin, 0.0), STEEL).stiffness[6:, 6:]
    )
    young = STEEL.youngs_modulus
    stretched = 4.0 * length / (np.pi * young * thick * thin)
    assert flexibility[0, 0] == pytest.approx(stretched, rel=1e-12)
    sheared = stretched * young / (SHEAR * shear_coefficient(0.0, 0.3))
    bent = 64.0 * length**3 / (3.0 * np.pi * young * thick**3 * thin)
    assert flexibility[1, 1] == pytest.approx(bent + sheared, rel=1e-12)
    twisted = 32.0 * length / (3.0 * np.pi * SHEAR)
    twisted *= (thick**2 + thick * thin + thin**2) / (thick * thin) ** 3
    assert flexibility[3, 3] == pytest.approx(twisted, rel=1e-12)


def test_a_cone_is_the_limit_of_many_cylinders():
    steps = 100
    share = (np.arange(steps) + 0.5) / steps
    cylinders = tuple(Section(CONE.length / steps, 0.05 - 0.02 * s, 0.01 + 0.01 * s) for s in share)
    stepped = ShaftMatrices(Shaft(cylinders), element_length=1.0)
    cone = ShaftMatrices(Shaft((CONE,)), element_length=CONE.length / steps)
    free = [fixed((part.stiffness, part.mass), np.arange(6)) for part in (stepped, cone)]
    np.testing.assert_allclose(
        frequencies(free[1])[:4], frequencies(free[0])[:4], rtol=1e-4
    )  # fmt: skip


@pytest.mark.parametrize("section", [Section(0.07, 0.03), Section(0.02, 0.09, 0.08), CONE])
def test_identities_of_an_element(section):
    element = BeamElement(section, STEEL)
    for matrix, sign in ((element.mass, 1), (element.stiffness, 1), (element.gyroscopic, -1)):
        np.testing.assert_allclose(matrix, sign * matrix.T, atol=1e-15 * np.abs(matrix).max())
    rigid = np.vstack((np.eye(6), carried_along(section.length)))
    strain = np.abs(element.stiffness @ rigid).max()
    assert strain < 1e-13 * np.abs(element.stiffness).max()
    assert np.linalg.eigvalsh(element.mass).min() > 0.0
    # mass, first moment and moments of inertia of the body about its first node
    sliced = np.linspace(0.0, section.length, 20001)
    middle, share = 0.5 * (sliced[1:] + sliced[:-1]), np.diff(sliced)
    part = middle / section.length
    outer = section.outer_diameter + part * (
        (section.end_outer_diameter or section.outer_diameter) - section.outer_diameter
    )
    inner = section.inner_diameter + part * (
        (section.end_inner_diameter or section.inner_diameter) - section.inner_diameter
    )
    mass = STEEL.density * np.pi / 4.0 * (outer**2 - inner**2) * share
    across = mass * (outer**2 + inner**2) / 16.0
    body = rigid.T @ element.mass @ rigid
    total, first, polar = mass.sum(), (mass * middle).sum(), 2.0 * across.sum()
    assert [body[0, 0], body[1, 1], body[1, 5], body[2, 4], body[3, 3]] == pytest.approx(
        [total, total, first, -first, polar], rel=1e-7
    )
    assert body[4, 4] == pytest.approx((across + mass * middle**2).sum(), rel=1e-7)
    # angular momentum of the spin turns with the axis
    spin = rigid.T @ element.gyroscopic @ rigid
    assert [spin[4, 5], spin[5, 4]] == pytest.approx([polar, -polar], rel=1e-7)


def test_gyroscopic_sign_on_a_turning_disc():
    """Turning the axis from x towards y while spinning takes a moment about y: H = J w x."""
    speed, rate = 100.0, 2.0
    element = BeamElement(Section(1e-4, 0.2), STEEL)
    turning = np.zeros(12)
    turning[[5, 11]] = rate
    moment = speed * element.gyroscopic @ turning
    polar = 2.0 * STEEL.density * 1e-4 * np.pi * 0.2**4 / 64.0
    momentum_rate = np.cross([0.0, 0.0, rate], [polar * speed, 0.0, 0.0])
    assert moment[4] + moment[10] == pytest.approx(momentum_rate[1], rel=1e-6)


def test_displacement_between_nodes():
    shaft = ShaftMatrices(Shaft((Section(0.1, 0.04), CONE)), (0.03,))
    coarse = ShaftMatrices(shaft.shaft, (), element_length=1.0)
    load = coarse.at(0.18).T @ np.array([10.0, 20.0, 30.0, 4.0, 5.0, 6.0])
    moved = np.zeros(coarse.size)
    moved[6:] = np.linalg.solve(coarse.stiffness[6:, 6:], load[6:])
    fine_load = shaft.at(0.18).T @ np.array([10.0, 20.0, 30.0, 4.0, 5.0, 6.0])
    fine = np.zeros(shaft.size)
    fine[6:] = np.linalg.solve(shaft.stiffness[6:, 6:], fine_load[6:])
    for position in (0.0, 0.03, 0.07, 0.1, 0.15, 0.18):
        np.testing.assert_allclose(
            coarse.at(position) @ moved, shaft.at(position) @ fine, rtol=1e-9, atol=1e-18
        )


def test_nodes_of_a_shaft():
    shaft = ShaftMatrices(Shaft((Section(0.1, 0.12), Section(0.1, 0.03))), (0.1, 0.04, 0.2))
    np.testing.assert_allclose(
        shaft.nodes, [0, 0.02, 0.04, 0.07, 0.1, *np.linspace(0.1, 0.2, 15)[1:]], atol=1e-12
    )  # fmt: skip
    rigid = ShaftMatrices(Shaft())
    assert rigid.size == 6
    assert not rigid.mass.any()
    np.testing.assert_allclose(rigid.at(0.3) @ [0, 1, 2, 0, 0.1, 0.2], [0, 1.06, 1.97, 0, 0.1, 0.2])


def test_rounding_of_lengths_leaves_no_slivers():
    lengths = [0.1, 0.2, 0.1 + 0.2 - 0.3, 0.7, 1e-13]  # the third is 5.6e-17 m
    places = (0.3, 0.1 + 0.2, 0.30000000000000004 + 4e-13, 1.0, -1e-12, 0.1 * 3.0 + 0.7)
    shaft = ShaftMatrices(Shaft([Section(length, 0.05) for length in lengths]), places)
    assert np.diff(shaft.nodes).min() > 0.005
    for place in places:
        assert shaft.at(place).sum() == 6.0  # each is a node
    plain = ShaftMatrices(Shaft([Section(0.1, 0.05), Section(0.2, 0.05), Section(0.7, 0.05)]))
    for name in ("mass", "stiffness", "gyroscopic"):
        matrix = getattr(plain, name)
        np.testing.assert_allclose(getattr(shaft, name), matrix, atol=1e-9 * matrix.max())


def test_a_position_off_the_shaft_is_refused():
    with pytest.raises(InputError, match=r"position = 201 mm.*extends from 0 to 200 mm"):
        _ = ShaftMatrices(Shaft((Section(0.2, 0.03),)), (0.201,)).nodes
    with pytest.raises(InputError, match="position = -1 mm"):
        ShaftMatrices(Shaft((Section(0.2, 0.03),))).at(-1e-3)


def test_other_materials():
    """Frequencies scale with the speed of sound."""
    light = Material(70e9, 0.3, 2700.0)
    section = (Section(0.5, 0.04),)
    first = [
        frequencies(supported_in_plane(ShaftMatrices(Shaft(section, material))))[0]
        for material in (STEEL, light)
    ]
    ratio = np.sqrt(70e9 / 2700.0 / (206e9 / 7850.0))
    assert first[1] / first[0] == pytest.approx(ratio, rel=1e-9)


def overhung_disc(speed):
    """Light cantilever with a disc at its end: our matrices, and those in y + i z by hand."""
    light, section = Material(206e9, 0.3, 1e-3), Section(0.3, 0.02)
    shaft = ShaftMatrices(Shaft((section,), light), element_length=0.1)
    end = shaft.at(0.3)
    mass, polar, across = 6.0, 0.03, 0.016
    inertia = shaft.mass + end.T @ np.diag([mass, mass, mass, polar, across, across]) @ end
    spin = np.outer(end[4], end[5]) - np.outer(end[5], end[4])
    gyroscopic = speed * (shaft.gyroscopic + polar * spin)
    matrices = fixed((inertia, gyroscopic, shaft.stiffness), np.arange(6))
    tip = BeamElement(section, light).stiffness[6:, 6:]
    # r = y + i z, slope = theta_z - i theta_y
    stiffness = tip[np.ix_([1, 5], [1, 5])]
    return matrices, stiffness, (mass, polar, across)


def test_gyroscopic_splitting_of_a_disc():
    speed = 400.0
    (mass, gyroscopic, stiffness), stiff, (m, polar, across) = overhung_disc(speed)
    size = len(mass)
    state = np.block([
        [np.zeros((size, size)), np.eye(size)],
        [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, gyroscopic)],
    ])  # fmt: skip
    computed = np.sort(np.linalg.eigvals(state).imag)
    # (k11 - m w^2)(k22 - J w^2 + J_p speed w) - k12^2 = 0, forward whirl with w > 0
    exact = np.roots([
        m * across, -m * polar * speed, -(m * stiff[1, 1] + across * stiff[0, 0]),
        polar * speed * stiff[0, 0], np.linalg.det(stiff),
    ])  # fmt: skip
    assert np.abs(exact.imag).max() == 0.0
    bending = np.sort(np.abs(exact))
    nearest = [computed[np.abs(computed - whirl).argmin()] for whirl in bending]
    np.testing.assert_allclose(nearest, bending, rtol=1e-5)
    assert bending[1] / bending[0] > 1.01
    # forward whirl turns y towards z and is the faster one
    values, vectors = np.linalg.eig(state)
    for whirl in bending[:2]:
        vector = vectors[:size, np.abs(values - 1j * whirl).argmin()]
        lag = (vector[-4] / vector[-5]).imag  # z over y
        assert lag == pytest.approx(-1.0 if whirl == bending[1] else 1.0, rel=1e-6)


def test_unbalance_response_of_a_disc():
    speed, moment = 120.0, 2e-4
    (mass, gyroscopic, stiffness), stiff, (m, polar, across) = overhung_disc(speed)
    force = np.zeros(len(mass), dtype=complex)
    force[-5:-3] = moment * speed**2 * np.array([1.0, -1j])  # real part times exp(i speed t)
    moved = np.linalg.solve(stiffness - speed**2 * mass + 1j * speed * gyroscopic, force)
    whirl = stiff - speed**2 * np.diag([m, across - polar])
    exact = np.linalg.solve(whirl, [moment * speed**2, 0.0])
    np.testing.assert_allclose(moved[[-5, -4, -1]], exact[[0, 0, 1]] * [1, -1j, 1], rtol=1e-6)
