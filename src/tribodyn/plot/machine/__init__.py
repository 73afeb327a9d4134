"""Figures of machines: side view, power, natural modes, orders, forces on bearings."""
