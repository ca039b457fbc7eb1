"""Sphinx configuration of the documentation site: `scripts/site`.

The source folder is the repository, so that a link between files is the same on GitHub and on the site.
"""

import sys
from pathlib import Path

import robosc

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs"))

project = "RoboSC"
author = "The RoboSC authors"
project_copyright = author
version = release = robosc.__version__
language = "en"

root_doc = "docs/index"
source_suffix = {".md": "markdown"}
include_patterns = [
    "docs/**",
    "examples/*.md",
    "examples/*/*.md",
    "editors/vscode/README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
]
exclude_patterns = [
    "docs/_*",
    "**/node_modules",
    *(path.name for path in ROOT.iterdir() if path.is_dir() and path.name not in ("docs", "examples", "editors")),
]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "_site.extension"]
myst_enable_extensions = ["attrs_block", "deflist"]
# Anchors of headings, as on GitHub.
myst_heading_anchors = 4
myst_fence_as_directive = ["mermaid"]

# A fence without a language contains a program's output.
highlight_language = "none"
pygments_style = "friendly"
pygments_dark_style = "native"
# Prompts are not copied.
copybutton_prompt_text = r"\$ |> "
copybutton_prompt_is_regexp = True

default_role = "code"
autodoc_typehints = "description"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
# Types of other libraries, and of parts of the tool without a page.
nitpick_ignore_regex = [("py:(class|exc|obj)", r".*")]

html_theme = "furo"
html_title = "RoboSC"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True, "top_of_page_buttons": []}
