"""Every quantity of the product once: name, symbol, unit, display unit, meaning.

Case fields, summary figures, plot axes and the glossary come from this table or are tested
against it. Symbols follow ISO 21771 and ISO 6336 where they have one.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arguments import guard
from tribodyn.errors import Argument, InputError, floats, real_numbers, require_positive, shortened
from tribodyn.types import Array

__all__ = ["GEARS", "QUANTITIES", "Quantity", "find", "lookup"]

#: Names of both gears of a pair, the smaller one first.
GEARS: Final = ("pinion", "wheel")
GearName = Literal["pinion", "wheel"]


class UnknownQuantityError(InputError, KeyError):
    """No quantity has this name."""

    __str__ = Exception.__str__


@dataclass(frozen=True)
class Quantity:
    """One named quantity.

    Parameters
    ----------
    name : str
        Long exact name used in the API.
    symbol : str
        Symbol of the field, plain text.
    unit : str
        SI unit, empty for a pure number.
    display_unit : str
        Unit shown to engineers.
    meaning : str
        One line.
    example : str
        A sensible value as a case file writes it.
    """

    name: str
    symbol: str
    unit: str
    display_unit: str
    meaning: str
    example: str = ""

    @property
    def label(self) -> str:
        """Axis label: name in words with the display unit."""
        label = self.name.replace("_", " ")
        label = label[0].upper() + label[1:]
        return f"{label} [{self.display_unit}]" if self.display_unit else label


_TABLE = """
teeth | z | | | number of teeth
normal_module | m_n | m | mm | module in the normal section | "4.5 mm"
normal_pressure_angle | alpha_n | rad | deg | pressure angle of the basic rack | "20 deg"
helix_angle | beta | rad | deg | helix angle at the reference cylinder; zero for spur gears | "21 deg"
base_helix_angle | beta_b | rad | deg | helix angle at the base cylinder
working_helix_angle | beta_w | rad | deg | helix angle at the operating pitch cylinder
transverse_pressure_angle | alpha_t | rad | deg | pressure angle at the reference circle in the transverse section
operating_pressure_angle | alpha_wt | rad | deg | pressure angle at the operating pitch circle
center_distance | a | m | mm | distance between the two axes | "91.5 mm"
profile_shift_coefficient | x | | | rack displacement divided by the module, positive outwards
addendum_coefficient | h_aP* | | | addendum of the basic rack divided by the module
dedendum_coefficient | h_fP* | | | dedendum of the basic rack divided by the module
rack_tip_radius_coefficient | rho_fP* | | | tip radius of the basic rack divided by the module
face_width | b | m | mm | width of the toothing | "20 mm"
common_face_width | b | m | mm | face width in which both gears are in contact
tip_diameter | d_a | m | mm | diameter of the tip circle | "88.6 mm"
root_diameter | d_f | m | mm | diameter of the root circle
reference_diameter | d | m | mm | diameter of the reference circle
bore_diameter | d_i | m | mm | diameter of the bore; zero for a solid gear | "30 mm"
rim_diameter | | m | mm | outer diameter of a ring | "160 mm"
base_radius | r_b | m | mm | radius of the base circle
axial_pitch | p_x | m | mm | distance of neighbouring flanks along the axis
base_pitch | p_b | m | mm | distance of neighbouring flanks along the line of action
tip_shortening_coefficient | k | | | shortening of the addendum divided by the module
tip_thickness | s_a | m | mm | tooth thickness at the tip circle
transverse_contact_ratio | epsilon_alpha | | | length of the path of contact divided by the base pitch
overlap_ratio | epsilon_beta | | | face width divided by the axial pitch
total_contact_ratio | epsilon_gamma | | | sum of the transverse contact ratio and the overlap ratio
contact_line_length | l | m | mm | length of all lines of contact together
roll_angle | xi | rad | rad | roll angle of the driving gear, radius of curvature over base radius | "0.5 rad"
curvature_radius | rho | m | mm | radius of curvature of a flank in the contact
equivalent_radius | R | m | mm | reduced radius of curvature of the contact
mass | m | kg | kg | mass of a gear | "0.676 kg"
moment_of_inertia | I | kg*m^2 | kg*mm^2 | polar moment of inertia of a gear about its axis | "407 kg*mm^2"
youngs_modulus | E | Pa | GPa | Young's modulus | "206 GPa"
poissons_ratio | nu | | | Poisson's ratio
density | rho | kg/m^3 | kg/m^3 | density | "880 kg/m^3"
effective_modulus | E' | Pa | GPa | 2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2 (Dowson-Higginson convention)
dynamic_viscosity | eta_0 | Pa*s | mPa*s | absolute viscosity at ambient pressure and working temperature | "82 mPa*s"
kinematic_viscosity | nu | m^2/s | mm^2/s | viscosity divided by density | "220 mm^2/s"
viscosity_index | VI | | | how little the viscosity falls with temperature, by ISO 2909 | 95
pressure_viscosity_coefficient | alpha | 1/Pa | 1/GPa | slope of ln(viscosity) over pressure at ambient pressure | "21.9 1/GPa"
temperature_viscosity_coefficient | beta | 1/K | 1/K | fall of ln(viscosity) per kelvin at ambient pressure | "0.04 1/K"
eyring_stress | tau_0 | Pa | MPa | shear stress from which the oil thins under shear | "5 MPa"
limiting_stress | tau_L0 | Pa | MPa | limiting shear stress of the oil at ambient pressure | "2 MPa"
heat_transfer | hA | W/K | W/K | heat that surroundings take up per kelvin that gears and oil are warmer | "15 W/K"
gear_heat_transfer | hA_g | W/K | W/K | heat that the oil takes up per kelvin that the gears are warmer than it | "20 W/K"
gear_temperature | theta_M | K | degC | bulk temperature of the gears | "95 degC"
ambient_temperature | T_amb | K | degC | temperature of the surroundings | "20 degC"
specific_heat | c_p | J/kg/K | J/kg/K | heat that warms a kilogram by one kelvin | "460 J/kg/K"
limiting_stress_slope | Lambda_L | | | rise of the limiting shear stress of the oil per pressure | 0.05
carreau_stress | G | Pa | MPa | shear stress from which the oil thins after Carreau | "5 MPa"
carreau_exponent | n | | | exponent of the shear stress over a high shear rate after Carreau | 0.5
yasuda_exponent | a | | | sharpness of the bend from Newton's oil to a power of the shear rate | 2.0
thermal_conductivity | k | W/m/K | W/m/K | thermal conductivity of the oil | "0.13 W/m/K"
temperature | theta | K | degC | working temperature | "40 degC"
speed | n | rad/s | rpm | rotational speed of the gear named by speed_of | "900 rpm"
torque | T | N*m | N*m | torque on the gear named by speed_of | "90 N*m"
rating_life | L_h | s | h | running time that bearings last by their rating
mesh_frequency | f_m | Hz | Hz | tooth engagements per second
mesh_phase | phi | | | fraction of the mesh cycle since a tooth pair entered contact at A
load_per_width | w | N/m | N/mm | normal load of a tooth pair per face width
normal_force | F_n | N | N | force along the line of action
contact_ratio_under_load | | | | mean number of tooth pairs that carry load: mesh cycles during which one pair carries
load_share | | | | part of the total normal force that a tooth pair carries
hertz_pressure | p_H | Pa | GPa | maximum Hertzian pressure
half_width | a | m | um | half width of the Hertzian contact
sliding_speed | v_s | m/s | m/s | difference of the surface speeds, pinion minus wheel | "0.001 m/s"
entrainment_speed | u_e | m/s | m/s | half the sum of the surface speeds
slide_to_roll_ratio | SR | | | sliding speed over entrainment speed
film_thickness | h | m | um | oil film thickness
central_film | h_c | m | um | oil film thickness in the centre of the contact
minimum_film | h_min | m | um | least oil film thickness
film_ratio | Lambda | | | minimum film over composite roughness
film_load_share | f_Lambda | | | part of the load of a tooth pair that its oil film carries; the asperities carry the rest
lubrication_regime | | | | 0 boundary, 1 mixed, 2 full film, by the film ratio
film_pressure | p_max | Pa | GPa | greatest pressure in the oil film
film_stiffness | K_o | N/m | N/um | stiffness of the oil film of one tooth pair along the line of action
composite_roughness | S | m | um | root of the sum of squares of the two rms roughnesses | "0.5 um"
roughness_rms | S_q | m | um | rms roughness of one flank | "0.4 um"
rms_slope | Delta_q | | | root mean square slope of a profile of one flank | 0.1
summit_density | eta | 1/m^2 | 1/mm^2 | summits of one flank per area | "10000 1/mm^2"
summit_radius | beta | m | um | mean radius of the summits of one flank
roughness_ra | Ra | m | um | arithmetic mean roughness of one flank; Rq = 1.25 Ra is taken, as of ground flanks | "0.4 um"
friction_coefficient | mu | | | friction force over normal force | 0.05
asperity_friction_coefficient | mu_a | | | part of the friction coefficient that the asperities cause
flash_temperature | Theta_fl | K | K | greatest rise of the surface temperature in a contact above that of the gears
mesh_load_factor | K_gamma | | | greatest load of a planet over the mean of all planets
gear_loss_factor | H_V | | | mean sliding work over transmitted work at unit friction
tooth_stiffness | k_t | N/m | N/um | stiffness of the teeth of one pair without their oil film
pair_stiffness | k_i | N/m | N/um | stiffness of one tooth pair along the line of action | "2e8 N/m"
mesh_stiffness | K_m | N/m | N/um | stiffness of all tooth pairs in contact | "2.5e8 N/m"
mesh_stiffness_secant | | N/m | N/um | force of all tooth pairs over the deflection that it causes
mesh_stiffness_tangent | | N/m | N/um | slope of the force of all tooth pairs over the deflection
maximum_single_pair_stiffness | | N/m | N/um | greatest stiffness of one tooth pair that carries the load alone
ramp_deflection | | m | um | deflection at which a straight piece of the force law of the mesh begins
ramp_stiffness | | N/m | N/um | stiffness that a straight piece adds to the force law of the mesh
film_offset | | m | um | distance before perfect rigid flanks touch at which the first oil film begins to carry
corner_share | | | | part of the load on tip corners beyond the path of contact
mesh_force | N | N | N | dynamic force along the line of action
friction_force | F_f | N | N | dynamic friction force of all tooth pairs
power | P | W | W | power
efficiency | eta | | | output power over input power
pitch_line_velocity | v_t | m/s | m/s | speed of the flanks at the operating pitch circle
tangential_force | F_t | N | N | force of the torque on the operating pitch circle
mesh_damping | c_m | N*s/m | N*s/m | damping of the tooth contact along the line of action | "900 N*s/m"
mesh_damping_ratio | zeta | | | mesh damping over its critical value
bearing_stiffness | k_b | N/m | N/um | radial stiffness of the support of each gear; a list has that of pinion and wheel | "500 N/um"
bearing_damping | c_b | N*s/m | N*s/m | radial damping of the support of each gear; a list has that of pinion and wheel | "4000 N*s/m"
shaft_stiffness | k_s | N*m/rad | N*m/rad | torsional stiffness of a shaft | "75400 N*m/rad"
shaft_damping | c_s | N*m*s/rad | N*m*s/rad | torsional damping of a shaft | "1 N*m*s/rad"
bearing_force | F_b | N | N | force of a gear on its support
backlash | j_bt | m | mm | total play along the line of action | "0.05 mm"
static_transmission_error | STE | m | um | approach of the gears along the line of action under load at rest
unloaded_transmission_error | e_0 | m | um | transmission error of the mesh without load
transmission_error | e | m | um | displacement of the wheel behind its ideal place on the line of action | "2 um"
dynamic_transmission_error | DTE | m | um | compression of the mesh along the line of action while running
dynamic_transmission_error_rate | dDTE/dt | m/s | um/s | rate at which the dynamic transmission error changes
deflection | delta | m | um | compression of a contact
acceleration | a | m/s^2 | m/s^2 | acceleration
frequency | f | Hz | Hz | frequency
time | t | s | ms | time
angle | | rad | deg | angle | "20 deg"
contact_loss_share | | | | part of the mesh cycle without contact on the driving flank
steady_state_error | | | | distance to the exact periodic orbit relative to its size
step_error | | | | distance to the periodic orbit at half the step relative to its size
path | g | m | mm | distance of a contact from the pinion's base tangent point along the line of action
in_contact | | | | whether a tooth pair is in contact
pinion_curvature_radius | rho_1 | m | mm | radius of curvature of the pinion's flank in the contact
wheel_curvature_radius | rho_2 | m | mm | radius of curvature of the wheel's flank in the contact
sliding_direction | sigma | | | sign of the sliding speed
friction_sum | | | | directed friction coefficient of all tooth pairs, each with its load share
friction_moment_pinion | | m | mm | friction moment on the pinion over total normal force
friction_moment_wheel | | m | mm | friction moment on the wheel over total normal force
total_normal_force | F_n | N | N | force along the line of action of all tooth pairs together
pinion_speed | n_1 | rad/s | rpm | rotational speed of the pinion
pinion_torque | T_1 | N*m | N*m | torque on the pinion
base_radius_pinion | r_b1 | m | mm | base radius of the pinion
base_radius_wheel | r_b2 | m | mm | base radius of the wheel
direction | h | | | change of the compression with a coordinate of the structure
friction_direction | s | | | generalized force of one newton of friction with its sign
single_pair_stiffness | | N/m | N/um | stiffness of the mesh while one tooth pair is in contact
double_pair_stiffness | | N/m | N/um | stiffness of the mesh while two tooth pairs are in contact
mean_mesh_stiffness | | N/m | N/um | mean of the mesh stiffness over the mesh cycle
mean_friction_coefficient | mu_m | | | friction coefficient weighted with the load share, mean over the mesh cycle
compliance | | m/N | um/kN | deflection over force
bore_radius | r_i | m | mm | radius of the bore
root_radius | r_f | m | mm | radius of the root circle
tip_relief | C_a | m | um | material taken away from the flank at the tip | "10 um"
tip_relief_length | L_Ca | m | mm | distance from the tip inwards over which the relief ends, as roll length | "4 mm"
root_relief | C_f | m | um | material taken away at the lowest point that the mate touches | "10 um"
root_relief_length | L_Cf | m | mm | distance from that point outwards over which the relief ends, as roll length | "4 mm"
profile_crowning | C_alpha | m | um | material taken away at both ends of the used flank against its middle | "5 um"
profile_slope | C_Halpha | m | um | material taken away at the tip, in proportion from the lowest point that the mate touches | "5 um"
crowning | C_beta | m | um | material taken away at both ends of the face against its middle | "5 um"
lead_slope | C_Hbeta | m | um | material taken away at the positive end of the face, more than at the other | "5 um"
end_relief | C_betae | m | um | material taken away at both ends of the face | "10 um"
end_relief_length | L_Cbetae | m | mm | distance from the end of the face over which the relief falls to zero | "3 mm"
flank_twist | S_alpha | m | um | slope over the face at the tip less that at the lowest used point | "5 um"
misalignment | F_beta | m | um | difference of the gap between the flanks over the common face width | "5 um"
single_pitch_deviation | f_p | m | um | deviation of the pitch from the flank before, one for each tooth | "5 um"
cumulative_pitch_deviation | F_p | m | um | by how much each flank stands further on than evenly spaced ones | "5 um"
run_out | F_r | m | um | run-out of the toothing, twice its eccentricity | "20 um"
run_out_phase | phi_r | rad | deg | rotation from where tooth 0 comes into contact to where the flanks stand out most | "0 deg"
wear_depth | h_w | m | um | depth of wear, alone or at equal distances from the lowest point to the tip | "5 um"
roll_length | L_y | m | mm | radius of curvature of the involute as a place on the profile
face_position | y | m | mm | place along the face from its middle
profile_deviation | f_alpha | m | um | measured excess of material along the normal of the flank
flank_gap | | m | um | distance that the shapes of both flanks leave where involutes would touch
separation | | m | um | approach along the line of action that brings the teeth of a pair into touch
"""


def _read() -> dict[str, Quantity]:
    rows = (line.split("|") for line in _TABLE.strip().splitlines())
    quantities = (Quantity(*(cell.strip() for cell in row)) for row in rows)
    return {quantity.name: quantity for quantity in quantities}


#: Every quantity by its name.
QUANTITIES: dict[str, Quantity] = _read()


def lookup(name: str) -> Quantity:
    """Return the quantity called ``name``.

    Parameters
    ----------
    name : str
        Exact name.

    Raises
    ------
    InputError
        If there is none; the message names the nearest. It is a KeyError as well.

    Examples
    --------
    >>> lookup("base_radius").symbol
    'r_b'
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    matches = difflib.get_close_matches(name, QUANTITIES, n=1)
    hint = f'; did you mean "{matches[0]}"?' if matches else ""
    what, why = f'no quantity is called "{name}"{hint}', "QUANTITIES holds all names"
    raise UnknownQuantityError(what, Argument("name"), why, "Look for it with find(name)")


