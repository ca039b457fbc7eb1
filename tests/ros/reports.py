"""Writes what a node says about itself (`~/state`, `~/definition`) to a file, a line of JSON each, until interrupted.

python3 reports.py 1|2 NODE FILE
"""

import json
import sys
from pathlib import Path

from topics import connect


def main(version, node, path):
    topics = connect(version, "reports")
    with Path(path).open("w", encoding="utf-8") as file:

        def note(topic):
            def write(message):
                file.write(json.dumps({"topic": topic, "data": json.loads(message.data)}) + "\n")
                file.flush()

            return write

        topics.listen(f"/{node}/state", "std_msgs/String", note("state"))
        topics.listen(f"/{node}/definition", "std_msgs/String", note("definition"), latched=True)
        while True:
            topics.receive(1.0)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(0)
