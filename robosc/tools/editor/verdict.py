"""Synthesis for an editor in a process of its own, so that typing never waits and the editor can stop it.

    python -m robosc.tools.editor.verdict < request.json > answer.json

The request holds the texts and folders (`answers.Request`), the answer the texts to show by line (`answers.Verdict`).
"""

from __future__ import annotations

import json
import os
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import robosc
from robosc.analysis.supervise import supervise
from robosc.analysis.system import format_count, format_number
from robosc.base.diagnostics import ModelError, has_errors, original_place
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.printing import RobotPrinter, conjunction
from robosc.model.semantics.roles import plant_of
from robosc.model.semantics.walks import copy_tree
from robosc.tools.editor.answers import Request, Verdict

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.analysis.supervise import Supervision
    from robosc.base.diagnostics import Diagnostic

#: Memory limit of decision diagrams in bytes, for use beside an editor.
_MEMORY = 1 << 30


def verdict(request: Request) -> Verdict:
    """Synthesize the supervisor of a robot that has no errors; return the verdict."""
    texts: dict[str | os.PathLike[str], str] = {Path(path): text for path, text in request.texts.items()}
    model = robosc.to_sct(robosc.load(request.path, request.libraries, request.interfaces, documents=texts))
    try:
        supervision = supervise(model, memory=_MEMORY, weigh=True)
    except ModelError as error:
        return Verdict(f"no supervisor: {error.diagnostics[0].message}", {}, {})
    except MemoryError:
        return Verdict("synthesis needs more than 1 GB: use `robosc synthesize`", {}, {})
    return _verdict(request.path, model, supervision)


def _verdict(path: str, model: sct.SupervisoryControlModel, supervision: Supervision) -> Verdict:
    synthesis = supervision.synthesis
    states = f"{format_count(synthesis.controlled_states, 'state')} under its supervisor"
    without = synthesis.uncontrolled_states
    size = states + (f", {format_number(without)} without requirements" if without is not None else "")
    faults = [finding.message for finding in supervision.findings if has_errors([finding])]
    requirements = {}
    for weight in synthesis.weights:
        file, span = place(weight.requirements[0])
        if file == path:
            forbids = (
                "forbids"
                if isinstance(weight.requirements[0], sct.StateInvariant | sct.ReachabilityRequirement)
                else "restricts the robot in"
            )
            effect = f"{forbids} {format_count(weight.states, 'state')}" if weight.states else "matters in no state"
            requirements[str(span.line)] = effect
    guards: dict[str, list[str]] = {}
    printed = RobotPrinter()
    for guard in synthesis.supervisor.guards if synthesis.supervisor is not None else ():
        whole = conjunction(copy_tree(part) for part in (guard.requirement, guard.synthesis) if part)
        origin = plant_of(guard.event).origin
        if whole is not None and origin and guard.event.kind in (sct.EventKind.trigger, sct.EventKind.cancel):
            name = "request" if guard.event.kind == sct.EventKind.trigger else "cancel"
            guards.setdefault(origin, []).append(f"{name}: {printed(whole)}")
    for finding, title in _absent(supervision.findings):
        line = str(finding.span.line)
        if finding.file == path and line in requirements:
            requirements[line] += f"; {title}"
        else:
            faults.append(title)
    return Verdict("; ".join([size, *faults]), requirements, guards)


def _absent(findings: Sequence[Diagnostic]) -> Iterator[tuple[Diagnostic, str]]:
    """Yield the original finding about each event or state that never occurs, with its consequences as one text."""
    for finding in findings:
        if finding.rule not in ("never-enabled", "unreachable-state") or finding.follows:
            continue
        original = finding.file, finding.span
        following = sum(original_place(other) == original for other in findings if other.follows)
        title = finding.message.partition(": ")[0]
        yield finding, f"{title}; therefore, {format_count(following, 'more finding')}" if following else title


def main() -> None:
    """Read a request and write the answer."""
    if hasattr(os, "nice"):
        os.nice(10)
    answer = verdict(Request(**json.load(sys.stdin)))
    sys.stdout.write(json.dumps(asdict(answer)))


if __name__ == "__main__":
    main()
