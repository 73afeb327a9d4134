"""Broken case files: what is changed in a sound one, and what the message must say."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["BROKEN", "SOUND", "Broken", "line_of"]

SOUND = """\
title = "A pair"
[gears]
normal_module = "4.5 mm"
normal_pressure_angle = "20 deg"
center_distance = "91.5 mm"
driver = "pinion"
composite_roughness = "0.53 um"
[gears.pinion]
teeth = 16
profile_shift_coefficient = 0.8635
face_width = "20 mm"
[gears.wheel]
teeth = 24
profile_shift_coefficient = -0.5103
[lubricant]
name = "80W"
[operation]
speed = "900 rpm"
torque = "90 N*m"
[stiffness]
model = "rectangular"
pair_stiffness = "2e8 N/m"
[friction]
law = "constant"
coefficient = 0.05
[dynamics]
bearing_stiffness = "3.5e9 N/m"
[solver]
method = "steady"
"""


@dataclass(frozen=True)
class Broken:
    """One fault.

    ``old`` is replaced by ``new`` in the sound file; the message must hold every part of
    ``says``, and ``at`` is the text of the line that it must name.
    """

    name: str
    old: str
    new: str
    at: str
    says: tuple[str, ...]


def line_of(text: str, part: str) -> int:
    """Line that first begins with a part, else that first holds it, counted from 1."""
    at = text.find("\n" + part) + 1 or text.index(part)
    return text.count("\n", 0, at) + 1


_MODULE = 'normal_module = "4.5 mm"'
_TEETH = "teeth = 16"
_SPEED = 'speed = "900 rpm"'
_DISTANCE = 'center_distance = "91.5 mm"'
_PAIR = 'pair_stiffness = "2e8 N/m"'
_DYNAMICS = 'bearing_stiffness = "3.5e9 N/m"'
_SOLVER = 'method = "steady"'
_LAW = 'law = "constant"\ncoefficient = 0.05'
_OIL = 'name = "80W"'
_SHEET = 'kinematic_viscosity_at_40 = "220 mm^2/s"\nviscosity_index = 95'
_REST = 'density_at_15 = "892 kg/m^3"\ntemperature = "60 degC"'
_ROUGH = 'composite_roughness = "0.53 um"'


def _film(*lines: str) -> str:
    """A table [film] in front of [solver], solved where no model is given."""
    model = () if any(line.startswith("model") for line in lines) else ('model = "newton"',)
    return "\n".join(("[film]", *model, *lines, "[solver]"))


BROKEN = (
    # units
    Broken("no-unit", _MODULE, "normal_module = 4.5", "normal_module",
           ("gears.normal_module", "4.5", "needs a unit", 'normal_module = "4.5 mm"')),
    Broken("no-unit-in-text", _MODULE, 'normal_module = "4.5"', "normal_module",
           ("gears.normal_module", '"4.5" has no unit', "4.5 mm")),
    Broken("wrong-kind-of-unit", _MODULE, 'normal_module = "4.5 kg"', "normal_module",
           ('normal_module = "4.5 kg"', "wrong kind of quantity", "4.5 mm")),
    Broken("unknown-unit", _MODULE, 'normal_module = "4.5 furlongz"', "normal_module",
           ("furlongz", "not a known unit", "4.5 mm")),
    Broken("metres-for-millimetres", _DISTANCE, 'center_distance = "91.5 m"', "center_distance",
           ("91.5 m", "91500 mm", "0.1 mm to 10000 mm", "wrong unit", "Correct the value")),
    Broken("no-number", _DISTANCE, 'center_distance = "wide"', "center_distance",
           ('"wide"', "does not begin with a number", "91.5 mm")),
    Broken("decimal-comma", _MODULE, 'normal_module = "4,5 mm"', "normal_module",
           ("point, not a comma", 'normal_module = "4.5 mm"')),
    Broken("unquoted-decimal-comma", "= 0.8635", "= 0,8635", "profile_shift_coefficient = 0,8635",
           ("decimal sign is a point", "profile_shift_coefficient = 0.8635")),
    Broken("separated-thousands", _SPEED, 'speed = "2,500 rpm"', "speed",
           ('speed = "2500 rpm" or speed = "2.5 rpm"', "thousands have no separator")),
    Broken("thousands-and-decimals", _SPEED, 'speed = "1.234,5 rpm"', "speed",
           ('Write speed = "1234.5 rpm".',)),
    Broken("blank-in-a-number", _SPEED, 'speed = "2 500 rpm"', "speed",
           ('Write speed = "2500 rpm".',)),
    Broken("apostrophe-in-a-number", _SPEED, 'speed = "2\'500 rpm"', "speed",
           ('Write speed = "2500 rpm".',)),
    Broken("unquoted-thousands", _SPEED, "speed = 2,500 rpm", "speed",
           ('Write speed = "2500 rpm" or speed = "2.5 rpm"',)),
    Broken("curly-quotes", _SPEED, "speed = “900 rpm”", "speed",
           ('Write straight quotes, as a text editor does: speed = "900 rpm"',)),
    Broken("frequency-for-speed", _SPEED, 'speed = "15 Hz"', "speed",
           ("operation.speed", '"900 rpm" if turns per second')),
    Broken("surface-speed-for-speed", _SPEED, 'speed = "3 m/s"', "speed",
           ("operation.speed", "rotational speed in rpm")),
    # types
    Broken("table-for-number", _MODULE, "normal_module = {a = 1, b = [true]}", "normal_module",
           ("normal_module = {a = 1, b = [true]}", "number with a unit")),
    Broken("flag-for-number", "teeth = 16", "teeth = true", "teeth = true",
           ("gears.pinion.teeth", "teeth = true", "whole number", "teeth = 16")),
    Broken("text-for-whole-number", _TEETH, 'teeth = "16"', 'teeth = "16"',
           ("gears.pinion.teeth", 'teeth = "16"', "whole number", "teeth = 16")),
    Broken("fraction-of-a-tooth", _TEETH, "teeth = 16.5", "teeth = 16.5",
           ("teeth = 16.5", "whole number", "teeth = 16")),
    Broken("text-for-pure-number", "= 0.8635", '= "0.8635"', '= "0.8635"',
           ("gears.pinion.profile_shift_coefficient", "pure number", "without quotes")),
    Broken("flag-for-text", 'title = "A pair"', "title = true", "title = true",
           ("title = true", "must be text", "in quotes")),
    Broken("number-for-flag", _DYNAMICS, _DYNAMICS + "\ndamping_in_gap = 1", "damping_in_gap",
           ("dynamics.damping_in_gap", "true or false")),
    Broken("value-for-table", "[solver]\n" + _SOLVER, "[film]\nmodel = {}", "model = {}",
           ("film.model", "Allowed: none, newton")),
    Broken("text-for-list", _PAIR, 'values = "2e8 N/m"', "values",
           ("stiffness.values", "must be a list", "[")),
    Broken("not-finite", "= 0.8635", "= nan", "= nan",
           ("profile_shift_coefficient = nan", "-3 to 3", "Correct the value")),
    # ranges
    Broken("too-few-teeth", _TEETH, "teeth = 3", "teeth = 3",
           ("teeth = 3", "5 to 1000", "ISO 1328-1")),
    Broken("negative-torque", '"90 N*m"', '"-90 N*m"', "torque",
           ("operation.torque", "-90 N*m", "Correct the value or its unit")),
    Broken("standstill", _SPEED, 'speed = "0 rpm"', "speed",
           ("operation.speed", "0 rpm", "0.01 rpm to 200000 rpm")),
    Broken("coefficient-above-one", "coefficient = 0.05", "coefficient = 5", "coefficient = 5",
           ("friction.coefficient", "coefficient = 5", "0 to 1")),
    Broken("too-few-steps", _SOLVER, _SOLVER + "\nsteps_per_mesh_cycle = 8", "steps_per_mesh",
           ("steps_per_mesh_cycle = 8", "64 to 262144")),
    # names
    Broken("misspelt-key", _MODULE, 'normal_modul = "4.5 mm"', "normal_modul",
           ("gears.normal_modul", "unknown key", 'Did you mean "normal_module"?')),
    Broken("misspelt-table", "[operation]", "[operations]", "[operations]",
           ("operations", "unknown key", 'Did you mean "operation"?')),
    Broken("key-in-wrong-table", 'driver = "pinion"', 'driver = "pinion"\nface_width = "20 mm"',
           'face_width = "20 mm"',
           ("face_width", "unknown key", "[gears.pinion] or [gears.wheel]")),
    Broken("misspelt-choice", 'driver = "pinion"', 'driver = "pinon"', "driver",
           ('driver = "pinon"', "Allowed: pinion, wheel", 'Did you mean "pinion"?')),
    Broken("helical-kind", 'driver = "pinion"', 'driver = "pinion"\nkind = "helical"', "kind",
           ('kind = "helical"', "the kind spur with a helix_angle in [gears]", "Allowed: spur")),
    Broken("helix-angle", _MODULE, _MODULE + '\nhelix_angle = "-15 deg"', "helix_angle",
           ("Allowed: 0 deg to 60 deg (the hand gives its sign)", "without its sign")),
    Broken("worm", 'driver = "pinion"', 'driver = "pinion"\nworm = 3', "worm",
           ("Not in this version: worm gears",)),
    Broken("gear-of-the-torque", _SPEED, _SPEED + '\ntorque_of = "wheel"', "torque_of",
           ("speed_of names the gear whose speed and torque are given", "Write speed_of")),
    Broken("support-of-one-gear", _DYNAMICS, 'bearing_stiffness_pinion = "1e9 N/m"',
           "bearing_stiffness_pinion",
           ('one list: bearing_stiffness = ["500 N/um", "500 N/um"]',)),
    Broken("three-supports", _DYNAMICS, 'bearing_stiffness = ["1 N/m", "1 N/m", "1 N/m"]',
           "bearing_stiffness", ("must have two values, for pinion and wheel", "value for both")),
    Broken("teeth-of-one-gear", _MODULE, _MODULE + "\npinion_teeth = 16", "pinion_teeth",
           ("It is teeth in [gears.pinion]",)),
    Broken("peak-to-valley", _TEETH, _TEETH + '\nroughness_rz = "2 um"', "roughness_rz",
           ("no rms roughness follows", "Write roughness_ra")),
    Broken("two-heights", _TEETH, f"{_TEETH}\nroughness_rms = '0.5 um'\nroughness_ra = '0.4 um'",
           "roughness_rms", ("roughness_ra = \"0.4 um\" are both given", "Keep one of them")),
    Broken("unknown-table", "[solver]", "[gear.pinion]\nteeth = 16\n[solver]", "[gear.pinion]",
           ("table [gear]: unknown key", 'Did you mean "gears"?')),
    Broken("misspelt-film", "[solver]", _film('model = "newtn"'), 'model = "newtn"',
           ("film.model", '"newtn"', "thermal, dowson-higginson", 'Did you mean "newton"?')),
    Broken("unknown-film-stiffness", "[solver]", _film('stiffness = "sekant"'), "stiffness",
           ("film.stiffness", '"sekant"', "none, tangent, secant, seed", '"secant"?')),
    Broken("unknown-inlet", "[solver]", _film('inlet = "dry"'), "inlet",
           ("film.inlet", '"dry"', "flooded, zero", "Choose one")),
    Broken("unknown-stiffness", 'model = "rectangular"', 'model = "fe4d"', 'model = "fe4d"',
           ("stiffness.model", '"fe4d"', "potential-energy", '"fe3d"?')),
    Broken("unknown-oil", _OIL, 'name = "80V"', 'name = "80V"',
           ("lubricant.name", '"80V"', 'Did you mean "80W"?')),
    # missing
    Broken("missing-driver", 'driver = "pinion"\n', "", "[gears]",
           ("gears.driver", "driver is missing", 'driver = "pinion"')),
    Broken("missing-table", '[operation]\nspeed = "900 rpm"\ntorque = "90 N*m"\n', "", "",
           ("operation", "the table [operation] is missing", "Add it with speed, torque")),
    Broken("missing-face-width", 'face_width = "20 mm"\n', "", "[gears.pinion]",
           ("face_width is missing", 'face_width = "20 mm"')),
    Broken("missing-bearing", _DYNAMICS, "", "[dynamics]",
           ("dynamics.bearing_stiffness", "spur-6dof", "torsional")),
    Broken("missing-coefficient", _LAW, 'law = "constant"', "[friction]",
           ("friction.coefficient", "constant", "coefficient = 0.05")),
    Broken("missing-option", _PAIR, "", "[stiffness]",
           ("stiffness.pair_stiffness", "rectangular", '"2e8 N/m"')),
    Broken("missing-counterpart", _PAIR, 'single_pair_stiffness = "2e8 N/m"', "[stiffness]",
           ("double_pair_stiffness is missing", '"2e8 N/m"')),
    Broken("missing-oil", _OIL, 'density = "880 kg/m^3"', "[lubricant]",
           ("dynamic_viscosity is missing", "pressure_viscosity_coefficient is missing", "80W")),
    Broken("missing-mate", "[gears.wheel]\nteeth = 24\nprofile_shift_coefficient = -0.5103\n", "",
           "[gears]", ("gears.wheel", "the table [gears.wheel] is missing")),
    # contradictions
    Broken("two-roughnesses", _TEETH, 'teeth = 16\nroughness_rms = "0.4 um"',
           "composite_roughness",
           ('"0.53 um"', '"0.4 um"', "same quantity", "Keep one")),
    Broken("one-roughness", _ROUGH + "\n[gears.pinion]",
           '[gears.pinion]\nroughness_rms = "0.4 um"', "[gears.wheel]",
           ("roughness_rms of the wheel is missing", '"0.4 um"')),
    Broken("oil-twice", _OIL, _OIL + '\ndynamic_viscosity = "82 mPa*s"', _OIL,
           ('"80W"', '"82 mPa*s"', "same quantity", "Keep one")),
    Broken("sheet-and-name", _OIL, _OIL + '\nviscosity_index = 95', _OIL,
           ('"80W"', "viscosity_index = 95", "same quantity", "Keep one")),
    Broken("sheet-with-one-figure", _OIL, f'kinematic_viscosity_at_40 = "220 mm^2/s"\n{_REST}',
           "[lubricant]", ("kinematic_viscosity_at_100 is missing", "Two of three", "Add one")),
    Broken("sheet-without-density", _OIL, _SHEET + '\ntemperature = "60 degC"', "[lubricant]",
           ("density_at_15 is missing", '"892 kg/m^3"')),
    Broken("sheet-without-temperature", _OIL, _SHEET + '\ndensity_at_15 = "892 kg/m^3"',
           "[lubricant]", ("temperature is missing", '"60 degC"')),
    Broken("sheet-and-property", _OIL, f'{_SHEET}\n{_REST}\ndynamic_viscosity = "82 mPa*s"',
           "dynamic_viscosity", ('"82 mPa*s"', '"220 mm^2/s"', "follows from", "Remove it")),
    Broken("sheet-that-contradicts-itself", _OIL,
           f'{_SHEET}\n{_REST}\nkinematic_viscosity_at_100 = "30 mm^2/s"', "viscosity_index",
           ("viscosity index 95", "220 mm^2/s at 40 degC and 30 mm^2/s at 100", "of 178", "leave")),
    Broken("oil-too-cold", _OIL, _OIL + '\ntemperature = "5 degC"', "temperature",
           ('"80W" at 5 degC', "from 10 to 130 degC", "Give a temperature of this range")),
    Broken("damping-twice", _DYNAMICS,
           _DYNAMICS + '\nmesh_damping = "900 N*s/m"\nmesh_damping_ratio = 0.04', "mesh_damping",
           ('"900 N*s/m"', "0.04", "same quantity", "Keep one")),
    Broken("stiffness-twice", _PAIR, _PAIR + '\nsingle_pair_stiffness = "1e8 N/m"',
           "single_pair_stiffness", ('"2e8 N/m"', '"1e8 N/m"', "same quantity")),
    Broken("foreign-option", _PAIR, _PAIR + '\nreference = "rim"', "reference",
           ('reference = "rim"', "does not belong", "rectangular", "pair_stiffness")),
    Broken("foreign-friction-option", _LAW, 'law = "none"\ncoefficient = 0.05',
           "coefficient = 0.05",
           ("coefficient = 0.05", "does not belong", '"none"', "no options")),
    Broken("bearing-of-torsional", _DYNAMICS, _DYNAMICS + '\nmodel = "torsional"',
           "bearing_stiffness", ("3.5e9 N/m", "torsional", "spur-6dof")),
    Broken("cycles-of-steady", _SOLVER, _SOLVER + "\ncycles = 50", "cycles",
           ("cycles = 50", "steady", "transient")),
    Broken("uneven-table", 'model = "rectangular"\n' + _PAIR,
           'model = "table"\nphase = [0.0, 1.0]\nvalues = ["2e8 N/m"]', "phase",
           ("phase has 2 entries, values has 1", "equal length")),
    Broken("larger-pinion", _TEETH, "teeth = 30", "teeth = 30",
           ("teeth = 30", "teeth = 24", "fewer teeth", "Exchange")),
    Broken("assumed-typo", "[solver]",
           '[assumed]\n"gears.center_distanc" = "guessed"\n[solver]', "center_distanc\"",
           ("gears.center_distanc", "no value is given", 'Did you mean "gears.center_distance"?')),
    Broken("assumed-without-reason", "[solver]",
           '[assumed]\n"gears.center_distance" = 3\n[solver]', "\"gears.center_distance\"",
           ("assumed.gears.center_distance", "must be text")),
    # film
    Broken("film-without-oil", '[lubricant]\nname = "80W"\n', '[film]\nmodel = "newton"\n', "",
           ('film model = "newton" needs an oil', 'name = "80W"')),
    Broken("too-few-nodes", "[solver]", _film("nodes = 33"), "nodes",
           ("film.nodes", "nodes = 33", "65 to 16385", "power of two plus one")),
    Broken("too-many-nodes", "[solver]", _film("nodes = 32769"), "nodes",
           ("film.nodes", "nodes = 32769", "65 to 16385")),
    Broken("nodes-between-grids", "[solver]", _film("nodes = 1000"), "nodes",
           ("film.nodes", "nodes = 1000", "power of two plus one", "nodes = 513 or nodes = 1025")),
    Broken("intervals-for-nodes", "[solver]", _film("nodes = 512"), "nodes",
           ("film.nodes", "nodes = 512", "nodes = 257 or nodes = 513")),
    Broken("fraction-of-a-node", "[solver]", _film("nodes = 513.0"), "nodes",
           ("film.nodes", "nodes = 513.0", "whole number", "nodes = 513")),
    Broken("nodes-of-a-formula", "[solver]", _film('model = "moes"', "nodes = 513"), "nodes",
           ("nodes = 513", 'does not belong to model = "moes"', "stiffness", "Remove it")),
    Broken("too-few-positions", "[solver]", _film("positions = 5"), "positions",
           ("film.positions", "positions = 5", "8 to 200")),
    Broken("positions-of-a-formula", "[solver]", _film('model = "pan-hamrock"', "positions = 30"),
           "positions", ("positions = 30", 'does not belong to model = "pan-hamrock"')),
    Broken("inlet-of-a-formula", "[solver]", _film('model = "moes"', 'inlet = "flooded"'), "inlet",
           ('inlet = "flooded"', 'does not belong to model = "moes"')),
    Broken("starved-anywhere", "[solver]", _film('inlet = "zero"'), "[film]",
           ("film.domain", 'domain is missing for inlet = "zero"', "domain = [-2.5, 1.5]")),
    Broken("domain-of-a-flooded-inlet", "[solver]", _film("domain = [-2.5, 1.5]"), "domain",
           ("domain = [-2.5, 1.5]", 'inlet = "flooded"', 'inlet = "zero"')),
    Broken("domain-inside-the-contact", "[solver]",
           _film('inlet = "zero"', "domain = [-0.5, 1.5]"), "domain",
           ("film.domain", "[-0.5, 1.5]", "-1.5 or less", "[-2.5, 1.5]")),
    Broken("half-a-domain", "[solver]", _film('inlet = "zero"', "domain = [-2.5]"), "domain",
           ("film.domain", "[-2.5]", "two numbers", "[-2.5, 1.5]")),
    Broken("domain-in-metres", "[solver]",
           _film('inlet = "zero"', 'domain = ["-2 mm", "1 mm"]'), "domain",
           ("film.domain", "-2 mm", "pure number")),
    Broken("endless-domain", "[solver]", _film('inlet = "zero"', "domain = [-500, 1.5]"), "domain",
           ("film.domain", "-500", "-100 to 10")),
    Broken("stiffness-without-film", "[solver]", _film('model = "none"', 'stiffness = "tangent"'),
           'stiffness = "tangent"',
           ("film.stiffness", 'stiffness = "tangent"', 'model = "none"', '"newton"')),
    Broken("secant-of-a-formula", "[solver]", _film('model = "moes"', 'stiffness = "secant"'),
           'stiffness = "secant"',
           ("film.stiffness", 'stiffness = "secant"', "none, tangent", '"newton", which has all')),
    Broken("friction-of-no-film", _LAW, 'law = "ehl"', 'law = "ehl"',
           ("friction.law", 'law = "ehl"', 'film model = "none"', 'model = "newton"')),
    Broken("friction-of-a-formula", _LAW, 'law = "ehl"\n[film]\nmodel = "moes"', 'law = "ehl"',
           ("friction.law", 'film model = "moes"', "needs the pressure", 'model = "newton"')),
    Broken("stress-without-unit", _LAW,
           'law = "ehl"\neyring_stress = 5e6\n[film]\nmodel = "newton"', "eyring_stress",
           ("friction.eyring_stress", "needs a unit", "5")),
    Broken("unknown-shear-model", _LAW,
           'law = "ehl"\nshear_model = "eyring"\n[film]\nmodel = "newton"', "shear_model",
           ("friction.shear_model", "newtonian, ree-eyring", 'Did you mean "ree-eyring"?')),
    Broken("shear-model-of-another-law", _LAW, _LAW + '\nshear_model = "newtonian"',
           "shear_model", ('shear_model = "newtonian"', 'does not belong to law = "constant"')),
    Broken("number-of-another-shear-model", _LAW,
           'law = "ehl"\ncarreau_exponent = 0.5\n[film]\nmodel = "newton"', "carreau_exponent",
           ('does not belong to shear_model = "ree-eyring"', 'shear_model = "carreau"')),
    # physics
    Broken("too-close", _DISTANCE, 'center_distance = "80 mm"', "center_distance",
           ("gears.center_distance", "80 mm")),
    Broken("pointed-tip", 'face_width = "20 mm"',
           'face_width = "20 mm"\ntip_diameter = "95 mm"', "tip_diameter",
           ("gears.pinion.tip_diameter", "pointed", "95 mm", "Reduce")),
    Broken("bore-through-root", 'face_width = "20 mm"',
           'face_width = "20 mm"\nbore_diameter = "80 mm"', "bore_diameter",
           ("gears.pinion.bore_diameter", "80 mm", "root")),
    Broken("no-contact", _DISTANCE, 'center_distance = "98 mm"', "[gears]",
           ("contact ratio", "Below 1")),
    # What was meant is told
    Broken("percent", 'coefficient = 0.05', 'coefficient = "5 %"', "coefficient",
           ("pure number", "Write coefficient = 0.05")),
    Broken("diametral-pitch", _MODULE, 'normal_module = "8 1/inch"', "normal_module",
           ("diametral pitch", '"3.175 mm"')),
    Broken("teeth-in-quotes", _TEETH, 'teeth = "16"', 'teeth = "16"', ("Write teeth = 16",)),
    Broken("coulombs", 'name = "80W"', 'name = "80W"\ntemperature = "70 C"', "temperature",
           ('Write temperature = "70 degC"',)),
    Broken("spread-of-both", 'torque = "90 N*m"', 'torque = "90 +- 5 N*m"', "torque",
           ('Write "90 N*m +- 5 N*m"',)),
    Broken("table-of-spreads", "[solver]", '[uncertainty]\ntorque = "5 %"\n[solver]',
           "[uncertainty]", ("is written at its key", "+- 5 %")),
    Broken("relief-of-a-gear", _TEETH, 'teeth = 16\ntip_relief = "9 um"', "tip_relief",
           ("It belongs to [gears.pinion.modification].",)),
    # TOML
    Broken("no-bore", '"rectangular"\n' + _PAIR, '"potential-energy"\nreference = "bore"',
           "[gears.pinion]",
           ("gears.pinion.bore_diameter", "gears.wheel.bore_diameter", 'reference = "rim"')),
    Broken("no-toml-at-all", 'title = "A pair"', "<!DOCTYPE html>" * 50, "<!DOCTYPE",
           ("not TOML", "...", "A line has the form")),
    Broken("too-deep", 'title = "A pair"', "title = " + "[" * 5000, "",
           ("nested too deeply", "not a case file")),
    Broken("unquoted", _MODULE, "normal_module = 4.5 mm", "normal_module",
           ("not TOML", 'Put the value in quotes: normal_module = "4.5 mm"')),
    Broken("unquoted-word", 'driver = "pinion"', "driver = pinion", "driver",
           ("not TOML", 'Put the word in quotes: driver = "pinion"')),
    Broken("open-quotes", 'driver = "pinion"', 'driver = "pinion', "driver",
           ("not TOML", "Close the quotes")),
    Broken("open-bracket", "[solver]", "[solver", "[solver", ("not TOML", "Close the bracket")),
    Broken("key-twice", _TEETH, "teeth = 16\nteeth = 17", "teeth = 17",
           ("gears.pinion.teeth is given twice", "lines 9 and 10", "Remove one")),
    Broken("table-twice", "[solver]", "[gears]\n[solver]", "[gears]\n[solver]",
           ("gears is given twice", "Remove one")),
)  # fmt: skip
