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

# Blender version -> the Python its `bpy` wheel is built for.
BLENDERS = {"4.2": "3.11", "4.5": "3.11", "5.0": "3.11", "5.2": "3.13"}
# In order of preference: the first one found runs the linters, the demo and the tests without Blender.
PYTHON_VERSIONS = ("3.11", "3.13")
MINIMUM_CMAKE = (3, 22)

# Names on Debian 12 and later and on Ubuntu 22.04 and later.
BUILD_PACKAGES = (
    "libgtest-dev",
    "libopenexr-dev",
    "libimath-dev",
    "libstb-dev",
    "libtinyobjloader-dev",
    "nlohmann-json3-dev",
)
BLENDER_PACKAGES = (
    "libegl1",
    "libgl1",
    "libgl1-mesa-dri",
    "libgomp1",
    "libsm6",
    "libxfixes3",
    "libxi6",
    "libxkbcommon0",
    "libxrender1",
    "libxxf86vm1",
)


# ---- system packages ---------------------------------------------------------------------------


def missing_packages(names: tuple[str, ...]) -> list[str]:
    """The Debian packages among `names` that are not installed."""
    result = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *names],
        capture_output=True,
        text=True,
        check=False,
    )
    installed = {
        line.split()[0] for line in result.stdout.splitlines() if line.endswith(" installed")
    }
    return [name for name in names if name not in installed]


def apt_prefix() -> list[str] | None:
    """How to call apt-get with the right to install, or None when we have no such right."""
    if os.geteuid() == 0:
        return []
    if shutil.which("sudo") and output_of(["sudo", "-n", "true"]) is not None:
        return ["sudo", "-n"]
    return None


def install_packages(names: tuple[str, ...], purpose: str) -> None:
    """Install the missing ones through apt, or stop and name them."""
    if not shutil.which("dpkg-query"):
        say(
            f"this is not Debian or Ubuntu: make sure you have what these packages hold: {' '.join(names)}"
        )
        return
    missing = missing_packages(names)
    if not missing:
        return
    command = f"apt-get install --no-install-recommends {' '.join(missing)}"
    prefix = apt_prefix()
    if prefix is None:
        raise ToolError(
            f"{purpose} needs system packages. Install them with\n\n    sudo {command}\n\n"
            "and run this again."
        )
    say(f"installing system packages for {purpose}: {' '.join(missing)}")
    apt = [
        *prefix,
        "env",
        "DEBIAN_FRONTEND=noninteractive",
        "apt-get",
        "-qq",
        "-o",
        "DPkg::Lock::Timeout=300",
    ]
    run([*apt, "update"], quiet=True)
    run([*apt, "install", "-y", "--no-install-recommends", *missing], quiet=True)


@functools.cache
def ensure_system() -> None:
    """Everything from the system's own packages, a compiler apart, that any command here uses."""
    with locked("system"):
        install_packages(BUILD_PACKAGES, "compiling BasicRT")
        install_packages(BLENDER_PACKAGES, "running Blender's Python module")
    if not any(shutil.which(name) for name in ("c++", "g++", "clang++")):
        raise ToolError("no C++ compiler found: install g++ 12 or clang++ 15, or newer")


# ---- Python versions ---------------------------------------------------------------------------


def python_candidates(wanted: str) -> Iterator[Path]:
    """Places where a Python of this version may be, the likeliest first; some may not run."""
    yield Path(sys.executable)
    name = f"python{wanted}"
    for entry in os.environ.get("PATH", "").split(os.pathsep):
        yield Path(entry) / name
    for folder, pattern in (
        (Path.home(), f".pyenv/versions/{wanted}*/bin/{name}"),
        (Path.home(), f".local/share/uv/python/cpython-{wanted}*/bin/{name}"),
        (VENVS, f"python/cpython-{wanted}*/bin/{name}"),
        (Path("/usr/local"), f"bin/{name}"),
    ):
        yield from sorted(folder.glob(pattern))


PROBE = """
import importlib.util, pathlib, sys, sysconfig
header = pathlib.Path(sysconfig.get_path("include")) / "Python.h"
has_venv = bool(importlib.util.find_spec("ensurepip"))
print("%d.%d" % sys.version_info[:2], int(header.is_file()), int(has_venv),
      getattr(sys, "_base_executable", sys.executable))
"""


@functools.cache
def probe(python: Path) -> tuple[str, bool, Path] | None:
    """(version, has headers and venv, the interpreter itself); None when it does not run."""
    answer = output_of([python, "-c", PROBE]) if python.is_file() else None
    if not answer:
        return None
    found, has_header, has_venv, executable = answer.split(maxsplit=3)
    return found, has_header == "1" and has_venv == "1", Path(executable)


@functools.cache
def find_python(wanted: str) -> Path | None:
    """A Python of exactly this minor version that can make virtual environments and compile modules."""
    incomplete = None
    for candidate in python_candidates(wanted):
        answer = probe(candidate)
        if answer and answer[0] == wanted:
            if answer[1]:
                return answer[2]
            incomplete = answer[2]
    if incomplete and shutil.which("dpkg-query") and incomplete.is_relative_to("/usr/bin"):
        # Debian and Ubuntu split Python: headers and `venv` are packages of their own.
        install_packages((f"python{wanted}-dev", f"python{wanted}-venv"), f"Python {wanted}")
        return incomplete
    return None


@functools.cache
def available_pythons() -> tuple[str, ...]:
    """Those of PYTHON_VERSIONS that this machine has; if none, one is fetched."""
    with locked("system"):
        found = tuple(wanted for wanted in PYTHON_VERSIONS if find_python(wanted))
        return found or (fetch_python(),)


def fetch_python() -> str:
    """Let the `uv` tool download a Python for the project alone: last resort where none fits Blender."""
    wanted = PYTHON_VERSIONS[0]
    say(
        f"Blender's Python module needs Python {' or '.join(PYTHON_VERSIONS)}, "
        f"and none is here: fetching {wanted}"
    )
    try:
        tool = VENVS / "uv"
        run([sys.executable, "-m", "venv", tool])
        run([tool / "bin" / "python", "-m", "pip", "install", "--quiet", "uv"])
        run(
            [
                tool / "bin" / "uv",
                "python",
                "install",
                "--no-bin",
                "--install-dir",
                VENVS / "python",
                wanted,
            ]
        )
    except ToolError as error:
        raise ToolError(
            f"{error}\nInstall Python {wanted} (on Ubuntu: from the deadsnakes archive, or with pyenv or uv) "
            f"as `python{wanted}` and run this again."
        ) from error
    find_python.cache_clear()
    return wanted


def primary_python() -> str:
    """The Python version used wherever any would do."""
    return available_pythons()[0]


def demo_blender() -> str:
    """The Blender version for the demo: 5.0, or 5.2 where only Python 3.13 is available."""
    return "5.0" if "3.11" in available_pythons() else "5.2"


# ---- virtual environments ----------------------------------------------------------------------


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
    answer = output_of(["cmake", "--version"]) or ""
    match = re.search(r"version (\d+)\.(\d+)", answer)
    has_cmake = (
        bool(match) and tuple(int(part) for part in match.groups()) >= MINIMUM_CMAKE
        if match
        else False
    )
    return (() if has_cmake else ("cmake",)) + (() if shutil.which("ninja") else ("ninja",))


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


# ---- the command -------------------------------------------------------------------------------


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
