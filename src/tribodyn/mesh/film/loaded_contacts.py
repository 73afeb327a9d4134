"""Contacts that share a load, and their motion: tooth pairs of cylindrical gears, hypoid cells."""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Protocol, TypeVar

from tribodyn.types import Array, Mask


class FilmSprings(NamedTuple):
    """Films of the pairs on the path of contact (n, pairs), linear about their loads."""

    stiffness: Array  #: zero where a pair is not in contact [N/m]
    lead: Array | None  #: distance of the flanks at which each begins to carry [m]


class ContactMotion(Protocol):
    """Motion of the flanks at contacts, of cylindrical teeth or of cells of hypoid ones."""

    @property
    def equivalent_radius(self) -> Array:
        """Radius of relative curvature across the line of contact [m]."""

    @property
    def sliding_speed(self) -> Array:
        """Speed of the pinion's surface over that of the wheel [m/s]."""

    @property
    def entrainment_speed(self) -> Array:
        """Half the sum of both surface speeds [m/s]."""

    @property
    def slide_to_roll_ratio(self) -> Array:
        """Sliding over entrainment speed."""


class PairShare(Protocol):
    """How contacts share a load."""

    @property
    def share(self) -> Array:
        """Part of the total force on each contact."""


Share = TypeVar("Share", bound=PairShare, covariant=True)


class LoadedTeeth(Protocol[Share]):
    """Contacts that share a load: pairs of cylindrical teeth, cells of hypoid ones."""

    coupled: ClassVar[bool]  #: solved together

    @property
    def in_contact(self) -> Mask:
        """Which contacts (n, contacts) can carry."""

    @property
    def normal_force(self) -> float:
        """Force of all contacts together [N]."""

    @property
    def face_width(self) -> float:
        """Face width in contact [m]."""

    @property
    def face_widths(self) -> Array:
        """Width of each contact [m]."""

    @property
    def load_per_width(self) -> Array | float:
        """The whole force per width of each contact [N/m]."""

    @property
    def least_load(self) -> float:
        """Load for which films and friction are computed at least [N/m]."""

    @property
    def dry_load(self) -> Array:
        """Load per width of every contact without films [N/m]."""

    def shared_load(self, film: FilmSprings | None = None) -> Share:
        """Share the load, each contact with its film in series."""
