"""Command line, as `python -m robosc` and as the program `robosc`."""

import signal
from typing import NoReturn


def run() -> NoReturn:
    """Load the command line and run it."""
    # During the import there is nothing to clean up: an interrupt ends the process at once, without a traceback.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from robosc.tools import cli  # noqa: PLC0415

    cli.run()


if __name__ == "__main__":
    run()
