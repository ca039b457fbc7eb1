"""C names for the elements of an sct model. ROS nodes in C++ use the same names."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.model import engine, sct
from robosc.model.semantics.naming import Names, snake_case
from robosc.model.semantics.roles import assumptions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from robosc.model import expression as ex

#: Keywords of C99, C11, C23 and C++20, and names that headers and compilers define.
_KEYWORDS = """
alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept auto bitand bitor bool break case catch char
char8_t char16_t char32_t class co_await co_return co_yield compl concept const const_cast consteval constexpr constinit
continue decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if
inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public reflexpr
register reinterpret_cast requires restrict return short signed sizeof static static_assert static_cast struct switch
synchronized template this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned using
virtual void volatile wchar_t while xor xor_eq NULL offsetof int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t
uint64_t size_t ptrdiff_t linux unix i386 _Alignas _Alignof _Atomic _Bool _Complex _Generic _Imaginary _Noreturn
_Static_assert _Thread_local
"""
KEYWORDS = frozenset(_KEYWORDS.split())
#: Macros of the standard headers that could clash with a model's names.
_MACROS = """
EOF assert errno stdin stdout stderr BUFSIZ RAND_MAX EXIT_SUCCESS EXIT_FAILURE SEEK_SET SEEK_CUR SEEK_END INFINITY
NAN HUGE_VAL M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 DBL_DIG
DBL_EPSILON DBL_MAX DBL_MIN FLT_DIG FLT_EPSILON FLT_MAX FLT_MIN CHAR_BIT CHAR_MAX CHAR_MIN SHRT_MAX SHRT_MIN INT_MAX
INT_MIN LONG_MAX LONG_MIN LLONG_MAX LLONG_MIN UCHAR_MAX USHRT_MAX UINT_MAX ULONG_MAX ULLONG_MAX INT8_MAX INT8_MIN
INT16_MAX INT16_MIN INT32_MAX INT32_MIN INT64_MAX INT64_MIN UINT8_MAX UINT16_MAX UINT32_MAX UINT64_MAX SIZE_MAX
PTRDIFF_MAX PTRDIFF_MIN PATH_MAX NAME_MAX BYTE_ORDER BIG_ENDIAN LITTLE_ENDIAN F_OK R_OK W_OK X_OK SIGABRT SIGALRM SIGHUP
SIGINT SIGKILL SIGQUIT SIGSTOP SIGTERM EACCES EAGAIN EBUSY ECANCELED EDOM EEXIST EINTR EINVAL EIO ENODATA ENODEV ENOENT
ENOMEM ENOTSUP EPERM ERANGE ETIME ETIMEDOUT
"""
#: Names that no member of a struct, field or variable for a model's element may have.
TAKEN = KEYWORDS.union(_MACROS.split())
_API = """
nothing event state inputs settings hooks set supervisor default_settings init enabled perform begin end tick event_name
"""
#: More names, if the model has assumptions.
_ASSUMPTIONS = "violates assumption_name assumption_text"
_SETTINGS = "events_per_tick reactions_per_tick react_immediately resolution_ms"


class CNames:
    """C names for the elements of one model. They are unique within a scope and no keywords.

    `prefix` begins every name at file level (`line_follower`), `macro` every macro (`LINE_FOLLOWER`). A state member
    has the name of its plant or `plant_variable`, an enumerator the name `prefix_plant_event`. If two names clash, the
    second gets an underscore.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.prefix = identifier(snake_case(model.name)).strip("_") or "robot"
        if self.prefix[0].isdigit():
            self.prefix = f"robot_{self.prefix}"
        self.macro = self.prefix.upper()
        self._global: dict[ex.NamedElement, str] = {}
        self._lookups: dict[ex.NamedElement, str] = {}
        self._name_globals(model)
        self._members = self._named(model, lambda plant: [plant, *plant.variables])
        self._members |= self._named(model, lambda plant: plant.inputs)
        settings = Names([*KEYWORDS, *_SETTINGS.split()])
        self._settings = {
            duration: settings.fresh(identifier(f"{duration.parameter.replace('.', '_')}_ms"))
            for duration in model.durations
        }

    def _name_globals(self, model: sct.SupervisoryControlModel) -> None:
        api = f"{_API} {_ASSUMPTIONS}" if assumptions(model) else _API
        names = Names(f"{self.prefix}_{name}" for name in api.split())
        owners: list[tuple[str, ex.NamedElement, Sequence[ex.NamedElement]]] = [
            *(("location_name", plant, [*plant.events, *plant.locations]) for plant in model.plants),
            *(("literal_name", enumeration, [*enumeration.literals]) for enumeration in model.enumerations),
        ]
        for _, owner, elements in owners:
            for element in elements:
                self._global[element] = names.fresh(self._prefixed(owner.name, element.name))
        for lookup, owner, _ in owners:
            self._lookups[owner] = names.fresh(self._prefixed(lookup, owner.name))

    def _named(
        self, model: sct.SupervisoryControlModel, elements_of: Callable[[sct.Plant], Iterable[ex.NamedElement]]
    ) -> dict[ex.NamedElement, str]:
        """Return the members of one struct."""
        names = Names(TAKEN | {"EVENTS"})  # the source defines EVENTS
        return {
            element: names.fresh(identifier(plant.name if element is plant else f"{plant.name}_{element.name}"))
            for plant in model.plants
            for element in elements_of(plant)
        }

    def enumerator(self, element: sct.Event | sct.Location | ex.EnumerationLiteral) -> str:
        """Return the enumerator of an event, location or literal: `line_follower_message_move_c_trigger`."""
        return self._global[element]

    def member(self, element: sct.Plant | sct.DiscreteVariable | sct.Input) -> str:
        """Return the member of the state (a plant's location, a variable) or of the inputs: `component_LidarSensor`."""
        return self._members[element]

    def setting(self, duration: sct.Duration) -> str:
        """Return the member of the settings: `pause_ms`."""
        return self._settings[duration]

    def of(self, declared: engine.StateVariable | engine.Input) -> str:
        """Return the member for a variable or input of the engine model."""
        if isinstance(declared, engine.Input):
            return self.member(declared.input)
        return self.member(declared.variable or declared.plant)

    def lookup(self, owner: sct.Plant | ex.Enumeration) -> str:
        """Return the function that returns the name of a plant's location or of an enumeration's literal."""
        return self._lookups[owner]

    def _prefixed(self, *parts: str) -> str:
        return identifier("_".join([self.prefix, *parts]))


def identifier(name: str) -> str:
    """Return the name in ASCII letters, digits and underscores. Other characters become their code."""
    return re.sub(r"[^A-Za-z0-9_]", lambda match: f"_u{ord(match[0]):04x}", name)
