"""Figures of machines: side and front view, power, natural modes, orders, forces on bearings."""
