"""The server: receives messages of the protocol, and sends answers and findings.

The thread of the event loop receives messages. A second thread computes answers one after the other. A third thread
computes findings, so that neither typing nor an answer waits for them. The server abandons three kinds of work:
requests that the editor canceled, work on texts that have changed ("content modified"), and work that takes too long
("request failed").
"""

from __future__ import annotations

import asyncio
import gc
import logging
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, lsp_method

from robosc.base.interruption import call_at_checkpoints
from robosc.language.grammar import language
from robosc.tools.editor import reading
from robosc.tools.editor.answers import Verdict
from robosc.tools.editor.changes import incoming_calls, inlay_hints, outgoing_calls, prepare_call_hierarchy
from robosc.tools.editor.colours import LEGEND, semantic_tokens
from robosc.tools.editor.completion import OPTIONS, SIGNATURE_OPTIONS, completion, signature_help
from robosc.tools.editor.findings import (
    ADD_LIBRARY_FOLDER,
    CODE_ACTION_OPTIONS,
    abandoned_diagnostic,
    code_actions,
    findings_by_path,
    quickly,
)
from robosc.tools.editor.places import to_offset
from robosc.tools.editor.project import Project
from robosc.tools.editor.renaming import prepare_rename, rename
from robosc.tools.editor.synthesis import COMMAND, Verdicts, communication_at, lenses, question

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Generator, Mapping, Sequence
    from pathlib import Path

    from robosc.tools.editor.project import Analysis, Snapshot
    from robosc.tools.editor.synthesis import Question

_Answer = TypeVar("_Answer")
#: Default delay in seconds between the last keystroke and the search for findings.
_PAUSE = 0.15
#: Further delay in seconds before a large text is read as a whole, if its changed part was checked by itself.
_REST = 0.6
#: Handlers of requests about one text: functions of the project, the text, and the parameters of the request.
ANSWERS: Mapping[str, Callable[[Snapshot, Analysis, Any], Any]] = {
    types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: reading.symbols,
    types.TEXT_DOCUMENT_FOLDING_RANGE: reading.folding_ranges,
    types.TEXT_DOCUMENT_SELECTION_RANGE: reading.selection_ranges,
    types.TEXT_DOCUMENT_REFERENCES: reading.references,
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT: reading.highlights,
    types.TEXT_DOCUMENT_FORMATTING: reading.formatting,
    types.TEXT_DOCUMENT_RANGE_FORMATTING: reading.range_formatting,
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: semantic_tokens,
    types.TEXT_DOCUMENT_COMPLETION: completion,
    types.TEXT_DOCUMENT_SIGNATURE_HELP: signature_help,
    types.TEXT_DOCUMENT_CODE_ACTION: code_actions,
    types.TEXT_DOCUMENT_INLAY_HINT: inlay_hints,
    types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY: prepare_call_hierarchy,
    types.CALL_HIERARCHY_INCOMING_CALLS: incoming_calls,
    types.CALL_HIERARCHY_OUTGOING_CALLS: outgoing_calls,
    types.TEXT_DOCUMENT_PREPARE_RENAME: prepare_rename,
    types.TEXT_DOCUMENT_RENAME: rename,
}
_OPTIONS: Mapping[str, Any] = {
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: LEGEND,
    types.TEXT_DOCUMENT_COMPLETION: OPTIONS,
    types.TEXT_DOCUMENT_SIGNATURE_HELP: SIGNATURE_OPTIONS,
    types.TEXT_DOCUMENT_CODE_ACTION: CODE_ACTION_OPTIONS,
    types.TEXT_DOCUMENT_RENAME: types.RenameOptions(prepare_provider=True),
}
#: Limit of processor time in seconds for an answer, or for the findings of one text.
_LONGEST = 30.0
_CONTENT_MODIFIED = int(types.LSPErrorCodes.ContentModified)
_REQUEST_FAILED = int(types.LSPErrorCodes.RequestFailed)
_TOO_LONG = f"this took more than {_LONGEST:.0f} seconds of processor time"


