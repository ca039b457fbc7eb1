"""What the elements of an sct model are called in CIF: one to one, no keyword, nothing hidden by a nearer name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.semantics.naming import Names

if TYPE_CHECKING:
    from robosc.metamodel import expression as ex
    from robosc.metamodel import sct

#: The words of CIF that are no names unless a `$` stands before them.
_WORDS = """
alg alphabet any attr automaton bool break case const cont continue controllable def der dict disables disc dist do
edge elif else end enum equation event false file final for func goto group id if import initial input int invariant
list location marked monitor namespace needs now plant post pre print printfile real requirement return self set
string supervisor svgcopy svgfile svgin svgmove svgout switch tau text time to true tuple type uncontrollable urgent
value void when while

abs acos acosh asin asinh atan atanh cbrt ceil cos cosh del empty exp floor fmt ln log max min pop pow round scale
sign sin sinh size sqrt tan tanh

bernoulli beta binomial constant erlang exponential gamma geometric lognormal normal poisson random triangle uniform
weibull

and div in mod not or sample sub
"""
KEYWORDS = frozenset(_WORDS.split())


def escaped(name: str) -> str:
    """A name of one identifier with a dollar sign before it where it is a keyword."""
    return f"${name}" if name in KEYWORDS else name


class CifNames:
    """The names in one specification, of a lowered model; a location without a name has none.

    A plant's members share one scope and so do plants, enumerations, literals and the supervisor. A member called like
    something of the outer scope would hide it from the plant's edges, so it gets another name.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._names: dict[Any, str] = {}
        outer = Names()
        for element in self._outer(model):
            self._names[element] = outer.fresh(element.name)
        #: What invariants with a name are called.
        self.invariants = {
            invariant: outer.fresh(invariant.name.replace(".", "_")) for invariant in model.invariants if invariant.name
        }
        #: The automaton that holds what synthesis added.
        self.supervisor = outer.fresh("sup")
        taken = {*self._names.values(), *self.invariants.values(), self.supervisor}
        for plant in model.plants:
            inner = Names(taken)
            for member in (*plant.events, *plant.inputs, *plant.variables, *plant.locations):
                if member.name:
                    self._names[member] = inner.fresh(member.name)

    @staticmethod
    def _outer(model: sct.SupervisoryControlModel) -> list[ex.NamedElement]:
        literals = [literal for enumeration in model.enumerations for literal in enumeration.literals]
        return [*model.plants, *model.enumerations, *literals]

    def declared(self, element: ex.NamedElement) -> str:
        """The name where the element is declared, and within the same plant."""
        return escaped(self._names[element])

    def used(self, element: ex.NamedElement, plant: sct.Plant | None) -> str:
        """The name as it is read from inside a plant, or from outside of all."""
        owner = element.eContainer()
        if owner is plant or owner not in self._names or not hasattr(owner, "locations"):
            return self.declared(element)
        return f"{self.declared(owner)}.{self.declared(element)}"


class AbsoluteNames:
    """Names as they are read outside of all automata."""

    def used(self, element: ex.NamedElement, _plant: sct.Plant | None) -> str:
        """A name with all around it."""
        around = element.eContainer().origin
        return f"{around}.{element.name}" if around else escaped(element.name)
