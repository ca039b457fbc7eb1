"""What a person reads who must sign for a supervised robot: requirements, what became of them, and what is assumed.

    found = report(models, configuration, verdicts)
    page = as_html(found)

`contents` collects it as plain data, in the order and with the words of the JSON; `printing` finds requirements in what
was generated, `playing` plays the traces of the generated tests on the interpreter, `digests` names what it is about.
"""

from robosc.report.contents import report
from robosc.report.rendering import as_html, as_json, as_needs

__all__ = ["as_html", "as_json", "as_needs", "report"]
