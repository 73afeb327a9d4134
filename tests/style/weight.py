"""Weight of the package: code lines, files, ``Any``, circles of imports; run it to print them."""

from __future__ import annotations

import ast
import io
import sys
import tokenize
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from source_tree import Module, modules

__all__ = ["ANY", "FILES", "LINES", "import_circles", "lines_of_code", "measures", "overweight"]

#: Code lines of each package. A number is raised only in the commit that brings a capability, with
#: a comment that names it; ``python tests/style/weight.py`` prints the numbers of today.
#: cli, study: tribodyn rate, the load capacity of the gears of a case.
#: rating: load capacity of gears by ISO 6336; lubricant: the line of Walther beyond its points.
#: study: quantities of unit libraries are read by exact factors. dynamics, machine: machines of
#: many phases are linearised in seconds. dynamics: no warning of few lanes on a graphics processor.
#: app, report, study: studies of one mesh, recordings and friction from losses on the page.
#: report: figures of parts as tables with a column for each part.
#: plot: bearing forces about their means, modes that the mesh strains, captions by the data.
#: study: cases of parts are equal, printed, and have [based_on] as pairs have.
#: analysis, cli, plot, study: kinematic frequencies of every case.
#: study: heat balance of machines.
#: study: film, friction and load agree in machines.
#: dynamics: adaptive trajectories of an ensemble step side by side.
#: machine, study: models of couplings, one file each.
#: arguments: copies that the package makes of its own objects are not checked again.
#: dynamics, nonlinear, report, study: diagrams, branches, basins and exponents of machines.
#: cli, dynamics, plot, study: machines of any teeth over independent phases, with their cost.
#: cases: the friction experiment, a study of papers, came from study
#: notebooks: tables of results, progress as text, short tracebacks and warnings in IPython.
#: rating: root stress by finite elements, computed load sharing
#: machine, study: life of bearings, fatigue of shafts of a case
#: app: motions of one mesh of a machine on the page
#: dynamics: rattle over phases integrated over time, contacts named
#: scope: one table of what is modelled, from which pages and messages come.
#: rating: criteria point by point over path and face, with maps
#: exchange: REXS to 2.0.0, racks of manufacturing steps, remarks on protuberance.
#: model, study: tables of machines are declared, one form of the page reads them
#: cli, study: best crowning and lead slope of a case
#: cli, study: probability of failure, safeties in summaries and reports
#: rating: sources say what is from memory
#: dynamics: march over phases, grids of each part
#: rating: ideal sharing on the path of contact
#: faults: check finds clamped teeth, run-ups over phases
#: rating, study: limits of factors and bearings reported with value and limit
#: measurement: names of channels in MAT files come back.
#: faults: phases of the shafts
#: study: one change by key for pairs and machines
#: plot: probability of failure, maps of ratings.
#: losses: bearings, seals and oil of machines
#: dynamics: turning errors on one clock
#: study: summary figures of users for every kind of part
#: rating, study: shafts against yield, oils of one viscosity
#: record: results are built from what their parts state
#: study: files of pairs keep their comments too
#: rating, study: load histories, wear of helical flanks, micropitting by method A
#: dynamics: motions over phases with forces that jump, to 1e-5
#: exchange, study: machines as REXS models, housings from Nastran punch files
#: plot, report: a machine in space, with its flow of power and its modes.
#: study: one settling of every kind of case
#: rating, stiffness: root stress of slices by solid elements
#: study: hunting pairs move over phases, lines name their cause, no longest period
#: types: arrays of texts have a name; arguments: annotations with a name
#: stiffness: rims of rings named as such
#: study: one reader for cases of every kind
#: plot: the spectrum of a machine names its largest combination lines
#: study, cli: verdicts on recordings
#: rating: deviations in fewer lines
#: study: phases with a clearance are refused
#: plot, study: a figure of the verdict on recordings; export of machines by the command.
#: variants: a closed connection to a cluster is said.
#: study, machine: housings from Abaqus and Ansys, refused where not symmetric or active.
#: dynamics: cheap parts of modal steps
#: study, measurement: recorded torques as load classes, shaping cutters of case files.
#: dynamics: idle gears float, whatever rounding does
#: nonlinear, study: machines settle as long as their slowest mode decays
#: study: machines warn, are stored and summed up as pairs are
#: dynamics: motions over phases in less time
#: study: one class Case reads and checks a case of any kind
#: report: figures of the teeth of machines
#: stiffness: force laws of heavy teeth
#: nonlinear: exponents from one period of the tangent
#: study: loads of machines beside their parts
#: study: wrong loads refused where they are written
#: dynamics: bearings with a clearance over independent phases
#: study: a verdict in volts names what it lacks.
#: study: check names keys without effect
#: study: verdicts on recordings find their speed
#: interrupt, stiffness, types: a run starts without SciPy's linear algebra; options have a type
#: dynamics: time of motions over phases is stated and shorter
#: study: hands of gears in meshes and stages
#: dynamics: motions whose disturbances grow are warned of
#: study: the class of all cases
#: dynamics: warnings of loose bearings hold for the last pass
#: dynamics: growth of disturbances where a period forgets them
#: study: hands
#: study: a stored load has its own figures alone
#: cli: check of a machine fits a screen, --all lists what is assumed
#: study: damage table of load classes with torque, speed and time
#: study: zero-torque loads and large pin errors refused at their key; gear: tip round that fits
#: dynamics: motions over phases that are unstable are named
#: study: check names keys of hypoid flanks, heat and bodies that do nothing
#: arguments, plot: options keep their units; captions from docstrings
#: dynamics: cracks and eccentric gears at once, ten times as fast
#: dynamics: smooth searches of motions over phases
#: model: runs and help start sooner, as the installed packages are searched once
#: study: starts of machines chosen by their time, long studies refused before teeth
#: study: messages about teeth name the gears of the file
#: aliases: names of pages are listed once, in stubs.
#: study: a sweep over speed or torque reads a machine once
#: study: dynamic transmission error of each mesh of a machine, as pairs have it
#: nomenclature: help starts sooner, without gears and models of contact
#: study: fast changes of numbers of tables alone
#: slow pairs by harmonic balance
#: solver.engine of every kind: harmonic balance of pairs and a choice by fitness
#: time of a motion over phases from what its forces do
#: machine, study: bearings of one axial direction found before the balance
#: notebook, study: unknown attributes end at the user's line; ratings of ISO 20816-9; sidebands
#: dynamics, machine: sweeps of machines in two fifths of the time
#: rating, study: what cannot be rated is refused before the run
#: rating, study: masses of planetary stages for K_v
#: study: machines take more steps where 128 do not suffice
#: machine: shares of planets do not depend on the processor
#: signals: Fourier sums over uneven places, from measurement
#: dynamics: slow meshes whose jumps excite natural frequencies get the points that they need
#: study: a refusal names the faults without which the motion fits the memory
#: arrays, compiled, contact, machine: starts without SciPy and Numba
#: study, dynamics: check states what a mesh that rings takes
#: study, dynamics: the choice between one clock and phases counts the work of both
#: dynamics: motions over phases with flanks that open are found in more cases
#: dynamics: forces of meshes have the lines of other meshes that their grids lack
#: dynamics: a turbine of three stages takes 2 GB
#: stiffness: stored compliances of bevel gears are checked again
#: dynamics: cracked and spalled teeth of large machines fit into the default memory.
#: dynamics: times that check states follow from counted operations of a trial
#: plot: lines of shafts with faults are shown, and close names do not overlap
#: 0.2.0: motion of a machine with a damaged planet over phases.
#: study: check states motions with faults on one clock, and what a search in vain takes
LINES: dict[str, int] = {
    "__init__": 24,
    "__main__": 3,
    "aliases": 105,
    "analysis": 54,
    "app": 2223,
    "arguments": 623,
    "arrays": 201,
    "cases": 1360,
    "checkpoints": 142,
    "cli": 2763,
    "compiled": 238,
    "contact": 398,
    "cookbook": 102,
    "drawing": 204,
    "dynamics": 16063,
    "ehl": 9327,
    "errors": 221,
    "exchange": 2162,
    "faults": 1652,
    "files": 244,
    "friction": 1461,
    "gear": 3629,
    "interrupt": 222,
    "losses": 896,
    "lubricant": 507,
    "machine": 5676,
    "measurement": 3339,
    "members": 3,
    "mesh": 5508,
    "model": 229,
    "nomenclature": 98,
    "notebook": 63,
    "nonlinear": 2556,
    "plot": 8640,
    "progress": 72,
    "rating": 2798,
    "record": 213,
    "report": 1764,
    "scope": 38,
    "signals": 1727,
    "stiffness": 5185,
    "study": 20188,
    "surrogate": 765,
    "types": 13,
    "uncertainty": 288,
    "units": 245,
    "validated_files": 195,
    "variants": 1030,
}
#: Modules of the package, and its annotations without a type.
FILES, ANY = 685, 1204

