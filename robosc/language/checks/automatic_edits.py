"""Apply edits only if they leave a model at least as good as it was."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from enum import Enum, auto
from typing import TYPE_CHECKING, Any, Protocol

from robosc.base.diagnostics import Severity
from robosc.language.tokens import Kind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic, Edit
    from robosc.language.reading import Reading
    from robosc.language.scopes import Reference
    from robosc.language.text import Text

#: Maximum number of syntax errors of one item to mend if each of them hides the next.
_MOST_HIDDEN = 8
_STRINGS = (Kind.STRING, Kind.OPEN_STRING)


class CheckedModel(Protocol):
    """A checked model; `findings` are those of reading and of the rules, including imported files."""

    @property
    def reading(self) -> Reading:
        """Model and its files."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        """All findings."""


class _Offsets:
    """Offsets of a text before and after edits that do not overlap."""

    def __init__(self, text: Text, edits: Iterable[Edit]) -> None:
        spans = [(edit.span, edit.text) for edit in sorted(edits)]
        starts = [text.offset(span.line, span.column) for span, _ in spans]
        self._ends = [text.offset(span.end_line, span.end_column) for span, _ in spans]
        self._ranges = list(zip(starts, self._ends, strict=True))
        self._shifts = [0]
        for (start, end), (_, new) in zip(self._ranges, spans, strict=True):
            self._shifts.append(self._shifts[-1] + len(new) - (end - start))
        self.written = [
            (start + shift, start + shift + len(new))
            for start, shift, (_, new) in zip(starts, self._shifts, spans, strict=False)
        ]

    def after(self, offset: int) -> int:
        """Return the offset after the edits; a replaced offset moves to the start of the new text."""
        index = bisect_right(self._ends, offset)
        start = self._ranges[index][0] if index < len(self._ranges) else offset
        return min(offset, start) + self._shifts[index]

    def range(self, start: int, end: int) -> tuple[int, int]:
        """Return the place of an unedited range after the edits."""
        return self.after(start), self.after(start) + end - start

    def edits_in(self, start: int, end: int) -> list[tuple[int, int]]:
        """Return the ranges between two offsets that are replaced or receive text."""
        return [(first, last) for first, last in self._ranges if first < end and start < last]

    def is_written(self, start: int, end: int) -> bool:
        """Return whether a range of the text after the edits contains new text."""
        return any(first < end and start < last for first, last in self.written)


def objection(
    before: CheckedModel, after: CheckedModel, edits: Mapping[str, Sequence[Edit]], mended: Sequence[Diagnostic] = ()
) -> str | None:
    """Return why the edits make a model worse, in words; None if they do not.

    `edits` maps the path of each file, as findings have it, to its edits. `mended` are the findings that the edits
    should mend. A model is worse if less of it can be read, if a finding is new, if one of `mended` stays, if a name
    refers to another element, or if a comment or a string has changed. A syntax error hides findings of the rules, so
    its repair may reveal them, but no errors on the lines that it changes. Each mended syntax error must reduce the
    number of syntax errors by one.
    """
    return _Comparison(before, after, edits).objection(mended)


class Safety(Enum):
    """Effect of the edits that mend one finding."""

    SAFE = auto()
    DOUBTFUL = auto()
    HARMFUL = auto()


def safety_of(
    finding: Diagnostic, edits: Sequence[Edit], before: CheckedModel, check: Callable[[str], CheckedModel]
) -> Safety:
    """Return the effect of edits of a file that should mend a finding in it.

    The edits are safe if `safe_edits` may use them; `check` is the argument of `safe_edits`. They are harmful if the
    finding stays, if a comment, a string or an import changes, or if a syntax error is new, except one that the mended
    error may have hidden. All others are doubtful, for example if a rule reports something else afterwards.
    """
    text = before.reading.file.text
    after = check(text.after(edits))
    comparison = _Comparison(before, after, {text.file: edits})
    if comparison.objection([finding]) is None:
        return Safety.SAFE
    if tuple(edits) == tuple(finding.edits) and _leads_on(finding, before, check):
        return Safety.SAFE
    return Safety.HARMFUL if comparison.is_harmful(finding) else Safety.DOUBTFUL


def safe_edits(before: CheckedModel, check: Callable[[str], CheckedModel]) -> list[Edit]:
    """Return the edits that leave a file no worse, for findings with exactly one way to mend them.

    `check` reads and checks the model with another text of the file. Syntax errors come first: other edits are returned
    only if no edit mends a syntax error. A syntax error that hides others of its item is mended only if those can be
    mended, too.
    """
    text = before.reading.file.text
    own = [finding for finding in before.findings if finding.file == text.file and finding.edits]
    syntax = [finding for finding in own if finding.rule == "syntax"]
    others = [finding for finding in own if finding.rule != "syntax"]
    return _edits(_safe(syntax, before, check) or _safe(others, before, check))


def _safe(
    findings: Sequence[Diagnostic], before: CheckedModel, check: Callable[[str], CheckedModel]
) -> Sequence[Diagnostic]:
    """Return a large set of these findings that can be mended together."""
    text = before.reading.file.text
    chosen = _apart(findings)
    if not chosen:
        return ()
    edits = _edits(chosen)
    if objection(before, check(text.after(edits)), {text.file: edits}, chosen) is None:
        return chosen
    if len(findings) == 1:
        return chosen if _leads_on(chosen[0], before, check) else ()
    half = len(findings) // 2
    first, last = _safe(findings[:half], before, check), _safe(findings[half:], before, check)
    both = _apart([*first, *last])
    if not first or not last or both == first:
        return first or last
    edits = _edits(both)
    return both if objection(before, check(text.after(edits)), {text.file: edits}, both) is None else first


def _leads_on(finding: Diagnostic, before: CheckedModel, check: Callable[[str], CheckedModel]) -> bool:
    """Return whether mending a syntax error reveals others that can be mended, too, with fewer left in the end.

    Each of several edits is a guess at the intention, so that the lines that they change must have no error in the end.
    """
    if finding.rule != "syntax":
        return False
    changed: set[int] = set()
    for _ in range(_MOST_HIDDEN):
        text = before.reading.file.text
        edits = _edits([finding])
        changed |= {edit.span.line for edit in edits}
        after = check(text.after(edits))
        comparison = _Comparison(before, after, {text.file: edits})
        if comparison.objection([finding]) is None:
            errors = (other for other in after.findings if other.severity is Severity.ERROR)
            return not any(error.file == text.file and error.span.line in changed for error in errors)
        revealed = comparison.revealed(finding)
        if revealed is None or comparison.objection([finding], revealed=1) is not None:
            return False
        finding, before = revealed, after
    return False


def _apart(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings whose edits touch no edit of an earlier finding; an equal edit is allowed."""
    separate: list[Diagnostic] = []
    done: set[Edit] = set()
    for finding in findings:
        new = set(finding.edits) - done
        if not any(_touch(edit, other) for edit in new for other in done):
            separate.append(finding)
            done |= new
    return separate


