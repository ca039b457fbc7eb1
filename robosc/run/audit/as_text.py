"""Result of an audit as text."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from robosc.run.audit.findings import MILLISECOND, SECOND, Kind
from robosc.run.runtime.core.blocking import LoggedReason

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.run.audit.findings import Audit, Finding

#: Start of the sentence for the reasons that the supervisor does not give.
_FORBIDDEN = {"data": "cannot be judged", "limit": "is beyond its limit", "cancel": "goes on, and should be canceled"}
_UNEXPECTED = {
    "state": "is not expected",
    "data": "cannot be read",
    "range": "is out of range",
    "unknown": "is unknown",
}
#: Number of findings that the text shows.
MOST = 100


def describe(finding: Finding) -> str:
    """Return what is wrong with an event, in words."""
    causes = "; ".join(finding.because)
    if finding.kind is Kind.ASSUMPTION:
        return f"violates `{'` and `'.join(finding.because)}`"
    if finding.kind is Kind.UNEXPECTED:
        return f"{_UNEXPECTED[finding.reason]}: {causes}"
    if finding.reason in _FORBIDDEN:
        return f"{_FORBIDDEN[finding.reason]}: {causes}"
    return f"is {LoggedReason(finding.reason, finding.because)}"


def lines(audit: Audit, most: int = MOST) -> Iterator[str]:
    """Yield the lines of the result; at most `most` findings."""
    if audit.start is None or audit.end is None:
        yield f"{audit.robot}: the recording has no messages of the model"
    else:
        took = (audit.end - audit.start) / SECOND
        yield (
            f"{audit.robot}: {_count(audit.commands, 'command')} and {_count(audit.events, 'event')} of the robot"
            f" in {took:,.3f} s from {_date(audit.start)}"
        )
    for finding in audit.findings[:most]:
        yield from _finding(audit, finding)
    if len(audit.findings) > most:
        yield f"{len(audit.findings) - most} more findings: --json has them all"
    for kind, one in (
        (Kind.FORBIDDEN, "forbidden command"),
        (Kind.ASSUMPTION, "violation of an assumption"),
        (Kind.UNEXPECTED, "unexpected event"),
    ):
        number = sum(len(finding.times) for finding in audit.findings if finding.kind is kind)
        many = "violations of assumptions" if kind is Kind.ASSUMPTION else f"{one}s"
        yield f"{number:,} {one if number == 1 else many}"
    if audit.tolerated:
        yield f"{_count(audit.tolerated, 'command')} permitted only shortly before or after"
    if audit.safe:
        yield f"{_count(audit.safe, 'safe message')} of the configuration"
    if audit.ignored:
        yield "Ignored in these states, which is no finding:"
        yield from (f"  {event} in {state}: {_count(count, 'time')}" for (event, state), count in audit.ignored.items())
    if audit.unseen:
        yield "Not in the recording, so the model does not follow it:"
        yield from (f"  {name}: {why}" for name, why in audit.unseen.items())
    yield from (f"Note: {note}" for note in audit.notes)


def _finding(audit: Audit, finding: Finding) -> Iterator[str]:
    first, last = finding.times[0], finding.times[-1]
    repeated = f"; {len(finding.times):,} times until {audit.seconds(last):.3f} s" if first != last else ""
    where = f" ({finding.topic})" if finding.topic else ""
    yield f"{audit.seconds(first):10.3f} s  {finding.name}{where} {describe(finding)}{repeated}"
    states = ", ".join(_state(name, part) for name, part in finding.components.items())
    since = ""
    if finding.since is not None:
        since = f"; permitted until {finding.since / MILLISECOND:.3f} ms before"
    if states or since:
        yield f"{'':14}in {states or 'the only state'}{since}"
    if finding.unheard:
        yield f"{'':14}nothing was heard yet of {', '.join(finding.unheard)}: its state is the one at the start"


def _state(name: str, part: object) -> str:
    assert isinstance(part, dict)
    variables: Mapping[str, object] = part["variables"]
    values = ", ".join(f"{variable} = {json.dumps(value, ensure_ascii=False)}" for variable, value in variables.items())
    return f"{name}.{part['state']}{f' ({values})' if values else ''}"


def _count(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def _date(time: int) -> str:
    """Return a time in nanoseconds as a date, or in seconds if it is none."""
    try:
        moment = datetime.fromtimestamp(time / SECOND, UTC)
    except (ValueError, OverflowError, OSError):
        return f"{time / SECOND:,.3f} s"
    return f"{moment.isoformat(sep=' ', timespec='milliseconds').removesuffix('+00:00')} UTC"
