"""Layout of a parse tree: its required and its optional line breaks."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from robosc.language.builder import element_class
from robosc.language.formatting.comments import Space, spaces
from robosc.language.formatting.documents import Document, Gap, Group, Indent
from robosc.language.grammar import attribute
from robosc.model.semantics.operators import PRECEDENCE

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from robosc.language.grammar import Node

#: Rules whose items take one line each, and rules whose items share a line if they fit.
_BLOCKS = {"Robot", "Library", "Component", "ComponentBehaviour", "State", "ObjectDataType", "EnumDataType"}
_BLOCKS |= {"AutomatonRequirement", "RequirementState"}
_LISTS = {"ObjectValue", "CommunicationTypeSet", "EventSet"}
#: Rules whose parts belong to the block around them.
_INLINED = {"", "ComponentType", "LocalComponent", "InstantiatedComponent", "ImportedComponent", "Automaton"}
#: Rules without a space between their words.
_TIGHT = {"Access", "CommunicationReference", "PropertySegment", "IndexSegment", "IntegerDataType", "Array"}
_TIGHT |= {"InterfaceTypeReference", "Negation", "UnaryMinus"}
_CALLS = {"FunctionCall", "Call", "ComplexDataTypeReference", "ArrayLiteral"}
#: Words before which, and words behind which, a line may break, by rule.
_COMMUNICATION: tuple[set[str], set[str]] = (set(), {"with", ","})
CLAUSES: dict[str, tuple[set[str], set[str]]] = {
    "Interface": ({"use", "from"}, set()),
    "Component": ({"from", "import"}, set()),
    "Message": _COMMUNICATION,
    "Service": _COMMUNICATION,
    "Action": _COMMUNICATION,
    "OutgoingService": _COMMUNICATION,
    "OutgoingAction": _COMMUNICATION,
    "ResultTransition": ({"if", "do", "goto"}, set()),
    "TauTransition": ({"if", "do", "goto"}, set()),
    "TimedTransition": ({"without", "do", "goto"}, set()),
    "EnumTransformationRule": ({"->"}, set()),
    "NeedsRequirement": (set(), {"needs"}),
    "Assumption": (set(), {"needs"}),
    "DisablesRequirement": ({"disables"}, set()),
    "OrderRequirement": ({"after"}, set()),
    "CountRequirement": ({"since"}, set()),
    "RequirementTransition": ({"if", "goto"}, set()),
    "StateInvariant": (set(), {"never", "always"}),
    "InvariantProperty": (set(), {"never", "always"}),
    "ReachabilityProperty": ({"from"}, {"reachable"}),
    "ReachabilityRequirement": ({"from"}, {"reachable"}),
    "ProvideStatement": ({"if"}, set()),
    "LimitStatement": ({"if"}, set()),
    "Conditional": ({"then", "else"}, set()),
    "Constant": (set(), {"="}),
    "Parameter": (set(), {"="}),
    "Condition": (set(), {"="}),
    "Function": (set(), {"="}),
}
#: Rules whose clauses break independently, because a clause may begin with a list that breaks.
_LOOSE = {"NeedsRequirement", "Assumption", "ProvideStatement", "LimitStatement"}


def layout(text: str, tree: Node) -> Document:
    """Return the document of a text and its parse tree by the rule `Base`."""
    return _DocumentLayout(spaces(text, _words(tree))).file(tree, len(text))


class _DocumentLayout:
    """Creates documents of nodes. The space before a node belongs to its parent."""

    def __init__(self, spaces: dict[int, Space]) -> None:
        self._spaces = spaces

    def file(self, tree: Node, end: int) -> Document:
        """Return the document of a whole file."""
        return self._line(tree.position, first=True), self._document(tree), self._line(end)

    def _document(self, node: Node) -> Document:
        if _is_leaf(node):
            # Only a signed number can contain blanks.
            return "".join(node.value.split()) if node.rule_name == "SignedInteger" else str(node.value)
        rule, parts = node.rule_name, list(_parts(node))
        if rule in _BLOCKS:
            return self._block(parts)
        if rule in _LISTS and len(parts) > 1:
            return self._list(parts)
        if rule in CLAUSES:
            return self._clauses(parts, rule)
        if rule == "Expression":
            return self._chain(parts[0], [(link[0], *_parts(link[0])) for link in parts[1:]])
        if rule in _CALLS:
            return Group(self._row(parts, Gap.NONE, after={","}))
        if rule == "Operand" and len(parts) > 1:
            return self._brackets(*parts)
        return self._row(parts, Gap.NONE if rule in _TIGHT else Gap.SPACE)

    # In a row

    def _row(
        self, parts: Sequence[Node], gap: Gap = Gap.SPACE, before: Collection[str] = (), after: Collection[str] = ()
    ) -> Document:
        """Lay out parts in a line that may break before and behind certain words; broken lines are indented."""
        row = [self._document(parts[0])]
        for left, right in pairwise(parts):
            breaks = _is_word(left, after) or _is_word(right, before)
            tight = _is_word(right, {",", ":", "(", "[", "]", "..", "/"}) or _is_word(left, {"[", "..", "/"})
            between = Gap.NONE if tight else Gap.BREAK if breaks else gap
            row.append(Indent(self._gap(right, between)))
            # A closing bracket aligns with the line of its opening bracket.
            document = self._document(right)
            row.append(document if gap is Gap.NONE or right.rule_name in _LISTS else Indent(document))
        return tuple(row)

    def _clauses(self, parts: Sequence[Node], rule: str) -> Document:
        """Lay out a row of rows."""
        starts, ends = CLAUSES[rule]
        clauses = [[parts[0]]]
        for left, right in pairwise(parts):
            if _is_word(right, starts) or _is_word(left, ends):
                clauses.append([])
            clauses[-1].append(right)
        first = self._row(clauses[0])
        documents: list[Document] = [Indent(first) if parts[0].rule_name == "Expression" else first]
        for clause in clauses[1:]:
            content = Group(self._row(clause, before={"links"}, after={"do", ","}))
            documents.append(Indent((self._gap(clause[0], Gap.BREAK), content)))
        return tuple(map(Group, documents)) if rule in _LOOSE else Group(tuple(documents))

    def _chain(self, first: Node, others: Sequence[tuple[Node, Node, Node]]) -> Document:
        """Lay out operands so that the loosest operators break first.

        Each operand but the first comes with its binary expression and its operator.
        """
        loosest = min((_precedence(binary) for binary, _, _ in others), default=0)
        links: list[tuple[Node | None, Node, list[tuple[Node, Node, Node]]]] = [(None, first, [])]
        for binary, operator, operand in others:
            if _precedence(binary) == loosest:
                links.append((operator, operand, []))
            else:
                links[-1][2].append((binary, operator, operand))
        if len(links) == 1:
            return self._document(first)
        chain: list[Document] = []
        for operator, operand, tighter in links:
            if operator is not None:
                chain += self._gap(operator, Gap.BREAK), self._document(operator), self._gap(operand, Gap.SPACE)
            inner = self._chain(operand, tighter)
            chain.append(Indent(inner) if tighter else inner)
        return Group(tuple(chain))

    # Between brackets

    def _brackets(self, opening: Node, content: Node, closing: Node) -> Document:
        inside = Indent((self._gap(content, Gap.SOFT), self._document(content)))
        return Group((self._document(opening), inside, self._closing(closing, Gap.SOFT)))

    def _list(self, parts: Sequence[Node]) -> Document:
        """Lay out items between braces, all in one line or each in its own."""
        opening, *items, closing = parts
        if not items:
            return self._empty(opening, closing)
        row: list[Document] = []
        for part in parts[1:-1]:
            row += self._gap(part, Gap.NONE if _is_word(part, {","}) else Gap.BREAK), self._document(part)
        return Group((self._document(opening), Indent(tuple(row)), self._closing(closing, Gap.BREAK)))

    def _block(self, parts: Sequence[Node]) -> Document:
        """Lay out a header and the items between its braces, each in its own line."""
        at = next((index for index, part in enumerate(parts) if _is_word(part, {"{"})), len(parts))
        header: Document = Group(self._row(parts[:at], after={","}))
        if any(_is_word(part, {"import"}) for part in parts):
            header = self._clauses(parts[:at], "Component")
            return (header, self._gap(parts[at], Gap.SPACE), self._list(parts[at:])) if at < len(parts) else header
        if at == len(parts):
            return header
        opening, *items, closing = parts[at:]
        start = header, self._gap(opening, Gap.SPACE)
        if not items:
            return *start, self._empty(opening, closing)
        lines = tuple((self._line(item.position, first=item is items[0]), self._document(item)) for item in items)
        return *start, self._document(opening), Indent(lines), self._closing(closing, Gap.LINE)

    def _empty(self, opening: Node, closing: Node) -> Document:
        gap = Gap.LINE if self._spaces[closing.position].comments else Gap.NONE
        return self._document(opening), self._closing(closing, gap, first=True)

    # Gaps and the comments in them

    def _gap(self, node: Node, gap: Gap) -> Document:
        """Return the gap before a node within an item, with its comments.

        Line breaks around the comments stay.
        """
        space = self._spaces[node.position]
        return self._comments(space, gap, _gaps(space))

    def _line(self, offset: int, *, first: bool = False) -> Document:
        """Return the line break before an item, with its comments. At most one empty line stays."""
        space = self._spaces[offset]
        gaps = _gaps(space, Gap.BLANK)
        start = gaps[space.trailing] = Gap.BLANK if gaps[space.trailing] is Gap.BLANK and not first else Gap.LINE
        return self._comments(space, start, gaps)

    def _comments(self, space: Space, gap: Gap, gaps: Sequence[Gap]) -> Document:
        if not space.comments:
            return gap
        documents: list[Document] = list(space.comments[: space.trailing])
        documents.append(gap)
        for before, comment in zip(gaps[space.trailing :], space.comments[space.trailing :], strict=False):
            documents += before, comment
        return *documents, gaps[-1]

    def _closing(self, node: Node, gap: Gap, *, first: bool = False) -> Document:
        """Return a closing bracket and the gap before it. Comments in the gap belong inside the brackets."""
        space = self._spaces[node.position]
        gaps = _gaps(space, Gap.BLANK if gap is Gap.LINE else Gap.LINE)
        if first and gaps[space.trailing] is Gap.BLANK:
            gaps[space.trailing] = Gap.LINE
        comments = tuple(part for pair in zip(gaps, space.comments, strict=False) for part in pair)
        end = Gap.LINE if space.comments and space.breaks[-1] else gap
        return Indent(comments), end, self._document(node)


def _gaps(space: Space, empty_line: Gap = Gap.LINE) -> list[Gap]:
    """Return the gaps before each comment and before the word, from the line breaks of the source."""
    return [empty_line if count > 1 else Gap.LINE if count else Gap.SPACE for count in space.breaks]


def _words(node: Node) -> Iterator[Node]:
    """Yield the words below a node in the order of the text."""
    if _is_leaf(node):
        yield node
    else:
        for part in node:
            yield from _words(part)


def _parts(node: Node) -> Iterator[Node]:
    """Yield the children of a node; rules without a layout of their own are replaced by their children."""
    for part in node:
        if not _is_leaf(part) and (part.rule_name in _INLINED or attribute(part) is not None):
            yield from _parts(part)
        else:
            yield part


def _is_leaf(node: Node) -> bool:
    return not isinstance(node, list)


def _is_word(node: Node, words: Collection[str]) -> bool:
    """Return whether a node is one of these words or symbols of the language, and not an equal name."""
    return _is_leaf(node) and node.rule_name in {"", "sep"} and node.value in words


def _precedence(node: Node) -> int:
    operator = element_class(node.rule_name)
    assert operator is not None
    return PRECEDENCE[operator]
