# SPDX-License-Identifier: GPL-3.0-or-later
"""The checks that need no build: formatters, linters, types, layers, documentation. `--fix` corrects what it can."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import bootstrap
from project import ROOT, Command, ToolError, relative, run, say

CPP_FOLDERS = ("native", "tests/native", "tests/fuzz", "benchmarks/native")
TYPED_FOLDERS = ("native/python/basicrt", "addon", "tools")


def cpp_files() -> list[Path]:
    """The C++ files that clang-format looks after."""
    suffixes = {".h", ".cpp", ".inl"}
    return sorted(
        p for name in CPP_FOLDERS for p in (ROOT / name).rglob("*") if p.suffix in suffixes
    )


def checks() -> dict[str, Command]:
    """Each check's name and command; a command that exits with 0 has nothing to say against the sources."""
    bin_folder = bootstrap.ensure_venv("dev").parent
    typed = [ROOT / name for name in TYPED_FOLDERS if any((ROOT / name).rglob("*.py"))]
    commands: dict[str, Command] = {
        "layers": [sys.executable, ROOT / "tools/check_layers.py"],
        "licences": [sys.executable, ROOT / "tools/check_licence_lines.py"],
        "ruff": [bin_folder / "ruff", "check", "--quiet", "."],
        "ruff-format": [bin_folder / "ruff", "format", "--diff", "."],
        "mypy": [bin_folder / "mypy", *typed],
        "docs": [bin_folder / "mkdocs", "build", "--quiet", "--strict"],
    }
    if cpp_files():
        commands["clang-format"] = [
            bin_folder / "clang-format",
            "--dry-run",
            "-Werror",
            *cpp_files(),
        ]
    return commands


def fix() -> None:
    """Apply the formatters and ruff's safe corrections."""
    bin_folder = bootstrap.ensure_venv("dev").parent
    run([bin_folder / "ruff", "check", "--fix", "--exit-zero", "."])
    run([bin_folder / "ruff", "format", "."])
    if cpp_files():
        run([bin_folder / "clang-format", "-i", *cpp_files()])
        say(f"formatted {len(cpp_files())} C++ files in {', '.join(CPP_FOLDERS)}")


def main() -> int:
    """Run the checks one by one, or fix."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fix", action="store_true")
    arguments = parser.parse_args()
    try:
        if arguments.fix:
            fix()
            return 0
        failed = []
        for name, command in checks().items():
            say(name)
            try:
                run(command)
            except ToolError:
                failed.append(name)
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    if failed:
        say(f"failed in {relative(ROOT)}: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
