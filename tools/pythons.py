# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the Python versions that Blender's wheels need, wherever they are installed."""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from project import VENVS, Command, ToolError, output_of, run, say
from system_packages import is_debian, is_offered

# In order of preference: the first one found serves wherever any would do.
PYTHON_VERSIONS = ("3.11", "3.13")


@dataclass(frozen=True)
class Python:
    """An interpreter that runs."""

    version: str
    executable: Path
    is_complete: bool  # can make virtual environments and compile modules


PROBE = """
import importlib.util, pathlib, sys, sysconfig
has_headers = (pathlib.Path(sysconfig.get_path("include")) / "Python.h").is_file()
has_venv = bool(importlib.util.find_spec("ensurepip"))
print("%d.%d" % sys.version_info[:2], int(has_headers and has_venv),
      getattr(sys, "_base_executable", sys.executable))
"""


def probe(path: Path) -> Python | None:
    """What is at `path`; None when it does not run (a pyenv shim may not)."""
    answer = output_of([path, "-c", PROBE]) if path.is_file() else None
    if not answer:
        return None
    version, is_complete, executable = answer.split(maxsplit=2)
    return Python(version, Path(executable), is_complete == "1")


def candidates(version: str) -> Iterator[Path]:
    """Places where a Python of this version may be, the likeliest first."""
    name = f"python{version}"
    yield Path(sys.executable)
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        yield Path(folder) / name
    for root, pattern in (
        (Path.home(), f".pyenv/versions/{version}*/bin/{name}"),
        (Path.home(), f".local/share/uv/python/cpython-{version}*/bin/{name}"),
        (VENVS, f"python/cpython-{version}*/bin/{name}"),
        (Path("/usr"), f"local/bin/{name}"),
    ):
        yield from sorted(root.glob(pattern))


@functools.cache
def look_for(version: str) -> Python | None:
    """A Python of exactly this minor version; a complete one if there is any."""
    incomplete = None
    for path in candidates(version):
        found = probe(path)
        if found and found.version == version:
            if found.is_complete:
                return found
            incomplete = incomplete or found
    return incomplete


def find_python(version: str) -> Path | None:
    """The interpreter of this version that environments are made with and modules compiled for."""
    found = look_for(version)
    return found.executable if found and found.is_complete else None


@functools.cache
def available_pythons() -> tuple[str, ...]:
    """Those of PYTHON_VERSIONS that this machine has."""
    return tuple(version for version in PYTHON_VERSIONS if find_python(version))


def primary_python() -> str:
    """The Python version used wherever any would do."""
    if not available_pythons():
        raise ToolError(f"no Python {' or '.join(PYTHON_VERSIONS)} here")
    return available_pythons()[0]


def needed_packages() -> list[str]:
    """Packages that make the system's own Python usable.

    Debian and Ubuntu split it: headers and `venv` are packages of their own.
    """
    found = [look_for(version) for version in PYTHON_VERSIONS]
    versions = [p.version for p in found if p and not p.is_complete and is_debians_own(p)]
    if not any(found):
        versions = [version for version in PYTHON_VERSIONS if is_offered(f"python{version}")][:1]
    packages = [f"python{version}{part}" for version in versions for part in ("-dev", "-venv")]
    return packages if any(found) or packages else ["python3-venv"]


def is_debians_own(python: Python) -> bool:
    """Whether apt can complete this Python."""
    return is_debian() and python.executable.resolve().is_relative_to("/usr/bin")


def forget() -> None:
    """Look again, after something was installed."""
    look_for.cache_clear()
    available_pythons.cache_clear()


def fetch_python() -> None:
    """Let `uv` download a Python for this project alone: the last resort where none fits Blender."""
    wanted = PYTHON_VERSIONS[0]
    say(f"Blender needs Python {' or '.join(PYTHON_VERSIONS)}, and none is here: fetching {wanted}")
    uv = VENVS / "uv"
    install: Command = ["python", "install", "--install-dir", VENVS / "python", wanted]
    try:
        run([sys.executable, "-m", "venv", uv], quiet=True)
        run([uv / "bin" / "python", "-m", "pip", "install", "--quiet", "uv"], quiet=True)
        run([uv / "bin" / "uv", *install], quiet=True)
    except ToolError as error:
        raise ToolError(
            f"{error}\nInstall Python {wanted} as `python{wanted}` (on Ubuntu from the deadsnakes "
            "archive, anywhere with pyenv or uv) and run this again."
        ) from error
    forget()
