"""Random robots of the language's second edition with assumptions."""

from __future__ import annotations

from tests.random_robots import BOOLEAN
from tests.random_second_edition import SecondWriter


class AssumingWriter(SecondWriter):
    """Writer of assumptions about messages, responses and feedback."""

    def robot(self, name: str) -> str:
        head, *lines, end = super().robot(name).split("\n")
        known = self.readable(finite=True)
        events = [
            (owner, communication, event)
            for owner in self.components
            for communication in owner.communications
            for event in ("response", "feedback")
            if event in communication.data and owner.name.startswith("C")
        ]
        for number in self.many(3, 1) if events else ():
            chosen = self.random.sample(events, min(len(events), self.random.randint(1, 2)))
            targets = [f"{event} from {self.reference(owner, message)}" for owner, message, event in chosen]
            target = targets[0] if len(targets) == 1 else f"{{ {', '.join(targets)} }}"
            named = self.one([f"U{number}: ", f'U{number} "as it is": ', '"as it is": ', ""])
            lines.append(f"assume {named}{target} needs {self.expression(BOOLEAN, known, 2)}")
        return "\n".join([head, *lines, end])


def assuming_robot(seed: int) -> str:
    """Return the text of a robot with assumptions; the same seed gives the same text."""
    return AssumingWriter(seed).robot(f"U{seed}")
