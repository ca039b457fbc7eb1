"""Exports the page as files that open without a server."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.tools.view.page import POLICY, page_files

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

#: Characters that must be escaped in a script.
_ESCAPED = {ord("<"): "\\u003c", ord("\u2028"): "\\u2028", ord("\u2029"): "\\u2029"}


def export(description: Mapping[str, Any], moments: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Return the files of the page with a robot's description and the moments of a run: texts by their names.

    Raises PageError if the page has not been built.
    """
    files = {name: content.decode() for name, content in page_files().items()}
    data = json.dumps({"description": description, "moments": moments}, ensure_ascii=False).translate(_ESCAPED)
    files["run.js"] = f"globalThis.robosc = {data};\n"
    # A page from a file must not start a worker, so the page itself computes the layout.
    scripts = (
        '<script src="run.js"></script>\n    <script src="layout.js"></script>\n    <script src="page.js"></script>'
    )
    page = files["index.html"].replace('<script src="page.js"></script>', scripts)
    policy = f'<meta http-equiv="Content-Security-Policy" content="{POLICY.partition("; frame-ancestors")[0]}" />'
    files["index.html"] = page.replace('<meta charset="utf-8" />', f'<meta charset="utf-8" />\n    {policy}')
    return files
