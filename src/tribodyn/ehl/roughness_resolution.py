"""Whether a grid resolves the waves of a roughness profile."""

from __future__ import annotations

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.errors import warn

#: Grid points that a wavelength needs, and the share of the mean square that may lie below.
_POINTS, _SHARE = 16, 0.02


def warn_if_unresolved(profile: RoughnessProfile, spacing: float, stacklevel: int = 2) -> None:
    """Warn where a grid does not resolve the waves of a profile."""
    shortest = _POINTS * spacing
    share = profile.short_wave_share(shortest)
    if share > _SHARE:
        warn(
            "roughness-resolution",
            f"{share:.1%} of the mean square roughness lies in waves shorter than "
            f"{shortest * 1e6:.3g} um, which have fewer than {_POINTS} nodes a wavelength at a "
            f"spacing of {spacing * 1e6:.3g} um. Take more nodes, or profile.filtered("
            f"{shortest:.2g})",
            stacklevel=stacklevel + 1,
        )
