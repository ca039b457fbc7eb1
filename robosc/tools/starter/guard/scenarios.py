"""The scenarios of a guard: what the layer blocks, and when it forwards."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.tools.starter.guard.choices import GuardChoices

_RELEASED = {"periodic": "every 100 ms pressed with false", "latched": "pressed with false"}
_PLACE = 'response from pose with {{"pose": {{"covariance": {{"0": {variance}, "7": {variance}}}}}}}'
_PRECISE, _VAGUE = (_PLACE.format(variance=variance) for variance in (0.01, 4.0))
#: The end of a call or a goal after the emergency stop.
_ENDS = {"service": "response from", "action": "canceled from"}


def scenarios(choices: GuardChoices) -> str:
    """Return the text of the scenarios."""
    return "\n".join(_lines(choices)) + "\n"


def _lines(choices: GuardChoices) -> Iterator[str]:
    words = [command.word for command in choices.commands]
    forbidden = [f"expect {word} forbidden by Stopped" for word in words]
    setting = [_RELEASED[choices.button], *([_PRECISE] if choices.goals else [])]
    yield f"// Scenarios of the guard of {choices.robot}: robosc test {choices.stem}.rscd {choices.stem}.scenarios"
    yield from ["before each {", *(f"  {line}" for line in setting), "}"]
    sent = [f"expect {word} sent within 1 s" for word in words]
    yield from _scenario("nothing passes before the robot is in service", [*forbidden, "continue", *sent])
    ends = [f"{_ENDS[command.kind]} {command.word}" for command in choices.commands if command.kind in _ENDS]
    # A controller sends some of many commands at its next tick.
    stopped = ["continue", "wait 1 s", "pressed with true", *ends, *forbidden]
    yield from _scenario("the emergency stop blocks every command, and cancels goals", stopped)
    if choices.button == "periodic":
        silent = ["continue", "stop pressed", "expect EmergencyStop.stopped within 1 s"]
        yield from _scenario("a silent emergency stop stops the robot", silent)
    if choices.goals:
        lost = [f"expect {command.word} forbidden by Localized" for command in choices.goals]
        yield from _scenario("no goal passes while the robot does not know its place", [_VAGUE, "continue", *lost])


def _scenario(name: str, lines: Sequence[str]) -> list[str]:
    return ["", f'scenario "{name}"', *(f"  {line}" for line in lines)]
