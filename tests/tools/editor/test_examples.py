"""Every kind of request about every example, over the protocol."""

from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types

from robosc.language.text import Text
from robosc.tools.editor.server import ANSWERS
from tests.tools.editor.server import CONFIG, ROOT, Editor, close, findings, initialize, open_text
from tests.tools.editor.test_robustness import EXAMPLES, parameters

pytestmark = pytest.mark.asyncio(loop_scope="module")
#: Copies of an example are one text.
TEXTS = {path.read_text(): path for path in EXAMPLES}
#: The other examples need more answers.
SMALL = "line_stepper"
OTHERS = (types.TEXT_DOCUMENT_DEFINITION, types.TEXT_DOCUMENT_HOVER, types.TEXT_DOCUMENT_CODE_LENS)


@pytest_lsp.fixture(config=CONFIG, scope="module")
async def client(lsp_client: Editor):
    await initialize(lsp_client, ROOT / "examples")
    yield
    await lsp_client.shutdown_session()


@pytest.mark.parametrize(
    ("text", "path"),
    [
        pytest.param(text, path, id=path.stem, marks=[pytest.mark.slow] if path.stem != SMALL else [])
        for text, path in TEXTS.items()
    ],
)
async def test_everything_is_answered(client: Editor, text: str, path: Path) -> None:
    uri = open_text(client, path, text)
    assert [found for found in await findings(client, uri, 1) if found.severity is types.DiagnosticSeverity.Error] == []
    offset = text.index("state ") + len("state ")
    for method in (*ANSWERS, *OTHERS):
        asked = parameters(method, Text("", text), offset, uri)
        answer = await client.protocol.send_request_async(method, asked)
        assert answer is not None or method == types.TEXT_DOCUMENT_SIGNATURE_HELP, method
    close(client, uri)
