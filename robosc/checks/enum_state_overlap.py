"""`enum-state-overlap` (thesis 4.5.13)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.automata import states
from robosc.checks.libraries import fact, imports, instances, reachable
from robosc.checks.rule import Finding, rule
from robosc.checks.unique_enum_value import enum_values, has_enum_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import robosc as rsc
    from robosc.semantics.instances import Instance


@rule("enum-state-overlap")
def enum_state_overlap(base: rsc.Base) -> Iterator[Finding]:
    """No enum value has the name of a state, in a robot or library and what it imports."""
    units = {value: unit for unit in [base, *reachable(base, has_enum_values)] for value in enum_values(unit)}
    named: dict[str, list[tuple[Instance, rsc.State]]] = {}
    for instance in instances(base):
        for state in states(instance.automaton) if instance.automaton else ():
            named.setdefault(state.name, []).append((instance, state))
    reported = set()
    for value, unit in units.items():
        for instance, state in named.get(value.name, ()):
            # What a library has together with its own imports, it has the finding of.
            if any((value, state) in fact(_overlaps, library) for library in reachable(base)):
                continue
            place = value if unit is base else state if instance.unit is base else _import(base, instance, unit)
            if place not in reported:
                reported.add(place)
                yield Finding(
                    place,
                    f"value `{value.name}` of enum `{value.eContainer().eContainer().name}`{_of(unit, base)} has the"
                    f" name of the state `{instance.name}.{state.name}`, expected names that differ",
                    _repair(value, state, unit is base, instance.unit is base),
                )


def _overlaps(library: rsc.Library) -> set[tuple[rsc.EnumValue, rsc.State]]:
    values = [value for unit in [library, *reachable(library, has_enum_values)] for value in enum_values(unit)]
    found = [state for instance in instances(library) if instance.automaton for state in states(instance.automaton)]
    return {(value, state) for value in values for state in found if value.name == state.name}


def _import(base: rsc.Base, instance: Instance, unit: rsc.Base) -> rsc.Component:
    """The later one of the two imports that bring the state and the value."""
    for component, library in reversed(list(imports(base))):
        if component is instance.component or unit in [library, *reachable(library)]:
            return component
    return instance.component


def _of(unit: rsc.Base, seen_from: rsc.Base) -> str:
    return "" if unit is seen_from else f" in library `{unit.name}`"


def _repair(value: rsc.EnumValue, state: rsc.State, own_value: bool, own_state: bool) -> str:
    if own_value:
        return f"rename the value, such as `{value.name}_{value.eContainer().eContainer().name.lower()}`"
    if own_state:
        return f"rename the state, such as `is_{state.name}`"
    return "import only one of these libraries: names that come from libraries can't be changed here"