_NO_CODE = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
    tokenize.ENDMARKER,
}  # fmt: skip
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def lines_of_code(module: Module) -> int:
    """Lines with code: without docstrings, comments and empty lines."""
    documented: set[int] = set()
    for node in module.nodes:
        if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            text = node.body[0]
            documented.update(range(text.lineno, (text.end_lineno or text.lineno) + 1))
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(module.text).readline):
        if token.type not in _NO_CODE:
            lines.update(range(token.start[0], token.end[0] + 1))
    return len(lines - documented)


def untyped(module: Module) -> int:
    """Times that a module says ``Any``."""
    return sum(isinstance(node, ast.Name) and node.id == "Any" for node in module.nodes)


def import_circles(read: Iterable[Module]) -> list[set[str]]:
    """Modules that import each other in a circle, with the imports inside functions."""
    dotted = {_name(module): module for module in read}
    places = {name: place for place, name in enumerate(dotted)}
    edges = [
        (place, places[target])
        for name, place in places.items()
        for target in _imports(dotted[name], dotted)
        if target != name and not name.startswith(f"{target}.")
    ]
    rows, columns = np.array(edges, dtype=int).reshape(-1, 2).T
    size = len(places)
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    _, labels = connected_components(graph, connection="strong")
    circles: dict[int, set[str]] = {}
    for name, place in places.items():
        circles.setdefault(int(labels[place]), set()).add(name)
    return sorted((circle for circle in circles.values() if len(circle) > 1), key=len)[::-1]


