"""A node that goes around a running layer is reported, by the layer and by `robosc verify --guard`."""

from __future__ import annotations

import json
import subprocess
from typing import TYPE_CHECKING, Any

from tests.ros.faults.partners import DIAGNOSTICS, Peer
from tests.ros.running import Runner
from tests.ros.test_layer import command
from tests.ros.workspaces import USHER, Workspace, middleware

if TYPE_CHECKING:
    from pathlib import Path

FLOAT, SET, GO = "std_msgs/Float32", "std_srvs/SetBool", "nav2_msgs/NavigateToPose"
AROUND = [
    "/speed: /intruder publishes it, too, around this layer",
    "/lamp/light: /intruder calls it, too, around this layer",
    "/go_to: /intruder sends goals, too, around this layer",
]


def test_nodes_that_go_around_are_reported(layers: Workspace | Runner, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with middleware(layers, folder) as processes:
        processes.start("layer", command(layers))
        names = ("world", "server", "intruder")
        world, server, intruder = (Peer(processes, layers.ros.python, 2, name) for name in names)

        def statuses() -> list[dict[str, Any]]:
            """Return the statuses of the layer in its last report."""
            heard = [entry["data"]["status"] for entry in world.all("heard") if entry["heard"] == DIAGNOSTICS]
            own = [report for report in heard if any("usher_layer" in status["name"] for status in report)]
            return own[-1] if own else []

        def around() -> set[str]:
            faults = {text for status in statuses() for text in status["message"].split("; ")}
            return {text for text in faults if "around" in text}

        server.do("answer_at_once", fields={"success": True})
        server.do("accept_at_once", accept=True, succeed=True)
        server.do("serve", name="/lamp/light", kind=SET)
        server.do("act", name="/go_to", kind=GO)
        world.do("listen", topic="/speed", kind=FLOAT)
        world.do("listen", topic=DIAGNOSTICS, kind="diagnostic_msgs/DiagnosticArray")
        processes.wait_until(lambda: bool(statuses()), "the layer reports")
        assert around() == set()
        intruder.do("advertise", topic="/speed", kind=FLOAT)
        intruder.do("call", name="/lamp/light", kind=SET, fields={})
        intruder.do("start", name="/go_to", kind=GO, fields={})
        processes.wait_until(lambda: around() == set(AROUND), "the layer sees that it is not alone")
        if isinstance(layers, Runner):
            verify = [layers.ros.python, "-m", "robosc", "verify", USHER / "usher.rscd", "--guard", "live", "--json"]
            done = subprocess.run(
                [str(word) for word in verify], env=processes.environment, capture_output=True, text=True, check=False
            )
            assert done.returncode == 1, done.stderr
            passages = json.loads(done.stdout)["passages"]
            found = {each["name"]: each["around"] for each in passages if each["outcome"] == "around"}
            assert found == {name: ["/intruder"] for name in ("/speed", "/lamp/light", "/go_to")}
        intruder.do("withdraw", topic="/speed")
        processes.wait_until(lambda: around() == set(AROUND[1:]), "the topic has one publisher again")
        log = (folder / "layer.log").read_text()
        assert [log.count(text) for text in AROUND] == [1, 1, 1]
