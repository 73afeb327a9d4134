"""Text of the documentation that the program itself writes: ``python tests/docs/generated.py``."""

import re

from pages import ROOT

from tribodyn.study.case.reference import reference_tables, start_toml


def _tables(text: str) -> str:
    """The page on the case file with the tables of all keys at its end."""
    return text[: text.index("### Top of the file")] + reference_tables()


def _start(text: str) -> str:
    """A page with the case file that ``tribodyn new`` writes, between its marks."""
    block = f"<!-- start -->\n```toml\n{start_toml()}```\n<!-- end -->"
    return re.sub(r"<!-- start -->\n.*?<!-- end -->", lambda _: block, text, flags=re.DOTALL)


#: What writes a part of each page anew.
GENERATED = {"README.md": (_start,), "docs/case-file.md": (_start, _tables)}


def written(page: str) -> str:
    """Text of a page with what the program writes in it."""
    text = (ROOT / page).read_text("utf-8")
    for write in GENERATED[page]:
        text = write(text)
    return text


if __name__ == "__main__":
    for page in GENERATED:
        (ROOT / page).write_text(written(page), "utf-8")
