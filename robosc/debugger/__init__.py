"""The simulator as a debug adapter: a supervised robot is stepped through, event by event, where its text is written.

`protocol` has the messages of the Debug Adapter Protocol, `adapter` answers them. `launching` says what is run,
`replay` is the run, forwards and backwards; `breakpoints` finds what of a model a run can stop at, `stops` says where
it does, `views` what is seen there.
"""

from robosc.debugger.adapter import Adapter
from robosc.debugger.launching import Loader, Wanted
from robosc.debugger.protocol import Connection, serve_port, serve_stdio

__all__ = ["Adapter", "Connection", "Loader", "Wanted", "serve_port", "serve_stdio"]
