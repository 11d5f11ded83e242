"""Sphinx settings of the documentation site: `make site`."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent / "extensions"), str(Path(__file__).parent.parent)]

project = "active-surface"
author = "the active-surface authors"
project_copyright = f"2026, {author}"
exclude_patterns = ["extensions", "decisions"]
extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc", "contents", "mathml", "reference"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
default_role = "literal"
smartquotes = False
highlight_language = "text"

numpydoc_show_class_members = False  # automodule lists them
numpydoc_class_members_toctree = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {name: name for name in ("ArrayLike", "FloatArray", "IntArray", "BoolArray")}
python_use_unqualified_type_names = True
add_module_names = False
maximum_signature_line_length = 90

html_math_renderer = "mathml"
html_theme = "furo"
html_title = "active-surface"
html_static_path = ["extensions/site.css"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
