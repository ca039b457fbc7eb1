"""The tools: their names, descriptions and parameters, as a client sees them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Maximum length of a text in a call, in characters. A model of 100,000 lines has about 4,000,000.
MOST_CHARACTERS = 4_000_000
#: Maximum number of random events of a simulation.
_MOST_EVENTS = 10_000
_SHORT = 1000


def _text(description: str, longest: int = _SHORT, **more: Any) -> dict[str, Any]:
    return {"type": "string", "description": description, "maxLength": longest, **more}


def _texts(description: str) -> dict[str, Any]:
    return {
        "type": "array",
        "description": description,
        "maxItems": 100,
        "items": {"type": "string", "minLength": 1, "maxLength": _SHORT},
    }


def _flag(description: str) -> dict[str, Any]:
    return {"type": "boolean", "description": description, "default": False}


_SOURCE = {
    "path": _text("File of the model, below a folder of this server.", minLength=1),
    "text": _text("Text of the model in place of the file, which need not exist.", MOST_CHARACTERS),
    "library_paths": _texts("Folders to search for libraries, after the model's folder."),
    "interface_paths": _texts("Folders with ROS packages, for their .msg, .srv and .action files."),
}
_CONFIG = {"config": _text("The configuration file. Default: controller-config.json near the model.", minLength=1)}

#: JSON Schema of the result of each tool that reads a model.
_ANSWER = {
    "type": "object",
    "required": ["exit_status", "error", "findings", "result"],
    "properties": {
        "exit_status": {
            "type": "integer",
            "description": "0 success, 1 errors in the model, a refuted property or a failed scenario, 2 a wrong call,"
            " 3 no supervisor exists, 70 an internal error of robosc.",
        },
        "error": {"type": ["string", "null"], "description": "Error without a place in a file."},
        "findings": {
            "type": "array",
            "description": "Errors and warnings, as `robosc check --format json` prints them: `hint` explains the"
            " repair, `edits` apply it. Lines and columns count from 1.",
            "items": {"type": "object"},
        },
        "result": {"type": "object", "description": "Empty after an error."},
    },
}


@dataclass(frozen=True)
class Tool:
    """A tool: `description` and the JSON Schemas of its parameters, by name, are texts for the client.

    A tool with `is_long` may run for minutes. One with `writes` changes files.
    """

    name: str
    title: str
    description: str
    parameters: Mapping[str, Any]
    required: tuple[str, ...] = ()
    output: Mapping[str, Any] = field(default_factory=lambda: _ANSWER)
    is_long: bool = False
    writes: bool = False

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of the arguments."""
        return {
            "type": "object",
            "properties": dict(self.parameters),
            "required": list(self.required),
            "additionalProperties": False,
        }


def _object(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "required": list(properties), "properties": properties}


