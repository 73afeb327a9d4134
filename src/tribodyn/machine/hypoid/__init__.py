"""Machines of hypoid and bevel pairs."""
