"""`python -m robosc`: the command line."""

from robosc.cli import run

run()
