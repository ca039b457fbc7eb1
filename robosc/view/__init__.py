"""`robosc view`: a model, a log or a counterexample in the browser, decision by decision.

`Record` is what has happened, `describe` what does not change, `application` serves both with the page, `export` writes
them as files that open without a server. The page itself is TypeScript, in `web/`.
"""

from robosc.view.description import describe
from robosc.view.export import export
from robosc.view.page import PageError
from robosc.view.record import Record
from robosc.view.server import application

__all__ = ["PageError", "Record", "application", "describe", "export"]
