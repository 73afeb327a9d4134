"""Periodic and transient motions of machines: many linear coordinates, few contacts.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``closed_structure`` | the linear structure with its contacts closed, by its modes: receptances |
| ``contact_equations`` | forces of all contacts over a period, their tangent, sides and jumps |
| ``harmonic_balance`` | the periodic motion at one frequency of the clock |
| ``modal_kernel``, ``modal_march`` | time integration in modal coordinates |
| ``newton`` | Newton's method with Krylov solutions for the residual over a period |
| ``orbit_response`` | the response from the harmonics of a motion |
"""
