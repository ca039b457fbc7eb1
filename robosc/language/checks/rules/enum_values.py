"""Rules `enum-default` and `enum-state-overlap` (thesis 4.5.8 and 4.5.13)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.cache import cached
from robosc.language.checks.definitions import of_kind, unit_of
from robosc.language.checks.edits import Insertion, Removal, Renaming, part_of
from robosc.language.checks.libraries import imports, instances, reachable
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.edits import Hint
    from robosc.model.semantics.instances import Instance


@rule("enum-default")
def enum_default(base: rsc.Base) -> Iterator[Finding]:
    """Every enum has exactly one default rule."""
    for enum in of_kind(rsc.EnumDataType, base.definitions):
        defaults = of_kind(rsc.EnumDefaultRule, enum.rules)
        if not defaults:
            yield Finding(
                enum,
                f"enum `{enum.name}` has no default rule, expected one for data that matches no other rule",
                Insertion(
                    "add a last rule, such as `default -> other`",
                    " default -> other",
                    enum.rules[-1],
                    behind=True,
                    is_choice=True,
                )
                if enum.rules
                else Insertion(
                    "add a last rule, such as `default -> other`",
                    " default -> other ",
                    part_of(enum).find("{"),
                    behind=True,
                    is_choice=True,
                ),
                relies_on=enum,
            )
        for other in defaults[1:]:
            yield Finding(
                other,
                f"enum `{enum.name}` has a second default rule, expected one",
                Removal("give this rule a condition in place of `default`, or leave it out", other),
            )


@rule("enum-state-overlap")
def enum_state_overlap(base: rsc.Base) -> Iterator[Finding]:
    """No enum value has the name of a state, in a robot or library with its imports."""
    named: dict[str, list[tuple[Instance, rsc.State]]] = {}
    for instance in instances(base):
        for state in instance.states:
            named.setdefault(state.name, []).append((instance, state))
    reported = set()
    for value in _reachable_values(base):
        unit = unit_of(value)
        for instance, state in named.get(value.name, ()):
            # If a library with its imports contains both, the finding is in the library.
            if any((value, state) in _overlaps(library) for library in reachable(base)):
                continue
            place = value if unit is base else state if instance.unit is base else _import(base, instance, unit)
            if place not in reported:
                reported.add(place)
                yield Finding(
                    place,
                    f"{_describe(value, base)} has the name of the state `{instance.name}.{state.name}`, expected names"
                    " that differ",
                    _repair_overlap(value, state, unit is base, instance.unit is base),
                )


def _overlaps(library: rsc.Library) -> set[tuple[rsc.EnumValue, rsc.State]]:
    def compute() -> set[tuple[rsc.EnumValue, rsc.State]]:
        states = [state for instance in instances(library) for state in instance.states]
        return {(value, state) for value in _reachable_values(library) for state in states if value.name == state.name}

    return cached((_overlaps, library), compute)


def _import(base: rsc.Base, instance: Instance, unit: rsc.Base) -> rsc.Component:
    """Return the later one of the two imports that bring the state and the value."""
    for component, library in reversed(list(imports(base))):
        if component is instance.component or unit in [library, *reachable(library)]:
            return component
    return instance.component


def _repair_overlap(value: rsc.EnumValue, state: rsc.State, own_value: bool, own_state: bool) -> Hint:
    if own_value:
        name = f"{value.name}_{_enum(value).name.lower()}"
        return Renaming(f"rename the value, such as `{name}`", value, name)
    if own_state:
        return Renaming(f"rename the state, such as `is_{state.name}`", state, f"is_{state.name}")
    return "import only one of these libraries: names that come from libraries cannot be changed here"


def _values(base: rsc.Base) -> Iterator[rsc.EnumValue]:
    """Yield the enum values that the base itself declares, in the order of the text."""
    for enum in of_kind(rsc.EnumDataType, base.definitions):
        yield from (alternative.value for alternative in enum.rules if alternative.value and alternative.value.name)


def _has_values(base: rsc.Base) -> bool:
    return any(True for _ in _values(base))


def _reachable_values(base: rsc.Base) -> list[rsc.EnumValue]:
    """Return the enum values of a base, then those of all libraries reachable by imports."""
    return [value for unit in [base, *reachable(base, _has_values)] for value in _values(unit)]


def _enum(value: rsc.EnumValue) -> rsc.EnumDataType:
    enum: rsc.EnumDataType = value.eContainer().eContainer()
    return enum


def _describe(value: rsc.EnumValue, seen_from: rsc.Base) -> str:
    unit = unit_of(value)
    where = "" if unit is seen_from else f" in library `{unit.name}`"
    return f"value `{value.name}` of enum `{_enum(value).name}`{where}"
