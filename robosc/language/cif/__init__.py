"""Specifications of CIF 3, the language of the Eclipse Supervisory Control Engineering Toolkit, as sct models.

    reading = read("model.cif")

`parsing` turns a text into objects of the grammar (grammar/cif.tx). `scopes` resolves names and creates the instances
of definitions. `values` and `expressions` read expressions, `static_values` evaluates those of other types. `to_sct`
creates the sct model, and `channels` its events with senders and receivers.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import has_errors, in_order
from robosc.language.cif.faults import CifFaultError, construct, place_of
from robosc.language.cif.parsing import annotations_of, parse
from robosc.language.cif.scopes import Specification
from robosc.language.cif.to_sct import to_sct
from robosc.language.text import Documents, decode

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic
    from robosc.model import sct

__all__ = ["CifReading", "read", "read_supervised"]

#: Annotations of CIF that do not affect synthesis.
_MEANINGLESS = frozenset(["doc", "state", "controller:properties"])
#: Prefix of annotations that are requirements.
_REQUIRED = "requirement:"


@dataclass(frozen=True)
class CifReading:
    """Result of reading a specification: its sct model, the findings, and the texts by path.

    `model` is None if the specification has errors.
    """

    model: sct.SupervisoryControlModel | None
    findings: list[Diagnostic]
    texts: dict[str, str]


def read(path: Path | str, documents: Documents | None = None) -> CifReading:
    """Read a specification and all that it imports. Raises OSError if the file itself cannot be read."""
    files = _Files(Path(path), documents or Documents())
    if has_errors(files.findings):
        return CifReading(None, in_order(files.findings), files.texts)
    names = Specification()
    for specification in files.specifications:
        names.add(specification)
    names.make_instances()
    # The name becomes an identifier in generated code, also that of `model.supervised.cif`.
    model = to_sct(names, Path(path).name.removesuffix(".cif").replace(".", "_"))
    findings = in_order([*files.findings, *names.findings])
    if names.findings:
        return CifReading(None, findings, files.texts)
    model.source = place_of(names.first)
    return CifReading(model, findings, files.texts)


def read_supervised(model: sct.SupervisoryControlModel, text: str, own_text: str | None = None) -> CifReading | None:
    """Read a specification that imports the one of a model, as if its file were beside the model's file.

    `own_text` is the specification of a model that was not read from CIF. Returns None if the model's own specification
    is no longer readable.
    """
    assert model.source is not None
    assert model.source.file is not None
    own = Path(model.source.file.path)
    beside = own.with_name(f"{model.name}.supervised.cif")
    texts = {str(beside): text}
    if own_text is not None:
        own = own.with_name(f"{model.name}.cif")
        texts[str(own)] = own_text
    documents = Documents(texts)
    try:
        documents.read(own)
    except OSError:
        return None
    return read(beside, documents)


class _Files:
    """A file and all that it imports, each parsed once: files may import each other."""

    def __init__(self, path: Path, documents: Documents) -> None:
        self.findings: list[Diagnostic] = []
        self.texts: dict[str, str] = {}
        self.specifications: list[Any] = []
        self._known = {path.resolve()}
        self._imports: list[tuple[Path, Any]] = []
        self._parse(path, documents.read(path))
        for file, importing in self._imports:  # `_parse` extends the list during the loop.
            try:
                content = documents.read(file)
            except OSError as error:
                reason = error.strerror or str(error)
                fault = CifFaultError(importing, "unresolved-reference", f"the file `{file}` cannot be read: {reason}")
                self.findings.append(fault.finding())
            else:
                self._parse(file, content)

    def _parse(self, path: Path, content: bytes) -> None:
        text, faults = decode(str(path), content, path.name)
        self.texts[str(path)] = text.content
        specification, more = parse(text)
        self.findings += [*faults, *more]
        if specification is None:
            return
        self.specifications.append(specification)
        self._annotations(specification)
        for declaration in specification.declarations:
            for name in declaration.files if type(declaration).__name__ == "Import" else ():
                imported = path.parent / name[1:-1].replace('\\"', '"').replace("\\\\", "\\")
                if imported.resolve() not in self._known:
                    self._known.add(imported.resolve())
                    self._imports.append((imported, declaration))

    def _annotations(self, specification: Any) -> None:
        """Reject other annotations that are requirements, and warn about unknown ones."""
        for annotation in annotations_of(specification):
            name = annotation.name.lstrip("@")
            if name.startswith(_REQUIRED):
                fault = construct(
                    annotation, f"the requirement `{annotation.name}`", "write it as a requirement, or leave it out"
                )
                self.findings.append(fault.finding())
            elif name not in _MEANINGLESS:
                message = f"the annotation `{annotation.name}` is unknown: synthesis ignores it"
                fault = CifFaultError(
                    annotation, "cif-construct", message, "leave it out, or check that it is no requirement"
                )
                self.findings.append(fault.warning())