def _name(module: Module) -> str:
    return ".".join(Path(module.path).with_suffix("").parts[1:]).removesuffix(".__init__")


def _imports(module: Module, names: Container[str]) -> Iterator[str]:
    """Modules of some names that a module imports when it runs."""
    for_types = {
        inner
        for node in module.nodes
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    for node in module.nodes:
        targets = []
        if isinstance(node, ast.Import):
            targets = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            targets = [f"{node.module}.{alias.name}" for alias in node.names]
        for target in targets if node not in for_types else []:
            while target and target not in names:
                target = target.rpartition(".")[0]
            if target:
                yield target


def measures(read: Iterable[Module]) -> tuple[Counter[str], int, int]:
    """Code lines by package, number of modules, and annotations without a type."""
    lines: Counter[str] = Counter()
    count = without = 0
    for module in read:
        lines[module.package] += lines_of_code(module)
        without += untyped(module)
        count += 1
    return lines, count, without


def overweight(lines: Mapping[str, int], allowed: Mapping[str, int]) -> list[str]:
    """Packages that have more code than is allowed."""
    return [
        f"{package}: {count} code lines, at most {allowed.get(package, 0)}"
        for package, count in sorted(lines.items())
        if count > allowed.get(package, 0)
    ]


def _print() -> None:
    lines, count, without = measures(modules())
    for package, number in sorted(lines.items()):
        print(f'    "{package}": {number},')
    print(f"code lines {lines.total()}, files {count}, Any {without}")
    for circle in import_circles(modules()):
        print(f"circle of {len(circle)}: {', '.join(sorted(circle))}")


if __name__ == "__main__":
    sys.exit(_print())
