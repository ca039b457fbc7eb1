"""Run `robosc run` and write the time of each tick at its end to the file that ROBOSC_TICK_TIMES names."""

from __future__ import annotations

import os
from pathlib import Path
from time import perf_counter_ns

from robosc.run.runtime.core.controller import Controller
from robosc.tools.cli import run


def main() -> None:
    times: list[int] = []
    tick, close = Controller.tick, Controller.close

    def timed_tick(self: Controller) -> None:
        began = perf_counter_ns()
        tick(self)
        times.append(perf_counter_ns() - began)

    def noting_close(self: Controller) -> None:
        close(self)
        Path(os.environ["ROBOSC_TICK_TIMES"]).write_text("".join(f"{time}\n" for time in times))

    Controller.tick, Controller.close = timed_tick, noting_close  # type: ignore[method-assign]
    run()


if __name__ == "__main__":
    main()
