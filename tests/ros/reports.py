"""Write the reports of a node (`~/state`, `~/definition`, `/diagnostics`) to a file until interrupted.

Each report is a line of JSON.

python3 reports.py 1|2 NODE FILE
"""

import json
import sys
from pathlib import Path

from topics import connect


def array(message):
    """Return an array of diagnostics as nested dicts, with its time in seconds."""
    stamp = message.header.stamp
    time = stamp.to_sec() if hasattr(stamp, "to_sec") else stamp.sec + stamp.nanosec / 1e9
    return {
        "time": time,
        "status": [
            {
                "level": status.level if isinstance(status.level, int) else ord(status.level),
                "name": status.name,
                "message": status.message,
                "hardware_id": status.hardware_id,
                "values": [[value.key, value.value] for value in status.values],
            }
            for status in message.status
        ],
    }


def main(version, node, path):
    topics = connect(version, "reports")
    with Path(path).open("w", encoding="utf-8") as file:

        def note(topic, read=lambda message: json.loads(message.data)):
            def write(message):
                file.write(json.dumps({"topic": topic, "data": read(message)}) + "\n")
                file.flush()

            return write

        topics.listen(f"/{node}/state", "std_msgs/String", note("state"))
        topics.listen(f"/{node}/definition", "std_msgs/String", note("definition"), latched=True)
        topics.listen("/diagnostics", "diagnostic_msgs/DiagnosticArray", note("diagnostics", array))
        while True:
            topics.receive(1.0)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(0)
