"""The words of CIF that are no names unless a `$` stands before them."""

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
