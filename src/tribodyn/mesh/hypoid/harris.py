"""Static transmission error of a hypoid pair over phase and torque."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import one_or_more
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact
from tribodyn.stiffness import HarrisMap
from tribodyn.stiffness.loaded.result import harmonic_amplitudes

#: Mesh harmonics of a map.
_HARMONICS = 10


def hypoid_transmission_error_over_torque(
    loaded: HypoidLoadedContact, torque: ArrayLike
) -> HarrisMap:
    """Compute the static transmission error of a hypoid pair over phase and torque (Harris map).

    Parameters
    ----------
    loaded : HypoidLoadedContact
        The contact under any torque: its contact lines are those of all.
    torque : float or array (t,)
        Torques on the smaller gear in its running sense, in any order [N*m].

    Returns
    -------
    HarrisMap
        The lag of the larger gear on the line of action, without load and under each torque; its
        ``gear_pair`` is None.

    Raises
    ------
    InputError
        If a torque is not positive.

    Notes
    -----
    :meth:`HypoidLoadedContact.under` at every torque. The lever of the mesh force depends on the
    load; that of the curve without load is the lever under the least torque.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> from tribodyn.mesh import hypoid_loaded_contact
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> ease_off = EaseOff(lengthwise_crowning=30e-6, profile_crowning=6e-6)
    >>> loaded = hypoid_loaded_contact(hypoid_flanks(blank, ease_off=ease_off), 500.0, steps=32)
    >>> study = hypoid_transmission_error_over_torque(loaded, [100.0, 500.0, 2000.0])
    >>> study.quietest_torque
    500.0
    """
    torques = np.unique(one_or_more(torque=torque)[0])
    contacts = [loaded.under(float(each)) for each in torques]
    phase = loaded.phase[:-1]  # the last is the first of the next cycle
    error = np.stack([each.loaded_transmission_error[:-1] for each in contacts])
    orders = max(1, min(_HARMONICS, (phase.size - 1) // 2))
    grid = loaded.grid
    return HarrisMap(
        gear_pair=None,
        provider="contact lines",
        reference="finite elements of the teeth"
        if loaded.compliance
        else f"{loaded.line_stiffness * 1e-9:g} N/(mm um) of contact line",
        torque=torques,
        phase=phase,
        mesh_cycles=1,
        transmission_error=error,
        unloaded_transmission_error=contacts[0].unloaded_transmission_error[:-1],
        harmonics=harmonic_amplitudes(phase, error, 1, orders),
        mean_mesh_stiffness_secant=np.array([each.mean_mesh_stiffness for each in contacts]),
        mean_mesh_stiffness_tangent=np.array(
            [float(grid.mean(each.mesh_stiffness_tangent)) for each in contacts]
        ),
    )
