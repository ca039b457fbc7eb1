"""The licenses of the page's packages are beside it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from robosc.tools.view.page import PageError, page_files

ROOT = Path(__file__).parents[3]
#: Packages of the build and the tests, which are not part of the page.
NOT_IN_THE_PAGE = {"@mermaid-js/tiny", "axe-core", "esbuild", "typescript"}


@pytest.fixture(scope="module")
def built() -> dict[str, str]:
    try:
        return {name: content.decode() for name, content in page_files().items()}
    except PageError as error:
        pytest.skip(str(error))


def test_each_package_in_the_page_is_listed_with_its_licence(built: dict[str, str]) -> None:
    lock = json.loads((ROOT / "web" / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    wanted = json.loads((ROOT / "web" / "package.json").read_text(encoding="utf-8"))["devDependencies"]
    listed = dict(re.findall(r"^(\S+) (\d\S*)\nLicence: ", built["LICENSES.txt"], re.MULTILINE))
    # Each package is listed or known to be absent from the page: a new one requires a decision.
    assert listed == {name: version for name, version in wanted.items() if name not in NOT_IN_THE_PAGE}
    for name, version in listed.items():
        locked = lock[f"node_modules/{name}"]
        assert locked["version"] == version
        assert f"{name} {version}\nLicence: {locked['license']}\nSource: http" in built["LICENSES.txt"]


def test_imports_of_the_page_are_listed(built: dict[str, str]) -> None:
    """A bare import name in the sources is a package; all other imports are local."""
    imported = set()
    for source in (ROOT / "web" / "src").glob("*.ts"):
        imported |= set(re.findall(r"""from "((?:@[\w-]+/)?[\w-]+)""", source.read_text(encoding="utf-8")))
    assert imported
    assert all(re.search(rf"^{re.escape(name)} \d", built["LICENSES.txt"], re.MULTILINE) for name in imported)


def test_the_texts_of_the_licences_are_there(built: dict[str, str]) -> None:
    assert "Eclipse Public License - v 2.0" in built["LICENSES.txt"]
