"""`python -m robosc`: the command line."""

from robosc.cli import main

main(prog_name="robosc")
