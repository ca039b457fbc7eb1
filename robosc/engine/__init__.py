"""Reference interpreter: executes an sct model with its supervisor, with or without the control loop."""

from robosc.base.cache import cache_results
from robosc.engine.control_loop import ControlLoop, Hooks, Settings
from robosc.engine.interpreter import Blocked, Engine
from robosc.engine.state import State, Value

__all__ = ["Blocked", "ControlLoop", "Engine", "Hooks", "Settings", "State", "Value", "cache_results"]
