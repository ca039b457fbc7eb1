"""Events and states by the names of the robot model or those of its plants."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from robosc.base.files.json_reading import JsonError, json_value
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.communication import ANSWERS, REQUESTS, event_word
from robosc.model.semantics.naming import output_name
from robosc.model.semantics.roles import Roles, event_name, plant_of
from robosc.synthesis.decoding import text, value
from robosc.synthesis.encoding import domain_size, smallest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.synthesis.encoding import Element

#: Event that the bare name of a communication refers to.
_MEANT = (sct.EventKind.trigger, sct.EventKind.reply, sct.EventKind.response)
#: Event in the words of models and answers.
_IN_WORDS = re.compile(r"(request|response|error|feedback|canceled|cancel) +(?:to|from|of) +(\S+)")


class NamingError(ValueError):
    """Unknown or ambiguous name; `hint` proposes alternatives."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message = message
        self.hint = hint


def find_event(model: sct.SupervisoryControlModel, name: str) -> sct.Event:
    """Return the event of a name.

    Examples of names are `message_move.c_trigger`, `move`, `Platform.move`, `drive.cancel` and `cancel from drive`.
    Raises NamingError if there is no such event or the name fits several.
    """
    meant: dict[str, list[sct.Event]] = {}
    for event in Roles(model).events:
        for known_as in dict.fromkeys(_event_names(event)):
            meant.setdefault(known_as, []).append(event)
    if words := _IN_WORDS.fullmatch(name.strip()):
        name = f"{words[2]}.{words[1]}"
    name = output_name(name)
    matches = [event for event in meant.get(name, ()) if event_name(event) == name] or meant.get(name, [])
    if len(matches) == 1:
        return matches[0]
    if matches:
        listed = ", ".join(f"`{plant_of(event).origin or event_name(event)}`" for event in matches)
        raise NamingError(f"`{name}` can be several events", f"say which: {listed}")
    raise NamingError(f"there is no event `{name}`", _close(name, meant, "`robosc synthesize --json` lists the events"))


def _event_names(event: sct.Event) -> Iterator[str]:
    plant = plant_of(event)
    yield event_name(event)
    if plant.kind == sct.PlantKind.data:
        return
    owners = [plant.name, *_plant_names(plant)]
    kind = event_word(event) if event.kind in (*ANSWERS, *REQUESTS) else event.kind.name
    numbered = event.kind in (sct.EventKind.tau, sct.EventKind.timeout)
    suffixes = [event.name] if numbered else [event.name, kind]
    if event.kind == sct.EventKind.trigger:
        suffixes.append("request")
    yield from (f"{owner}.{suffix}" for owner in owners for suffix in suffixes)
    if event.kind == next(
        (kind_meant for kind_meant in _MEANT if any(own.kind == kind_meant for own in plant.events)), None
    ):
        yield from owners


def _plant_names(plant: sct.Plant) -> list[str]:
    """Return the names of a plant in the robot model: `Base`; `Base.drive` and `drive`."""
    return [plant.origin, plant.origin.rpartition(".")[2]] if plant.origin else []


def parse_state(model: sct.SupervisoryControlModel, text: str) -> dict[Element, int]:
    """Return the codes of the elements that a state names.

    The state is text such as `Door=open,Gauge.level=3`, JSON as `robosc simulate` prints it, or a message that a node
    publishes on `~/state` or `~/blocked`, bare or as ROS prints it. Raises NamingError for any other text, and if the
    text names an unknown element.
    """
    elements = _elements(model)
    codes: dict[Element, int] = {}
    for name, chosen in _pairs(model, _echoed(text)):
        matches = elements.get(output_name(name), [])
        if not matches:
            raise NamingError(f"the state has no `{name}`", _close(name, elements, ""))
        if len(matches) > 1:
            listed = ", ".join(f"`{_whole_name(element)}`" for element in matches)
            raise NamingError(f"`{name}` can be several parts of the state", f"say which: {listed}")
        code = _code(matches[0], chosen, name)
        if codes.setdefault(matches[0], code) != code:
            raise NamingError(f"the state has two values for `{name}`", "leave one out")
    return codes


def _whole_name(element: Element) -> str:
    if isinstance(element, sct.Plant):
        return element.name
    plant: sct.Plant = element.eContainer()
    return f"{plant.origin or plant.name}.{element.name}"


