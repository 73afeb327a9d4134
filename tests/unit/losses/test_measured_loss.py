"""Friction from measured losses: round trips, conditioning, and what is wrong with a table."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning, quiet
from tribodyn.friction import measured
from tribodyn.losses import (
    PowerLossTable,
    friction_from_power_loss,
    power_loss_table,
    read_power_loss_table,
)

H = 0.3024
RPM = math.pi / 30.0
TORQUES, MU = np.array([50.0, 150.0, 300.0]), np.array([0.04, 0.05, 0.06])


def table(noise=0.0, repeats=1, seed=0, idle=1.0, **more):
    """Readings of three torques and without load, at 1400 rpm."""
    torque = np.repeat([5.0, *TORQUES], repeats)
    loss = np.repeat([idle, *(idle + MU * TORQUES * H)], repeats)
    loss = loss + noise * np.random.default_rng(seed).standard_normal(loss.size)
    return PowerLossTable(np.full(loss.size, 1400.0 * RPM), torque, loss, H, **more)


def test_exact_readings_give_back_the_friction():
    result = friction_from_power_loss(table(torque_loss_uncertainty=0.0))
    assert result.friction_coefficient == pytest.approx(MU, rel=1e-12)
    assert result.standard_uncertainty == pytest.approx([0.0] * 3)
    assert result.verdict == ("sound",) * 3


def test_conditioning_of_low_torque():
    result = friction_from_power_loss(table(torque_loss_uncertainty=0.1))
    per_tenth = 0.1 * result.sensitivity
    assert per_tenth == pytest.approx(0.1 / (TORQUES * H), rel=1e-12)
    assert per_tenth[[0, 2]] == pytest.approx([0.0066, 0.0011], abs=5e-5)
    assert per_tenth[0] / 0.0271 == pytest.approx(0.24, abs=5e-3)
    assert result.standard_uncertainty == pytest.approx(math.sqrt(2.0) * per_tenth, rel=1e-12)
    assert result.verdict[0].startswith("uncertain: 23 %")
    assert result.verdict[1:] == ("sound", "sound")
    worse = friction_from_power_loss(table(torque_loss_uncertainty=0.2)).verdict[0]
    assert worse == "ill-conditioned: 47 % standard uncertainty"


@pytest.mark.parametrize(("repeats", "uncertainty"), [(1, 0.05), (4, None)])
def test_band_holds_the_truth_in_95_of_100(repeats, uncertainty):
    inside = np.zeros(3)
    trials = 1000
    for seed in range(trials):
        rows = table(0.05, repeats, seed, torque_loss_uncertainty=uncertainty)
        with quiet():
            result = friction_from_power_loss(rows, draws=2)
        inside += (result.low <= MU) & (result.high >= MU)
    # 1000 trials scatter by 0.7 %; the effective degrees of freedom are on the safe side.
    assert np.all(inside / trials > 0.93)
    assert np.all(inside / trials < 0.98)


def test_first_order_and_drawn_uncertainty_agree():
    rows = table(
        torque_loss_uncertainty=0.05, torque_uncertainty=0.5, other_loss=0.1,
        other_loss_uncertainty=0.03, gear_loss_factor_uncertainty=0.005,
    )  # fmt: skip
    result = friction_from_power_loss(rows, draws=200_000)
    assert result.monte_carlo_uncertainty == pytest.approx(result.standard_uncertainty, rel=0.01)
    mu, u = result.friction_coefficient, result.standard_uncertainty
    parts = (0.05**2 * 2.0 + 0.03**2) / (TORQUES * H) ** 2
    parts += mu**2 * ((0.5 / TORQUES) ** 2 + (0.005 / H) ** 2)
    assert u == pytest.approx(np.sqrt(parts), rel=1e-12)
    assert np.all(np.isinf(result.degrees_of_freedom))


def test_repeats_tell_their_scatter():
    rows = PowerLossTable([100.0] * 4, [5.0, 5.0, 100.0, 100.0], [1.0, 1.2, 3.0, 3.4], H)
    result = friction_from_power_loss(rows)
    assert result.friction_coefficient == pytest.approx((3.2 - 1.1) / (100.0 * H))
    variance = (0.2**2 / 4.0 + 0.4**2 / 4.0) / (100.0 * H) ** 2
    assert result.standard_uncertainty == pytest.approx(math.sqrt(variance))
    freedom = (0.2**2 + 0.4**2) ** 2 / (0.2**4 + 0.4**4)
    assert result.degrees_of_freedom == pytest.approx(freedom)


def test_equal_slave_gears_halve_the_friction():
    result = friction_from_power_loss(table(torque_loss_uncertainty=0.1, gear_sets=2.0))
    assert result.friction_coefficient == pytest.approx(0.5 * MU)


def test_factors_of_the_printed_points():
    rows = power_loss_table("fzg-wheel-driven")
    result = friction_from_power_loss(rows)
    points = {
        (round(torque), round(speed / RPM)): mu
        for torque, speed, mu in zip(
            result.torque, result.speed, result.friction_coefficient, strict=True
        )
    }
    # 339 % from 50 to 300 N*m, -63.2 % from 400 to 1800 rpm, as printed.
    assert points[300, 1400] / points[50, 1400] - 1.0 == pytest.approx(3.39, abs=5e-3)
    assert points[150, 1800] / points[150, 400] - 1.0 == pytest.approx(-0.632, abs=5e-4)
    assert result.verdict[0].startswith("ill-conditioned")
    for (torque, speed), mu in points.items():
        assert measured(float(torque), speed * RPM) == pytest.approx(mu, rel=1e-9)
    assert "neither is printed" in rows.source
    with pytest.raises(InputError, match="fzg-wheel-driven"):
        power_loss_table("fzg")


def test_a_run_without_load_still_rubs():
    """What is taken off holds the friction of its own torque: 5/50 of it at 50 N*m."""
    torque = np.array([5.0, *TORQUES])
    rows = PowerLossTable(
        np.full(4, 100.0), torque, 1.0 + 0.05 * torque * H, H, torque_loss_uncertainty=0.0
    )
    result = friction_from_power_loss(rows)
    assert result.friction_coefficient == pytest.approx(0.05 * (1.0 - 5.0 / TORQUES), rel=1e-12)


def rows_of(speed, torque, loss, **more):
    return PowerLossTable(np.array(speed) * RPM, torque, loss, H, **more)


def test_every_row_without_idle_run_is_reported():
    rows = rows_of([400, 400, 800, 1400], [5.0, 150.0, 150.0, 150.0], [1.0, 4.0, 4.0, 4.0],
                   torque_loss_uncertainty=0.1)  # fmt: skip
    with pytest.raises(InputError, match="no run without load at 800 rpm") as caught:
        friction_from_power_loss(rows)
    assert [problem.where for problem in caught.value.problems] == ["row 3", "row 4"]
    assert "400 rpm" in str(caught.value)


def test_loss_below_the_idle_loss_is_reported_with_its_row():
    rows = rows_of([400, 400, 400], [5.0, 50.0, 150.0], [2.0, 1.0, 4.0],
                   torque_loss_uncertainty=0.05)  # fmt: skip
    with pytest.raises(InputError, match=r"row 2.*1 N\*m is below the 2 N\*m without load"):
        friction_from_power_loss(rows)


def test_negative_friction_is_returned_with_a_warning():
    rows = rows_of([400, 400, 400], [5.0, 50.0, 150.0], [1.0, 1.2, 4.0], other_loss=0.5,
                   torque_loss_uncertainty=0.05)  # fmt: skip
    with pytest.warns(ModelWarning, match="friction-from-loss.*row 2 is not positive"):
        result = friction_from_power_loss(rows)
    assert result.friction_coefficient[0] == pytest.approx(-0.3 / (50.0 * H))
    assert result.verdict[0].startswith("negative")
    assert result.verdict[1] == "sound"


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (([400, 400], [5.0], [1.0, 2.0]), "2 of speed, 1 of torque"),
        (([400, 0], [5.0, 50.0], [1.0, 2.0]), "row 2: speed = 0"),
        (([400, 400], [5.0, 50.0], [math.nan, 2.0]), "row 1: torque_loss = nan"),
        (([400, 400], [5.0, -50.0], [1.0, 2.0]), "row 2: torque = -50"),
    ],
)
def test_bad_columns(columns, message):
    with pytest.raises(InputError, match=message):
        rows_of(*columns)


def test_one_reading_without_uncertainty_and_no_load_at_all():
    with pytest.raises(InputError, match="one reading at 50"):
        friction_from_power_loss(rows_of([400, 400], [5.0, 50.0], [1.0, 2.0]))
    with pytest.raises(InputError, match="no row has more than 5"):
        friction_from_power_loss(rows_of([400], [5.0], [1.0], torque_loss_uncertainty=0.1))


def test_csv_with_units_comments_and_other_columns(tmp_path):
    file = tmp_path / "losses.csv"
    file.write_text(
        "# a rig\nrun, speed [rpm], torque [N*m], torque_loss [N*mm]\n"
        "1, 1400, 5, 1000\n\n2, 1400, 150, 3268\n"
    )
    rows = read_power_loss_table(file, H, torque_loss_uncertainty=0.05)
    assert rows.speed == pytest.approx([1400.0 * RPM] * 2)
    assert friction_from_power_loss(rows).friction_coefficient == pytest.approx([0.05])


def test_columns_without_a_unit_are_reported(tmp_path):
    file = tmp_path / "losses.csv"
    file.write_text("speed\ttorque [N*m]\ttorque_loss\n150\t5\t1\n")
    with pytest.warns(ModelWarning, match=r"SI: speed in rad/s, torque_loss in N\*m"):
        assert read_power_loss_table(file, H).speed == pytest.approx([150.0])


def test_implausibly_high_friction_is_reported_with_its_row():
    rows = rows_of([400] * 3, [5.0, 50.0, 150.0], [1.0, 60.0, 4.0], torque_loss_uncertainty=0.05)
    with pytest.warns(ModelWarning, match=r"friction-from-loss.*row 2 \(3\.9.*above 0\.2"):
        result = friction_from_power_loss(rows)
    assert result.friction_coefficient[0] == pytest.approx(59.0 / (50.0 * H))
    assert result.verdict[0].startswith("implausible")
    assert result.verdict[1] == "sound"


def test_repeats_that_do_not_differ_tell_no_uncertainty():
    rows = rows_of([400] * 4, [5.0, 5.0, 50.0, 50.0], [1.0, 1.0, 1.4, 1.4])
    assert friction_from_power_loss(rows).verdict == (
        "unknown: the repeats do not differ, give torque_loss_uncertainty",
    )


_HEAD = "speed [rpm], torque [N*m], torque_loss [N*m]"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed [rpm], torque [N*m]\n1, 2\n", r"losses.csv:1: no column torque_loss"),
        ("speed [rpm], torque [N*m], torque_loss [N*m]\n1, x, 2\n1, 2\n", r"losses.csv:2: \"x\""),
        ("speed [m], torque [N*m], torque_loss [N*m]\n1, 2, 3\n", r'column "speed \[m\]"'),
        ("# nothing\n", "the table is empty"),
        (f"{_HEAD}\n1400,5,1,0\n1400,50,1.4\n", r"losses.csv:2: 4 cells below 3 columns"),
        (f"{_HEAD}\n1400; 5; 1\n", r'losses.csv:2: "1400; 5; 1" is not a number'),
        (_HEAD.replace(",", ";") + "\n1400;5;1,0\n", r'losses.csv:2: "1,0" is not a number'),
    ],
)
def test_bad_files_name_their_line(tmp_path, text, message):
    file = tmp_path / "losses.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=message):
        read_power_loss_table(file, H)


def test_no_file(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_power_loss_table(tmp_path / "none.csv", H)
