"""Messages and hints for syntax errors: the token at fault, the expected words, and a repair."""

from __future__ import annotations

from decimal import Decimal, InvalidOperation
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Repair
from robosc.language.grammar import first, first_words, following, is_reserved, words_of
from robosc.language.outline import COMPONENT, DEFINITIONS, RULES
from robosc.language.tokens import Kind, Token
from robosc.model.semantics.naming import ROBOSC_QUANTIFIERS, enumeration, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from robosc.language.outline import Block, Level
    from robosc.language.tokens import Tokens

#: Symbols of other languages and the RoboSC symbols that replace them.
_FOREIGN = {
    "==": "=",
    "===": "=",
    "<>": "!=",
    "=<": "<=",
    "&&": "and",
    "&": "and",
    "||": "or",
    "|": "or",
    "\N{NOT EQUAL TO}": "!=",
    "\N{LESS-THAN OR EQUAL TO}": "<=",
    "\N{GREATER-THAN OR EQUAL TO}": ">=",
    "\N{RIGHTWARDS ARROW}": "->",
    "\N{LEFT DOUBLE QUOTATION MARK}": '"',
    "\N{RIGHT DOUBLE QUOTATION MARK}": '"',
    ";": "",
    "#": "//",
    "\N{NO-BREAK SPACE}": " ",
}
#: Hints for symbols that have no counterpart.
_LEFT_OUT = {";": "leave it out: RoboSC has no semicolons", "\N{NO-BREAK SPACE}": "write a common blank"}
#: Symbols that bind closer than comparisons in other languages.
_BITWISE = {"&", "|"}
_COMPARISONS = {"=", "!=", "<", "<=", ">", ">=", "==", "===", "<>", *_BITWISE}
_ENDS_OF_OPERANDS = (
    *("and", "or", "&&", "||", "=>", ",", "(", ")", "{", "}", "if", "do", "goto", "needs", "disables"),
    *first_words("Definition", "ComponentDefinition", "AutomatonDefinition"),
)
#: Hints for words of other languages, and for words of RoboSC in a wrong place.
_CONSTANT = "write `constant name: type = value`"
_PARAMETER = "write `parameter name: type = value` in the robot, a library or a component"
_TIME = "write `after 3.0 s goto state` in a state, or `after 500 ms without message goto state` for a silent topic"
_FUNCTION = "write `function name(parameter: type): type = expression`"
_INVARIANT = "write `requirement never condition` or `requirement always condition`; `property` only verifies it"
_ORDER = "write `requirement b after a`, or `requirement b after each a` where each `b` needs an `a` of its own"
_COUNT = "write `requirement at most 3 b since a`"
_TEMPLATE = (
    "write `component name(parameter: type) { … }`, and `component other is name(argument)` for an instance of it"
)
_QUANTIFIER = (
    f"write {enumeration(f'`{word}`' for word in ROBOSC_QUANTIFIERS)}, a name, `in` and an array, or the name of a "
    "template, and a colon"
)
_CASES = "write a transition for each case: the first whose condition holds is taken"
_MODULO = "write `mod(a, b)`"
_CONDITION = "write `if`"
_CHOICE = "write `if condition then value else value`"
_MEANT = {
    **dict.fromkeys(("const", "let", "val", "define"), _CONSTANT),
    **dict.fromkeys(("param", "parameter"), _PARAMETER),
    **dict.fromkeys(("after", "timeout", "timer", "wait", "delay", "sleep", "every"), _TIME),
    **dict.fromkeys(("def", "fn", "func", "fun"), _FUNCTION),
    **dict.fromkeys(("never", "always", "invariant", "assert", "require"), _INVARIANT),
    "before": _ORDER,
    "each": "write `requirement each T: …` for each instance of `T`, or `requirement b after each a` for an order",
    **dict.fromkeys(("at", "most", "least", "since"), _COUNT),
    **dict.fromkeys(("template", "extends", "new", "instance"), _TEMPLATE),
    **dict.fromkeys(("forall", "exists", "foreach", *ROBOSC_QUANTIFIERS), _QUANTIFIER),
    **dict.fromkeys(("else", "elif", "elseif"), _CASES),
    **dict.fromkeys(("mod", "%"), _MODULO),
    "reachable": "write `property reachable condition`, or `requirement reachable condition` to enforce it",
    "automaton": "write `requirement name: automaton { … }`",
    "then": _CHOICE,
    "?": _CHOICE,
    "not": "write `!` for `not`",
    "when": _CONDITION,
    "unless": "write `if` and `!` before the condition",
    "var": "write `variable`",
}
#: Units of time in other spellings.
_UNITS = {
    **dict.fromkeys(("millis", "msec", "msecs", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"),
}
#: Words in another spelling, or of another language, each with the only word that it can stand for.
_SPELLED = {"cancelled": "canceled", "implies": "=>", "topic": "identifier"}
#: Replacement of such a word that turns the text into the intended construct.
_WRITTEN = {
    **dict.fromkeys(("const", "let", "val", "define"), "constant"),
    "param": "parameter",
    **dict.fromkeys(("timeout", "timer", "wait", "delay", "sleep"), "after"),
    **dict.fromkeys(("def", "fn", "func", "fun"), "function"),
    "reachable": "property reachable",
    "forall": "all",
    "exists": "any",
    "when": "if",
    "var": "variable",
}
#: Hints for words that were read as names: keywords of RoboSC in a wrong place, and literals of Python.
CONSTRUCTS: dict[str, Repair | str] = {
    "True": Repair("write `true`", "true"),
    "False": Repair("write `false`", "false"),
} | {word: _MEANT[word] for word in (*ROBOSC_QUANTIFIERS, "never", "always", "reachable", "each", "after")}
#: Names of the basic types in other languages.
BASIC_TYPES = {
    **dict.fromkeys(("int", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "long"), "integer"),
    **dict.fromkeys(("float", "float32", "float64", "real"), "double"),
    **dict.fromkeys(("bool", "Boolean"), "boolean"),
    **dict.fromkeys(("str", "String", "text"), "string"),
    **dict.fromkeys(("void", "empty", "Empty"), "none"),
}
#: Levels and the names of the places that contain their items.
_PLACES = ((DEFINITIONS, "the robot", "a library"), (COMPONENT, "a component"))
#: Maximum number of characters of a number that a hint writes without exponent.
_LONGEST_NUMBER = 40
_RULES = {
    "Name": "a name",
    "UnreservedName": "a name",
    "String": "a string",
    "LoneString": "a string",
    "Integer": "a whole number",
    "LoneInteger": "a whole number",
    "SignedInteger": "a whole number",
    "Double": "a number",
    "FeedbackTo": "`feedback`",
}
#: Phrases that replace several expected words in a message. Each has the rule that the words begin, and its core: words
#: that the grammar expects only together. The phrase is used if the whole core is expected.
_GROUPS = (
    ("an expression", "Expression", {"value", "UnreservedName", "!"}),
    ("an operator", "BinaryExpression", {"and", "or", "=>"}),
    ("a type", "DataType", {"double", "integer", "none"}),
)


def quote_token(token: Token) -> str:
    """Return a token as a message quotes it."""
    if token.kind is Kind.END:
        return "the end of the file"
    text = token.text if len(token.text) <= 30 else f"{token.text[:29]}\N{HORIZONTAL ELLIPSIS}"
    return f"`{text}`" if text.isprintable() and not text.isspace() else f"the character U+{ord(token.text[0]):04X}"


def enumerate_expected(expectations: Iterable[str], level: Level | None) -> str:
    """Return the expected words as an enumeration; `end` stands for the next item of the level."""
    words = [word for word in expectations if word]  # A negative lookahead has no word.
    for name, rule, core in _GROUPS:
        if core <= set(words):
            words = [name if word in core else word for word in words if word in core or word not in _alike(rule)]
    if len(words) > 1:
        # A name can nearly always continue, but its continuation is never the missing part.
        words = [word for word in words if word not in {".", "[", "("}]
    named = [_RULES.get(word, word if " " in word else f"`{word}`") for word in words if word != "end"]
    if "end" in words:
        named.append(f"the next {level.noun}" if level else "the end of the file")
    return enumeration(dict.fromkeys(named))


def closest(word: str, known: Iterable[str], *, cutoff: float) -> str | None:
    """Return the known name most similar to a word, or None if none reaches the similarity `cutoff` (0 to 1)."""
    return next(iter(get_close_matches(word, sorted(set(known)), n=1, cutoff=cutoff)), None)


def did_you_mean(word: str, known: Iterable[str], *, cutoff: float) -> Repair | None:
    """Return the repair that offers the closest name for a word of a RoboSC text, or None if no name is close.

    A name is never replaced without a choice: the closest name of `unlocked` is `locked`.
    """
    close = closest(word, known, cutoff=cutoff)
    return offer_name(escape_keyword(close)) if close else None


def offer_name(name: str) -> Repair:
    """Return the repair that offers a name as it is written in the text."""
    return Repair(f"did you mean `{name}`?", choices=(name,))


def _alike(rule: str) -> set[str]:
    """Return the words that can begin a text of a rule; symbols also without their lookahead."""
    return {spelling for word in first(rule) for spelling in (word, word.partition("(?!")[0])}


def hint(tokens: Tokens, index: int, expectations: Sequence[str], block: Block) -> Repair | str | None:
    """Return a repair or hint for the faulty token of an item, or None if there is none."""
    token, before = tokens[index], tokens[index - 1]
    symbols = _symbols(token, expectations)
    if index < block.after and _is_name(tokens, index, expectations):
        return _as_name(tokens, index, expectations)
    definite = (
        _foreign(tokens, index) if token.text in _FOREIGN else _statement_hint(tokens, index, expectations, block)
    )
    if definite is not None:
        return definite
    if before.is_name and before.text in expectations and is_reserved(before.text):
        return f"is a name missing before `{before.text}`?"
    if "then" in expectations or "else" in expectations:
        return _CHOICE
    if before.is_keyword(",") and token.kind is Kind.SYMBOL:
        is_last = token.text in {")", "]", "}"}  # elsewhere, a value may be missing
        return Repair("leave out the comma before it", elsewhere=((before.start, before.end, ""),) if is_last else ())
    if "->" in expectations and block.level is RULES and (token.is_first or before.text == "default"):
        return _value_hint(token, has_value=index < block.after and not token.is_keyword("}"))
    if token.text in {"=", ":", ":=", "=>", "->"} and len(symbols) == 1:
        return _symbol_hint(token, symbols[0], expectations)
    if "." in {token.text, before.text} and Kind.NUMBER in {token.kind, before.kind, tokens[index + 1].kind}:
        return _both_sides(tokens, index)
    if token.kind is Kind.NUMBER and not token.text.replace(".", "").isdigit():
        return _without_exponent(tokens, index)
    return _word_hint(tokens, index, expectations, block) if token.kind is Kind.WORD else _MEANT.get(token.text)


def _symbol_hint(token: Token, symbol: str, expectations: Collection[str]) -> Repair:
    """Return the hint for a symbol in the place of another one."""
    if token.text == "->" and "goto" in expectations:
        return Repair("write `goto`, or `=>` for an implication", choices=("goto", "=>"))
    # A list is not what an arrow means.
    return Repair(f"write `{symbol}`", symbol, is_offered=symbol == "," and token.text != ":")


def _is_name(tokens: Tokens, index: int, expectations: Sequence[str]) -> bool:
    """Return whether a keyword was meant as a name, and no name is missing before it."""
    token, before, after = tokens[index], tokens[index - 1], tokens[index + 1]
    if token.kind is not Kind.WORD or "UnreservedName" not in expectations:
        return False
    if not is_reserved(token.text) or token.text not in following():
        return False
    if before.is_keyword("requirement", "property", "disables") and after.text in following()[token.text]:
        return False
    return after.is_first or after.kind is not Kind.WORD or after.text in words_of("Base")


def _as_name(tokens: Tokens, index: int, expectations: Collection[str]) -> Repair:
    """Return the hint for a keyword meant as a name.

    At a type it is an edit only if the text declares such a name.
    """
    written_so = f"^{tokens[index].text}"
    is_type = any(name == "a type" and core <= set(expectations) for name, _, core in _GROUPS)
    is_edit = not is_type or any(token.text == written_so for token in tokens)
    return Repair(f"write `{written_so}` to use a keyword as a name", written_so if is_edit else None)


def misread(tokens: Tokens, index: int, expectations: Collection[str]) -> int:
    """Return the index of the token that was meant as a name.

    That is the token before `index` if it was read as a keyword, else the one at `index`.
    """
    before, token = tokens[index - 1], tokens[index]
    around = tokens[index - 2]
    is_event = set(expectations) == {"to", "from"} and not around.is_keyword("on")
    is_target = around.is_keyword("requirement", ":") and token.is_keyword("needs", "after")
    is_literal = before.is_keyword("value", "true", "false", "if") and is_target
    return index - 1 if is_event or is_literal else index


def _foreign(tokens: Tokens, index: int) -> Repair:
    """Return the hint for a symbol of another language.

    The hint replaces a quotation mark together with its counterpart.
    """
    own = _FOREIGN[tokens[index].text]
    hint_text = _LEFT_OUT.get(tokens[index].text) or f"write `{own}`"
    if own != '"':
        return Repair(hint_text, own, is_offered=_binds_otherwise(tokens, index))
    others = _other_quotes(tokens, index)
    # An unclosed string would reach the end of the line, and a string around a comment would swallow it.
    is_whole = others and not tokens.has_comment(tokens[index].start, others[-1][1])
    return Repair(hint_text, own, elsewhere=others) if is_whole else Repair(hint_text)


def _binds_otherwise(tokens: Tokens, index: int) -> bool:
    """Return whether a symbol may mean something else in its own language: `a == b == c`, `a & b == c`, `[a; -b]`."""
    if tokens[index].text in _BITWISE:
        return True
    if tokens[index].text == ";":  # The next value may continue the one before it: `[a; -b]`.
        after = tokens[index + 1]
        return after.kind is Kind.SYMBOL and after.text != "}"
    return tokens[index].text in {"==", "==="} and any(
        _has_comparison(tokens, index, direction) for direction in (-1, 1)
    )


def _has_comparison(tokens: Tokens, index: int, direction: int) -> bool:
    """Return whether a comparison or bitwise symbol is beside the one at `index`, in the same operand."""
    at = index + direction
    while 0 < at < len(tokens) - 1:
        if tokens[at].text in _COMPARISONS:
            return True
        if tokens[at].is_keyword(*_ENDS_OF_OPERANDS):
            return False
        at += direction
    return False


def _before(token: Token, hint_text: str, text: str) -> Repair:
    """Return a hint that inserts text before a token."""
    return Repair(hint_text, elsewhere=((token.start, token.start, f"{text} "),))


def _value_hint(token: Token, *, has_value: bool) -> Repair | str:
    if has_value:
        return _before(token, "write `->` before the value that the rule gives", "->")
    return "write `->` and the value that the rule gives"


def _other_quotes(tokens: Tokens, index: int) -> tuple[tuple[int, int, str], ...]:
    """Return edits for the other foreign quotation marks in the line."""
    edits = []
    other = index + 1
    while other < len(tokens) - 1 and not tokens[other].is_first:
        if _FOREIGN.get(tokens[other].text) == '"':
            edits.append((tokens[other].start, tokens[other].end, '"'))
        other += 1
    return tuple(edits)


def _both_sides(tokens: Tokens, index: int) -> Repair:
    """Return the hint for a number without digits on one side of its point, and the edit that adds a zero."""
    hint_text = "a number has digits on both sides of its point, such as `0.5` or `1.0`"
    point = next((at for at in (index, index - 1) if tokens[at].text == "."), index)
    before, token, after = tokens[point - 1], tokens[point], tokens[point + 1]
    if ".." in {before.text, after.text}:
        return Repair(
            "a range has two points, such as `0..5`", elsewhere=((token.start, token.end, ""),), is_offered=True
        )
    is_after = before.kind is Kind.NUMBER and before.end == token.start
    if is_after and not (after.kind is Kind.NUMBER and after.start == token.end):
        return Repair(hint_text, elsewhere=((token.end, token.end, "0"),))
    is_before = after.kind is Kind.NUMBER and after.start == token.end
    return Repair(hint_text, elsewhere=((token.start, token.start, "0"),) if is_before and not is_after else ())


def _without_exponent(tokens: Tokens, index: int) -> Repair:
    """Return the hint for a number in the notation of other languages, and the edit that rewrites it."""
    hint_text = "a number has digits and a point only, no exponent and no letters"
    token, sign, digits = tokens[index], tokens[index + 1], tokens[index + 2]
    is_signed = token.text[-1] in "eE" and token.end == sign.start and sign.end == digits.start
    text, end = (token.text + sign.text + digits.text, digits.end) if is_signed else (token.text, token.end)
    try:
        number = Decimal(text)
    except InvalidOperation:
        return Repair(hint_text)
    is_short = len(text) < _LONGEST_NUMBER and abs(number.adjusted()) < _LONGEST_NUMBER
    return Repair(hint_text, elsewhere=((token.start, end, f"{number:f}"),) if is_short else ())


def _timed_hint(token: Token, before: Token, expectations: Sequence[str]) -> Repair | str | None:
    if token.text in _UNITS and _UNITS[token.text] in expectations:
        return Repair(f"write `{_UNITS[token.text]}`", _UNITS[token.text])
    if Kind.NUMBER in {token.kind, before.kind} and "do" not in expectations:
        return "write a number, a space and a unit, `ms`, `s` or `min`: `after 3.0 s`"
    if token.text == "if":
        return "an `after` has no condition: add a state with a `transition if …`"
    return None


def _statement_hint(tokens: Tokens, index: int, expectations: Sequence[str], block: Block) -> Repair | str | None:
    """Return the hint that depends on the kind of definition around the token."""
    token, before, starter = tokens[index], tokens[index - 1], tokens[block.first]
    if _SPELLED.get(token.text) in expectations:
        return Repair(f"write `{_SPELLED[token.text]}`", _SPELLED[token.text])
    if token.text == "[" and before.is_keyword("integer", "double"):
        return _range_hint(tokens, index)
    if token.text == "if" and (moved := _condition_first(tokens, index, expectations, starter)) is not None:
        return moved
    if starter.is_keyword("after"):
        return _timed_hint(token, before, expectations)
    if starter.is_keyword("incoming", "outgoing", "service", "action"):
        return _order_hint(tokens, index, expectations)
    if starter.is_keyword("provide", "limit") and token.text in {"else", ":"}:
        return _CHOICE if token.text == "else" else "write the properties of an object in braces"
    if starter.is_keyword("requirement", "property"):
        return _set_hint(tokens, index, block) or _requirement_hint(token, before, expectations)
    if starter.is_keyword("component") and "is" in expectations and token.text in {"=", ":"}:
        return Repair(_TEMPLATE, "is" if tokens[index - 1].end < token.start else " is")
    if starter.is_keyword("function") and token.text == "{" and {"=", "=(?!>)"} & set(expectations):
        return "write `=` and one expression instead of braces"
    return None


def _range_hint(tokens: Tokens, index: int) -> Repair:
    """Return the hint for a range in brackets."""
    closing = index + 1
    while closing < len(tokens) and tokens[closing].text not in {"[", "]", "{", "}"}:
        closing += 1
    is_closed = tokens[closing].text == "]"
    ends = ((tokens[closing].start, tokens[closing].end, ")"),) if is_closed else ()
    return Repair("write parentheses around the range", "(" if is_closed else None, elsewhere=ends)


def _condition_first(tokens: Tokens, index: int, expectations: Collection[str], starter: Token) -> Repair | None:
    """Return the hint for a condition before `on`, which follows the event; None if a transition cannot begin here."""
    is_next = "end" in expectations and starter.is_keyword("on", "transition", "after")
    if "on" not in expectations and not is_next:
        return None
    hint_text = "write the condition after the event, as in `on … if … do … goto …`"
    event = index + 1
    while event < len(tokens) and not tokens[event].is_keyword("on", "{", "}", "goto"):
        event += 1
    if not tokens[event].is_keyword("on"):
        return None if is_next else Repair(hint_text)
    if tokens.has_comment(tokens[index].start, tokens[event].start):
        return Repair(hint_text)
    name = tokens[_reference_end(tokens, event + 3)]
    moved = (
        (tokens[index].start, tokens[event].start, ""),
        (name.end, name.end, f" {_joined_text(tokens, index, event)}"),
    )
    return Repair(hint_text, elsewhere=moved, is_offered=True)


def _joined_text(tokens: Tokens, first: int, after: int) -> str:
    """Return a range of tokens as the text has it, with one blank in place of several."""
    parts = [tokens[first].text]
    for at in range(first + 1, after):
        parts += [" "] if tokens[at].start > tokens[at - 1].end else []
        parts.append(tokens[at].text)
    return "".join(parts)


def _reference_end(tokens: Tokens, at: int) -> int:
    """Return the index of the last token of a reference, such as `Cell[1].enter`, that begins at an index."""
    while tokens[at + 1].text in {".", "["}:
        if tokens[at + 1].text == ".":
            at += 2
        else:
            at = next((end for end in range(at + 2, len(tokens)) if tokens[end].text == "]"), len(tokens) - 1)
    return at


def _reference_start(tokens: Tokens, at: int) -> int:
    """Return the index of the first token of a reference that ends at an index."""
    while tokens[at - 1].text == ".":
        at -= 2
        if tokens[at].text == "]":
            at = next((start for start in range(at - 1, 0, -1) if tokens[start].text == "["), 1) - 1
    return at


def _set_hint(tokens: Tokens, index: int, block: Block) -> Repair | None:
    """Return the hint for several communications without braces."""
    needs = next((at for at in range(index, block.after) if tokens[at].is_keyword("needs")), None)
    if tokens[index].text != "," or needs is None:
        return None
    start = tokens[_reference_start(tokens, index - 1)].start
    around = ((start, start, "{ "), (tokens[needs - 1].end, tokens[needs - 1].end, " }"))
    return Repair("write braces around several communications", elsewhere=around)


def _order_hint(tokens: Tokens, index: int, expectations: Sequence[str]) -> Repair | str | None:
    """Return the hint for clauses of a communication in the wrong order."""
    token = tokens[index]
    if token.text == "," and tokens[index - 2].is_keyword("links"):
        return "write `links` after all other clauses"
    if token.text == "send" and "type" in expectations:
        return "write `send: change` after the type"
    if token.text == "identifier" and token.text not in expectations:
        return "write `identifier` before all other clauses"
    if "change" in expectations:
        hint_text = "write `send: change`, or leave `send` out to send in every tick"
        return Repair(hint_text, choices=("change",) if token.kind is Kind.WORD else ())
    return None


def _requirement_hint(token: Token, before: Token, expectations: Sequence[str]) -> Repair | str | None:
    if ":" in expectations and (before.kind is Kind.STRING or token.is_keyword("automaton")):
        return _before(token, "write `:` before it", ":")
    if (token.is_keyword("needs") and "after" in expectations) or before.is_keyword("disables"):
        return "write the name of the communication alone, without the word for its event"
    if before.kind is Kind.STRING:
        return 'write the text before the colon: `requirement name "text": …`'
    if "needs" in expectations and token.text in {"when", "if", "requires", "while"}:
        # `stop when` can mean that the robot must stop then.
        is_certain = token.text == "requires"
        return Repair("write `needs`", "needs" if is_certain else None, () if is_certain else ("needs",))
    if before.text == "every":
        return _ORDER
    if token.text in {"on", "transition", "after", "do", "variable"}:
        return "a requirement automaton has only states with `on … if … goto …`"
    return None


def _symbols(token: Token, expectations: Sequence[str]) -> list[str]:
    """Return the symbols that may have been meant instead of another symbol."""
    if token.text == "->" and "=>" in expectations:
        return ["=>"]
    return [
        word
        for word in (":", ":=", "=", "->", "{", ",")
        if word in expectations or (word == "=" and "=(?!>)" in expectations)
    ]


def _construct(word: Token) -> Repair | str:
    """Return the hint for a misused word, with an edit if a single word replaces it."""
    if word.text == "not":
        return Repair(_MEANT["not"], elsewhere=((word.start, word.end, "!"),))
    if word.text in {"never", "always"}:
        # A requirement restricts the robot, a property does not.
        return Repair(_INVARIANT, choices=(f"requirement {word.text}", f"property {word.text}"))
    text = _WRITTEN.get(word.text)
    if text is None:
        return _MEANT[word.text]
    if word.text == "when" and word.is_first:
        return Repair(_CONDITION, choices=("if", "transition if"))
    # Other languages declare variables with `let`. A pause in a transition is no transition of its own.
    is_offered = word.text in {"let", "val"} or text == "after"
    return Repair(_MEANT[word.text], elsewhere=((word.start, word.end, text),), is_offered=is_offered)


def _word_hint(tokens: Tokens, index: int, expectations: Sequence[str], block: Block) -> Repair | str | None:
    token = tokens[index]
    words = {word for word in expectations if word.isalpha() and word.islower()} - {"end"}
    if "end" in expectations and block.level:
        words |= block.level.starters
    close = get_close_matches(token.text, sorted(words - {token.text}), n=1, cutoff=0.7)
    if list(expectations) in ([","], [":"]):
        return _before(token, f"write `{expectations[0]}` before it", expectations[0])
    for word in (token, tokens[index - 1]):  # The parser reads a misused word as a name if a name is allowed there.
        if word.text in _MEANT and word.kind is Kind.WORD:
            return _construct(word)
    places = [place for level, *places in _PLACES if level.starter(token) == token.text for place in places]
    if places and index == block.first and block.level not in (DEFINITIONS, COMPONENT):
        return f"write such a definition in {enumeration(places)}"
    if not token.text.removeprefix("^").isascii():
        return "a name has only the letters a to z and A to Z, digits and `_`"
    if token.text == "if" and tokens[block.first].is_keyword("on"):
        return "write the condition of a transition before `do` and `goto`, as in `on … if … do … goto …`"
    return keyword_hint(token.text, close[0]) if close else None


def keyword_hint(word: str, close: str) -> Repair | str:
    """Return the hint for a word similar to a keyword.

    If the word begins or ends with the keyword, the hint is a missing blank. A word is never replaced without a choice:
    the closest keyword of `with` may be `without`.
    """
    if word.startswith(close):
        return f"is a space missing after `{close}`?"
    if word.endswith(close):
        return f"is a space missing before `{close}`?"
    return offer_name(close)
