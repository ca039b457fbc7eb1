"""The JSON of the nodes: its content and its exact bytes."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.run.runtime.core.json_text import json_text

_VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)


@given(_VALUES)
def test_reads_back_as_it_was(value: Any) -> None:
    assert json.loads(json_text(value)) == value


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "-0"),
        (0.1, "0.1"),
        (1 / 3, "0.3333333333333333"),
        (1e20, "1e+20"),
        (1795174473.5, "1795174473.5"),
        (math.nan, "null"),
        (-math.inf, "null"),
        ('a "b" \\ \n ü', '"a \\"b\\" \\\\ \\u000a ü"'),
        ("\x7f\x85 \u2028\u202e\ufffe\U000e0041", '"\\u007f\\u0085 \\u2028\\u202e\\ufffe\\udb40\\udc41"'),
        ({"a": [1, True, None], "b": {}}, '{"a":[1,true,null],"b":{}}'),
    ],
)
def test_is_written_as_the_generated_nodes_write_it(value: Any, text: str) -> None:
    assert json_text(value) == text
