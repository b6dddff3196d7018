# SPDX-License-Identifier: GPL-3.0-or-later
"""The documentation names files that exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# A path in backquotes that begins with a folder of the project; `<kind>` and the like stand for a name.
PATH = re.compile(r"`((?:native|addon|tests|tools|docs|scenes|benchmarks)/[^`\s]*)`")
DOCUMENTS = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "benchmarks").rglob("*.md")),
]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_paths_in_the_documentation_exist(document: Path) -> None:
    named = PATH.findall(document.read_text(encoding="utf-8"))
    missing = [path for path in named if "<" not in path and not (ROOT / path).exists()]
    assert not missing
