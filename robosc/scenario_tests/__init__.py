"""Scenarios: what comes from a robot, step by step, and what is expected of its controller then."""

from robosc.scenario_tests.live import LiveError, LiveNode
from robosc.scenario_tests.playing import Player, unfit_data, unknown_events
from robosc.scenario_tests.reading import RULE, Scenario, read_scenarios

__all__ = ["RULE", "LiveError", "LiveNode", "Player", "Scenario", "read_scenarios", "unfit_data", "unknown_events"]
