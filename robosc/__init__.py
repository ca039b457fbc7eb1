"""RoboSC: write what a robot may do; get a controller that provably does only that."""

__version__ = "0.1.0"