def _elements(model: sct.SupervisoryControlModel) -> dict[str, list[Element]]:
    """Return the parts of the state by each of their names; a full name hides the short form of another."""
    exact: dict[str, list[Element]] = {}
    short: dict[str, list[Element]] = {}
    for plant in model.plants:
        exact.setdefault(plant.name, []).append(plant)
        if plant.kind != sct.PlantKind.data and len(plant.locations) > 1:
            for name in dict.fromkeys(_plant_names(plant)):
                short.setdefault(name, []).append(plant)
        for variable in plant.variables:
            exact.setdefault(_whole_name(variable), []).append(variable)
            short.setdefault(variable.name, []).append(variable)
            short.setdefault(f"{plant.name}.{variable.name}", []).append(variable)
    return short | exact


def _echoed(output: str) -> str:
    """Return the data of the last `std_msgs/String` in the output of `ros2 topic echo` or `rostopic echo`.

    Other text is returned unchanged.
    """
    printed = [document.strip() for document in re.split(r"^---\s*$", output, flags=re.MULTILINE)]
    last = next((document for document in reversed(printed) if document), "")
    if last.startswith("data:"):
        last = last.removeprefix("data:").strip()
        if last.startswith("'"):
            last = last[1:].removesuffix("'").replace("''", "'")
        elif last.startswith('"'):
            with suppress(ValueError):
                last = str(json.loads(last, strict=False))
    if last.startswith("{") and last.endswith("..."):
        raise NamingError("the state was cut short", "`ros2 topic echo --full-length` prints it whole")
    return last


def _pairs(model: sct.SupervisoryControlModel, text: str) -> list[tuple[str, Any]]:
    if text.startswith("{"):
        try:
            values = json_value(text)
        except JsonError as error:
            raise NamingError("the state cannot be read", f"{error} (character {error.position + 1})") from None
        if isinstance(values.get("components"), dict):
            return list(_reported(model, values))
        inner = values.get("state", values)
        return list((inner if isinstance(inner, dict) else values).items())
    if ";" in text:
        raise NamingError("a state has no `;`", f"separate its parts by commas: `{text.replace(';', ',')}`")
    pairs = []
    for pair in text.split(","):
        name, equals, chosen = pair.partition("=")
        if not equals:
            raise NamingError(
                f"`{pair.strip()}` is not part of a state", "write `Component=state,Component.variable=3`"
            )
        pairs.append((name.strip(), chosen.strip()))
    return pairs


def _reported(model: sct.SupervisoryControlModel, report: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the state of components in a node's report, without variables that are unknown to the supervisor."""
    robot = report.get("robot", model.name)
    if robot != model.name:
        raise NamingError(f"the state is one of the robot `{robot}`", f"the model is `{model.name}`")
    components = {plant.origin or plant.name: plant for plant in model.plants if plant.kind == sct.PlantKind.behaviour}
    for name, entry in report["components"].items():
        if name not in components:
            raise NamingError(f"there is no component `{name}`", _close(name, components, ""))
        if not (isinstance(entry, dict) and "state" in entry and isinstance(entry.get("variables"), dict)):
            raise NamingError(f"the state has no value for `{name}`", "it needs `state` and `variables`")
        plant = components[name]
        yield plant.name, entry["state"]
        known = {variable.name: _whole_name(variable) for variable in plant.variables}
        yield from (
            (known[known_name], chosen) for known_name, chosen in entry["variables"].items() if known_name in known
        )


def _code(element: Element, raw: Any, name: str) -> int:
    """Return the code of a value, which is given directly or as text."""
    size = domain_size(element)
    if not isinstance(element, sct.Plant) and isinstance(element.type, ex.IntegerType):
        last = smallest(element) + size - 1
        try:
            number = int(raw) if isinstance(raw, str) else raw
        except ValueError:
            number = None
        if isinstance(number, int) and not isinstance(number, bool) and smallest(element) <= number <= last:
            return number - smallest(element)
        raise NamingError(f"`{name}` cannot be `{raw}`", f"it is an integer from {smallest(element)} to {last}")
    values = {text(value(element, code)): code for code in range(size)}
    shown = text(raw) if isinstance(raw, (bool, int, str)) else ""
    if shown in values:
        return values[shown]
    raise NamingError(f"`{name}` cannot be `{raw}`", _close(shown, values, f"it is one of {', '.join(values)}"))


def _close(name: str, known: Iterable[str], otherwise: str) -> str:
    close = get_close_matches(name, sorted(known), n=1)
    return f"did you mean `{close[0]}`?" if close else otherwise
