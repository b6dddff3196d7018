# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every source file names its licence at the top, as SPDX wants it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from project import ROOT

LINE = "SPDX-License-Identifier: GPL-3.0-or-later"
SUFFIXES = {".py", ".pyi", ".cpp", ".h", ".inl", ".cmake", ".sh"}
NAMES = {"CMakeLists.txt", "Makefile", "run"}


def missing_in(files: list[Path]) -> list[Path]:
    """The source files among these without the line in their first three."""
    found = []
    for path in files:
        if path.suffix in SUFFIXES or path.name in NAMES:
            first_lines = path.read_text(encoding="utf-8").split("\n", 3)[:3]
            if not any(LINE in line for line in first_lines):
                found.append(path)
    return found


def main() -> int:
    """Check all files that git knows or would add."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    files = [ROOT / name for name in listed.stdout.splitlines()]
    missing = missing_in([path for path in files if path.is_file()])
    for path in missing:
        print(f"{path.relative_to(ROOT)}:1: no line `{LINE}`")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
