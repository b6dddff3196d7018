# SPDX-License-Identifier: GPL-3.0-or-later
"""Real Blender executables to test with: those named by the user, or made by a script beside the checkout.

`BASICRT_BLENDER` lists commands that start Blender, separated as in a PATH; empty means none.
`BASICRT_REAL_BLENDER` names the script that makes some in folders of their own (`setup`, `root` and `run`,
each with a Debian suite); without it `../shared/tools/real-blender` is used where that exists.
"""

from __future__ import annotations

import functools
import os
import shlex
import subprocess
from pathlib import Path

import bootstrap
from project import ROOT, say

SUITES = ("trixie", "sid")


def script() -> Path | None:
    """The script that makes Blender executables, where there is one."""
    named = os.environ.get("BASICRT_REAL_BLENDER")
    path = Path(named) if named else ROOT.parent / "shared" / "tools" / "real-blender"
    return path if path.is_file() else None


@functools.cache
def root_of(suite: str) -> Path | None:
    """The folder of one made executable, made now if need be; None where it cannot be had."""
    tool = script()
    if tool is None:
        return None
    with bootstrap.locked("real-blender"):
        say(f"looking for a real Blender from Debian {suite} (takes minutes the first time)")
        words = [str(tool), "root", suite]
        result = subprocess.run(
            words, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
        )
    if result.returncode != 0:
        say(f"no real Blender from {suite}: {result.stderr.strip()}")
        return None
    return Path(result.stdout.split()[-1])


def roots() -> list[Path]:
    """The folders of all made executables: their Pythons' headers may be in them."""
    return [root for root in map(root_of, SUITES) if root]


def commands() -> list[str]:
    """What starts each real Blender."""
    named = os.environ.get("BASICRT_BLENDER")
    if named is not None:
        return [command for command in named.split(os.pathsep) if command]
    return [f"{shlex.quote(str(script()))} run {suite}" for suite in SUITES if root_of(suite)]
