"""The reference: a page for each package, and links from names to it."""

import contextlib
import importlib
import inspect
import re
import textwrap
from functools import cache
from typing import Any

from docutils import nodes
from numpydoc.docscrape_sphinx import SphinxDocString
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.nodes import make_refnode

from _site.names import described, homes, packages
from tribodyn.nomenclature import QUANTITIES


def written() -> dict[str, str]:
    """The pages by file name."""
    index = ["# Reference", "", "Public names by package; each with its whole contract.", ""]
    index += ["| package | what it holds |", "|---|---|"]
    pages = {}
    for name, package in packages().items():
        docstring = _markdown(inspect.getdoc(package) or "")
        first = " ".join(docstring.partition("\n\n")[0].split())
        index.append(f"| [`{name}`]({name}.md) | {first} |")
        pages[f"api/{name}.md"] = _page(name, package, docstring)
    tree = ["", "```{toctree}", ":hidden:", "", *packages(), "```", ""]
    return {"api/index.md": "\n".join([*index, *tree]), **pages}


def _page(name: str, package: Any, docstring: str) -> str:
    names = sorted(package.__all__, key=str.casefold)
    rows = [f"| {{py:obj}}`{n} <{homes()[name, n]}>` | {described(package, n)} |" for n in names]
    mine = [n for n in names if homes()[name, n] == f"{name}.{n}"]
    entries = "\n".join(_entry(package, n) for n in mine)
    docstring = re.sub(r"^>>> (?:.+\n?)+", _code, docstring, flags=re.MULTILINE)
    table = "\n".join(["| name | what it is |", "|---|---|", *rows])
    return (
        f"# {name}\n\n{docstring}\n\n{table}\n\n## Contracts\n\n````{{eval-rst}}\n{entries}\n````\n"
    )


def _code(example: re.Match[str]) -> str:
    return f"```pycon\n{example[0].rstrip()}\n```\n"


def _markdown(text: str) -> str:
    return re.sub(r":[a-z]+:`~?([^`]*)`", r"`\1`", text).replace("``", "`")


def _entry(package: Any, name: str) -> str:
    """Directive that writes the contract of one name."""
    value, full = getattr(package, name), f"{package.__name__}.{name}"
    if inspect.isclass(value):
        options = ["   :members:", "   :show-inheritance:"]
        bases = [base for base in value.__mro__[1:] if base.__module__.startswith("tribodyn")]
        foreign = [base.__name__ for base in value.__mro__[1:] if base not in bases]
        options += [f"   :inherited-members: {', '.join(foreign)}"] if bases else []
        return "\n".join([f".. autoclass:: {full}", *options, ""])
    if inspect.isroutine(value) or hasattr(value, "py_func"):
        return f".. autofunction:: {full}\n"
    if hasattr(value, "draw"):
        contract = str(SphinxDocString(inspect.getdoc(value.draw) or ""))
        head = f".. py:function:: {full}{inspect.signature(value.draw)}"
        return f"{head}\n\n{textwrap.indent(contract, '   ')}\n"
    text = described(package, name)
    return f".. py:data:: {full}\n\n   {text.replace('`', '``')}\n"


@cache
def _unique_homes() -> dict[str, str]:
    """Page of each name that has one meaning."""
    all_homes: dict[str, set[str]] = {}
    for (package, name), home in homes().items():
        all_homes.setdefault(name, set()).add(home)
        all_homes.setdefault(f"{package}.{name}", set()).add(home)
    return {name: min(places) for name, places in all_homes.items() if len(places) == 1}


def home_of(text: str) -> str | None:
    """Full name of what is written as ``td.run``, ``Case.replace()`` or ``solve_line_contact``."""
    called = text.endswith("()")
    name = re.sub(r"\(\)$", "", text).replace("td.", "tribodyn.", 1)
    if not re.fullmatch(r"[A-Za-z_][\w.]*", name):
        return None
    if not called and "." not in name and name.islower() and "_" not in name:
        return None
    short = name.split(".")
    for end in range(len(short), 0, -1):
        for start in (0, end - 1):
            home = _unique_homes().get(".".join(short[start:end]))
            if home:
                return ".".join([home, *short[end:]])
    return None


def resolve(app: Any, env: Any, node: Any, content: Any) -> Any:
    """Lead a reference to the one place of a name that several packages have."""
    if node.get("refdomain") != "py":
        return None
    target = node["reftarget"]
    objects = env.get_domain("py").objects
    home = home_of(target if "." in target else f"{target}()")
    if home in objects:
        entry = objects[home]
        return make_refnode(app.builder, node["refdoc"], entry.docname, entry.node_id, content)
    return content if exists(target) else None


def exists(target: str) -> bool:
    """Whether a name is one of another library, or one of ours that is not public."""
    if not target.startswith("tribodyn."):
        return True
    for parts in range(target.count(".") + 1, 0, -1):
        names = target.split(".")
        with contextlib.suppress(ImportError):
            value = importlib.import_module(".".join(names[:parts]))
            return all((value := getattr(value, name, None)) is not None for name in names[parts:])
    return False


class NamesInCode(SphinxPostTransform):
    """Lead names in code type to the reference, or to the glossary."""

    default_priority = 5

    def run(self, **_: Any) -> None:
        """Link every unambiguous name."""
        objects = self.env.get_domain("py").objects
        terms = self.env.get_domain("std").objects
        for literal in list(self.document.findall(nodes.literal)):
            if isinstance(literal.parent, nodes.reference) or _in_signature(literal):
                continue
            text = literal.astext()
            term = terms.get(("term", text)) if text in QUANTITIES else None
            home = None if term else home_of(text)
            if term:
                docname, anchor = term
            elif home in objects:
                docname, anchor = objects[home].docname, objects[home].node_id
            else:
                continue
            link = make_refnode(
                self.app.builder, self.env.docname, docname, anchor, literal.deepcopy()
            )
            literal.parent.replace(literal, link)


def _in_signature(node: Any) -> bool:
    while node is not None:
        if isinstance(node, nodes.title | nodes.reference):
            return True
        node = node.parent
    return False


def escape(_: Any, __: str, ___: str, ____: Any, _____: Any, lines: list[str]) -> None:
    """Keep bars of absolute values from being read as substitutions."""
    for number, line in enumerate(lines):
        pieces = re.split(r"(``.*?``)", line)
        if "|" in line and not line.lstrip().startswith("|"):
            pieces[::2] = [piece.replace("|", r"\|") for piece in pieces[::2]]
            lines[number] = "".join(pieces)