def _touch(edit: Edit, other: Edit) -> bool:
    first, second = sorted((edit.span, other.span))
    return (second.line, second.column) <= (first.end_line, first.end_column)


def _edits(findings: Iterable[Diagnostic]) -> list[Edit]:
    return sorted({edit for finding in findings for edit in finding.edits})


class _Comparison:
    """Comparison of a model before and after edits."""

    def __init__(self, before: CheckedModel, after: CheckedModel, edits: Mapping[str, Sequence[Edit]]) -> None:
        self._before, self._after = before, after
        self._files = before.reading.files
        self._files_after = after.reading.files
        self._moved = {path: _Offsets(file.text, edits.get(path, ())) for path, file in self._files.items()}

    def objection(self, mended: Sequence[Diagnostic], *, revealed: int = 0) -> str | None:
        """Return why the model is worse; `revealed` formerly hidden syntax errors are accepted."""
        damage = self._damage(mended)
        if damage is not None:
            return damage
        is_syntax = any(finding.rule == "syntax" for finding in mended)
        if is_syntax:
            worse = self._syntax_error(mended, revealed) or (None if revealed else self._revealed_error(mended))
        else:
            worse = next(self._new_findings(mended), None)
        if worse is not None:
            return f"line {worse.span.line}: {worse.message}"
        name = None if is_syntax else next(self._changed_names(), None)
        return None if name is None else f"`{name.name}` would refer to something else"

    def is_harmful(self, mended: Diagnostic) -> bool:
        """Return whether the edits for a finding break the text or leave the finding."""
        if self._damage([mended], removing=True) is not None:
            return True
        if mended.rule == "syntax":
            return self._syntax_error([mended], revealed=1) is not None
        if len(_syntax_errors(self._after)) > len(_syntax_errors(self._before)):
            return True
        text = self._files_after[mended.file].text
        before, after = (
            [other for other in checked.findings if (other.file, other.rule) == (mended.file, mended.rule)]
            for checked in (self._before, self._after)
        )
        same = (mended.message, self._start(mended))
        stays = any(same == (other.message, _start(other, text)) for other in after)
        return stays and len(after) >= len(before)

    def _damage(self, mended: Sequence[Diagnostic], *, removing: bool = False) -> str | None:
        """Return which import, comment or string changes; `removing`: edits may remove whole strings."""
        for path in self._files:
            if path not in self._files_after:
                return f"{path} would no longer be imported"
            if not self._keeps_comments(path):
                return "a comment would change"
            if not self._keeps_strings(path, mended, removing):
                return "a string would change"
        return None

    def _keeps_comments(self, path: str) -> bool:
        moved, comments = self._moved[path], self._files[path].text.tokens.comments
        if any(moved.edits_in(*comment) for comment in comments):
            return False
        return [moved.range(*comment) for comment in comments] == self._files_after[path].text.tokens.comments

    def _keeps_strings(self, path: str, mended: Sequence[Diagnostic], removing: bool) -> bool:
        """Return whether all strings stay, except wholly replaced strings and strings with an error inside.

        `removing`: strings may also disappear with the element that contains them.
        """
        moved, text = self._moved[path], self._files[path].text
        faulty = [_start(finding, text) for finding in mended if finding.file == path]
        stays = set()
        for start, end in _strings(text):
            edited = moved.edits_in(start, end)
            if not edited:
                stays.add(moved.range(start, end))
            elif removing and len(edited) == 1 and edited[0][0] <= start and end <= edited[0][1]:
                continue
            elif edited != [(start, end)] and not any(start < place < end for place in faulty):
                return False
        strings = set(_strings(self._files_after[path].text))
        return stays <= strings and all(moved.is_written(*string) for string in strings - stays)

    def revealed(self, mended: Diagnostic) -> Diagnostic | None:
        """Return the first new syntax error after the mended one; None if it has no edit."""
        before, after = _syntax_errors(self._before), _syntax_errors(self._after)
        known = {(self._start(earlier), earlier.message) for earlier in before if earlier.file == mended.file}
        text = self._files_after[mended.file].text
        for other in after:
            place = _start(other, text) if other.file == mended.file else -1
            if place >= self._start(mended) and (place, other.message) not in known:
                return other if other.edits else None
        return None

    def _syntax_error(self, mended: Sequence[Diagnostic], revealed: int) -> Diagnostic | None:
        """Return a mended syntax error that stays, or the first of too many.

        The number of syntax errors must fall by one for each mended one; `revealed` more are accepted.
        """
        before, after = _syntax_errors(self._before), _syntax_errors(self._after)
        if len(after) > len(before) - len(mended) + revealed:
            return after[0]
        places = {(other.file, _start(other, self._files_after[other.file].text), other.message) for other in after}
        return next((other for other in mended if (other.file, self._start(other), other.message) in places), None)

    def _revealed_error(self, mended: Sequence[Diagnostic]) -> Diagnostic | None:
        """Return a new error of a rule on an edited line: it suggests that the edit was not meant."""
        lines = {
            (path, self._files_after[path].text.span(start, start).line)
            for path, moved in self._moved.items()
            for start, _ in moved.written
        }
        new = (finding for finding in self._new_findings(mended) if finding.rule != "syntax")
        errors = (finding for finding in new if finding.severity is Severity.ERROR)
        return next((finding for finding in errors if (finding.file, finding.span.line) in lines), None)

    def _new_findings(self, mended: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
        """Yield the findings of a rule on a line with more findings of this rule than before."""
        left = Counter(map(self._line, self._before.findings))
        left.subtract(map(self._line, mended))
        for finding in self._after.findings:
            key = finding.file, finding.rule, finding.span.line
            left[key] -= 1
            if left[key] < 0:
                yield finding

    def _start(self, finding: Diagnostic) -> int:
        """Return where a finding from before starts after the edits."""
        return self._moved[finding.file].after(_start(finding, self._files[finding.file].text))

    def _line(self, finding: Diagnostic) -> tuple[str, str, int]:
        """Return the file, the rule and the new line of a finding from before."""
        if finding.file not in self._files:
            return finding.file, finding.rule, finding.span.line
        start = self._start(finding)
        return finding.file, finding.rule, self._files_after[finding.file].text.span(start, start).line

    def _changed_names(self) -> Iterator[Reference]:
        """Yield the names that refer to another element than before.

        Names that an edit replaces or removes are exempt, unless their element is renamed.
        """
        declared, declared_after = _declarations(self._before.reading), _declarations(self._after.reading)
        for path, file in self._files.items():
            names = {name.start: name for name in self._files_after[path].names}
            for name in file.names:
                place = declared.get(name.target)
                is_kept = place is not None and not self._moved[place[0]].edits_in(*place[1:])
                is_renamed = place is not None and self._moved[place[0]].edits_in(*place[1:]) == [place[1:]]
                if name.target is None or not (is_renamed or not self._moved[path].edits_in(name.start, name.end)):
                    continue
                after = names.get(self._moved[path].after(name.start))
                if after is None or after.target is None:
                    yield name
                elif place is not None and (is_kept or is_renamed):
                    origin = declared_after.get(after.target)
                    if origin is None or origin[:2] != (place[0], self._moved[place[0]].after(place[1])):
                        yield name


def _syntax_errors(checked: CheckedModel) -> list[Diagnostic]:
    return [finding for finding in checked.findings if finding.rule == "syntax"]


def _strings(text: Text) -> Iterator[tuple[int, int]]:
    return ((token.start, token.end) for token in text.tokens if token.kind in _STRINGS)


def _start(finding: Diagnostic, text: Text) -> int:
    return text.offset(finding.span.line, finding.span.column)


def _declarations(reading: Reading) -> dict[Any, tuple[str, int, int]]:
    """Return the file and the offsets of the name of each declared element."""
    return {
        name.target: (path, name.start, name.end)
        for path, file in reading.files.items()
        for name in file.names
        if name.is_declaration
    }
