"""What a diagram says: verdicts, step limit, periods, jumps, two motions, in display units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tribodyn as td
from tribodyn.analysis import Bifurcation
from tribodyn.study.studies.bifurcation import Findings


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-roughness")


def diagram(count=10, branches=("up",)):
    """Motions of period 1 whose rms rises slowly, between 1000 and 1900 rpm."""
    shape = (len(branches), count)
    rpm = 1000.0 + 100.0 * np.arange(count)
    rms = np.tile(1e-6 * (1.0 + 0.01 * np.arange(count)), (len(branches), 1))
    return Bifurcation(
        parameter=rpm * np.pi / 30.0, parameter_name="operation.speed", parameter_unit="rad/s",
        mesh_frequency=rpm * 16.0 / 60.0, branches=branches, signal="contact 0",
        section=np.zeros((*shape, 4)), period=np.ones(shape, dtype=int), rms=rms,
        contact_loss_share=np.zeros(shape), step_number=np.full(count, 0.5),
        steps=np.full(count, 512), verdict=np.full(shape, "physical", dtype="<U12"),
        refined_period=np.ones(shape, dtype=int), refined_rms=rms,
        refined_steps=np.full(count, 1024), largest_exponent=np.full(shape, np.nan),
        finished=np.ones(shape, dtype=bool),
    )  # fmt: skip


def test_a_quiet_diagram(case):
    findings = Findings(case, diagram())
    assert findings.sentences() == [
        "10 motions: 10 physical",
        "up: period 1 from 1000 rpm to 1900 rpm",
    ]
    assert findings.lead() == "10 values of operation.speed from 1000 rpm to 1900 rpm"
    head, rows = findings.rows()
    assert head[0] == "speed [rpm]"
    assert rows[3][:4] == ["1300", "up", "1", "1.03"]
    assert findings.figures()["jumps"] == []


def test_step_limit_names_its_onset_and_the_motions_of_shorter_steps(case):
    plain = diagram()
    verdict, period = plain.verdict.copy(), plain.period.copy()
    verdict[0, 6:], period[0, 8:] = "step-limited", 0
    number = np.where(np.arange(10) >= 6, 2.75, 2.5)
    findings = Findings(case, replace(plain, verdict=verdict, period=period, step_number=number))
    text = "\n".join(findings.sentences())
    assert "step-limited from 1600 rpm on: omega_max dt = 2.75 with 512 steps" in text
    assert "with 1024 steps the motion has period 1" in text
    assert "from 1800 rpm on" in text
    # what the step made is no period of the motion
    assert "up: period 1 from 1000 rpm to 1500 rpm" in text
    assert "no period" not in text
    assert findings.figures()["step_limited_onset"] == pytest.approx(1600.0 * np.pi / 30.0)


def test_periods_jumps_and_two_motions(case):
    plain = diagram(branches=("up", "down"))
    period, rms = plain.period.copy(), plain.rms.copy()
    period[0, 4:6], period[0, 7] = 2, 0
    rms[0, 5:] *= 2.0
    rms[1, 3:] *= 2.0
    loss = np.full_like(rms, 0.1)
    findings = Findings(case, replace(plain, period=period, rms=rms, contact_loss_share=loss))
    sentences = findings.sentences()
    assert "up: period 2 from 1400 rpm to 1500 rpm" in sentences
    assert "up: no period within 16 mesh cycles at 1700 rpm" in sentences
    assert "up: the rms jumps between 1400 rpm and 1500 rpm, from 1.04 um to 2.1 um" in sentences
    assert "down: the rms jumps between 1200 rpm and 1300 rpm, from 1.02 um to 2.06 um" in sentences
    assert "two motions are possible from 1300 rpm to 1400 rpm: up and down differ" in sentences
    assert [jump["branch"] for jump in findings.figures()["jumps"]] == ["up", "down"]
    rms = plain.rms.copy()
    rms[1, -2:] *= 2.0
    sentences = "\n".join(Findings(case, replace(plain, rms=rms)).sentences())
    assert "up and down differ; the range ends there, and they may go on beyond it" in sentences


def test_the_title_of_the_figure_names_the_main_finding():
    plain = diagram(branches=("up", "down"))
    rms, period, verdict = plain.rms.copy(), plain.period.copy(), plain.verdict.copy()

    def title():
        diagram_ = replace(plain, rms=rms, period=period, verdict=verdict)
        return diagram_.plot().layout.title.text

    assert title() == "Every response has a period of one mesh cycle"
    period[0, 7] = 2
    assert title() == "Periods of up to 2 mesh cycles"
    rms[1, 3:5] *= 2.0
    assert title() == (
        "Two responses coexist from 1300 rpm to 1400 rpm; periods of up to 2 mesh cycles"
    )
    verdict[0, 7] = "step-limited"  # its period counts no longer
    assert title().endswith("1400 rpm; 1 of 20 depend on the time step")
    verdict[:, 5:] = "step-limited"
    assert title() == "10 of 20 responses depend on the time step and are not physical"


def test_diverged_motions_are_reported(case):
    plain = diagram(branches=("up", "down"))
    rms, period, verdict = plain.rms.copy(), plain.period.copy(), plain.verdict.copy()
    rms[0, 6:], period[0, 6:], verdict[0, 6:] = np.nan, 0, "undecided"
    verdict[0, 9] = "step-limited"  # with half the step this one does not
    runaway = replace(plain, rms=rms, period=period, verdict=verdict)
    assert runaway.ran_away.sum() == 3
    assert repr(runaway).endswith("3 undecided, 3 ran away)")
    assert runaway.plot().layout.title.text.startswith("3 of 20 responses grow without bound")
    findings = Findings(case, runaway)
    text = "\n".join(findings.sentences())
    assert "up: 3 motions grew beyond all bounds from 1600 rpm to 1800 rpm" in text
    assert "down: period 1 from 1000 rpm to 1900 rpm" in text
    assert "no period" not in text
    assert "nan" not in text
    assert findings.figures()["ran_away"] == 3
    _, rows = findings.rows()
    assert rows[12][:5] == ["1600", "up", "none", "ran away", ""]
    assert Findings(case, plain).figures()["ran_away"] == 0


def test_a_resonance_is_no_jump(case):
    plain = diagram(40)
    speed = np.arange(40.0)
    peak = 1e-6 / np.hypot(1.0 - (speed / 20.0) ** 2, 0.1)
    assert Findings(case, replace(plain, rms=peak[None])).figures()["jumps"] == []


def test_flanks_in_touch_do_not_jump(case):
    plain = diagram()
    rms, loss = plain.rms.copy(), np.zeros_like(plain.rms)
    rms[0, 5:] *= 2.0  # a resonance between two points
    flat = replace(plain, rms=rms, contact_loss_share=loss)
    assert Findings(case, flat).figures()["jumps"] == []
    loss[0, 5:] = 0.1
    assert len(Findings(case, flat).figures()["jumps"]) == 1


def test_interrupted_diagram_counts_finished_motions(case):
    plain = diagram()
    finished, verdict = plain.finished.copy(), plain.verdict.copy()
    finished[0, 7:], verdict[0, 5:] = False, ""
    findings = Findings(case, replace(plain, finished=finished, verdict=verdict))
    assert findings.sentences()[0] == "7 motions: 5 physical, 2 not judged"
    assert len(findings.rows()[1]) == 7
    assert findings.figures()["finished"] == 7
