"""CIF names for the elements of an sct model: unique, no keywords, not hidden by an inner scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.model.semantics.naming import Names

if TYPE_CHECKING:
    from robosc.model import expression as ex
    from robosc.model import sct

#: Words of CIF that are names only with a `$` before them.
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


def escape_keyword(name: str) -> str:
    """Return a name of one identifier, with a dollar sign before it if it is a keyword."""
    return f"${name}" if name in KEYWORDS else name


class CifNames:
    """Names in one specification of a lowered model. A location without a name has none.

    The members of a plant share one scope. Plants, enumerations, literals and the supervisor share the outer scope. A
    member with a name of the outer scope would hide it from the plant's edges, so it gets another name.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._names: dict[Any, str] = {}
        outer = Names()
        for element in self._outer(model):
            self._names[element] = outer.fresh(element.name)
        #: Names of the invariants that have one.
        self.invariants = {
            invariant: outer.fresh(invariant.name.replace(".", "_")) for invariant in model.invariants if invariant.name
        }
        #: Name of the automaton with the additions of synthesis.
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

    def declared_name(self, element: ex.NamedElement) -> str:
        """Return the name at the element's declaration and within its plant."""
        return escape_keyword(self._names[element])

    def used_name(self, element: ex.NamedElement, plant: sct.Plant | None) -> str:
        """Return the name as it is used inside a plant, or outside of all plants."""
        owner = element.eContainer()
        if owner is plant or owner not in self._names or not hasattr(owner, "locations"):
            return self.declared_name(element)
        return f"{self.declared_name(owner)}.{self.declared_name(element)}"


class AbsoluteNames:
    """Names as they are used outside of all automata."""

    def used_name(self, element: ex.NamedElement, _plant: sct.Plant | None) -> str:
        """Return a name with all its scopes."""
        around = element.eContainer().origin
        return f"{around}.{element.name}" if around else escape_keyword(element.name)
