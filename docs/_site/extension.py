"""Extensions of the site: links to folders, Mermaid without a network, an entry page at its root."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from pygments.lexers.special import TextLexer
from sphinx.addnodes import pending_xref
from sphinx.util.docutils import SphinxDirective

if TYPE_CHECKING:
    from sphinx.application import Sphinx

REPOSITORY = "https://github.com/robosc/robosc/tree/main"
#: The part of Mermaid for the browser, as `npm ci` installs it in `web/`.
MERMAID = Path("web/node_modules/@mermaid-js/tiny/dist/mermaid.tiny.js")
ENTRY = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>RoboSC</title>
<meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">RoboSC</a></html>
"""


class Mermaid(SphinxDirective):
    """A fence ```mermaid that the browser draws. Without the script it stays text."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the text in a frame that the script searches for."""
        text = "\n".join(self.content)
        drawing = nodes.literal_block(text, text, classes=["mermaid-source"])
        drawing["language"] = "none"
        return [nodes.container("", drawing, classes=["mermaid-drawing"])]


def link_folders(app: Sphinx, doctree: nodes.document) -> None:
    """Let a link to a folder lead to its page or, without a page, to the folder in the repository."""
    here = Path(app.env.doc2path(app.env.docname)).parent
    for link in list(doctree.findall(pending_xref)):
        target = (here / str(link["reftarget"])).resolve()
        if link.get("reftype") != "myst" or not target.is_dir() or not str(link["reftarget"]):
            continue
        path = target.relative_to(app.srcdir).as_posix()
        pages = (f"{path}/README", path)
        page = next((name for name in pages if name in app.env.found_docs), None)
        if page is not None:
            link.attributes.update(refdomain="doc", reftarget=page, reftargetid=None)
            continue
        link.replace_self(nodes.reference("", "", *link.children, refuri=f"{REPOSITORY}/{path}"))


def add_script(
    app: Sphinx, _page: str, _template: str, _context: dict[str, Any], doctree: nodes.document | None
) -> None:
    """Add the scripts that draw Mermaid (3 MB), if they are installed, to pages with drawings."""
    drawings = doctree.findall(nodes.container) if doctree is not None else ()
    if (app.srcdir / MERMAID).is_file() and any("mermaid-drawing" in drawing["classes"] for drawing in drawings):
        app.add_js_file("mermaid.tiny.js", loading_method="defer")
        app.add_js_file("draw-mermaid.js", loading_method="defer")


def finish(app: Sphinx, exception: Exception | None) -> None:
    """Write the entry page and Mermaid's script into the built site."""
    if exception is not None or app.builder.format != "html":
        return
    (Path(app.outdir) / "index.html").write_text(ENTRY, encoding="utf-8")
    script = app.srcdir / MERMAID
    if script.is_file():
        shutil.copyfile(script, Path(app.outdir) / "_static" / "mermaid.tiny.js")


def setup(app: Sphinx) -> dict[str, Any]:
    """Connect the extensions. Sphinx calls this function."""
    app.add_directive("mermaid", Mermaid)
    app.add_lexer("cif", TextLexer)  # Pygments has none
    app.connect("doctree-read", link_folders)
    app.connect("html-page-context", add_script)
    app.connect("build-finished", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
