"""`enum-default` (thesis 4.5.8)."""

from collections.abc import Iterator

from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc


@rule("enum-default")
def enum_default(base: rsc.Base) -> Iterator[Finding]:
    """An enum has exactly one default rule."""
    for enum in base.definitions:
        if not isinstance(enum, rsc.EnumDataType):
            continue
        defaults = [alternative for alternative in enum.rules if isinstance(alternative, rsc.EnumDefaultRule)]
        if not defaults:
            yield Finding(
                enum,
                f"enum `{enum.name}` has no default rule, expected one for data that no other rule matches",
                "add a last rule, such as `default -> other`",
                relies_on=enum,
            )
        for other in defaults[1:]:
            yield Finding(
                other,
                f"enum `{enum.name}` has a second default rule, expected one",
                "give this rule a condition in place of `default`, or leave it out",
            )
