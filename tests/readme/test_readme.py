# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command in README.md works: ```sh and ```python blocks are run from the top, in the project's folder.

What a test cannot run as it stands:
`git clone` and `cd` (we are there already), `make test` (it is what runs this), and `blender …` where no
real Blender is named in BASICRT_BLENDER (skipped with a message).
"""

import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```(sh|bash|console|python)\s*\n(.*?)^```", re.MULTILINE | re.DOTALL)
DONE_ALREADY = ("git clone", "cd ", "make test", "bash .ci/run")


@dataclass(frozen=True)
class Snippet:
    """Something the README tells the reader to run."""

    language: str
    text: str
    line: int

    def __str__(self) -> str:
        return f"line {self.line}: {self.text.splitlines()[0]}"


def shell_commands(block: str) -> list[tuple[int, str]]:
    """(line within the block, command) pairs; a backslash at a line's end continues it."""
    commands: list[tuple[int, str]] = []
    pending = ""
    for number, line in enumerate(block.splitlines()):
        text = line.strip().removeprefix("$ ")
        if pending or (text and not text.startswith("#")):
            pending += text
            if pending.endswith("\\"):
                pending = pending[:-1]
            else:
                commands.append((number, pending))
                pending = ""
    return commands


def snippets() -> list[Snippet]:
    """All of them, in the README's order: one per shell command, one per Python block."""
    path = ROOT / "README.md"
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    found: list[Snippet] = []
    for block in BLOCK.finditer(text):
        first = text.count("\n", 0, block.start()) + 2
        if block[1] == "python":
            found.append(Snippet("python", block[2], first))
        else:
            found += [Snippet("sh", c, first + n) for n, c in shell_commands(block[2])]
    return found


def environment(folder: Path) -> dict[str, str]:
    """The reader's shell after following the README: `basicrt` installed, `blender` on the PATH."""
    commands = [c for c in os.environ.get("BASICRT_BLENDER", "").split(os.pathsep) if c]
    if commands:
        shim = folder / "blender"
        # The command must not find this script again under the name that it looks for itself.
        own_path = shlex.quote(os.environ["PATH"])
        shim.write_text(
            f'#!/bin/sh\nPATH={own_path}\nexport PATH\nexec {commands[0]} "$@"\n', encoding="utf-8"
        )
        shim.chmod(0o755)
    blenders = sorted((ROOT / ".venv").glob("bpy-*/bin"))
    preferred = [path for path in blenders if path.parent.name == "bpy-5.0"] or blenders
    path = [str(folder), *map(str, preferred[:1]), str(Path(sys.executable).parent)]
    return {
        **os.environ,
        "PATH": os.pathsep.join([*path, os.environ["PATH"]]),
        "BLENDER_USER_RESOURCES": str(folder / "profile"),
    }


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("reader")
    (folder / "profile").mkdir()
    return environment(folder)


@pytest.mark.skipif(not (ROOT / "README.md").exists(), reason="there is no README.md yet")
def test_readme_names_the_two_commands() -> None:
    texts = [snippet.text for snippet in snippets()]
    assert "make demo" in texts
    assert "make test" in texts


@pytest.mark.parametrize("snippet", snippets(), ids=str)
def test_command_in_readme_works(snippet: Snippet, reader: dict[str, str]) -> None:
    if snippet.language == "python":
        command = [sys.executable, "-c", snippet.text]
    elif snippet.text.startswith(DONE_ALREADY):
        return
    elif shlex.split(snippet.text)[0] == "blender" and not os.environ.get("BASICRT_BLENDER"):
        pytest.skip("no Blender executable: name one in BASICRT_BLENDER")
    else:
        command = ["bash", "-euo", "pipefail", "-c", snippet.text]
    result = subprocess.run(
        command,
        cwd=ROOT,
        env=reader,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=1200,
        check=False,
    )
    assert result.returncode == 0, f"{snippet}\n{result.stdout}\n{result.stderr}"
