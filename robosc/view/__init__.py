"""`robosc view`: shows a model, a log, a counterexample or a running robot in the browser, decision by decision.

`Moments` is the history of a run: a `Record` that is played, or a `Live` node. `describe` returns the constant parts
of a robot. `server` serves both with the page, and `export` writes them as files that open without a server. The page
itself is TypeScript, in `web/`.
"""

from robosc.view.description import describe
from robosc.view.export import export
from robosc.view.live import Live
from robosc.view.moments import Moments
from robosc.view.page import PageError
from robosc.view.record import Record

__all__ = ["Live", "Moments", "PageError", "Record", "describe", "export"]
