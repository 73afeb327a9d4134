"""Machines in the modes of their structure: many linear coordinates, few contacts.

| module | content |
|---|---|
| ``closed_structure`` | the linear structure with its contacts closed, by its modes: receptances |
| ``contact_equations`` | forces of all contacts over a period, their tangent, sides and jumps |
| ``modal_kernel`` | compiled time integration in modal coordinates |
| ``modal_step`` | its steps and parts of steps, and the structures that it reads |
| ``modal_march`` | that integration for one system at any speed |
"""
