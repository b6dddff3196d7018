# SPDX-License-Identifier: GPL-3.0-or-later
"""Real Blender executables, each with the extension installed into a profile of its own.

BASICRT_BLENDER lists the commands that start them, separated like a PATH; without it these tests skip.
"""

import os
import shlex
from collections.abc import Iterator

import pytest

from support.extension import RealBlender, find_extension

COMMANDS = [c for c in os.environ.get("BASICRT_BLENDER", "").split(os.pathsep) if c]


@pytest.fixture(scope="session", params=COMMANDS or [None])
def blender(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[RealBlender]:
    """A real Blender with the extension installed and enabled from the command line."""
    if request.param is None:
        pytest.skip("no Blender executable: name some in BASICRT_BLENDER")
    found = RealBlender(shlex.split(request.param), tmp_path_factory.mktemp("profile"))
    version = found.run("-b", "--python-expr", "import sys; print('cp%d%d' % sys.version_info[:2])")
    if version.returncode == 77:
        pytest.skip(f"{request.param}: {version.stderr.strip()}")
    assert version.returncode == 0, version.stdout + version.stderr
    extension = find_extension()
    tag = next(line for line in version.stdout.splitlines() if line.startswith("cp3"))
    if f"-{tag}-".encode() not in extension.read_bytes():
        pytest.skip(f"{extension.name} holds no wheel for Python {tag}")
    result = found.run(
        *("--command", "extension", "install-file", "-r", "user_default", "--enable", extension)
    )
    assert result.returncode == 0, result.stdout + result.stderr
    yield found
    result = found.run("--command", "extension", "remove", "basicrt")
    assert result.returncode == 0, result.stdout + result.stderr
