"""How long do all friction laws take over a million contact states?

Processor time of one core, each law alone, with its range checked; the laws that shear the
solved film need films and are left out. The rival of Xu's law is its bare formula in NumPy, without
checks and units.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from race import Goal, arguments, print_goals, race
from reference_pair import path
from tribodyn.errors import quiet
from tribodyn.friction import LAWS, TribologicalContact, pitch_point

OPTIONS = {"constant": {"coefficient": 0.05}}


def contacts(count: int) -> TribologicalContact:
    """Seeded states like those of gears."""
    random = np.random.default_rng(1)
    entrainment = random.uniform(1.0, 20.0, count)
    ratio = random.uniform(-1.0, 1.0, count)
    return TribologicalContact(
        load_per_width=random.uniform(5e4, 5e5, count),
        hertz_pressure=random.uniform(0.5e9, 1.5e9, count),
        sliding_speed=ratio * entrainment,
        entrainment_speed=entrainment,
        slide_to_roll_ratio=ratio,
        equivalent_radius=random.uniform(5e-3, 5e-2, count),
        dynamic_viscosity=0.03,
        composite_roughness=0.4e-6,
        oil_density=880.0,
        film_thickness=random.uniform(1e-7, 1e-6, count),
        pitch=pitch_point(path().pair, 150.0, 150.0),
    )


def plain_xu(contact: TribologicalContact) -> np.ndarray:
    """Xu's formula and nothing else."""
    pressure, ratio = contact.hertz_pressure * 1e-9, np.abs(contact.slide_to_roll_ratio)
    viscosity, speed = contact.dynamic_viscosity * 1e3, contact.entrainment_speed
    product = ratio * pressure * np.log10(viscosity)
    rough = 0.620305 * np.exp(contact.composite_roughness * 1e6)
    f = -8.916465 - 0.354068 * product + 2.812084 * np.exp(-product) + rough
    powers = pressure**1.03303 * ratio**1.036077 * speed**-0.100601 * viscosity**0.752755
    return np.exp(f) * powers * contact.equivalent_radius**-0.390958


def main(words: Sequence[str] | None = None) -> None:
    """Print seconds of each law and their sum."""
    count = 10_000 if arguments(__doc__, words).quick else 1_000_000
    few, contact, total = contacts(10), contacts(count), 0.0
    for name in LAWS:
        if LAWS[name].needs_film:
            continue
        with quiet():  # What is imported or tabulated once belongs to no state.
            LAWS[name](few, **OPTIONS.get(name, {}))
        start = time.process_time()
        with quiet():
            LAWS[name](contact, **OPTIONS.get(name, {}))
        spent = time.process_time() - start
        total += spent
        print(f"{name:<20} {spent:6.3f} s for {count} states")
    print(f"{'all laws':<20} {total:6.3f} s")
    with quiet():
        times = race({
            "ours": lambda: float(LAWS["xu-2007"](contact).size),
            "plain": lambda: float(plain_xu(contact).size),
        }, 5)  # fmt: skip
        apart = np.abs(LAWS["xu-2007"](contact) / plain_xu(contact) - 1.0).max()
    ratio = times["ours"].faster_than(times["plain"])
    print(f"xu-2007 takes {1.0 / ratio:.2f} times the plain formula, equal to {apart:.1g}")
    print_goals([Goal("all laws, 1e6 states", 1.0, total * 1e6 / count, "s", at_least=False)])


if __name__ == "__main__":
    main()
