"""Critical section of a tooth root: chord, fillet radius, lever arm; ISO 6336-3 and exact fillets.

The section is where a line at 30 degrees (of a ring 60 degrees) to the middle of the tooth touches
the fillet of the virtual spur gear, ``z_n = z/(cos^2(beta_b) cos(beta))``. All lengths here are in
normal modules. Three tools cut it:

* a rack with a round tip (hob): the closed form of the standard, exact for that tool,
* a gear-shaped cutter: the envelope of its tip round, exact,
* the fillet arc of a ring as its drawing has it, where no cutter is stated.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.gear import CylindricalGear
from tribodyn.gear.curves import inverse_involute, involute, root_arc
from tribodyn.rating.rated_gear import ShaperCutter


class RootSection(NamedTuple):
    """Critical section of a tooth root; lengths over the normal module."""

    chord: float  #: s_Fn
    fillet_radius: float  #: rho_F
    center_distance: float  #: distance of the chord from the axis of the virtual gear
    tool: str

    @property
    def notch(self) -> float:
        """q_s = s_Fn/(2 rho_F)."""
        return self.chord / (2.0 * self.fillet_radius)


def virtual_teeth(gear: CylindricalGear) -> float:
    """z_n, with its sign."""
    return gear.teeth / (math.cos(gear.base_helix_angle) ** 2 * math.cos(gear.helix_angle))


def _tangent_angle(gear: CylindricalGear) -> float:
    """Angle between the tangent of the section and the middle of the tooth [rad]."""
    return math.pi / 3.0 if gear.is_ring else math.pi / 6.0


def rack_section(gear: CylindricalGear, tip_radius: float | None = None) -> RootSection:
    """Section cut by a rack with a round tip, or with another radius of it: 2006, rings."""
    z, angle, rack = virtual_teeth(gear), gear.normal_pressure_angle, gear.rack
    rho = rack.fitting_tip_radius_coefficient(angle) if tip_radius is None else tip_radius
    depth, shift = rack.dedendum_coefficient, gear.generating_shift_coefficient
    end = math.pi / 4.0 - depth * math.tan(angle) - (1.0 - math.sin(angle)) * rho / math.cos(angle)
    g, turned = rho - depth + shift, math.pi / 2.0 - _tangent_angle(gear)
    h = 2.0 / z * (math.pi / 2.0 - end) - turned
    theta = turned
    for _ in range(100):
        residual = theta - 2.0 * g / z * math.tan(theta) + h
        step = residual / (1.0 - 2.0 * g / z / math.cos(theta) ** 2)
        theta -= step
        if abs(step) < 1e-15:
            break
    else:
        raise ComputationError(
            f"no critical section in the root of a gear with {gear.teeth} teeth",
            why="The angle of the tangent to the fillet did not converge",
            remedy="Check rack and profile shift, or give Y_F and Y_S",
        )
    reach = g / math.cos(theta) - rho
    chord = z * math.sin(turned - theta)
    chord += (1.0 if gear.is_ring else math.sqrt(3.0)) * reach
    center = 0.5 * (
        z * math.cos(turned - theta) + (math.sqrt(3.0) if gear.is_ring else 1.0) * reach
    )
    cosine = math.cos(theta)
    fillet = rho + 2.0 * g**2 / (cosine * (z * cosine**2 - 2.0 * g))
    return RootSection(chord, fillet, abs(center), "rack with a round tip")


def equivalent_tip_radius(gear: CylindricalGear, cutter: ShaperCutter) -> float:
    """Tip radius of the rack that replaces a cutter in the 2006 form of rings, in modules."""
    rho, depth = cutter.tip_radius_coefficient, gear.rack.dedendum_coefficient
    extent = max(cutter.profile_shift_coefficient + depth - rho, 0.0)
    return float(rho + extent**1.95 / (3.156 * 1.036**cutter.teeth))


def arc_section(ring: CylindricalGear) -> RootSection:
    """Section of a ring whose fillet is the arc of its drawing, on the virtual spur gear."""
    z, angle = abs(virtual_teeth(ring)), ring.normal_pressure_angle
    shift = ring.generating_shift_coefficient
    base = 0.5 * z * math.cos(angle)
    half = (math.pi / 2.0 + 2.0 * shift * math.tan(angle)) / z - involute(angle)
    root = 0.5 * z + ring.rack.dedendum_coefficient - shift
    arc = root_arc(root, base, half, z, ring.rack.tip_radius_coefficient)  # type: ignore[arg-type]
    # Its normal makes 30 degrees with the middle of the tooth where its tangent makes 60.
    x = arc.center_radius * math.cos(arc.center_angle)
    y = arc.center_radius * math.sin(arc.center_angle)
    normal = math.pi / 2.0 - _tangent_angle(ring)
    x, y = x + arc.arc_radius * math.cos(normal), y - arc.arc_radius * math.sin(normal)
    return RootSection(2.0 * y, arc.arc_radius, x, "arc of the drawing")


class _Envelope:
    """Fillet that the tip round of a gear-shaped cutter leaves, in the frame of the tooth."""

    # The cutter's axis is the origin, the pitch point lies at (cutter_pitch, 0). In the frame of
    # the gear X points from its axis to the pitch point; the space turns by roll pitch_0/pitch.
    def __init__(self, gear: CylindricalGear, cutter: ShaperCutter) -> None:
        self.sign = gear.sign
        alpha, shift = gear.normal_pressure_angle, gear.generating_shift_coefficient
        scale = virtual_teeth(gear) / gear.teeth
        self.teeth, self.cutter_teeth = abs(virtual_teeth(gear)), cutter.teeth * scale
        total = self.cutter_teeth + self.sign * self.teeth
        shifts = cutter.profile_shift_coefficient + shift
        value = involute(alpha) + 2.0 * shifts * math.tan(alpha) / total
        working = inverse_involute(value) if value > 0.0 else 0.0
        scale = math.cos(alpha) / math.cos(working)
        self.pitch, self.cutter_pitch = 0.5 * self.teeth * scale, 0.5 * self.cutter_teeth * scale
        self._place_tip_round(alpha, gear.rack.dedendum_coefficient, cutter)

    def _place_tip_round(self, alpha: float, depth: float, cutter: ShaperCutter) -> None:
        """Centre of the tip round: distance from the axis, angle from the middle of the tooth."""
        z, x = self.cutter_teeth, cutter.profile_shift_coefficient
        tip, base = 0.5 * z + depth + x, 0.5 * z * math.cos(alpha)
        half = (math.pi / 2.0 + 2.0 * x * math.tan(alpha)) / z + involute(alpha)

        from scipy.optimize import brentq

        def angle_at(rho: float) -> float:
            roll = math.sqrt(max((tip - rho) ** 2 - base**2, 0.0)) / base
            return half - rho / base - (roll - math.atan(roll))

        low, rho = 0.0, cutter.tip_radius_coefficient
        if angle_at(low) < 0.0:
            raise _refused(cutter, "Its teeth end in a point before their tip")
        if angle_at(rho) < 0.0:  # the full round is smaller
            rho = brentq(angle_at, low, rho, xtol=1e-15)
        self.rho, self.center, self.angle = rho, tip - rho, max(angle_at(rho), 0.0)

    def point(self, normal_angle: float) -> tuple[float, float, float]:
        """Point along and across the middle of the tooth, and angle of the normal into it."""
        # The line from the pitch point through the centre of the tip round to the point that is
        # cut makes the normal angle with the line of centres: 0 at the root circle.
        sine = self.cutter_pitch / self.center * math.sin(normal_angle)
        turned = normal_angle - math.asin(sine)
        reach = self.rho + self.center * math.cos(math.asin(sine))
        reach -= self.cutter_pitch * math.cos(normal_angle)
        u_x, u_y = math.cos(normal_angle), math.sin(normal_angle)
        x, y = self.pitch - self.sign * reach * u_x, reach * u_y
        middle = (turned - self.angle) * self.cutter_pitch / self.pitch + math.pi / self.teeth
        angle, radius = middle - math.atan2(y, x), math.hypot(x, y)
        normal = middle - math.atan2(u_y, -self.sign * u_x)
        return radius * math.cos(angle), radius * math.sin(angle), normal


def _refused(cutter: ShaperCutter, why: str) -> InputError:
    """Error of a cutter that cannot cut the root."""
    what = f"cutter of {cutter.teeth} teeth with x_0 = {cutter.profile_shift_coefficient:g}"
    remedy = "Check the number of teeth, shift and tip radius of the cutter"
    return InputError(what, Argument("cutter"), why, remedy)


def cutter_section(gear: CylindricalGear, cutter: ShaperCutter) -> RootSection:
    """Section cut by a gear-shaped cutter: exact envelope of its tip round."""
    from scipy.optimize import brentq

    envelope = _Envelope(gear, cutter)
    tangent = _tangent_angle(gear)
    target_angle = tangent - math.pi / 2.0 if gear.is_ring else -math.pi / 2.0 - tangent

    def difference(normal_angle: float) -> float:
        return math.remainder(envelope.point(normal_angle)[2] - target_angle, 2.0 * math.pi)

    last = 0.5 * math.pi - gear.normal_pressure_angle  # where the flank of the cutter begins
    reaches = envelope.center > envelope.cutter_pitch
    if not reaches or difference(0.0) * difference(last) > 0.0:
        why = "Its tip round leaves no fillet with a tangent as the critical section has it"
        raise _refused(cutter, why)
    root = brentq(difference, 0.0, last, xtol=1e-15)
    x, y, _ = envelope.point(root)
    before, after = envelope.point(root - 1e-4), envelope.point(root + 1e-4)
    arc = math.hypot(after[0] - before[0], after[1] - before[1])
    radius = arc / abs(math.remainder(after[2] - before[2], 2.0 * math.pi))
    return RootSection(2.0 * y, radius, x, f"cutter of {cutter.teeth} teeth")


def root_section(gear: CylindricalGear, cutter: ShaperCutter | None, edition: int) -> RootSection:
    """Critical section of a gear by the tool that cut it."""
    if cutter is not None and gear.is_ring and edition == 2006:
        section = rack_section(gear, equivalent_tip_radius(gear, cutter))
        return section._replace(tool=f"rack for a cutter of {cutter.teeth} teeth, edition 2006")
    if cutter is not None:
        return cutter_section(gear, cutter)
    return arc_section(gear) if gear.is_ring else rack_section(gear)
