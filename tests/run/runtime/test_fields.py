"""Conversion of numbers for message fields."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.run.runtime.core.node_data import NotFiniteError, fill
from tests.run.runtime.fake import FakePort, Record

BOUNDS = {
    "int8": (-128, 127),
    "uint8": (0, 255),
    "char": (0, 255),
    "byte": (-128, 127),
    "int16": (-(2**15), 2**15 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
    "bool": (0, 1),
}


def held(kind: str, value: float | str) -> object:
    message = Record()
    noted = fill(FakePort(types={"x": kind}), message, ["inner", "x"], value)
    assert message.inner.x == noted
    return noted


@given(st.sampled_from(sorted(BOUNDS)), st.integers(-(2**63), 2**63 - 1))
def test_an_integer_becomes_the_nearest_that_the_field_holds(kind: str, value: int) -> None:
    low, high = BOUNDS[kind]
    assert held(kind, value) == min(max(value, low), high)


@given(st.sampled_from(sorted(BOUNDS)), st.floats(allow_nan=False, allow_infinity=False))
def test_a_double_in_an_integer_field_loses_its_fraction(kind: str, value: float) -> None:
    low, high = BOUNDS[kind]
    assert held(kind, value) == min(max(math.trunc(value), low), high)


@given(st.floats(width=64, allow_nan=False, allow_infinity=False))
def test_a_double_is_narrowed_or_refused(value: float) -> None:
    assert held("double", value) == value
    try:
        (narrow,) = struct.unpack("f", struct.pack("f", value))
    except OverflowError:
        narrow = math.inf
    if math.isfinite(narrow):
        assert held("float", value) == held("float32", value) == narrow
    else:
        with pytest.raises(NotFiniteError, match=r"inner\.x"):
            held("float32", value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("kind", ["float32", "float64", "int16"])
def test_what_is_not_finite_is_refused(kind: str, value: float) -> None:
    with pytest.raises(NotFiniteError):
        held(kind, value)


def test_texts_booleans_and_bytes_are_set() -> None:
    assert held("string", "ü") == "ü"
    assert held("boolean", True) is True
    message = Record()
    assert fill(FakePort(types={"x": "octet"}), message, ["x"], 300) == 255
    assert message.x == b"\xff"
