"""The documentation as a site: ``python -m sphinx -W -n docs build/docs``."""

import sys
from pathlib import Path

import tribodyn

sys.path.insert(0, str(Path(__file__).parent))

project = "tribodyn"
author = "The tribodyn developers"
release = version = tribodyn.__version__
exclude_patterns = ["extending"]
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "numpydoc",
    "sphinx_copybutton",
    "sphinx_design",
    "_site",
]
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
python_maximum_signature_line_length = 88
numpydoc_show_class_members = False
html_theme = "furo"
html_title = "tribodyn"
html_show_copyright = False
html_copy_source = False
# Summaries are fetched from a server, which pages on disk do not have.
html_show_search_summary = False
