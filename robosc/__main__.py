"""`python -m robosc`, and the program `robosc`: the command line."""

import signal
from typing import NoReturn


def run() -> NoReturn:
    """Loads the command line and runs it."""
    # While it loads nothing has to be undone: an interrupt ends the process at once, and without a traceback.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from robosc import cli  # noqa: PLC0415

    cli.run()


if __name__ == "__main__":
    run()
