"""Compiled kernels of the line contact."""

from __future__ import annotations

__all__: list[str] = []
