"""What machines of equal parts have at rest under one torque, which their speed does not change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.memory import Memo
from tribodyn.errors import ModelWarning, collected, warn
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import mean_over_phase
from tribodyn.machine.reduction import Parts
from tribodyn.machine.static.balance import StaticBalance, static_balance
from tribodyn.machine.static.static_model import MeshLaw
from tribodyn.machine.structure import MachineStructure
from tribodyn.types import Array


class AtRest:
    """Balances and matrices of machines that differ in speed, torque and teeth alone."""

    def __init__(self) -> None:
        self._balances: Memo[tuple[StaticBalance, list[ModelWarning]]] = Memo(4)
        self._parts: Memo[Parts] = Memo(2)

    def balance(self, machine: Machine, laws: Mapping[str, MeshLaw]) -> StaticBalance:
        """Static balance with laws of the meshes, see :func:`static_balance`."""

        def compute() -> tuple[StaticBalance, list[ModelWarning]]:
            with collected() as caught:
                return static_balance(machine, laws=laws), caught

        numbers = [number for law in laws.values() for number in vars(law).values()]
        numbers += [float(mesh.stiffness is None) for mesh in machine.meshes.values()]
        # On crossed axes the law of a mesh has no such numbers.
        shared = len(laws) == len(machine.meshes)
        key = _numbers(machine, numbers)
        static, caught = self._balances.get(key, compute) if shared else compute()
        for each in caught:
            warn(each.code, each.message, affected=each.affected)
        return replace(static, machine=machine)

    def parts(self, machine: Machine, damping_ratio: float, frame: str | None) -> Parts:
        """Matrices of the machine, whose bearings are springs."""
        laws = [mesh.stiffness for mesh in machine.meshes.values()]
        numbers: list[ArrayLike] = [np.nan if k is None else mean_over_phase(k) for k in laws]
        for bearing in machine.bearings.values():
            numbers += [bearing.stiffness_matrix, bearing.rest_load]

        def compute() -> Parts:
            return Parts(MachineStructure(machine, damping_ratio, frame=frame))

        return self._parts.get(_numbers(machine, numbers), compute)


def _numbers(machine: Machine, numbers: Sequence[ArrayLike]) -> tuple[Array]:
    """Numbers of a machine, with its torque and the sense in which it turns."""
    run, carried = machine.operation, any(part.carrier for part in machine.bearings.values())
    turning = run.speed if carried else np.sign(run.speed)  # planets pull outwards
    shares = [machine._sharing.get(name, np.inf) for name in machine.meshes]
    every = run.torque, turning, *shares, *numbers
    return (np.concatenate([np.ravel(each) for each in every]),)
