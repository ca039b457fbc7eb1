"""`robosc view`: shows a model, a log, a counterexample or a running robot in the browser, decision by decision.

`Moments` is the history of a run: a `Record` that is played, or a `Live` node. `describe` returns the constant parts
of a robot. `server` serves both with the page, and `export` writes them as files that open without a server. The page
itself is TypeScript, in `web/`.
"""

from robosc.tools.view.description import SIMULATION, Source, describe
from robosc.tools.view.export import export
from robosc.tools.view.live import Live
from robosc.tools.view.moments import Moments
from robosc.tools.view.page import PageError
from robosc.tools.view.record import Record

__all__ = ["SIMULATION", "Live", "Moments", "PageError", "Record", "Source", "describe", "export"]
