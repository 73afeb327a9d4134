"""Faults in a case: their tables, the motion over whole turns, recordings of a sensor."""
