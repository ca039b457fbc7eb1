"""The simulator as a debug adapter: the user steps through a supervised robot, event by event, in its text.

`protocol` implements the messages of the Debug Adapter Protocol, and `adapter` answers them. `launch` selects the
model and its script. `robosc.run.simulation.replay` runs them, forwards and backwards. `breakpoints` finds the elements
of a model at which a run can stop, `stops` decides where it stops, and `views` shows its state there.
"""

from robosc.tools.debugger.adapter import Adapter
from robosc.tools.debugger.launch import LaunchTarget, Loader
from robosc.tools.debugger.protocol import Connection, serve_port, serve_stdio

__all__ = ["Adapter", "Connection", "LaunchTarget", "Loader", "serve_port", "serve_stdio"]
