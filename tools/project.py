# SPDX-License-Identifier: GPL-3.0-or-later
"""What every tool shares: the project's folders, running commands, and stamps that make second runs fast.

Uses the standard library only, because it runs before any virtual environment exists.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENVS = ROOT / ".venv"
DIST = ROOT / "dist"
REPORTS = ROOT / "build" / "reports"


if sys.version_info < (3, 10):  # noqa: UP036 (this runs with the user's own Python)
    sys.exit(
        "This needs Python 3.10 or newer (and finds 3.11 or 3.13 for Blender); try PYTHON=python3.11 make …"
    )


# The words of a command line.
Command = Sequence["str | Path"]


class ToolError(Exception):
    """Something the user has to know about; shown without a traceback."""


def say(message: str) -> None:
    """One plain line about what is being done, in order with the output of commands."""
    print(f"-- {message}", flush=True)


def relative(path: Path) -> str:
    """The path as a user in the project's folder would type it."""
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def version() -> str:
    """The project's version, from pyproject.toml."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    match = re.search(r'^version = "([^"]+)"', text, re.MULTILINE)
    if not match:
        raise ToolError("pyproject.toml: no version")
    return match.group(1)


def build_environment() -> dict[str, str]:
    """The environment for compilers: ccache when it is there, and one place for our own tools."""
    environment = dict(os.environ)
    environment["PATH"] = os.pathsep.join([environment.get("PATH", ""), str(VENVS / "dev" / "bin")])
    if shutil.which("ccache"):
        environment.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")
    for variable in ("CMAKE_BUILD_PARALLEL_LEVEL", "CTEST_PARALLEL_LEVEL"):
        environment.setdefault(variable, str(os.cpu_count() or 1))
    return environment


def generator(build: Path) -> list[str]:
    """The option that chooses Ninja for a new build folder."""
    is_new = not (build / "CMakeCache.txt").exists()
    found = shutil.which("ninja", path=build_environment()["PATH"])
    return ["-G", "Ninja"] if is_new and found else []


def run(
    command: Command,
    *,
    cwd: Path = ROOT,
    environment: Mapping[str, str] | None = None,
    quiet: bool = False,
) -> None:
    """Run a command; raise ToolError when it fails. `quiet` shows its output only then."""
    words = [str(word) for word in command]
    result = subprocess.run(
        words,
        cwd=cwd,
        env=dict(environment) if environment is not None else build_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE if quiet else None,
        stderr=subprocess.STDOUT if quiet else None,
        text=True,
        errors="replace",
        check=False,
    )
    if result.returncode != 0:
        if quiet:
            print(result.stdout, end="", flush=True)
        raise ToolError(f"exit status {result.returncode} from: {' '.join(words)}")


def pip(python: Path, action: str) -> list[str | Path]:
    """How to call pip quietly."""
    return [python, "-m", "pip", action, "--quiet", "--disable-pip-version-check"]


def output_of(command: Command) -> str | None:
    """What a command prints, or None when it cannot be run or fails."""
    try:
        result = subprocess.run(
            [str(word) for word in command],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return result.stdout.strip() if result.returncode == 0 else None


def files_under(*names: str) -> list[Path]:
    """Every file at or under the given paths of the project, sorted, without caches."""
    found: list[Path] = []
    for name in names:
        path = ROOT / name
        if path.is_file():
            found.append(path)
        found += [p for p in path.rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return sorted(found)


def digest(files: Iterable[Path], *words: str) -> str:
    """A hash of names and contents of files and of some words."""
    state = hashlib.sha256(repr(words).encode())
    for path in files:
        state.update(f"{relative(path)}\0".encode())
        state.update(hashlib.sha256(path.read_bytes()).digest())
    return state.hexdigest()


def is_fresh(stamp: Path, key: str) -> bool:
    """Whether `write_stamp` recorded this very key."""
    return stamp.is_file() and stamp.read_text(encoding="utf-8") == key


def write_stamp(stamp: Path, key: str) -> None:
    """Remember that what `key` stands for is done."""
    stamp.parent.mkdir(parents=True, exist_ok=True)
    stamp.write_text(key, encoding="utf-8")
