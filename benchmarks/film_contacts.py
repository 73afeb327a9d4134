"""Contacts that the film is timed on: a random set like those of gears, and a study of one pair."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

# The readable rival is kept with the tests.
sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

from plain.film import PlainContact, PlainOil
from tribodyn.ehl import solve_line_contact_moes
from tribodyn.lubricant import Lubricant, from_library

__all__ = ["MODULUS", "MoesContact", "Study", "random_contacts", "random_si", "study", "twin"]

#: Steel on steel, ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2`` [Pa].
MODULUS = 2.2e11
_HIGHEST_PRESSURE = 2e9


@dataclass(frozen=True)
class MoesContact:
    """A contact by the numbers of Moes and its oil.

    Parameters
    ----------
    load, viscosity : float
        M and L.
    coefficient : float
        Pressure-viscosity coefficient [1/Pa].
    index : float
        Exponent z of the Roelands law.
    """

    load: float
    viscosity: float
    coefficient: float
    index: float

    @property
    def hertz_pressure(self) -> float:
        """Greatest pressure of the dry contact [Pa]."""
        return self.viscosity * math.sqrt(self.load / (2.0 * math.pi)) / self.coefficient

    def solve(self, nodes: int, method: str = "newton", **options: Any) -> Any:
        """Solve from a cold start, fully flooded.

        Parameters
        ----------
        nodes : int
        method : str
        **options
            More arguments of ``solve_line_contact_moes``.

        Returns
        -------
        LineContactSolution
        """
        return solve_line_contact_moes(
            self.load,
            self.viscosity,
            pressure_viscosity_coefficient=self.coefficient,
            pressure_viscosity_index=self.index,
            domain="auto",
            inlet="flooded",
            nodes=nodes,
            method=method,
            **options,
        )


def random_contacts(count: int, seed: int = 3) -> list[MoesContact]:
    """M 1..300 evenly in its logarithm, L 0..25 up to p_h = 2 GPa, alpha 12..30 1/GPa, z .45...75.

    Parameters
    ----------
    count : int
    seed : int

    Returns
    -------
    list of MoesContact
    """
    generator = np.random.default_rng(seed)
    found: list[MoesContact] = []
    for _ in range(count):
        load = math.exp(generator.uniform(0.0, math.log(300.0)))
        coefficient, index = generator.uniform(1.2e-8, 3e-8), generator.uniform(0.45, 0.75)
        highest = _HIGHEST_PRESSURE * coefficient / math.sqrt(load / (2.0 * math.pi))
        viscosity = generator.uniform(0.0, min(25.0, highest))
        found.append(MoesContact(load, viscosity, coefficient, index))
    return found


def twin(solution: Any) -> PlainContact:
    """The same contact on the same grid for the plain solver.

    Parameters
    ----------
    solution : LineContactSolution

    Returns
    -------
    PlainContact
    """
    grid = solution._grid
    oil = PlainOil(*(float(number) for number in grid.oil))
    return PlainContact(grid.n, solution.domain, grid.lam, oil, grid.load, grid.tail)


@dataclass(frozen=True)
class Study:
    """Contacts in SI: arrays of load per width, radius and speed, one oil.

    Parameters
    ----------
    load_per_width, equivalent_radius, entrainment_speed : array
        In N/m, m and m/s.
    lubricant : Lubricant
    """

    load_per_width: np.ndarray
    equivalent_radius: np.ndarray
    entrainment_speed: np.ndarray
    lubricant: Lubricant


def random_si(count: int, seed: int = 5) -> Study:
    """Gear contacts in SI: 20 to 500 N/mm, radii of 3 to 30 mm, 0.3 to 20 m/s.

    Parameters
    ----------
    count : int
    seed : int

    Returns
    -------
    Study
    """
    generator = np.random.default_rng(seed)
    low, high = np.log([[2e4, 3e-3, 0.3], [5e5, 3e-2, 20.0]])
    values = np.exp(generator.uniform(low, high, (count, 3)).T)
    return Study(*np.ascontiguousarray(values), from_library("80W"))


def study(positions: int = 30) -> Study:
    """FZG pair of 16/24 teeth along its path of contact at 3 torques and 6 speeds.

    Parameters
    ----------
    positions : int
        Points of the path.

    Returns
    -------
    Study
        Arrays of shape (18, positions).
    """
    base = np.array([33.829e-3, 50.7434e-3])
    line = float(base.sum() * math.tan(math.radians(22.44)))
    # Pinion arms from the first to the last contact; a single pair carries between the bases.
    arm = np.linspace(0.3244, 0.8455, positions) * base[0]
    radius = arm * (line - arm) / line
    pitch = math.pi * 4.5e-3 * math.cos(math.radians(20.0))
    shared = (arm < arm[-1] - pitch) | (arm > arm[0] + pitch)
    torque, speed = np.meshgrid([50.0, 150.0, 300.0], [400, 800, 1400, 1800, 3000, 3500.0])
    load = torque.reshape(-1, 1) / (base[1] * 20e-3) * np.where(shared, 0.5, 1.0)
    wheel = speed.reshape(-1, 1) * math.pi / 30.0
    rolling = 0.5 * wheel * ((line - arm) + arm * base[1] / base[0])
    return Study(load, np.broadcast_to(radius, load.shape), rolling, from_library("80W"))
