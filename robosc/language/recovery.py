"""Parses a file; if it has faults, finds all of them and parses the rest.

A text without faults is parsed as a whole. Otherwise its outline is parsed item by item, the smallest first. Items that
do not parse become findings and are blanked out. The remaining text, parsed as a whole, becomes the model.
"""

from __future__ import annotations

from dataclasses import replace
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Related, Repair
from robosc.language.builder import Builder
from robosc.language.grammar import Failure, first_words, is_reserved, parse
from robosc.language.outline import DECLARED, DEFINITIONS, PROPERTIES, RULES, Block, Brace, Outline
from robosc.language.scopes import File, NameKind, SkippedRegions
from robosc.language.spellings import parse_text, usual_spelling
from robosc.language.syntax_messages import enumerate_expected, hint, misread, quote_token
from robosc.language.tokens import Kind, Token, too_complex

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.text import Text
    from robosc.model import robosc as rsc

_LEAVE_OUT = "leave it out"
#: First keywords of items that declare no name usable elsewhere.
_DECLARING_NOTHING = first_words("Requirement", "Assumption", "ProvideStatement", "LimitStatement", "Transition")


def parse_file(text: Text) -> File:
    """Return the readable parts of a text as a file with unlinked names.

    Findings are of the rule `syntax`.
    """
    file = _parsed(text)
    if text.source_file is not None:
        text.source_file.parsed = file
    return file


def _parsed(text: Text) -> File:
    tree = None if too_complex(text.tokens) else parse_text(text)[0]
    if tree is None or isinstance(tree, Failure):
        return recover(text)
    builder = Builder(text)
    base = builder.build(tree)
    return File(text, base, builder.references, builder.declared, builder.bounded, findings=builder.findings)


def recover(text: Text) -> File:
    """Return the readable parts of a text that the grammar rejects, with a finding for each fault."""
    return _Recovery(text).parse()


