"""What the site has beyond the pages: contents, gallery, reference, glossary, links, llms.txt.

The pages stand as they read in the repository. Here the links of the index become the tree of
contents, links to examples lead to the gallery, those to packages to the reference, and names in
code type lead to where they are explained. Written pages go to ``docs/_generated``.
"""

from pathlib import Path
from typing import Any

GENERATED = Path(__file__).resolve().parents[1] / "_generated"


def setup(app: Any) -> dict[str, bool]:
    """Register everything with Sphinx."""
    from _site import llms, pages, reference

    app.connect("builder-inited", _write)
    app.connect("build-finished", llms.write)
    app.connect("source-read", pages.rewrite)
    app.connect("autodoc-process-docstring", reference.escape, priority=900)
    app.connect("missing-reference", reference.resolve)
    app.add_post_transform(reference.NamesInCode)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write(_: Any) -> None:
    from _site import gallery, reference

    written = {**gallery.written(), **reference.written()}
    for name, text in written.items():
        path = GENERATED / name
        path.parent.mkdir(parents=True, exist_ok=True)
        # A page that is as before keeps its time, so that Sphinx need not read it again.
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")
    for path in GENERATED.rglob("*.md"):
        if path.relative_to(GENERATED).as_posix() not in written:
            path.unlink()
