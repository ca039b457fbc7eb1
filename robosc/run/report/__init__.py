"""Verification report for the person who signs off a robot: requirements, their results, and assumptions.

    found = report(models, configuration, verdicts)
    page = as_html(found)

`contents` collects it as plain data, with the order and the keys of the JSON. `printing` finds requirements in the
generated code. `trace_coverage` plays the traces of the generated tests on the interpreter. `digests` identifies the
inputs and outputs.
"""

from robosc.run.report.contents import report
from robosc.run.report.rendering import as_html, as_json, as_needs

__all__ = ["as_html", "as_json", "as_needs", "report"]
