# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets up what the other commands need: system packages, Python versions, virtual environments, wheels.

Run alone (`make setup`) it prepares everything; the other tools call the functions for what they use.
Everything is done once and remembered by a hash of what it was made from.
"""

from __future__ import annotations

import argparse
import contextlib
import fcntl
import functools
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pythons
from project import (
    ROOT,
    VENVS,
    ToolError,
    digest,
    is_fresh,
    output_of,
    pip,
    relative,
    run,
    say,
    write_stamp,
)
from pythons import available_pythons, find_python, primary_python
from system_packages import BLENDER_PACKAGES, BUILD_PACKAGES, install_packages

# Blender version -> the Python its `bpy` wheel is built for.
BLENDERS = {"4.2": "3.11", "4.5": "3.11", "5.0": "3.11", "5.2": "3.13"}
MINIMUM_CMAKE = (3, 22)


@functools.cache
def ensure_system() -> None:
    """Everything that virtual environments cannot hold: system packages, a compiler, a Python."""
    with locked("system"):
        if install_packages([*BUILD_PACKAGES, *BLENDER_PACKAGES, *pythons.needed_packages()]):
            pythons.forget()
        if not pythons.available_pythons():
            pythons.fetch_python()
    if not any(shutil.which(name) for name in ("c++", "g++", "clang++")):
        raise ToolError("no C++ compiler found: install g++ 12 or clang++ 15, or newer")


def ensure_build_tools() -> None:
    """What compiles the core: the system's, and of CMake and Ninja what pip has to bring."""
    ensure_system()
    if missing_build_tools():
        ensure_venv("dev")


def demo_blender() -> str:
    """The Blender version for the demo: 5.0, or 5.2 where only Python 3.13 is available."""
    return "5.0" if "3.11" in available_pythons() else "5.2"


@contextlib.contextmanager
def locked(name: str) -> Iterator[None]:
    """Keep two commands (or threads) from preparing the same thing at once."""
    VENVS.mkdir(exist_ok=True)
    with (VENVS / f"{name}.lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


GROUP = """
import sys, tomllib
print("\\n".join(tomllib.load(open("pyproject.toml", "rb"))["dependency-groups"][sys.argv[1]]))
"""


def requirements(name: str, python: Path) -> list[str]:
    """What pip has to install into the environment `name`."""
    kind, _, which = name.partition("-")
    listed = subprocess.run(
        [python, "-c", GROUP, kind], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    blender = [f"bpy=={which}.*"] if kind == "bpy" else []
    tools = missing_build_tools() if kind in {"dev", "build"} else ()
    return [*blender, *listed, *tools]


@functools.cache
def missing_build_tools() -> tuple[str, ...]:
    """Of CMake and Ninja, what the system lacks or has too old; pip brings these."""
    entries = os.environ.get("PATH", "").split(os.pathsep)
    path = os.pathsep.join(entry for entry in entries if not Path(entry).is_relative_to(VENVS))
    cmake = shutil.which("cmake", path=path)
    answer = (output_of([cmake, "--version"]) if cmake else None) or ""
    match = re.search(r"version (\d+)\.(\d+)", answer)
    has_cmake = match is not None and (int(match[1]), int(match[2])) >= MINIMUM_CMAKE
    has_ninja = shutil.which("ninja", path=path) is not None
    return (() if has_cmake else ("cmake",)) + (() if has_ninja else ("ninja",))


def python_for(name: str) -> str:
    """The Python version of the environment `name`."""
    kind, _, which = name.partition("-")
    return {"bpy": BLENDERS.get(which, ""), "build": which}.get(kind) or primary_python()


def python_of(name: str) -> Path:
    """The interpreter in the environment `name` (made or not)."""
    return VENVS / name / "bin" / "python"


def ensure_venv(name: str) -> Path:
    """Make `.venv/<name>` (`dev`, `test`, `build-3.11`, `bpy-5.0`) if it is not up to date; its Python."""
    base = find_python(python_for(name))
    if base is None:
        raise ToolError(f".venv/{name} needs Python {python_for(name)}, which is not here")
    folder, python = VENVS / name, python_of(name)
    with locked(name):
        needed = requirements(name, base)
        key = digest([], str(base), *needed)
        stamp = folder / "requirements.stamp"
        if is_fresh(stamp, key) and python.exists():
            return python
        download = (
            " (Blender: some 350 MB to download, 1 GB on disk)" if name.startswith("bpy-") else ""
        )
        say(f"setting up {relative(folder)}{download}")
        run([base, "-m", "venv", folder], quiet=True)
        run(
            [*pip(python, "install"), *needed],
            quiet=True,
        )
        write_stamp(stamp, key)
    return python


def main() -> int:
    """Prepare what the arguments name, or everything."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "venv", nargs="*", help="virtual environments to make, such as dev or bpy-5.0"
    )
    arguments = parser.parse_args()
    try:
        ensure_system()
        everything = [
            f"bpy-{version}"
            for version, python in BLENDERS.items()
            if python in available_pythons()
        ]
        for name in arguments.venv or ["dev", "test", *everything]:
            ensure_venv(name)
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    say("everything that was asked for is set up")
    return 0


if __name__ == "__main__":
    sys.exit(main())