class _Protocol(LanguageServerProtocol):
    @lsp_method(types.INITIALIZE)
    def lsp_initialize(self, params: types.InitializeParams) -> Generator[Any, Any, types.InitializeResult]:
        """Initialize with UTF-16 positions, which every editor supports, whatever else it offers."""
        if params.capabilities.general is not None:
            params.capabilities.general.position_encodings = None
        return (yield from super().lsp_initialize(params))

    def _execute_handler(self, msg_id: Any, handler: Any, callback: Any, *rest: Any, **options: Any) -> None:
        """Drop futures when they are done.

        pygls 2.1 keeps the future of each notification as long as the server runs.
        """

        def done(future: Any) -> None:
            self._request_futures.pop(msg_id, None)
            callback(future)

        super()._execute_handler(msg_id, handler, done, *rest, **options)

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Reject a request whose parameters do not fit its method: pygls 2.1 only logs it."""
        try:
            return super().structure_message(data)
        except JsonRpcException as error:
            if "method" in data and isinstance(data.get("id"), int | str):
                self._send_response(data["id"], error=error.to_response_error())
            raise


class Server(LanguageServer):
    """A language server for one editor."""

    def __init__(self, version: str, libraries: Sequence[str] = (), interfaces: Sequence[str] = ()) -> None:
        """Create a server of this version of robosc with the library and interface folders of the command line."""
        super().__init__("robosc", version, protocol_cls=_Protocol)
        self.project = Project(libraries, interfaces)
        self._worker = ThreadPoolExecutor(1, "answers")
        self._finder = ThreadPoolExecutor(1, "findings")
        #: Checks changes within a large text in parallel to requests about the whole text.
        self._quick = ThreadPoolExecutor(1, "slices")
        self._pause = _PAUSE
        self._ended = False
        #: Whether the editor has the commands that lenses and quick fixes name.
        self.has_commands = False
        self._waiting: asyncio.Task[None] | None = None
        self._published: dict[Path, tuple[int | None, list[types.Diagnostic]]] = {}
        self.verdicts = Verdicts(COMMAND, self._refresh_lenses)
        _register(self)

    def shutdown(self) -> None:
        """Stop the server."""
        self._ended = True
        self.verdicts.cancel()
        for worker in (self._worker, self._finder, self._quick):
            worker.shutdown(wait=False, cancel_futures=True)
        super().shutdown()  # type: ignore[no-untyped-call]

    def configure(self, params: types.InitializeParams) -> None:
        """Apply the editor's folders and settings.

        The settings are `libraryPaths`, `interfacePaths`, `pause` in milliseconds, and `commands`. The latter is true
        if the editor has the commands of the extension for VS Code.
        """
        options = params.initialization_options
        settings: Mapping[str, Any] = options if isinstance(options, dict) else {}
        libraries, interfaces = (_strings(settings.get(name)) for name in ("libraryPaths", "interfacePaths"))
        self.project = Project([*libraries, *self.project.libraries], [*interfaces, *self.project.interfaces])
        self._pause = float(settings["pause"]) / 1000 if isinstance(settings.get("pause"), int | float) else _PAUSE
        self.has_commands = settings.get("commands") is True
        self.take_folders()

    def add_library_folder(self, folder: str) -> None:
        """Search one more folder for libraries."""
        self.project.libraries = (*self.project.libraries, self.project.path(folder))
        self.project.forget()
        self.search_later()

    def take_folders(self) -> None:
        """Apply the editor's folders."""
        uris = list(self.workspace.folders)
        if not uris and self.workspace.root_uri:
            uris = [self.workspace.root_uri]
        self.project.folders = tuple(self.project.path(uri) for uri in uris)

    async def answer(self, uri: str, job: Callable[[Snapshot, Analysis], _Answer]) -> _Answer | None:
        """Run a job on a text when its turn comes; return None if there is no such text."""
        path = self.project.path(uri)

        def with_text(snapshot: Snapshot) -> _Answer | None:
            analysis = snapshot.analysis(path)
            return None if analysis is None else job(snapshot, analysis)

        return await self.answer_project(with_text)

    async def answer_project(self, job: Callable[[Snapshot], _Answer]) -> _Answer:
        """Run a job on the whole project."""
        snapshot, canceled = self.project.snapshot(), threading.Event()

        def in_turn() -> _Answer:
            check = self._check(snapshot, canceled)
            check()
            with call_at_checkpoints(check):
                return job(snapshot)

        try:
            return await asyncio.get_running_loop().run_in_executor(self._worker, in_turn)
        except asyncio.CancelledError:
            canceled.set()
            raise

    def _check(self, snapshot: Snapshot, canceled: threading.Event | None = None) -> Callable[[], None]:
        """Return a check that raises JsonRpcException if the work of this thread is obsolete or takes too long."""
        project, end = self.project, time.thread_time() + _LONGEST

        def check() -> None:
            if self._ended or not project.is_current(snapshot) or (canceled is not None and canceled.is_set()):
                raise JsonRpcException("the text has changed", _CONTENT_MODIFIED)
            if time.thread_time() > end:
                raise JsonRpcException(_TOO_LONG, _REQUEST_FAILED)

        return check

    def search_later(self, typed: Path | None = None) -> None:
        """Search for findings after a pause without further changes.

        `typed` is the text in which the user typed.
        """
        self.verdicts.cancel()
        if self._waiting is not None:
            self._waiting.cancel()
        self._waiting = asyncio.get_running_loop().create_task(self._find(typed))

    def verdict(self, query: Question) -> Verdict | str | None:
        """Return the verdict of synthesis, or None if it is not yet known."""
        project = self.project
        return self.verdicts.ask(query, list(map(str, project.libraries)), list(map(str, project.interfaces)))

    def _refresh_lenses(self) -> None:
        workspace = self.client_capabilities.workspace
        if workspace is not None and workspace.code_lens is not None and workspace.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)

    def tell_again(self, path: Path) -> None:
        """Publish the findings of an opened text even if they have not changed."""
        self._published.pop(path, None)

    async def _find(self, typed: Path | None) -> None:
        await asyncio.sleep(self._pause)
        snapshot = self.project.snapshot()
        if typed is not None and await self._find_quickly(snapshot, typed):
            await asyncio.sleep(_REST)

        try:
            diagnostics = await asyncio.get_running_loop().run_in_executor(self._finder, self._findings, snapshot)
        except (RuntimeError, JsonRpcException):
            return  # The server stops, or a text has changed.
        if self.project.is_current(snapshot):
            self._publish(snapshot, diagnostics)

    def _findings(self, snapshot: Snapshot) -> dict[Path, list[types.Diagnostic]]:
        """Return the diagnostics to publish for all texts. Raises JsonRpcException if one of them has changed."""
        analyses, published_findings = [], {}
        for path in snapshot.documents:
            try:
                with call_at_checkpoints(self._check(snapshot)):
                    analysis = snapshot.analysis(path)
            except JsonRpcException as error:
                if error.code != _REQUEST_FAILED:
                    raise
                published_findings[path] = [abandoned_diagnostic(_TOO_LONG)]
                continue
            if analysis is not None:
                analyses.append(analysis)
        published_findings |= {
            path: diagnostics
            for path, diagnostics in findings_by_path(snapshot, analyses).items()
            if path not in published_findings
        }
        for analysis in analyses:
            if analysis.is_large:
                analysis.slices.prepare()
        return published_findings

    async def _find_quickly(self, snapshot: Snapshot, path: Path) -> bool:
        """Publish the findings of the definition in which the user typed, and return whether this is possible."""

        def in_turn() -> list[types.Diagnostic] | None:
            with call_at_checkpoints(self._check(snapshot)):
                return quickly(snapshot, path)

        try:
            diagnostics = await asyncio.get_running_loop().run_in_executor(self._quick, in_turn)
        except (RuntimeError, JsonRpcException):
            return False  # The server stops, a text has changed, or the search took too long.
        if diagnostics is not None and self.project.is_current(snapshot):
            version = snapshot.documents[path].version
            self._published[path] = version, diagnostics
            params = types.PublishDiagnosticsParams(snapshot.uri(str(path)), diagnostics, version)
            self.text_document_publish_diagnostics(params)
        return diagnostics is not None

    def _publish(self, snapshot: Snapshot, findings: Mapping[Path, list[types.Diagnostic]]) -> None:
        """Publish changed diagnostics.

        A file that is not open is published only if it has, or had, findings.
        """
        for path in [*findings, *(path for path in self._published if path not in findings)]:
            document = snapshot.documents.get(path)
            version, diagnostics = document.version if document else None, findings.get(path, [])
            if self._published.get(path, (None, [])) == (version, diagnostics) and path in self._published:
                continue
            if document is None and not diagnostics and not self._published.get(path, (None, []))[1]:
                continue
            self._published[path] = version, diagnostics
            params = types.PublishDiagnosticsParams(snapshot.uri(str(path)), diagnostics, version)
            self.text_document_publish_diagnostics(params)


