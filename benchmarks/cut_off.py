"""Send all requests of the language server for every example, cut off at every position: no answer may fail.

    python benchmarks/cut_off.py [--every 1] [--processes 2] [EXAMPLE ...]

Each text is cut off behind each of its characters, as it is while a user types it. Each kind of request is answered
there, as tests/tools/editor/test_robustness.py does at some positions. Prints a row for each example, and ends with the
first failure. All examples take an hour or two of one processor. Needs `pip install 'robosc[test]'`.
"""

from __future__ import annotations

import argparse
import sys
import time
import traceback
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.tools.editor.test_robustness import EXAMPLES, ask_everything, project  # noqa: E402


def cut_off(every: int, path: Path) -> tuple[int, float]:
    """Return the number of positions tried in a text, and the processor seconds taken."""
    text = path.read_text(encoding="utf-8")
    made, began = project(text), time.process_time()
    ends = range(0, len(text) + 1, every)
    for end in ends:
        try:
            ask_everything(made, text[:end], end)
        except Exception:
            # As text: an exception may hold objects that can't be sent between processes.
            told = f"{path.relative_to(ROOT)}, cut off behind {end} characters:\n{traceback.format_exc()}"
            raise RuntimeError(told) from None
    return len(ends), time.process_time() - began


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("examples", nargs="*", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    # Copies of an example are one text.
    texts = {path.read_bytes(): path.resolve() for path in options.examples or EXAMPLES}
    # Longest first, with the others beside it.
    examples = sorted(texts.values(), key=lambda path: -path.stat().st_size)
    total, spent = 0, 0.0
    with ProcessPoolExecutor(options.processes) as processes:
        waiting = {processes.submit(cut_off, options.every, path): path for path in examples}
        for done in as_completed(waiting):
            if done.exception() is not None:
                processes.shutdown(wait=False, cancel_futures=True)
            positions, seconds = done.result()
            total, spent = total + positions, spent + seconds
            print(f"{waiting[done].stem}: {positions:,} positions, {seconds:,.0f} s", flush=True)
    print(f"{len(examples)} texts, {total:,} positions, no exception, {spent / 60:,.0f} min of one processor")


if __name__ == "__main__":
    main()
