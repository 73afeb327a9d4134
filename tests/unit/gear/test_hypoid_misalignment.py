"""Displaced gears of hypoid pairs: where the contact moves, what is transmitted, reciprocity."""

import math

import numpy as np
import pytest

from known_hypoids import eased, h1043
from tribodyn.errors import InputError
from tribodyn.gear import Misalignment, misalignment_study, tooth_contact
from tribodyn.gear.hypoid.conjugate import ContactLines
from tribodyn.gear.hypoid.tooth_contact import exact_contact, gap_of, lightest, start_values
from tribodyn.mesh import hypoid_loaded_contact

STEPS = {"offset": 2e-6, "pinion_axial": 2e-6, "wheel_axial": 2e-6, "shaft_angle": 2e-5}
PAIRS = [("drive", "left"), ("coast", "right")]


@pytest.fixture(scope="module", params=PAIRS, ids="-".join)
def flanks(request):
    side, hand = request.param
    # A strong profile crowning keeps the contact off the edges.
    return eased(h1043(hand_pinion=hand), side, along=1e-4, across=6e-4)


@pytest.mark.parametrize("name", STEPS)
def test_small_displacements_move_the_contact_as_the_surfaces_do(flanks, name):
    # The gap is of first order in the ease-off, and the displacement in that.
    flanks = eased(flanks.blank, flanks.side, along=1e-4, across=6e-4, scale=0.05)
    lines, step = ContactLines(flanks.conjugate), 0.05 * STEPS[name]
    rotation = np.array([-0.03, 0.0, 0.03]) * flanks.conjugate.sense
    ends, _ = lines.ends(rotation)
    station, lag, edge = lightest(lines, rotation, ends, Misalignment())
    assert not np.any(edge)
    # The lag is (E + m g) / lever: its least value moves by -(g / lever)' / (E / lever)''.
    near = station + 2e-4 * np.array([[-1.0], [0.0], [1.0]])
    touch = lines.touch(rotation, near)
    eases = gap_of(flanks.conjugate, touch, Misalignment()) / touch.lever
    moved = gap_of(flanks.conjugate, touch, Misalignment(**{name: 1e-6})) / touch.lever
    rate = (moved - eases) / 1e-6
    bend = (eases[0] - 2.0 * eases[1] + eases[2]) / 2e-4**2
    expected = -(rate[2] - rate[0]) / 4e-4 / bend
    contacts = [
        exact_contact(
            flanks.conjugate,
            rotation / flanks.conjugate.axes.ratio,
            start_values(lines, rotation, station, lag),
            Misalignment(**{name: sign * step}),
        )
        for sign in (1.0, -1.0)
    ]
    places, turns = ((getattr(contacts[0], each) - getattr(contacts[1], each)) / (2.0 * step)
                     for each in ("places", "wheel_rotation"))  # fmt: skip
    assert places @ lines.along == pytest.approx(expected, rel=0.02)
    assert -flanks.conjugate.sense * turns == pytest.approx(rate[1], rel=2e-3)


def test_force_and_displacement_are_reciprocal(flanks):
    """From one potential: d(force along a displacement)/d(torque) is -d(lag)/d(displacement)."""
    loaded = hypoid_loaded_contact(flanks, 400.0, steps=16, cells=12)
    sense = {"left": 1.0, "right": -1.0}[flanks.blank.hand_pinion]
    turn = flanks.conjugate.sense

    def work(contact):
        force = contact.mesh_force
        pinion, wheel = (force[:, None] * each for each in
                         (contact.pinion_direction, contact.wheel_direction))  # fmt: skip
        # The gears' frames: x common, y of the pinion and z of the fixed one with the sense.
        return {
            "offset": -sense * pinion[:, 0],
            "pinion_axial": turn * pinion[:, 1],
            "wheel_axial": turn * wheel[:, 1],
            "shaft_angle": -wheel[:, 3],
        }

    up, down = loaded.under(400.4), loaded.under(399.6)
    # The other side takes one, as each needs two analyses.
    few = flanks.side == "drive"
    for name, step in list(STEPS.items())[3 if few else 0 :]:
        force = (work(up)[name] - work(down)[name]) / (0.8 * flanks.blank.ratio)
        lags = [
            hypoid_loaded_contact(
                flanks, 400.0, misalignment=Misalignment(**{name: sign * 0.1 * step}),
                steps=16, cells=12,
            ).loaded_rotation
            for sign in (1.0, -1.0)
        ]  # fmt: skip
        lag = (lags[0] - lags[1]) / (0.2 * step)
        scale = np.abs(lag).max()
        assert scale > 0.0
        assert force == pytest.approx(-lag, abs=2e-3 * scale), name


def test_a_study_has_the_contact_of_each_case():
    flanks = eased()
    cases = [
        Misalignment(),
        Misalignment(offset=40e-6),
        Misalignment(shaft_angle=math.radians(0.03)),
    ]
    study = misalignment_study(flanks, cases)
    nominal = tooth_contact(flanks)
    assert np.array_equal(study.contacts[0].clearance, nominal.clearance)
    assert study.along[0] == nominal.along[nominal.leads].mean()
    assert study.peak_to_peak[0] == nominal.peak_to_peak
    assert study.offset.tolist() == [0.0, 40e-6, 0.0]
    moved = np.hypot(
        np.diff(study.along[[0, 1, 0, 2]])[::2], np.diff(study.across[[0, 1, 0, 2]])[::2]
    )
    assert np.all(moved > 1e-3)
    assert np.all((study.edge_share >= 0.0) & (study.edge_share <= 1.0))
    figure = study.plot()
    patterns = [trace for trace in figure.data if trace.fill == "toself"]
    assert [trace.name for trace in patterns] == ["nominal", "V +40 µm", "α +1.8 arcmin"]
    assert np.nanmean(patterns[1].x) != pytest.approx(np.nanmean(patterns[0].x), abs=0.2)
    with pytest.raises(InputError, match="one Misalignment for each case"):
        misalignment_study(flanks, [])
