"""Text of the documentation that the program itself writes: ``python tests/docs/generated.py``."""

import re
import sys
from textwrap import fill, indent

from contents import page as contents_page
from pages import ROOT
from written_tables import (
    kind_table,
    machine_tables,
    needs_table,
    program_table,
    reference_tables,
    scope_table,
)

sys.path.insert(0, str(ROOT / "docs"))

from _site.names import described, packages

from tribodyn.aliases import RENAMED
from tribodyn.scope import PROGRAMS, statement
from tribodyn.study import Case
from tribodyn.study.case.reference import start_toml
from tribodyn.study.case.section import Table
from tribodyn.study.case.values import Term, find_term, listed_terms
from tribodyn.study.pipeline.citations import bibliography


def _tables(text: str) -> str:
    """The page on the case file with the tables of all keys at its end."""
    head = text[: text.index("### Top of the file")]
    return f"{head}{reference_tables()}\n{_OF_PARTS}{machine_tables()}"


_OF_PARTS = """## All keys of machines and planetary stages

`NAME` is the name of a part. `[dynamics]` also has the keys of a pair but for `model` and
`bearing_damping_ratio`, and a mesh or a stage may have them too; `[material]`, `[lubricant]`,
`[film]`, `[stiffness]` and `[friction]` are those above, for all meshes or, as
`[meshes.NAME.film]`, for one. `tribodyn new my.toml --machine`, `--stage` and `--hypoid` write
short files to fill in.

"""


def _start(text: str) -> str:
    """A page with the case file that ``tribodyn new`` writes, between its marks."""
    block = f"<!-- start -->\n```toml\n{start_toml()}```\n<!-- end -->"
    return re.sub(r"<!-- start -->\n.*?<!-- end -->", lambda _: block, text, flags=re.DOTALL)


def _faults(text: str) -> str:
    """The page on faults with the table of kinds between its marks."""
    block = f"<!-- kinds -->\n{kind_table()}\n<!-- end -->"
    return re.sub(r"<!-- kinds -->\n.*?<!-- end -->", lambda _: block, text, flags=re.DOTALL)


def _needs(text: str) -> str:
    """The page on the command line with the table of studies between its marks."""
    block = f"<!-- needs -->\n{needs_table()}\n<!-- end -->"
    return re.sub(r"<!-- needs -->\n.*?<!-- end -->", lambda _: block, text, flags=re.DOTALL)


def _scope(text: str) -> str:
    """A page with what the table of the scope says between its marks."""
    texts = {"table": scope_table(), "gears": fill(f"It models {statement('gears')}.", 110)}
    texts |= {name: program_table(name) for name in PROGRAMS}
    return re.sub(
        r"<!-- scope (\w+) -->\n.*?<!-- end -->",
        lambda mark: f"<!-- scope {mark[1]} -->\n{texts[mark[1]]}\n<!-- end -->",
        text,
        flags=re.DOTALL,
    )


def _citation(text: str) -> str:
    """The abstract of the citation."""
    abstract = fill(f"{statement('summary').capitalize()}. Gears: {statement('gears')}.", 98)
    block = f"abstract: >-\n{indent(abstract, '  ')}\nauthors:"
    return re.sub(r"abstract: >-\n.*?authors:", lambda _: block, text, flags=re.DOTALL)


def _description(text: str) -> str:
    """The description of the package."""
    line = f'description = "Gear tribo-dynamics: {statement("summary")}"'
    return re.sub(r'^description = ".*"$', lambda _: line, text, count=1, flags=re.MULTILINE)


def _words(text: str) -> str:
    """The page of the words of the trade."""
    terms: dict[Term, list[str]] = {}
    for word in listed_terms():
        if (term := find_term(word)) is not None:
            terms.setdefault(term, []).append(word)
    rows = sorted(
        f"| {', '.join(words)} | {term.meaning} | {f'`{term.key}`' if term.key else ''} | "
        f"[{term.page.partition('.')[0]}]({term.page}) |"
        for term, words in terms.items()
    )
    return "\n".join([_OF_WORDS, *rows]) + "\n"


_OF_WORDS = """# Words of the trade

After this page you know what tribodyn calls what you look for. `tribodyn explain WORDS` prints the
same, and explains every key, model, law, symbol and warning besides.

| words | what it is here | key or quantity | page |
|---|---|---|---|"""


def _bibliography(text: str) -> str:
    """The page of sources."""
    users: dict[str, list[str]] = {}
    for table, field in Case.fields.items():
        models = field.kind.section_keys().models if isinstance(field, Table) else {}
        for model in models.values():
            for key in model.papers:
                users.setdefault(key, []).append(f"`{table}` `{model.name}`")
    lines = [
        f"- {reference}{_used(users.get(key, []))}" for key, reference in bibliography().items()
    ]
    return _HEAD + "\n".join(lines) + "\n"


def _used(by: list[str]) -> str:
    return f" ({', '.join(by)})" if by else ""


_HEAD = """# Sources

Every source that the program and these pages cite, ordered by author and title; behind it the
models that rest on it. `tribodyn cite DIRECTORY` prints those behind one result, `--bibtex` for
BibTeX. Docstrings name the source of every formula with its equation or table.

"""


def _reference(text: str) -> str:
    """The page of public names."""
    lines = [
        "# Public names",
        "",
        "What can be imported, by package, with the first line of its contract. `help(name)` shows",
        "the whole: parameters with units and shapes, results, errors, range, source, example.",
    ]
    for name, package in packages().items():
        lines += ["", f"## `{name}`", "", "| name | what it is |", "|---|---|"]
        lines += [
            f"| `{public}` | {described(package, public)} |"
            for public in sorted(package.__all__, key=str.casefold)
        ]
    lines += ["", *_DEPRECATED, *(f"| `{old}` | `{new}` |" for old, new in RENAMED.items())]
    return "\n".join(lines) + "\n"


_DEPRECATED = (
    "## Deprecated names",
    "",
    "Earlier names still work; a script that uses one gets a `DeprecationWarning` with the new",
    "name. Parameters are written in brackets behind their function or class; `Section` is that",
    "of every table of a case, and of the case.",
    "",
    "| deprecated name | current name |",
    "|---|---|",
)

#: What writes a page, or a part of it, anew.
GENERATED = {
    "README.md": (_start, _scope),
    "CITATION.cff": (_citation,),
    "pyproject.toml": (_description,),
    "docs/scope.md": (_scope,),
    "docs/words.md": (_words,),
    **{f"docs/coming-from-{name}.md": (_scope,) for name in PROGRAMS.values()},
    "docs/command-line.md": (_needs,),
    "docs/case-file.md": (_start, _tables),
    "docs/faults.md": (_faults,),
    "docs/bibliography.md": (_bibliography,),
    "docs/reference.md": (_reference,),
    "docs/coverage.md": (contents_page,),
}


def written(page: str) -> str:
    """Text of a page with what the program writes in it."""
    text = (ROOT / page).read_text("utf-8") if (ROOT / page).exists() else ""
    for write in GENERATED[page]:
        text = write(text)
    return text


if __name__ == "__main__":
    for page in GENERATED:
        (ROOT / page).write_text(written(page), "utf-8")
