# SPDX-License-Identifier: GPL-3.0-or-later
"""The installable extension and real Blender executables, for the tests that bring them together."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def find_extension() -> Path:
    """The zip to test: BASICRT_EXTENSION, or the newest one in dist/."""
    named = os.environ.get("BASICRT_EXTENSION")
    zips = [Path(named)] if named else sorted(ROOT.glob("dist/basicrt-*.zip"), key=os.path.getmtime)
    if not zips:
        pytest.skip("no extension in dist/: run `make extension`")
    return zips[-1]


@dataclass
class RealBlender:
    """One executable and the folder it keeps its preferences and extensions in."""

    command: list[str]
    profile: Path

    def run(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        """Start it with these arguments in the project's folder and wait until it ends."""
        return subprocess.run(
            [*self.command, *map(str, arguments)],
            cwd=ROOT,
            env={**os.environ, "BLENDER_USER_RESOURCES": str(self.profile)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=600,
            check=False,
        )