def _strings(value: Any) -> list[str]:
    return [part for part in value if isinstance(part, str)] if isinstance(value, list) else []


def _register(server: Server) -> None:
    _register_texts(server)
    _register_answers(server)
    _register_commands(server)


def _register_texts(server: Server) -> None:
    @server.feature(types.INITIALIZE)
    def initialize(params: types.InitializeParams) -> None:
        server.configure(params)

    @server.feature(types.INITIALIZED)
    async def initialized(_: types.InitializedParams) -> None:
        await _watch_files(server)

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def did_open(params: types.DidOpenTextDocumentParams) -> None:
        opened = params.text_document
        server.tell_again(server.project.put(opened.uri, opened.version, opened.text))
        server.search_later()

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def did_change(params: types.DidChangeTextDocumentParams) -> None:
        changes = [(_place(change), change.text) for change in params.content_changes]
        server.project.change(params.text_document.uri, params.text_document.version, changes)
        server.search_later(server.project.path(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def did_close(params: types.DidCloseTextDocumentParams) -> None:
        server.project.close(params.text_document.uri)
        server.search_later()

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def did_save(_: types.DidSaveTextDocumentParams) -> None:
        server.project.forget()
        server.search_later()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def did_change_files(_: types.DidChangeWatchedFilesParams) -> None:
        server.project.forget()
        server.search_later()

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def did_change_folders(_: types.DidChangeWorkspaceFoldersParams) -> None:
        server.take_folders()
        server.search_later()


async def _watch_files(server: Server) -> None:
    """Ask the editor to report changes of files that are not open, if it supports this."""
    workspace = server.client_capabilities.workspace
    watched = workspace.did_change_watched_files if workspace else None
    if watched is None or not watched.dynamic_registration:
        return
    patterns = ("**/*.rscd", "**/*.msg", "**/*.srv", "**/*.action")
    options = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher(name) for name in patterns])
    registration = types.Registration("robosc-files", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
    await server.client_register_capability_async(types.RegistrationParams([registration]))


def _place(change: types.TextDocumentContentChangeEvent) -> tuple[int, int, int, int] | None:
    if not isinstance(change, types.TextDocumentContentChangePartial):
        return None
    start, end = change.range.start, change.range.end
    return start.line, start.character, end.line, end.character


def _register_answers(server: Server) -> None:
    for method, job in ANSWERS.items():
        server.feature(method, _OPTIONS.get(method))(_handler(server, job))

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.LocationLink] | list[types.Location] | None:
        links = await server.answer(params.text_document.uri, partial(reading.definition, params=params))
        capabilities = server.client_capabilities.text_document
        known = capabilities.definition if capabilities else None
        if links is None or (known is not None and known.link_support):
            return links
        return [types.Location(link.target_uri, link.target_selection_range) for link in links]

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def code_lens(params: types.CodeLensParams) -> list[types.CodeLens]:
        query = await server.answer(params.text_document.uri, question)
        if query is None:
            return []
        return lenses(query, server.verdict(query), params.text_document.uri, commands=server.has_commands)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        def job(snapshot: Snapshot, analysis: Analysis) -> tuple[types.Hover | None, str | None, Question | None]:
            named = communication_at(analysis, to_offset(analysis.text, params.position))
            query = question(snapshot, analysis) if named is not None else None
            return reading.hover(snapshot, analysis, params), named, query

        answer = await server.answer(params.text_document.uri, job)
        description, named, query = answer or (None, None, None)
        # A later hover shows the verdict, even in an editor without code lenses.
        known = server.verdict(query) if query is not None else None
        if description is not None and named is not None and isinstance(known, Verdict) and named in known.guards:
            assert isinstance(description.contents, types.MarkupContent)
            guards = "\n".join(f"- {guard}" for guard in known.guards[named])
            description.contents.value += f"\n\nThe supervisor allows its\n{guards}"
        return description

    @server.feature(types.WORKSPACE_SYMBOL)
    async def workspace_symbols(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        return await server.answer_project(partial(reading.workspace_symbols, query=params.query))


def _register_commands(server: Server) -> None:
    @server.command(ADD_LIBRARY_FOLDER)
    def add_library_folder(folder: str) -> None:
        server.add_library_folder(folder)
        duration = "until the editor ends; set `libraryPaths` or ROBOSC_PATH to keep it"
        message = f"libraries are also searched in {server.project.path(folder)}, {duration}"
        server.window_show_message(types.ShowMessageParams(types.MessageType.Info, message))


def _handler(server: Server, job: Callable[[Snapshot, Analysis, Any], Any]) -> Callable[[Any], Awaitable[Any]]:
    async def handle(params: Any) -> Any:
        uri = params.item.uri if hasattr(params, "item") else params.text_document.uri
        return await server.answer(uri, lambda snapshot, analysis: job(snapshot, analysis, params))

    return handle


def serve(server: Server, port: int | None = None) -> None:
    """Serve one editor over the standard input and output, or over a local port, until it sends `exit`."""
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING, format="%(message)s")
    language()
    # The grammar is permanent; the models of closed texts are collected.
    gc.freeze()
    gc.set_threshold(50_000, 10, 10)
    if port is None:
        server.start_io()
    else:
        logging.getLogger("pygls.server").setLevel(logging.INFO)
        server.start_tcp("127.0.0.1", port)
