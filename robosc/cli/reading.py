"""Reads the MODEL of a command."""

from __future__ import annotations

from typing import TYPE_CHECKING

import robosc
from robosc.checks import check
from robosc.cli import CallError
from robosc.interfaces import Interfaces
from robosc.language import read as read_text
from robosc.metamodel import robosc as rsc
from robosc.metamodel import rosgraph, sct
from robosc.models import Models

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.cli.report import Report

    Root = rsc.Base | sct.SupervisoryControlModel | rosgraph.RosGraph


def read(path: str, library_paths: Sequence[str], report: Report, interface_paths: Sequence[str] = ()) -> Root | None:
    """The model in a file of any kind; all findings of reading and of the rules go to the report.

    None where so little could be read that there is none. Raises ModelError for an XMI file with faults.
    """
    interfaces = Interfaces(interface_paths)
    if path.endswith(".xmi"):
        from robosc.metamodel import xmi

        root: Root | None = xmi.load(path)
        findings = []
    else:
        reading = read_text(path, library_paths, interfaces)
        root, findings = reading.base, reading.findings
        report.add(findings, reading.texts)
    if isinstance(root, rsc.Base):
        report.add(check(root, findings, interfaces))
    return root


def read_models(path: str, library_paths: Sequence[str], report: Report, interface_paths: Sequence[str] = ()) -> Models:
    """The sct model in a file, or made from what it holds, and what else there is about the robot.

    Ends the report where there are errors. Raises CallError for a library.
    """
    root = read(path, library_paths, report, interface_paths)
    if isinstance(root, rsc.Library):
        raise CallError(f"{path} holds a library: it has no supervisor of its own, a robot that imports it has")
    report.stop_on_errors()
    if isinstance(root, rsc.Robot):
        return Models(robosc.to_sct(root), robosc.to_rosgraph(root, interface_paths), root)
    if isinstance(root, rosgraph.RosGraph):
        return Models(root.model, root)
    assert isinstance(root, sct.SupervisoryControlModel)
    return Models(root)
