"""`robosc view`: a model, a log, a counterexample or a robot that runs in the browser, decision by decision.

`Moments` are what has happened: of a `Record` that is played, or `Live` as a node tells. `describe` says what does not
change, `server` serves both with the page, `export` writes them as files that open without a server. The page
itself is TypeScript, in `web/`.
"""

from robosc.view.description import describe
from robosc.view.export import export
from robosc.view.live import Live
from robosc.view.moments import Moments
from robosc.view.page import PageError
from robosc.view.record import Record

__all__ = ["Live", "Moments", "PageError", "Record", "describe", "export"]