def find(text: str) -> list[Quantity]:
    """Find quantities by symbol, name or part of a name.

    Parameters
    ----------
    text : str
        What the user typed.

    Returns
    -------
    list of Quantity
        Exact matches of symbol or name alone if there are any, else all partial matches.

    Examples
    --------
    >>> [quantity.name for quantity in find("epsilon_alpha")]
    ['transverse_contact_ratio']
    """
    exact = [q for q in QUANTITIES.values() if text in (q.name, q.symbol)]
    if exact:
        return exact
    lowered = text.lower().replace(" ", "_")
    return [q for q in QUANTITIES.values() if lowered in q.name or lowered in q.meaning.lower()]


guard(__name__)


#: Remedy for a value that is not positive.
_REMEDIES = {
    "load_per_width": "1 N/mm is 1000 N/m",
    "entrainment_speed": "A film needs a rolling motion: give half the sum of the surface speeds",
    "eyring_stress": "5 MPa is 5e6 Pa",
}


def positive(**quantities: ArrayLike) -> list[Array]:
    """Arrays of named quantities; raise unless all values are finite and positive."""
    arrays = [floats(Argument(name), value) for name, value in quantities.items()]
    for name, array in zip(quantities, arrays, strict=True):
        if not array.size or (array.min() > 0.0 and array.max() < np.inf):
            continue
        if not np.all((array > 0.0) & (array < np.inf)):
            unit = QUANTITIES[name].unit if name in QUANTITIES else ""
            require_positive(name, array, unit, remedy=_REMEDIES.get(name, ""))
    require_one_shape(**dict(zip(quantities, arrays, strict=True)))
    return arrays