class _Recovery:
    """Parses a text that has faults. `_content` is the text, with its faults blanked out or repaired."""

    def __init__(self, text: Text) -> None:
        self._text = text
        self._tokens = tokens = text.tokens
        # Comments become blanks. Blanks behind the text are room for missing braces.
        self._content = [character if character == "\n" else " " for character in text.content + " " * 10]
        usual = usual_spelling(text)
        for token in tokens:
            self._content[token.start : token.end] = usual[token.start : token.end]
        self._findings: list[Diagnostic] = []
        self._regions = SkippedRegions()
        self._is_library = tokens[0].text == "library"

    def parse(self) -> File:
        """Return the model of the remaining text, and all findings."""
        tokens = self._tokens
        first, last = tokens[0], tokens[len(tokens) - 1]
        if last.kind is Kind.OPEN_COMMENT:
            self._report(len(tokens) - 1, "this comment is not closed", "end it with `*/`")
            self._blank(last.start, last.end)
        if not {"robot", "library"} & {first.text, _intended_word(first)} and DEFINITIONS.starter(first) is None:
            if first is not last or last.kind is not Kind.OPEN_COMMENT:
                self._report(0, f"found {quote_token(first)}, expected `robot` or `library`")
            return File(self._text, None, findings=self._findings)
        outline = Outline(tokens)
        root = outline.file()
        self._mend(outline.braces)
        self._remainder(root)
        for item in root.items:
            self._check(item)
        builder = Builder(self._text)
        base = self._base(root, builder)
        findings = sorted([*self._findings, *builder.findings], key=lambda finding: finding.span)
        findings = _without_consequences(_by_cause(findings))
        return File(
            self._text, base, builder.references, builder.declared, builder.bounded, self._regions, findings=findings
        )

    # Braces

    def _mend(self, braces: Iterable[Brace]) -> None:
        tokens = self._tokens
        at_end = tokens[len(tokens) - 1].kind is Kind.OPEN_COMMENT
        why: str | None
        for brace in braces:
            self._regions.mended = True
            token = tokens[brace.index]
            if brace.surplus:
                why = "the next lines belong inside" if brace.text == "}" else "there is one before it"
                # An earlier `}` may be the wrong one.
                repair = Repair(_LEAVE_OUT, "", is_offered=brace.text == "}")
                self._report(brace.index, f"unexpected `{brace.text}`: {why}", repair)
                self._blank(token.start, token.end)
                continue
            # If several braces are missing at the end, only the innermost is reported.
            if token.kind is not Kind.END or not at_end:
                opened = None if brace.opened is None else tokens[brace.opened]
                line = self._text.span(opened.start, opened.end).line if opened else None
                why = f"the `{{` in line {line} is not closed" if line else None
                self._report(brace.index, f"found {quote_token(token)}, expected `{brace.text}`", why)
            at_end = at_end or token.kind is Kind.END
            if brace.offset is not None:
                self._content[brace.offset] = brace.text

    def _remainder(self, root: Block) -> None:
        """Report and skip text behind the closing brace of the robot."""
        tokens = self._tokens
        if root.after < len(tokens) and tokens[root.after].kind is not Kind.OPEN_COMMENT:
            token = tokens[root.after]
            hint = "a file has one robot or one library" if token.is_keyword("robot", "library") else None
            self._report(root.after, f"found {quote_token(token)}, expected the end of the file", hint)
            self._skip(root.after, len(tokens))

    # Items

    def _check(self, block: Block) -> None:
        """Parse an item and the items in it."""
        for item in block.items:
            self._check(item)
        complex_ = None if block.items else too_complex(self._tokens, block.first, block.after)
        if complex_ is not None:
            self._report(*complex_, "use variables or functions for its parts")
            self._skip_block(block)
        elif self._is_library and block.level is DEFINITIONS and self._starts(block, "requirement", "provide", "limit"):
            message = f"a library has no {self._tokens[block.first].text} statements"
            self._report(block.first, message, "write it in the robot that imports the library")
            self._skip_block(block)
        else:
            failure = self._failure(block)
            if failure is not None:
                self._failed(block, failure)

    def _failure(self, block: Block) -> Failure | None:
        result = parse(self._own_text(block), block.level.rule if block.level else "Base")
        return result if isinstance(result, Failure) else None

    def _at(self, block: Block, failure: Failure) -> int:
        return self._tokens.index_at(block.start + failure.position)

    def _failed(self, block: Block, failure: Failure) -> None:
        index = self._at(block, failure)
        goes_on = "end" in failure.expected and self._tokens[index].start == block.start + failure.position
        if not goes_on or block.items or not block.first < index < block.after:
            self._explain(block, index, failure)
            self._skip_block(block)
            return
        # The item itself is complete. The text behind it may be a faulty item or an unknown part of this one.
        self._regions.uncertain.append((block.start, block.end))
        if self._tokens[index].kind is Kind.SYMBOL:
            self._explain(block, index, failure)
            self._skip(index, block.after)
            return
        outline = Outline(self._tokens, index, block.after)
        following, *others = outline.items(block.levels)
        self._mend(outline.braces)
        self._skip(outline.after, block.after)
        fault = self._failure(following)
        if fault is not None and not index < self._at(following, fault) < following.after:
            self._explain(block, index, failure)
            for item in following.items:
                self._check(item)
            self._skip_block(following)
        else:
            self._check(following)
        for item in others:
            self._check(item)

    def _explain(self, block: Block, index: int, failure: Failure) -> None:
        tokens, token = self._tokens, self._tokens[index]
        if token.kind is Kind.OPEN_STRING:
            self._report(index, "this string is not closed", f"end it with `{token.text[0]}` in the same line")
            return
        named = misread(tokens, index, failure.expected)
        if named < index:
            index, failure = named, replace(failure, expected=("UnreservedName",))
            token = tokens[index]
        expectation = f"expected {enumerate_expected(failure.expected, block.level)}"
        message = f"found {quote_token(token)}, {expectation}"
        repair = hint(tokens, index, failure.expected, block)
        if index >= block.after and token.is_first:
            # The missing words belong at the end of the item, not at the next one.
            end = tokens[index - 1].end
            message = (
                f"found {quote_token(token)} in line {self._text.span(token.start, token.end).line}, {expectation}"
            )
            hint_text = repair._replace(text=None, choices=()) if isinstance(repair, Repair) else repair
            self._findings.append(self._text.error("syntax", end, end, message, hint_text))
        else:
            self._report(index, message, repair)

    def _starts(self, block: Block, *words: str) -> bool:
        return self._tokens[block.first].is_keyword(*words)

    def _own_text(self, block: Block) -> str:
        """Return the text of an item, with blanks in place of the items between its braces."""
        content = self._content[block.start : block.end]
        for item in block.items:
            content[item.start - block.start : item.end - block.start] = " " * (item.end - item.start)
        return "".join(content)

    # The model

    def _base(self, root: Block, builder: Builder) -> rsc.Base | None:
        """Return the model of the remaining text.

        If the first line is unreadable, return the model of the definitions alone.
        """
        failure = self._failure(root)
        if failure is None:
            return self._built("".join(self._content[: root.end]), 0, builder)
        self._explain(root, self._at(root, failure), failure)
        if not root.items:
            return None
        header = f"{'library' if self._is_library else 'robot'} unnamed {{"
        start, end = root.items[0].start, root.items[-1].end
        base = self._built(f"{header}{''.join(self._content[start:end])}}}", start - len(header), builder)
        if base is not None:
            del builder.declared[base]  # The text does not contain its name.
            base.source = self._text.source(root.start, min(root.end, len(self._text.content)))
        return base

    def _built(self, content: str, offset: int, builder: Builder) -> rsc.Base | None:
        tree = parse(content, "Base")
        if isinstance(tree, Failure):
            # Each item parses by itself. Should they fail to parse together, the failure is reported at its position.
            index = self._tokens.index_at(tree.position + offset)
            self._report(
                index, f"found {quote_token(self._tokens[index])}, expected {enumerate_expected(tree.expected, None)}"
            )
            return None
        base: rsc.Base = builder.build(tree, offset)
        return base

    # Skipping

    def _skip_block(self, block: Block) -> None:
        """Blank an item out, and record the names that it seems to declare."""
        at = block.first
        for item in (*block.items, None):
            self._skip(at, item.first if item else block.after, declares=not self._starts(block, *_DECLARING_NOTHING))
            if item:
                self._skip_block(item)
                at = item.after
        self._blank(block.start, block.end)
        self._regions.skipped.append((block.start, block.end))
        self._note_nameless(block)

    def _skip(self, first: int, after: int, *, declares: bool = True) -> None:
        tokens = self._tokens
        for index in range(first, after):
            token = tokens[index]
            named = token.is_name and not tokens[index - 1].is_keyword("goto") and not token.text.startswith("^")
            if token.kind is Kind.WORD and (declares or named):
                self._regions.names.add(token.text.removeprefix("^"))
        if first < after:
            self._blank(tokens[first].start, tokens[after - 1].end)

    def _note_nameless(self, block: Block) -> None:
        """Record the declarations of a skipped item whose names are not visible in it."""
        tokens, first = self._tokens, self._tokens[block.first]
        words = [tokens[index] for index in range(block.first, block.items[0].first if block.items else block.after)]
        starter = block.level.starter(first) if block.level else None
        # A keyword in place of a name is the keyword after a missing name.
        named = any(word.is_name and not is_reserved(word.text) for word in words)
        if block.level is PROPERTIES:
            unseen = {NameKind.PROPERTY} if first.kind is not Kind.WORD else set()
        elif block.level is RULES:
            unseen = {NameKind.ENUM_VALUE} if not named or first.is_keyword("->") else set()
        else:
            unseen = {DECLARED[starter]} if starter in DECLARED and not named else set()
        if (starter == "component" and not block.items) or any(word.is_keyword("import") for word in words):
            # An import may declare any of these.
            unseen |= {NameKind.COMMUNICATION, NameKind.MEMBER, NameKind.INTERFACE, NameKind.DATA_TYPE}
            unseen |= {NameKind.ENUM_VALUE, NameKind.PROPERTY}
        place = self._text.span(block.start, block.end)
        self._regions.nameless += ((kind, place) for kind in unseen)

    def _blank(self, start: int, end: int) -> None:
        self._content[start:end] = [character if character == "\n" else " " for character in self._content[start:end]]

    # Findings

    def _report(self, index: int, message: str, repair: Repair | str | None = None) -> None:
        token = self._tokens[index]
        self._findings.append(self._text.error("syntax", token.start, token.end, message, repair))


def _by_cause(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Merge the findings of each keyword used as a name into the first one, with the edits of all."""
    merged: list[Diagnostic] = []
    firsts: dict[str, int] = {}
    for finding in findings:
        word = finding.edits[0].text if finding.edits else ""
        if word.startswith("^") and firsts.setdefault(word, len(merged)) < len(merged):
            first = merged[firsts[word]]
            other = Related(finding.file, finding.span, f"`{word}` is also missing here")
            merged[firsts[word]] = replace(first, edits=first.edits + finding.edits, related=(*first.related, other))
        else:
            merged.append(finding)
    return merged


def _without_consequences(findings: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Drop edits that delete a surplus brace behind another error, as this error may be its cause."""
    first = findings[0].span.line if findings else 0
    hint = f"correct the error in line {first} first"
    return [
        replace(finding, hint=hint, edits=()) if index and finding.hint == _LEAVE_OUT else finding
        for index, finding in enumerate(findings)
    ]


def _intended_word(token: Token) -> str | None:
    """Return the first word of a file that a token was meant to be."""
    return next(iter(get_close_matches(token.text, ["library", "robot"], n=1, cutoff=0.7)), None)
