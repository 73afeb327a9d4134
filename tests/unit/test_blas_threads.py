"""The linear algebra has one thread where threads or small matrices are ours, else what it had."""

import threading

import numpy as np
import pytest
import scipy.linalg
from threadpoolctl import threadpool_info, threadpool_limits

from tribodyn.gear import Material, SpurGear
from tribodyn.interrupt import in_threads, single_blas_thread
from tribodyn.stiffness.fe3d import ring
from tribodyn.stiffness.fe3d.provider import fe3d_influence


def counts():
    return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def three_threads():
    scipy.linalg.inv(np.eye(2))
    with threadpool_limits(3, "blas"):
        if counts() != {3}:
            pytest.skip("this linear algebra has no threads to set")
        yield
        assert counts() == {3}


def test_our_threads_meet_one_of_the_linear_algebra():
    assert in_threads(lambda _: counts(), range(3), 2) == [{1}] * 3
    with pytest.raises(ZeroDivisionError):
        in_threads(lambda each: 1 / each, [1, 0], 2)


def test_the_limit_lasts_until_the_last_block_ends():
    entered, leave, after = (threading.Event() for _ in range(3))

    def other():
        with single_blas_thread():
            entered.set()
            leave.wait(10.0)
        after.set()

    thread = threading.Thread(target=other)
    with single_blas_thread():
        thread.start()
        assert entered.wait(10.0)
    assert counts() == {1}
    leave.set()
    assert after.wait(10.0)
    thread.join()
    assert counts() == {3}


def test_teeth_are_computed_with_one(monkeypatch):
    seen, inverse = [], ring.np.linalg.inv
    monkeypatch.setattr(ring.np.linalg, "inv", lambda m: (seen.append(counts()), inverse(m))[1])
    gear = SpurGear(
        teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
        profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03,
    )  # fmt: skip
    fe3d_influence(gear, Material(), cache=False)
    assert seen
    assert all(each == {1} for each in seen)
