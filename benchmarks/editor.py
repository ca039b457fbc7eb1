"""Time the language server's findings after opening a text and after a key; measure its memory over many edits.

    python benchmarks/editor.py [--lines 1000 10000] [--keys 20] [--edits 2000]

Prints the table of docs/editor.md. The server runs in its own process, over its standard input and output, without
its pause while a user types. A key is a letter within a name, typed and taken back, so that findings appear and
disappear. Brackets hold processor time, of a key the mean, on which other programs have less influence. Needs
`pip install 'robosc[test]'`.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from lsprotocol import types

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.tools.editor.server import COMMAND, Editor, findings, initialize, open_text, position, replace  # noqa: E402

#: Twelve lines; the requirements of each component name the next one.
COMPONENT = """  component Door{number} {{
    outgoing message opened{number} with identifier: "/door_{number}", type: double
    incoming message turn{number} with identifier: "/turn_{number}", type: none
    behaviour {{
      variable seen: boolean
      initial marked state closed {{ on response from opened{number} if value > 0.5 do seen := true goto open }}
      state open {{
        on response from opened{number} if value <= 0.5 goto closed
      }}
    }}
  }}
  requirement turn{number} needs Door{number}.open and Door{following}.closed
"""


def model(lines: int) -> str:
    """Return a robot of about this many lines."""
    count = lines // COMPONENT.count("\n")
    parts = (COMPONENT.format(number=number, following=(number + 1) % count) for number in range(count))
    return f"robot Doors {{\n{''.join(parts)}}}\n"


async def measure(lines: int, keys: int, edits: int) -> str:
    """Return a row of the table."""
    text = model(lines)
    with tempfile.TemporaryDirectory() as folder:
        client = Editor()
        await client.start_io(*COMMAND)
        await initialize(client, Path(folder))
        began = time.perf_counter()
        uri = open_text(client, Path(folder) / "doors.rscd", text)
        await findings(client, uri, 1)
        opened, opened_spent = time.perf_counter() - began, _spent(client)
        where = position(text, "seen := true", nth=lines // 24)
        inserted = types.Range(where, where)
        taken = types.Range(where, types.Position(where.line, where.character + 1))
        version, times = 1, []
        for key in range(keys):
            version += 1
            began = time.perf_counter()
            replace(client, uri, version, (inserted, "x") if key % 2 == 0 else (taken, ""))
            told = await findings(client, uri, version)
            times.append(time.perf_counter() - began)
            assert bool(told) == (key % 2 == 0)
        spent = (_spent(client) - opened_spent) / keys
        at_first = _megabytes(client)
        for edit in range(edits):
            if edit == edits // 10:
                at_first = _megabytes(client)
            version += 1
            replace(client, uri, version, (inserted, "x") if edit % 2 == 0 else (taken, ""))
            if edit % 10 == 9:  # at typing speed, findings arrive now and then
                await findings(client, uri, version)
        at_last = _megabytes(client)
        await client.shutdown_session()
        await client.stop()
    count = text.count("\n")
    return (
        f"| {count:,} | {opened:,.1f} s ({opened_spent:,.1f} s) |"
        f" {statistics.median(times) * 1000:,.0f} ms ({spent * 1000:,.0f} ms) |"
        f" {at_first:,.0f} MB after {edits // 10:,} edits | {at_last:,.0f} MB after {edits:,} |"
    )


def _megabytes(client: Editor) -> float:
    """Return the memory of the server in megabytes."""
    pages = int((Path("/proc") / str(client._server.pid) / "statm").read_text().split()[1])  # noqa: SLF001
    return pages * 4096 / 2**20


def _spent(client: Editor) -> float:
    """Return the processor seconds that the server has taken."""
    words = (Path("/proc") / str(client._server.pid) / "stat").read_text().rpartition(")")[2].split()  # noqa: SLF001
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--lines", type=int, nargs="+", default=[1000, 10000])
    parser.add_argument("--keys", type=int, default=20)
    parser.add_argument("--edits", type=int, default=2000)
    options = parser.parse_args()
    print("| lines | opened | from a key to its findings | memory | memory later |\n|---|---|---|---|---|")
    for lines in options.lines:
        print(asyncio.run(measure(lines, options.keys, options.edits)), flush=True)


if __name__ == "__main__":
    main()
