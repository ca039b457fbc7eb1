"""The simulator as a debug adapter: a supervised robot is stepped through, event by event, where its text is written.

`protocol` has the messages of the Debug Adapter Protocol, `adapter` answers them. `launching` finds what to run,
`robosc.simulation.replay` runs it, forwards and backwards. `breakpoints` finds the elements of a model at which a run
can stop, `stops` decides where it does, `views` shows its state there.
"""

from robosc.debugger.adapter import Adapter
from robosc.debugger.launching import Loader, Wanted
from robosc.debugger.protocol import Connection, serve_port, serve_stdio

__all__ = ["Adapter", "Connection", "Loader", "Wanted", "serve_port", "serve_stdio"]
