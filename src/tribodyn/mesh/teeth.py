"""The teeth of a mesh under load, with or without an oil film in series with each pair."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tribodyn.contact import PathOfContact
from tribodyn.gear import Material
from tribodyn.stiffness import MODELS, ContactProblem, mesh_problem
from tribodyn.stiffness.model import usable_stiffness
from tribodyn.types import Array, Mask

#: A pair that is kept apart has the film and the friction of this part of the load of all.
LEAST_SHARE = 1e-3


class Carried(NamedTuple):
    """How a mesh carries its quasi-static load."""

    stiffness: Array  #: [N/m]
    share: Array  #: part of the total force on each pair on the path of contact
    corner_share: Array  #: the same on tip corners before A, and after E
    transmission_error: Array  #: approach along the line of action, deviations included [m]
    tangent: Array  #: slope of the total force over it [N/m]


@dataclass(frozen=True, eq=False)
class Teeth:
    """Teeth of all pairs over one mesh cycle; made by :func:`teeth_of`."""

    in_contact: Mask  #: which pairs are on the path of contact
    total_force: float  #: normal force of all pairs [N]
    stiffness: Array | None  #: secant stiffness of pairs that are springs of their own [N/m]
    problem: ContactProblem  #: the loaded tooth contact at the same phases

    def carried(self, film_stiffness: Array | None = None) -> Carried:
        """Share the load among the pairs."""
        if self.stiffness is None:
            return self._together(self.with_film(film_stiffness))
        each = self.stiffness
        if film_stiffness is not None:
            each = np.zeros(self.stiffness.shape)
            touch = self.in_contact
            each[touch] = 1.0 / (1.0 / self.stiffness[touch] + 1.0 / film_stiffness[touch])
        whole = each.sum(axis=1)
        share = each / whole[:, None]
        problem = self.with_film(film_stiffness)
        load = share * self.total_force / problem.widths.sum()
        return Carried(
            each,
            share,
            np.zeros((whole.size, 2)),
            self.total_force / whole,
            problem.tangent_at(load),
        )

    def with_film(self, film_stiffness: Array | None) -> ContactProblem:
        """Put the films in series with the teeth."""
        if film_stiffness is None:
            return self.problem
        entering, leaving = self._ends()
        film = np.where(self.in_contact, film_stiffness, film_stiffness[leaving])
        if self._extended:
            first = np.full((film.shape[0], 1), film_stiffness[entering])
            film = np.concatenate([first, film, np.full_like(first, film_stiffness[leaving])], 1)
        return self.problem.with_film(film)

    @property
    def _extended(self) -> bool:
        return bool(self.problem.gaps.shape[2] > self.in_contact.shape[1])

    def _ends(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """Row and column of the pair at A, and of the pair at E."""
        last = int(np.flatnonzero(self.in_contact.any(axis=0))[-1])
        return (0, 0), (int(np.flatnonzero(self.in_contact[:, last])[-1]), last)

    def _together(self, problem: ContactProblem) -> Carried:
        found = problem.at_loads(np.array([self.total_force]))
        force = np.einsum("s,psn->pn", problem.widths, found.load[0])
        inner = force[:, 1:-1] if self._extended else force
        on_path = np.where(self.in_contact, inner, 0.0)
        deflection = found.approach[0] - problem.least_gap
        places, contact = problem.places, problem.places.contact
        early = places.direction * (2.0 * places.path - contact.A - contact.E) < 0.0
        corners = force.copy()
        (corners[:, 1:-1] if self._extended else corners)[self.in_contact] = 0.0
        corner = [np.where(side, corners, 0.0).sum(axis=1) for side in (early, ~early)]
        return Carried(
            stiffness=on_path / deflection[:, None],
            share=on_path / self.total_force,
            corner_share=np.stack(corner, axis=1) / self.total_force,
            transmission_error=found.approach[0],
            tangent=found.tangent[0],
        )

    @property
    def least_share(self) -> float:
        """Part of the load for which film and friction of a pair are found at least."""
        return 0.0 if self.stiffness is not None else LEAST_SHARE

    @property
    def bends(self) -> tuple[float, ...]:
        """Mesh phases, no events, at which a pair begins or ceases to carry."""
        if self.stiffness is not None:
            return ()
        carries = self.problem.at_loads(np.array([self.total_force])).load[0].any(axis=1)
        phase = self.problem.places.phase
        turns = (carries[1:] != carries[:-1]).any(axis=1) & (np.diff(phase) > 0.0)
        return tuple(float(bend) for bend in 0.5 * (phase[1:] + phase[:-1])[turns])

    @property
    def maximum_single_pair_stiffness(self) -> float:
        """Greatest stiffness of one pair that carries the whole force alone [N/m]."""
        parts, width = self.problem.compliance, float(self.problem.widths.sum())
        own = np.diagonal(parts.structure, axis1=1, axis2=2)
        local = parts.local - parts.logarithm * np.log(self.total_force / width)
        alone = width / (own + local)
        return float(alone[self.problem.places.on_path].max())


def teeth_of(
    contact: PathOfContact,
    places: tuple[Array, Array, Mask],
    material: Material,
    total_force: float,
    model: str,
    options: Mapping[str, Any],
) -> Teeth:
    """Teeth of a mesh by a named stiffness model."""
    chosen, pair = MODELS[model], contact.pair
    phase, path, in_contact = places
    given = {**chosen.options, **options}
    problem = mesh_problem(
        pair,
        provider=model,
        places=places,
        total_force=total_force,
        extended_contact=bool(given.get("extended_contact", False)),
        material=material,
        options=options,
    )
    stiffness = None
    if not chosen.coupled and not pair.has_modification:
        if chosen.influence is None:
            own = np.diagonal(problem.compliance.structure, axis1=1, axis2=2)
            stiffness = np.where(in_contact, pair.common_face_width / own, 0.0)
        else:
            found = chosen(pair, material, path, in_contact, phase, total_force, **options)
            stiffness = usable_stiffness(found, in_contact, model)
    return Teeth(in_contact, total_force, stiffness, problem)