_ALL = (
    Tool(
        "check",
        "Check a model",
        "Report errors and warnings of a model (.rscd), each with a hint and, where a repair is clear, its edits."
        " Call it after each change of a model.",
        _SOURCE,
    ),
    Tool(
        "fix",
        "Apply clear repairs",
        "Apply the findings' edits wherever exactly one repair exists, and report the remaining findings. With `path`"
        " alone, the file is changed. With `text`, nothing is written and `result.text` is the repaired model.",
        _SOURCE,
        writes=True,
    ),
    Tool(
        "synthesize",
        "Synthesize the supervisor",
        "Compute the supervisor of a robot: numbers of states, the guard of each event, and the number of states in"
        " which each requirement matters, as `robosc synthesize --json` prints them.",
        {**_SOURCE, "counts": _flag("Only numbers of states, without guards and findings.")},
        is_long=True,
    ),
    Tool(
        "explain",
        "Explain why an event is forbidden",
        "Explain why an event can or cannot happen in a state (`event`, `state`), why it can never happen"
        " (`why_never`), or why the robot has no supervisor (`why_empty`). Give exactly one of the three.",
        {
            **_SOURCE,
            "event": _text("Event, such as `move`, `Platform.move`, `drive.cancel` or `grip.error`."),
            "state": _text("State for `event`, such as `Door=open,Gauge.level=3`. Default: the initial state.", 10_000),
            "why_never": _text("Event that can never happen."),
            "why_empty": _flag("Explain why the robot has no supervisor."),
        },
        is_long=True,
    ),
    Tool(
        "verify",
        "Prove the properties",
        "Prove the properties of the supervised robot and of its generated code, or refute them with a shortest trace,"
        " as `robosc verify --json` prints them.",
        {**_SOURCE, **_CONFIG},
        is_long=True,
    ),
    Tool(
        "simulate",
        "Simulate the supervised robot",
        "Play a script of events, or random events. The answer to each line tells whether the supervisor accepts it,"
        ' and the state after it. A line is an event with its data: message_scan.u_response {"value": "clear"}. An'
        " empty script returns no lines. With `loop`, the control loop runs between the lines.",
        {
            **_SOURCE,
            **_CONFIG,
            "script": _text("Lines of events.", MOST_CHARACTERS),
            "random": {
                "type": "integer",
                "minimum": 0,
                "maximum": _MOST_EVENTS,
                "description": "Number of random events, in place of `script`.",
            },
            "seed": {"type": "integer", "description": "Seed of random numbers.", "default": 0},
            "loop": _flag("Run the control loop between the lines of the script."),
            "parameters": {
                "type": "object",
                "description": "Values of parameters of the model, by name.",
                "additionalProperties": {"type": ["boolean", "number", "string"]},
            },
        },
        is_long=True,
    ),
    Tool(
        "test",
        "Run scenario tests",
        "Play scenarios: events from the robot, and the expected reactions of its controller. The page"
        " docs/scenarios.md describes their format.",
        {
            **_SOURCE,
            **_CONFIG,
            "scenarios": _texts("Files of scenarios (.scenarios)."),
            "scenarios_text": _text("Text of scenarios, in place of files.", MOST_CHARACTERS),
        },
        is_long=True,
    ),
    Tool(
        "rule",
        "Explain a rule",
        "Return the page of a rule (the `rule` of a finding), with a wrong and a right model. Without a name, return"
        " the names of all rules.",
        {"name": _text("Rule, such as `marked-state`.")},
        output=_object(page={"type": ["string", "null"]}, rules={"type": "array", "items": {"type": "string"}}),
    ),
    Tool(
        "new",
        "Create a model",
        "Create a folder with a small, complete model, its configuration, a page and a test. Existing files are never"
        " overwritten.",
        {
            "name": _text("Name of the robot, such as `Porter`.", minLength=1),
            "folder": _text("The new folder, below a folder of this server. Default: the robot's name.", minLength=1),
            "ros": {"type": "integer", "enum": [1, 2], "description": "The ROS version in README.md.", "default": 2},
            "sensors": _texts("Messages (std_msgs/Bool) that allow or forbid driving. Default: clear."),
            "command": _text("Command to send while all sensors allow it. Default: drive.", minLength=1),
            "stop": _text("Command to send otherwise; `-` for none. Default: halt.", minLength=1),
            "service": _text("Service (std_srvs/Trigger) to call first, until it succeeds.", minLength=1),
            "twist": _flag("Send commands as velocities (geometry_msgs/Twist) on /cmd_vel."),
            "guard": _flag("Create a guard: a supervisory layer in front of a robot."),
            "topics": _texts("For a guard: topics of the robot, such as `/cmd_vel:geometry_msgs/Twist`."),
            "services": _texts("For a guard: services of the robot, such as `/gripper/release:std_srvs/Trigger`."),
            "actions": _texts(
                "For a guard: actions of the robot, such as `/navigate_to_pose:nav2_msgs/NavigateToPose`."
            ),
            "button": {
                "type": "string",
                "enum": ["periodic", "latched"],
                "description": "For a guard: whether the emergency stop repeats its state. Default: periodic.",
            },
            "pose": _text("For a guard: topic of the localization without which no goal passes.", minLength=1),
        },
        required=("name",),
        output=_object(folder={"type": "string"}, files={"type": "array", "items": {"type": "string"}}),
        writes=True,
    ),
    Tool(
        "search_docs",
        "Search the documentation",
        "Search the pages about the language, the tools and the rules. Each result has an excerpt and the URI of its"
        " page, which the client reads as a resource.",
        {
            "query": _text("A few words, such as `limit speed near people`.", minLength=1),
            "most": {"type": "integer", "minimum": 1, "maximum": 20, "default": 5, "description": "Number of results."},
        },
        required=("query",),
        output=_object(
            results={
                "type": "array",
                "items": _object(
                    uri={"type": "string"},
                    page={"type": "string"},
                    heading={"type": "string"},
                    excerpt={"type": "string"},
                ),
            }
        ),
    ),
)
#: All tools by name.
TOOLS = {tool.name: tool for tool in _ALL}
