"""Process that runs calls for the server: `python -m robosc.tools.mcp.process PARENT`.

PARENT is the number of the server's process, with which this one ends. The first line of input has the settings, and
each further line a call. The first line of output is empty, and each further line is an answer.
"""

from __future__ import annotations

import gc
import json
import os
import sys
from typing import Any

from robosc.language.grammar import language
from robosc.tools.mcp.tools import Calls
from robosc.tools.mcp.worker import MOST_BYTES
from robosc.tools.workers import end_with_parent


def main() -> None:
    """Answer calls until the input ends."""
    end_with_parent(int(sys.argv[1]))
    wire = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # prints must not reach the server
    requests = os.fdopen(os.dup(0), "rb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    sys.set_int_max_str_digits(0)  # the number of states of a robot may have many digits
    language()
    # The grammar is permanent. The model of a call is collected after the answer.
    gc.freeze()
    gc.set_threshold(50_000, 10, 10)
    calls = Calls(**json.loads(requests.readline()))
    wire.write(b"\n")
    wire.flush()
    for line in requests:
        request = json.loads(line)
        wire.write(_line(calls.answer(request["tool"], request["arguments"])))
        wire.flush()
        gc.collect()


def _line(answer: dict[str, Any]) -> bytes:
    line = json.dumps(answer).encode()
    if len(line) > MOST_BYTES:
        error = f"the answer has more than {MOST_BYTES >> 20} MB: request less, such as `counts` of `synthesize`"
        line = json.dumps({"exit_status": 2, "error": error}).encode()
    return line + b"\n"


if __name__ == "__main__":
    main()
