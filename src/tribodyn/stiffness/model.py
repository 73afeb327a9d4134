"""Interface of stiffness models, and the registry that selects them by name.

A model returns the stiffness of each tooth pair over one mesh cycle. All models have the same
interface, so the mesh table does not depend on the model.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import ComputationError, InputError, ModelOption, Problem
from tribodyn.gear import Material, SpurPair
from tribodyn.model import Model, Registry, choice
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.types import Array, ByName, Mask


class MeshState(NamedTuple):
    """Mesh states to evaluate: the positional arguments of :class:`StiffnessModel`."""

    pair: SpurPair
    material: Material
    path: Array  #: positions on the line of action, from the smaller gear (n, pairs) [m]
    in_contact: Mask
    phase: Array  #: (n,)
    normal_force: float  #: of all pairs together [N]


@dataclass(frozen=True)
class StiffnessModel(Model):
    """One named model of tooth pair stiffness.

    Parameters
    ----------
    name : str
        Name in case files.
    function : callable
        ``function(pair, material, path, in_contact, phase, normal_force, /, **options)``.
    options : mapping of str to Option or default
        Accepted options; afterwards their defaults, ``None`` where the user must give a value, or
        one of several values. ``declared`` holds their descriptions.
    influence : callable, optional
        ``influence(gear, material, *, reference)``: the structure of one gear, of models that
        know it; these carry contacts anywhere on the flank, and deviations of the flanks.
    over_face : bool
        Whether that structure is known over the face width, so that slices act on each other.
    external_only : bool
        Whether it does not know internal teeth.
    coupled : bool
        Whether pairs act on each other through the gear bodies; such a model is always solved
        by the loaded tooth contact.
    source : str
        Paper behind the model.
    meaning : str
        One line for whoever chooses a model.
    papers : tuple of str
        Keys of the bibliography of the package.
    """

    name: str
    function: Callable[..., Array]
    options: ByName
    influence: Callable[..., GearInfluence | FaceInfluence] | None = None
    over_face: bool = False
    external_only: bool = False
    coupled: bool = False
    source: str = ""
    meaning: str = ""
    papers: tuple[str, ...] = ()

    def __call__(
        self,
        pair: SpurPair,
        material: Material,
        path: Array,
        in_contact: Mask,
        phase: Array,
        normal_force: float,
        /,
        **options: Any,
    ) -> Array:
        """Return the pair stiffness over the mesh cycle.

        Parameters
        ----------
        pair : SpurPair
            Both gears in their working position.
        material : Material
            Material of both gears.
        path : array (n, pairs) [m]
            Distance of each contact from the base tangent point of the smaller gear.
        in_contact : bool array (n, pairs)
            Whether the pair is in contact.
        phase : array (n,)
            Mesh phase.
        normal_force : float [N]
            Force along the line of action that all pairs carry together.
        **options : object
            Options of this model, see ``options``; ``None`` counts as not given.

        Returns
        -------
        array (n, pairs) [N/m]
            Secant stiffness of each pair at its quasi-static load, zero where not in contact.

        Raises
        ------
        InputError
            If an option is unknown, missing or out of range.
        """
        supplied = {name: value for name, value in options.items() if value is not None}
        unknown = [name for name in supplied if name not in self.options]
        if unknown:
            raise InputError([self._unknown(name) for name in unknown])
        self.require_known_teeth(pair)
        return self.function(
            pair, material, path, in_contact, phase, normal_force, **{**self.options, **supplied}
        )

    def require_known_teeth(self, pair: SpurPair) -> None:
        """Refuse internal teeth where the model knows external ones alone.

        Parameters
        ----------
        pair : SpurPair
            Both gears in their working position.

        Raises
        ------
        InputError
            If it does not know the teeth of the pair.
        """
        if self.external_only and pair.is_internal:
            raise InputError(
                f'the stiffness model "{self.name}" of a pair with internal teeth',
                where=ModelOption("stiffness", self.name),
                why="It describes teeth that grow thinner outwards, not those of a ring",
                remedy='Choose "fe2d", "fe3d" or "iso6336", or give the stiffness',
            )

    def _unknown(self, name: str) -> Problem:
        names = ", ".join(self.options)
        return Problem(
            what=f'the stiffness model "{self.name}" has no option "{name}"',
            where=ModelOption("stiffness", name=name),
            why=f"Its options are: {names}",
            remedy=self.nearest(name) or "Choose one of these, or leave it out",
        )


MODELS: Registry[StiffnessModel] = Registry("stiffness model", "tribodyn.stiffness", StiffnessModel)


def reference_option(default: str) -> Any:
    """Option of models that know the body of a gear."""
    return choice(
        default,
        {
            "bore": "deflection is measured against the bore, the wind-up of the gear body "
            "included",
            "rim": "deflection is measured against the body under the teeth",
        },
        meaning="body against which deflection is measured",
    )


def share_equally(total: Array, in_contact: Mask) -> Array:
    """Distribute the mesh stiffness evenly over the pairs in contact."""
    return np.where(in_contact, (total / in_contact.sum(axis=1))[:, None], 0.0)


def usable_stiffness(values: Array, in_contact: Mask, model: str) -> Array:
    """Check the result of a stiffness model, including those of third parties."""
    stiffness = np.asarray(values)
    sound = stiffness.shape == in_contact.shape and bool(
        np.all(np.where(in_contact, np.isfinite(stiffness) & (stiffness > 0.0), stiffness == 0.0))
    )
    if not sound:
        what = f'the stiffness model "{model}" returned an unusable pair stiffness'
        why = "It must be finite and positive where a pair is in contact, zero elsewhere"
        remedy = "Check the options of the model, or choose another"
        raise ComputationError(what, "stiffness of the tooth pairs", why, remedy)
    return stiffness
