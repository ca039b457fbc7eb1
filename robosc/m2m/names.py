"""Names that cannot clash: a name already taken gets underscores, in the order of the text."""

from collections.abc import Iterable


class Names:
    """The names of one scope."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)

    def fresh(self, name: str) -> str:
        """The name itself where it is free, else the name with as few underscores behind it as make it so."""
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name
