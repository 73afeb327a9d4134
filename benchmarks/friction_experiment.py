"""How long do 250 steady states under all friction laws take, with shared films and each by itself?

The rival runs every state as a case of its own, one after the other; a sample of them is timed and
counted up.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence

from race import Goal, arguments, print_goals
from tribodyn import friction_experiment, load_case, run
from tribodyn.cases.papers.friction_experiment import ROUGHNESSES
from tribodyn.errors import ModelWarning

#: Changes of the sample: laws that differ in what they need.
SAMPLE = ("none", "benedict-kelly", "xu-2007", "mixed", "mixed-ehl", "ehl")


def main(words: Sequence[str] | None = None) -> None:
    """Print seconds of the experiment and of its states one by one."""
    quick = arguments(__doc__, words).quick
    case = load_case("fzg-roughness").replace({"film.model": "newton"})
    heights = ROUGHNESSES[1:3] if quick else ROUGHNESSES
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        run(case.replace({"friction.law": "ehl"}))  # what is compiled once
        start, used = time.perf_counter(), time.process_time()
        found = friction_experiment(case, roughness=heights)
        spent, used = time.perf_counter() - start, time.process_time() - used
        start = time.perf_counter()
        for law in SAMPLE:
            run(case.replace({"friction.law": law})).summary()
        alone = (time.perf_counter() - start) / len(SAMPLE) * len(found.points)
    print(f"{len(found.points)} steady states with shared films   {spent:6.1f} s, {used:.1f} s CPU")
    times = f"{alone:6.1f} s, {alone / spent:.2g} times"
    print(f"each by itself, from {len(SAMPLE)} of them           {times}")
    if not quick:
        print_goals([Goal("the whole experiment", 60.0, spent, "s wall", at_least=False)])


if __name__ == "__main__":
    main()
