"""Tests of generated nodes: traces to play against them, and what the player must know of a node.

A trace is an event log (docs/ros.md). `random_walk` makes one by running the controller in Python.
"""
