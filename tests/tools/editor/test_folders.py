"""Several folders of one editor are one project: names are found and renamed in the texts of all folders."""

from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import client_capabilities

from tests.tools.editor.server import CONFIG, LIBRARY, ROBOT, Editor, at, edited, findings, of, open_text, position

VAN = ROBOT.replace("Cart", "Van")


@pytest_lsp.fixture(config=CONFIG)
async def client(lsp_client: Editor, tmp_path: Path):
    """Start with the folder of two robots and that of their library; `others` is added later."""
    for name, text in (("robots/cart", ROBOT), ("robots/van", VAN), ("parts/wheels", LIBRARY), ("others/cart", ROBOT)):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.rscd").write_text(text)
    folders = [types.WorkspaceFolder((tmp_path / name).as_uri(), name) for name in ("robots", "parts")]
    await lsp_client.initialize_session(
        types.InitializeParams(
            client_capabilities("visual-studio-code"),
            workspace_folders=folders,
            initialization_options={"pause": 0, "libraryPaths": [str(tmp_path / "parts")]},
        )
    )
    yield
    await lsp_client.shutdown_session()


@pytest.mark.slow
@pytest.mark.asyncio
async def test_a_name_in_the_texts_of_two_folders(client: Editor, tmp_path: Path) -> None:
    texts = {name: (tmp_path / name).read_text() for name in ("robots/cart.rscd", "robots/van.rscd")}
    texts["parts/wheels.rscd"] = LIBRARY
    uri = open_text(client, tmp_path / "robots/cart.rscd", ROBOT)
    assert await findings(client, uri, 1) == []
    where = position(ROBOT, "drive needs")
    (definition,) = await client.text_document_definition_async(types.DefinitionParams(**at(uri, where)))
    assert definition.target_uri == (tmp_path / "parts/wheels.rscd").as_uri()
    context = types.ReferenceContext(include_declaration=True)
    found = await client.text_document_references_async(types.ReferenceParams(context, **at(uri, where)))
    places = [(place.uri.removeprefix(f"{tmp_path.as_uri()}/"), place.range) for place in found]
    assert sorted(name for name, _ in places) == sorted(
        [*("robots/cart.rscd", "robots/van.rscd") * 2, "parts/wheels.rscd"]
    )
    assert {of(texts[name], place) for name, place in places} == {"drive"}
    renamed = await client.text_document_rename_async(types.RenameParams(new_name="go", **at(uri, where)))
    after = {
        name: edited(texts[name], renamed.changes[(tmp_path / name).as_uri()])
        for name in texts
        if (tmp_path / name).as_uri() in renamed.changes
    }
    used = ("drive needs", "go needs"), ("provide drive", "provide go")
    assert after == {
        "robots/cart.rscd": ROBOT.replace(*used[0]).replace(*used[1]),
        "robots/van.rscd": VAN.replace(*used[0]).replace(*used[1]),
        "parts/wheels.rscd": LIBRARY.replace("message drive", "message go"),
    }
    symbols = await client.workspace_symbol_async(types.WorkspaceSymbolParams("Motors"))
    assert [symbol.location.uri for symbol in symbols] == [(tmp_path / "parts/wheels.rscd").as_uri()]


@pytest.mark.slow
@pytest.mark.asyncio
async def test_folders_come_and_go(client: Editor, tmp_path: Path) -> None:
    uri = open_text(client, tmp_path / "robots/cart.rscd", ROBOT)
    asked = types.RenameParams(new_name="go", **at(uri, position(ROBOT, "drive needs")))
    added = types.WorkspaceFolder((tmp_path / "others").as_uri(), "others")
    client.workspace_did_change_workspace_folders(
        types.DidChangeWorkspaceFoldersParams(types.WorkspaceFoldersChangeEvent([added], []))
    )
    renamed = await client.text_document_rename_async(asked)
    assert (tmp_path / "others/cart.rscd").as_uri() in renamed.changes
    parts = types.WorkspaceFolder((tmp_path / "parts").as_uri(), "parts")
    client.workspace_did_change_workspace_folders(
        types.DidChangeWorkspaceFoldersParams(types.WorkspaceFoldersChangeEvent([], [added, parts]))
    )
    with pytest.raises(JsonRpcException, match="which is not in the editor's folders"):
        await client.text_document_rename_async(asked)
