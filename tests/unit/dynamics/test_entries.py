"""Entries of contacts: numbers or functions of the mesh phase alone, that jump at events only."""

import numpy as np
import pytest

from tribodyn.dynamics import Contact, LoadFriction, System, steady_state
from tribodyn.errors import InputError
from tribodyn.mesh import PhaseFunction, phase_grid

FULL = 2.0 * np.pi


def _orbit(force=(1.0,), frictions=(), **parts):
    contact = Contact(**({"direction": [1.0], "stiffness": 9.0} | parts))
    system = System([[1.0]], [[1.0]], [[0.0]], force, [contact], frictions=frictions)
    return steady_state(system, 1.0, steps=256)


SMOOTH = {
    "harmonic": lambda phase: 9.0 + np.cos(FULL * phase),
    "kinks": lambda phase: 9.0 + np.abs(np.cos(FULL * phase)),
    "steep": lambda phase: 9.0 + np.tanh(2000.0 * (phase - 0.377)),
    "saw": lambda phase: 9.0 + phase,
    "narrow pulse": lambda phase: 9.0 + np.exp(-(((phase - 0.4) / 0.01) ** 2)),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_continuous_functions_are_accepted(name):
    assert _orbit(stiffness=SMOOTH[name]).converged


@pytest.mark.parametrize("height", [1.0, -1e-2, 1e-3, -1e-4])
@pytest.mark.parametrize("place", [0.377, 0.25, 0.9996])
def test_a_jump_without_an_event_is_refused(height, place):
    """An error names its location, whatever the operands; as an event it is accepted."""
    for name, smooth in SMOOTH.items():

        def jumping(phase, smooth=smooth):
            return smooth(phase) + np.where(phase < place, 0.0, height)

        if abs(height) < 0.1 and name in ("steep", "narrow pulse"):
            continue
        with pytest.raises(InputError, match=r"contacts\[0\].stiffness jumps by") as caught:
            _orbit(stiffness=jumping)
        reported = float(str(caught.value).split("mesh phase ")[1].split(",")[0])
        assert reported == pytest.approx(place, abs=1e-6)
        assert _orbit(stiffness=jumping, events=(0.0, place)).converged


@pytest.mark.parametrize("name", ["stiffness", "error"])
@pytest.mark.parametrize("place", [0.0, 0.3])
def test_a_jump_at_the_phase_zero_costs_no_order(name, place):
    """Mesh cycles begin at an event: a jump there needs none, and errors fall with dt^4."""

    def state(place, steps):
        base = {"stiffness": 1.0, "error": 0.0}
        entries = {**base, name: lambda phase: base[name] + 0.3 * ((phase - place) % 1.0)}
        contact = Contact([1.0], damping=0.05, events=(place,) if place else (), **entries)
        system = System([[1.0]], [[0.05]], [[0.0]], [0.3], [contact])
        orbit = steady_state(system, 0.11, steps=steps)
        row = int(np.argmin(np.abs(orbit.phase - place)))
        return np.append(orbit.position[row], orbit.velocity[row])

    errors = [np.abs(state(place, steps) - state(0.0, 2048)).max() for steps in (32, 64, 128)]
    assert errors[0] < 1e-4
    assert errors[1] < errors[0] / 11.0
    assert errors[2] < errors[1] / 11.0


def test_a_jump_too_small_to_be_refused_does_nothing():
    smooth, small = (
        _orbit(stiffness=lambda phase, h=h: SMOOTH["steep"](phase) + np.where(phase < 0.37, 0.0, h))
        for h in (0.0, 5e-8)
    )
    assert np.abs(small.position - smooth.position).max() < 1e-7 * np.abs(smooth.position).max()


@pytest.mark.parametrize("name", ["stiffness", "damping", "error", "gap", "direction", "friction"])
def test_every_entry_is_checked_for_jumps(name):
    def jumping(phase):
        return np.where(phase < 0.3, 0.5, 0.6)

    with pytest.raises(InputError, match=rf"contacts\[0\].{name} jumps by 0.1"):
        _orbit(**{name: jumping})
    with pytest.raises(InputError, match=r"force jumps by 0.1 at the mesh phase 0.3"):
        _orbit(force=lambda phase: jumping(phase)[:, None])
    with pytest.raises(InputError, match=r"frictions\[0\].coefficients jumps by 0.1"):
        _orbit(frictions=[LoadFriction([1.0], jumping, 1.0)])


def test_a_finer_grid_repeats_the_check():
    """A pulse between the nodes of the first grid is found by one that is fine enough."""
    pulse = Contact([1.0], lambda phase: 9.0 + ((phase > 0.5019) & (phase < 0.5023)))
    system = System([[1.0]], [[1.0]], [[0.0]], [1.0], [pulse])
    assert steady_state(system, 1.0, steps=64).converged
    with pytest.raises(InputError, match=r"jumps by 1 at the mesh phase 0.5019"):
        steady_state(system, 1.0, steps=4096)


def test_functions_that_depend_on_more_than_the_phase_are_refused():
    generator, calls = np.random.default_rng(1), []

    def counted(phase):
        calls.append(1)
        return 9.0 + 0.1 * len(calls) + 0.0 * phase

    for function in (counted, lambda phase: 9.0 + generator.random(phase.size),
                     lambda phase: 9.0 + 1e-3 * np.arange(phase.size)):  # fmt: skip
        with pytest.raises(InputError, match="other values when it is called again"):
            _orbit(stiffness=function)


@pytest.mark.parametrize("bad", ["9", 9.0 + 1j, None, {}, [[1.0], [1.0, 2.0]], b"9", object()])
def test_entries_that_are_not_real_numbers_are_refused(bad):
    for entry in (bad, lambda phase: bad, lambda phase: np.full(phase.shape, bad)):
        with pytest.raises(InputError, match=r"(Contact|contacts\[0\])\.stiffness"):
            _orbit(stiffness=entry)


@pytest.mark.parametrize("nothing", [None, 0, 0.0, [0.0], (0,), lambda phase: 0.0 * phase])
def test_a_contact_without_direction(nothing):
    with pytest.raises(InputError, match="direction"):
        _orbit(direction=nothing)


def test_a_table_may_jump_at_events_of_the_contact_alone():
    """Tables are not searched for jumps if their events are those of the contact."""
    grid = phase_grid((0.0, 0.3), 64)
    table = PhaseFunction(grid, np.where(grid.middle < 0.3, 9.0, 12.0))
    with pytest.raises(InputError, match=r"jumps by 3 at the mesh phase 0\.3"):
        _orbit(stiffness=table)
    assert _orbit(stiffness=table, events=(0.0, 0.3)).converged
