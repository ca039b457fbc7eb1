"""`unique-enum-value` (thesis 4.5.12)."""

from collections.abc import Iterator

from robosc.checks.libraries import fact, imports, reachable
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc


@rule("unique-enum-value")
def unique_enum_value(base: rsc.Base) -> Iterator[Finding]:
    """No two enum values of a robot or library and its imports have one name."""
    firsts: dict[str, rsc.EnumValue] = {}
    for value in (enum_value for library in reachable(base, has_enum_values) for enum_value in enum_values(library)):
        firsts.setdefault(value.name, value)
    for value in enum_values(base):
        first = firsts.setdefault(value.name, value)
        if first is not value:
            yield Finding(
                value,
                f"{_describe(value, base)} has the name of {_describe(first, base)}, expected a name of its own",
                _repair(value, first),
            )
    yield from _between_imports(base)


def enum_values(base: rsc.Base) -> Iterator[rsc.EnumValue]:
    """The enum values that the base itself declares, in the order of the text."""
    for definition in base.definitions:
        if isinstance(definition, rsc.EnumDataType):
            for alternative in definition.rules:
                if alternative.value and alternative.value.name:
                    yield alternative.value


def has_enum_values(base: rsc.Base) -> bool:
    """Whether the base itself declares an enum value."""
    return any(True for _ in enum_values(base))


def _between_imports(base: rsc.Base) -> Iterator[Finding]:
    """Values of two libraries that only this base brings together; of one library's own imports it has the finding."""
    firsts: dict[str, rsc.EnumValue] = {}
    importing: dict[rsc.Library, rsc.Component] = {}
    for component, library in imports(base):
        importing.setdefault(library, component)
    for library, component in importing.items():
        for value in _with_imports(library):
            first = firsts.setdefault(value.name, value)
            if first is not value and not any({first, value} <= fact(_brought, other) for other in reachable(base)):
                yield Finding(
                    component,
                    f"the import of `{library.name}` brings {_describe(value, base)}, which has the name of"
                    f" {_describe(first, base)}, expected a name of its own",
                    "import only one of these libraries: names that come from libraries can't be changed here",
                )


def _with_imports(library: rsc.Library) -> Iterator[rsc.EnumValue]:
    for base in [library, *reachable(library, has_enum_values)]:
        yield from enum_values(base)


def _brought(library: rsc.Library) -> set[rsc.EnumValue]:
    return set(_with_imports(library))


def _enum(value: rsc.EnumValue) -> rsc.EnumDataType:
    enum: rsc.EnumDataType = value.eContainer().eContainer()
    return enum


def _describe(value: rsc.EnumValue, seen_from: rsc.Base) -> str:
    enum = _enum(value)
    unit = enum.eContainer()
    where = "" if unit is seen_from else f" in library `{unit.name}`"
    return f"value `{value.name}` of enum `{enum.name}`{where}"


def _repair(value: rsc.EnumValue, first: rsc.EnumValue) -> str:
    rules = [same.eContainer() for same in (value, first)]
    if _enum(value) is _enum(first) and all(
        isinstance(alternative, rsc.EnumTransformationRule) for alternative in rules
    ):
        return f"join the two conditions by `or`, so that `{value.name}` stands once"
    if _enum(value) is _enum(first):
        return (
            f"the default gives `{value.name}` wherever no rule holds: leave the other rule out, and let rules that"
            " follow it hold only where it did not"
        )
    return f"rename it, such as `{value.name}_{_enum(value).name.lower()}`"
