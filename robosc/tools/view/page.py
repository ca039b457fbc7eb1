"""Files of the page, as `npm run build` in `web/` writes them into this package."""

from __future__ import annotations

from pathlib import Path

#: Files of the page and their types.
FILES = {
    "index.html": "text/html; charset=utf-8",
    "page.css": "text/css; charset=utf-8",
    "page.js": "text/javascript; charset=utf-8",
    "layout.js": "text/javascript; charset=utf-8",
    "icon.svg": "image/svg+xml",
    "LICENSES.txt": "text/plain; charset=utf-8",
}
_FOLDER = Path(__file__).with_name("built")
#: The page loads and sends only to its own server, and no text of a model can become a script.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; worker-src 'self'; connect-src 'self'; img-src 'self';"
    " base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


class PageError(Exception):
    """The page has not been built."""


def page_files() -> dict[str, bytes]:
    """Return the content of each of FILES.

    Raises PageError if the page has not been built, as in a fresh clone.
    """
    try:
        return {name: (_FOLDER / name).read_bytes() for name in FILES}
    except FileNotFoundError:
        raise PageError(
            "the page has not been built: `npm ci --prefix web && npm run build --prefix web` in the clone does it,"
            " with Node 20 or newer; the wheels of robosc contain it"
        ) from None
