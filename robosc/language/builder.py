"""From a parse tree to model elements: a rule creates an element of its class, an assignment sets its feature."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Repair
from robosc.base.interruption import checkpoint
from robosc.language.grammar import attribute
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.failures import FAILURE
from robosc.model.semantics.naming import NUMBER
from robosc.model.semantics.operators import BY_CLASS, Associativity

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic
    from robosc.language.grammar import Node
    from robosc.language.text import Text
    from robosc.model.places import Place

_LARGEST = 2**63 - 1
_ESCAPES = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r", '"': '"', "'": "'", "\\": "\\"}
_ESCAPE = re.compile(r"\\(u[0-9A-Fa-f]{4}|x[0-9A-Fa-f]{2}|.)")


@dataclass(frozen=True)
class Name:
    """A name and its offsets in the text."""

    text: str
    start: int
    end: int


@cache
def element_class(rule: str) -> Any | None:
    """Return the class of a rule's elements, or None for an abstract rule or a rule that only matches words."""
    candidate = getattr(rsc, rule, None) or getattr(ex, rule, None)
    eclass = getattr(candidate, "eClass", None)
    return candidate if eclass is not None and not eclass.abstract else None


class Builder:
    """Builds the model of one text, or of parts of it.

    References are not linked yet. `references` maps element and feature to the name, in the order of the text.
    `declared` maps each named element to its name. `bounded` lists the types whose bounds are expressions.
    `findings` reports words that the grammar accepts but that have no meaning, such as a number too large.
    """

    def __init__(self, text: Text) -> None:
        self.references: dict[Any, dict[str, Name]] = {}
        self.declared: dict[Any, Name] = {}
        self.bounded: list[rsc.IntegerDataType] = []
        self.findings: list[Diagnostic] = []
        self._text = text
        #: Literals of 2^63: too large for an integer, except behind a minus.
        self._unsigned: dict[Any, Node] = {}

    def build(self, node: Node, offset: int = 0) -> Any:
        """Return the element of a parse tree whose text starts at `offset` in the file."""
        self._offset = offset
        built = self._build(node)
        for literal in self._unsigned.values():
            self._too_large(literal)
        self._unsigned.clear()
        return built

    def _build(self, node: Node) -> Any:
        rule = node.rule_name
        if rule == "Expression":
            return self._expression(node)
        kind = element_class(rule)
        if kind is not None:
            return self._element(node, kind)
        return self._build(next(part for part in node if part.rule_name))

    def _element(self, node: Node, kind: Any) -> Any:
        checkpoint()
        element = kind(source=self._source(node.position, node.position_end))
        for child in node if isinstance(node, list) else ():
            feature = attribute(child)
            if feature is not None:
                for value in child:
                    if value.rule_name != "sep":
                        self._set(element, feature, value)
        self._complete(element, node)
        return element

    def _complete(self, element: Any, node: Node) -> None:
        """Set what the words of an element imply."""
        if isinstance(element, rsc.InterfaceTypeReference | rsc.ErrorReason):
            self.references[element] = self._implied(element, node)
        elif isinstance(element, rsc.Component) and element.first is not None:
            element.number = rsc.FormalParameter(name=NUMBER, type=rsc.IntegerDataType())
        elif isinstance(element, rsc.IntegerDataType) and element.lower is not None:
            self.bounded.append(element)
        elif isinstance(element, rsc.Parameter):
            element.description = self._text.comment_above(node.position + self._offset)
        elif isinstance(element, ex.IntegerLiteral) and element.value > _LARGEST:
            self._unsigned[element] = node
        elif isinstance(element, ex.UnaryMinus):
            self._unsigned.pop(element.operand, None)

    def _implied(self, element: rsc.InterfaceTypeReference | rsc.ErrorReason, node: Node) -> dict[str, Name]:
        """Return a reference to an element that no text, or only the predefined library, declares."""
        start, end = node.position + self._offset, node.position_end + self._offset
        if isinstance(element, rsc.ErrorReason):
            return {"enumeration": Name(FAILURE, start, end)}
        return {"type": Name(f"{element.package}/{element.rosType}", start, end)}

    def _set(self, element: Any, feature: str, node: Node) -> None:
        definition = getattr(type(element), feature)
        if definition.is_attribute:
            literal = isinstance(element, ex.IntegerLiteral)
            setattr(element, feature, self._integer(node, literal=True) if literal else self._word(node))
            if feature == "name":
                self.declared[element] = self._name(node)
        elif not definition.containment:
            self.references.setdefault(element, {})[feature] = self._name(node)
        elif definition.many:
            getattr(element, feature).append(self._build(node))
        else:
            setattr(element, feature, self._build(node))

    def _expression(self, node: Node) -> Any:
        """Build the tree of an expression.

        An operator waits on a stack until all tighter operators behind it are reduced.
        """
        operands = [(self._build(node[0]), node[0].position, node[0].position_end)]
        waiting: list[Any] = []

        def reduce() -> None:
            right, _, end = operands.pop()
            left, start, _ = operands.pop()
            kind = waiting.pop()
            operands.append((kind(left=left, right=right, source=self._source(start, end)), start, end))

        for (binary,) in node[1:]:
            operator = element_class(binary.rule_name)
            assert operator is not None
            while waiting and _binds_first(waiting[-1], operator):
                reduce()
            waiting.append(operator)
            operand = next(child for child in binary if attribute(child) == "right")[0]
            operands.append((self._build(operand), operand.position, operand.position_end))
        while waiting:
            reduce()
        return operands[0][0]

    def _name(self, node: Node) -> Name:
        return Name(node.value.lstrip("^"), node.position + self._offset, node.position_end + self._offset)

    def _word(self, node: Node) -> Any:
        """Return the value of a match rule; a keyword assigned by itself is a flag, so its value is True."""
        match node.rule_name:
            case "Name" | "UnreservedName":
                return node.value.lstrip("^")
            case "BuiltIn":
                return node.value
            case "Integer" | "SignedInteger" | "LoneInteger":
                return self._integer(node, literal=False)
            case "Double":
                return self._double(node)
            case "String" | "LoneString":
                return self._string(node)
            case "Boolean":
                return node.value == "true"
            case "MessageDirection" | "ResultType" | "Quantifier" | "InvariantKind" | "TimeUnit":
                return getattr(rsc, node.rule_name).getEEnumLiteral(node.value)
        return True

    def _integer(self, node: Node, *, literal: bool) -> int:
        digits = "".join(node.value.split())
        # Python itself refuses to convert numbers of more than a few thousand digits.
        most = _LARGEST + 1 if literal else _LARGEST
        if len(digits.lstrip("-0")) > 19 or not -_LARGEST - 1 <= int(digits) <= most:
            self._too_large(node)
            return 0
        return int(digits)

    def _too_large(self, node: Node) -> None:
        self._fault(node, "an integer lies between -9223372036854775808 and 9223372036854775807")

    def _double(self, node: Node) -> float:
        value = float(node.value)
        if value == float("inf"):
            self._fault(node, "a double is smaller than 1.8 times 10 to the power of 308")
            return 0.0
        return value

    def _string(self, node: Node) -> str:
        def replace(match: re.Match[str]) -> str:
            code = match[1]
            if len(code) > 1:
                return chr(int(code[1:], 16))
            if code not in _ESCAPES:
                start = node.position + 1 + match.start()
                hint = Repair("write `\\\\` for a backslash", f"\\\\{code}")
                self._fault(node, f"`\\{code}` is not an escape sequence", hint, start)
            return _ESCAPES.get(code, code)

        text = _ESCAPE.sub(replace, node.value[1:-1])
        try:
            # As in Java, two escapes may be the two halves of one code point. A single half is invalid.
            return text.encode("utf-16", "surrogatepass").decode("utf-16")
        except UnicodeDecodeError:
            self._fault(node, "a code point between `\\uD800` and `\\uDFFF` is not a character")
            return ""

    def _fault(self, node: Node, message: str, hint: Repair | str | None = None, start: int | None = None) -> None:
        first, end = (node.position, node.position_end) if start is None else (start, start + 2)
        finding = self._text.error("syntax", first + self._offset, end + self._offset, message, hint)
        self.findings.append(finding)

    def _source(self, start: int, end: int) -> Place:
        return self._text.source(start + self._offset, end + self._offset)


def _binds_first(left: Any, right: Any) -> bool:
    """Return whether the left operator of `a left b right c` takes `b`."""
    before, behind = BY_CLASS[left], BY_CLASS[right]
    if before.precedence == behind.precedence:
        return before.associativity is not Associativity.RIGHT
    return before.precedence > behind.precedence
