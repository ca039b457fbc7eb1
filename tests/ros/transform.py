"""Run `robosc` for each list of arguments in a JSON list, in one process: loading takes as long as most runs."""

from __future__ import annotations

import json
import sys

from click.testing import CliRunner

from robosc.tools.cli import main

if __name__ == "__main__":
    for arguments in json.load(sys.stdin):
        done = CliRunner().invoke(main, arguments)
        if done.exit_code:
            sys.exit(f"robosc {' '.join(arguments)}\n{done.output}{done.exception or ''}")