def require_one_shape(**arrays: Array) -> None:
    """Raise :class:`InputError` unless arrays, each called by its name, broadcast to one shape."""
    try:
        np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        what = ", ".join(f"{name} has the shape {array.shape}" for name, array in arrays.items())
        why, remedy = "They are combined element by element", "Give numbers, or arrays of one shape"
        raise InputError(what, Argument(" and ".join(arrays)), why, remedy) from None


def one_or_more(**quantities: ArrayLike) -> list[Array]:
    """Lists of positive quantities, each given as one value or as several."""
    lists = [np.array(positive(**{n: v})[0], ndmin=1) for n, v in quantities.items()]
    for name, values in zip(quantities, lists, strict=True):
        if values.ndim != 1 or values.size == 0:
            what = f"{name} has the shape {values.shape}"
            remedy = "Give each value once; all combinations are computed"
            raise InputError(what, Argument(name), "It is one value or a list of values", remedy)
    return lists


def require_whole(name: str, value: Any, least: int = 1, *, why: str = "") -> int:
    """Return a whole number, or raise :class:`InputError`."""
    wanted = f"{why} a whole number".strip()
    number = real_numbers(Argument(name), value, wanted)
    if number.ndim or not (float(number).is_integer() and least <= number <= 1e9):
        reason = f"Wanted: {wanted} from {least} to {1e9:g}"
        what, remedy = f"{name} = {shortened(repr(value))}", "Give a number of this range"
        raise InputError(what, Argument(name), reason, remedy)
    return int(number)


def require_number(name: str, value: Any) -> float:
    """Return one finite number, or raise :class:`InputError`."""
    number = real_numbers(Argument(name), value, "a number")
    if number.ndim or not np.abs(number) < 1e60:
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: one finite number"
        raise InputError(what, Argument(name), why, "Give a number in SI units")
    return float(number)


def require_flag(name: str, value: Any) -> bool:
    """Return True or False, or raise :class:`InputError` for anything else."""
    if not isinstance(value, bool | int | np.bool_) or value not in (0, 1):
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: True or False"
        raise InputError(what, Argument(name), why, "Give one of the two")
    return bool(value)
