"""Gears that the tests of the mesh table share."""

from known_pairs import fzg, high_contact_pair, steel

__all__ = ["fzg", "high_contact_pair", "steel"]
