"""Scenarios: messages of a robot, step by step, and the expected behavior of its controller."""

from robosc.run.scenario_tests.checks import unfit_data, unknown_events
from robosc.run.scenario_tests.live import LiveError, LiveNode
from robosc.run.scenario_tests.player import Player
from robosc.run.scenario_tests.reading import RULE, Scenario, read_scenarios

__all__ = ["RULE", "LiveError", "LiveNode", "Player", "Scenario", "read_scenarios", "unfit_data", "unknown_events"]
