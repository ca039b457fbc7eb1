"""Generated packages of the eight scenarios whose nodes note the times of their ticks."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
INTERFACES = HERE.parent / "tests" / "ros" / "interfaces"
TICK = re.compile(
    r"  void tick\(\) override \{\n"
    r"((?:    .*\n)*?    (\w+)_tick\(&supervisor_((?:, alarm_->at\(\))?)\);\n(?:.*\n)*?)"
    r"  \}\n"
)
TIMED = r"""  void tick() override {
    auto alone = supervisor_;
    const auto began = TickTimes::Clock::now();
\1    const auto ended = TickTimes::Clock::now();
    alone.hooks = \2_hooks{};
    \2_tick(&alone\3);
    tick_times.note(ended - began, TickTimes::Clock::now() - ended);
  }
"""


@dataclass(frozen=True)
class Scenario:
    """Measured node: its title, its package, its model, and whether it is a layer without ticks."""

    title: str
    package: str
    model: Path
    layer: bool = False

    @property
    def name(self) -> str:
        """The name in the simulator."""
        return self.model.stem


def _controller(title: str) -> Scenario:
    name = title.lower().replace(" ", "_")
    return Scenario(title, f"{name}_controller", EXAMPLES / name / f"{name}.rscd")


SUPERVISED = EXAMPLES / "supervised_line_follower"
#: Rows of table 6.8 of the thesis, and the layer.
SCENARIOS = [
    *map(
        _controller,
        (
            "Line follower",
            "Simple navigation",
            "Obstacle navigation",
            "Object finder",
            "Maze solver",
            "Push ball",
            "Person follower",
        ),
    ),
    Scenario(
        "Supervised line follower",
        "supervised_line_follower_layer",
        SUPERVISED / "supervised_line_follower.rscd",
        layer=True,
    ),
]
#: Controller behind the layer; it is not measured.
STEPPER = Scenario("Line stepper", "line_stepper_controller", SUPERVISED / "controller" / "line_stepper.rscd")


def timed_packages(version: int, folder: Path) -> list[Path]:
    """Generate the packages for a ROS into a folder and return their paths. Unchanged files are not rewritten."""
    with tempfile.TemporaryDirectory() as generated:
        return [
            _timed(scenario, version, Path(generated), folder / scenario.package)
            for scenario in [*scenarios(version), STEPPER]
        ]


def scenarios(version: int) -> list[Scenario]:
    """Return the scenarios that run over a ROS: layers are nodes of ROS 2."""
    return [scenario for scenario in SCENARIOS if version == 2 or not scenario.layer]


def _timed(scenario: Scenario, version: int, generated: Path, folder: Path) -> Path:
    ros = f"ros{version}"
    target, package = f"{ros}-layer" if scenario.layer else ros, folder / ros / scenario.package
    command = [sys.executable, "-m", "robosc", "transform", scenario.model, "--to", target, "-o", generated]
    command += ["--interface-path", INTERFACES / ros]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    plain = generated / ros / scenario.package
    texts = {path.relative_to(plain): path.read_text() for path in plain.rglob("*") if path.is_file()}
    if not scenario.layer:
        node = Path("src") / f"{scenario.package}_node.cpp"
        timed, found = TICK.subn(TIMED, texts[node])
        assert found == 1, f"{node} has no tick as expected"
        texts[node] = '#include "tick_times.hpp"\n' + timed
        texts[Path("include") / "tick_times.hpp"] = (HERE / "tick_times.hpp").read_text()
    for path, text in texts.items():
        place = package / path
        if not place.exists() or place.read_text() != text:
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text)
    return package
