"""A structure of your own: masses, springs and one tooth contact by hand, no case file.

Two gears on springs, each free to move along (y) and across (x) the line of action and to turn.
The contact needs three things over the mesh phase: the direction in which it is compressed, its
stiffness, and the phases where that jumps. Here every tooth pair has the same constant stiffness,
so the mesh is stiffer while two pairs share the load, and there is no friction.
"""

import math

import numpy as np

import tribodyn as td
from tribodyn.dynamics import Contact, System, steady_state

PAIR_STIFFNESS = 2.0e8  # N/m
pair = td.load_case("fzg-roughness").gear_pair
path = td.contact.path_of_contact(pair)
radius_p, radius_w = pair.pinion.base_radius, pair.wheel.base_radius


def mesh_stiffness(phase):
    """Stiffness of all pairs in contact [N/m], by counting them."""
    _, in_contact = path.pair_paths(phase)
    return PAIR_STIFFNESS * in_contact.sum(axis=1)


bearing_stiffness, bearing_damping = 3.5e9, 4.0e3  # N/m, N*s/m
held = np.array([1.0, 1.0, 0.0, 1.0, 1.0, 0.0])  # x, y of both gears; rotation is free
system = System(
    mass=np.diag([0.676, 0.676, 407e-6, 1.084, 1.084, 1168e-6]),
    damping=np.diag(bearing_damping * held),
    stiffness=np.diag(bearing_stiffness * held),
    force=[0.0, 0.0, 90.0, 0.0, 0.0, -135.0],
    contacts=[
        Contact(
            direction=[0.0, 1.0, radius_p, 0.0, -1.0, -radius_w],
            stiffness=mesh_stiffness,
            damping=900.0,
            events=path.event_phases(),
        )
    ],
    names=["pinion_x", "pinion_y", "pinion_theta", "wheel_x", "wheel_y", "wheel_theta"],
)

pinion_speed = 900 * math.pi / 30  # rad/s
mesh_frequency = pinion_speed * pair.pinion.teeth / (2 * math.pi)
# the gears vibrate on their bearings up to 48 times in a mesh cycle: fine steps for six digits
orbit = steady_state(system, mesh_frequency, steps=4096)

samples = orbit.fine  # both ends and the middle of every step, so that jumps count on both sides
force = samples.contact_force[:, 0]
acceleration = samples.acceleration[:, 1]


def rms(signal):
    """Root of the mean square over the orbit."""
    return math.sqrt(samples.mean(signal**2))


print(f"mesh frequency                    {mesh_frequency:.1f} Hz")
print(f"mean transmission error           {1e6 * samples.mean(samples.deflection[:, 0]):.5f} um")
print(f"mean mesh force                   {samples.mean(force):.4f} N")
print(f"rms mesh force                    {rms(force):.4f} N")
print(f"rms pinion acceleration along     {rms(acceleration):.3f} m/s^2")
print(f"distance to the exact orbit       {orbit.error:.1e}")
