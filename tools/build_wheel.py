# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the `basicrt` wheel into dist/, once per Python version, again only when its sources changed.

tools/build_wheel.py                     for every Python of this machine that Blender may have
tools/build_wheel.py --python 3.13       for one of them
tools/build_wheel.py --headers ROOT      for the Python whose headers are under ROOT/usr/include,
                                         without running it (ROOT may be another system's folder)
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import os
import re
import shutil
import sys
import sysconfig
import zipfile
from pathlib import Path

import bootstrap
import pythons
from project import (
    DIST,
    ROOT,
    ToolError,
    build_environment,
    digest,
    files_under,
    generator,
    is_fresh,
    output_of,
    pip,
    relative,
    run,
    say,
    version,
    write_stamp,
)

SOURCES = ("CMakeLists.txt", "cmake", "native", "addon", "pyproject.toml", "LICENSE")


def sources_key(*words: str) -> str:
    """A hash of everything that goes into a wheel."""
    return digest(files_under(*SOURCES), *words)


def wheel_path(python_version: str) -> Path:
    """Where the wheel for a Python version is, or will be."""
    tag = "cp" + python_version.replace(".", "")
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return DIST / f"basicrt-{version()}-{tag}-{tag}-{platform}.whl"


def build_core() -> Path:
    """The core library, compiled once for all wheels in the folder of `cmake --preset release`."""
    bootstrap.ensure_build_tools()
    build = ROOT / "build"
    with bootstrap.locked("core"):
        if not (build / "CMakeCache.txt").exists():
            run(["cmake", "--preset", "release", *generator(build)], quiet=True)
        run(["cmake", "--build", build, "--target", "basicrt_core"], quiet=True)
    return build / "native" / "libbasicrt_core.a"


def build_wheel(python_version: str) -> Path:
    """The up-to-date wheel for one of this machine's Pythons."""
    bootstrap.ensure_system()
    python = bootstrap.ensure_venv(f"build-{python_version}")
    wheel = wheel_path(python_version)
    with bootstrap.locked(f"wheel-{python_version}"):
        stamp, key = DIST / f".{wheel.name}.stamp", sources_key(python_version)
        if wheel.exists() and is_fresh(stamp, key):
            return wheel
        say(f"building {relative(wheel)}")
        environment = build_environment()
        environment["PATH"] = os.pathsep.join([str(python.parent), environment["PATH"]])
        core = f"cmake.define.BASICRT_CORE={build_core()}"
        options: list[str | Path] = [
            "--no-deps",
            "--no-build-isolation",
            "-C",
            core,
            "-w",
            DIST,
            ROOT,
        ]
        run([*pip(python, "wheel"), *options], environment=environment, quiet=True)
        write_stamp(stamp, key)
    return wheel


def install_wheel(venv: str) -> Path:
    """Make sure `.venv/<venv>` exists and holds the up-to-date wheel; its Python."""
    wheel = build_wheel(bootstrap.python_for(venv))
    python = bootstrap.ensure_venv(venv)
    with bootstrap.locked(venv):
        stamp, key = python.parent.parent / "wheel.stamp", digest([wheel])
        if not is_fresh(stamp, key):
            say(f"installing {wheel.name} into .venv/{venv}")
            run([*pip(python, "install"), "--no-deps", "--force-reinstall", wheel], quiet=True)
            write_stamp(stamp, key)
    return python


# ---- for a Python that cannot be run here ------------------------------------------------------


def foreign_python(root: Path) -> tuple[str, str]:
    """(version, suffix of extension modules) of the Python whose headers are under `root`."""
    for data in sorted(root.glob("usr/lib/python3.*/_sysconfigdata__*.py")):
        suffix = re.search(r"'EXT_SUFFIX': '([^']+)'", data.read_text(encoding="utf-8"))
        found = re.search(r"python(3\.\d+)", str(data.parent))
        if suffix and found and (root / "usr/include" / found[0] / "Python.h").exists():
            return found[1], suffix[1]
    raise ToolError(f"{root}: no Python headers under usr/include")


def collect_headers(root: Path, python_version: str, folder: Path) -> list[Path]:
    """Links to that Python's headers alone, so that nothing else of the other system is found."""
    shutil.rmtree(folder, ignore_errors=True)
    name = f"python{python_version}"
    folder.mkdir(parents=True)
    (folder / name).symlink_to(root / "usr/include" / name)
    for configured in (root / "usr/include").glob(
        f"*/{name}"
    ):  # Debian: pyconfig.h per architecture
        (folder / configured.parent.name).mkdir()
        (folder / configured.parent.name / name).symlink_to(configured)
    return [folder / name, folder]


def build_foreign_wheel(root: Path) -> Path:
    """A wheel for the Python under `root`: the module is compiled anew, the rest is the local wheel's."""
    python_version, suffix = foreign_python(root)
    donor = build_wheel(pythons.primary_python())
    wheel = wheel_path(python_version)
    with bootstrap.locked(f"wheel-{python_version}"):
        stamp, key = DIST / f".{wheel.name}.stamp", sources_key(python_version, str(root), suffix)
        if wheel.exists() and is_fresh(stamp, key):
            return wheel
        say(f"building {relative(wheel)} from the headers in {root}")
        build = ROOT / f"build-wheel/foreign-{python_version}"
        include, parent = collect_headers(root, python_version, build / "headers")
        environment = build_environment()
        build_python = bootstrap.python_of(f"build-{pythons.primary_python()}")
        environment["PATH"] = os.pathsep.join([str(build_python.parent), environment["PATH"]])
        # To CMake this is cross-compiling: there is no interpreter to ask. Modules link no Python
        # library; one by name keeps CMake from taking the version from the local Python's.
        library = build / f"libpython{python_version}.so"
        library.touch()
        definitions = {
            "CMAKE_BUILD_TYPE": "Release",
            "CMAKE_SYSTEM_NAME": "Linux",
            "CMAKE_CXX_FLAGS": f"-isystem {parent}",
            "PYBIND11_USE_CROSSCOMPILING": "ON",
            "PYTHON_MODULE_EXTENSION": suffix,
            "Python_INCLUDE_DIR": str(include),
            "Python_LIBRARY": str(library),
            "pybind11_DIR": output_of([build_python, "-m", "pybind11", "--cmakedir"]),
            "BASICRT_BUILD_PYTHON": "ON",
            "BASICRT_CORE": str(build_core()),
            "BASICRT_BUILD_RENDERER": "OFF",
            "BASICRT_BUILD_TESTS": "OFF",
            "BASICRT_BUILD_BENCHMARKS": "OFF",
        }
        flags = [f"-D{name}={value}" for name, value in definitions.items()]
        run(["cmake", "-S", ROOT, "-B", build, *flags], environment=environment, quiet=True)
        run(["cmake", "--build", build, "--target", "_native"], environment=environment, quiet=True)
        repack(donor, wheel, next(build.rglob(f"_native*{suffix}")))
        write_stamp(stamp, key)
    return wheel


def repack(donor: Path, wheel: Path, module: Path) -> None:
    """Write `wheel`: the donor's files with another compiled module, and its own tags."""
    tags = "-".join(wheel.stem.split("-")[2:])
    records: list[str] = []
    partial = wheel.with_suffix(".part")
    with (
        zipfile.ZipFile(donor) as source,
        zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as target,
    ):

        def add(name: str, data: bytes) -> None:
            sha = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            records.append(f"{name},sha256={sha},{len(data)}")
            target.writestr(name, data)

        for name in source.namelist():
            data = source.read(name)
            if name.startswith("basicrt/_native.") and name.endswith(".so"):
                add(f"basicrt/{module.name}", module.read_bytes())
            elif name.endswith(".dist-info/WHEEL"):
                add(name, re.sub(rb"(?m)^Tag: .*$", f"Tag: {tags}".encode(), data))
            elif not name.endswith((".dist-info/RECORD", "/")):
                add(name, data)
        record = f"basicrt-{version()}.dist-info/RECORD"
        target.writestr(record, "\n".join([*records, f"{record},,", ""]))
    partial.replace(wheel)


def main() -> int:
    """Build what the arguments ask for and print the paths."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--python", action="append", metavar="3.N", help="only for this version (repeatable)"
    )
    parser.add_argument("--headers", action="append", type=Path, default=[], metavar="ROOT")
    arguments = parser.parse_args()
    try:
        local = arguments.python or ([] if arguments.headers else pythons.available_pythons())
        wheels = [build_wheel(wanted) for wanted in local]
        wheels += [build_foreign_wheel(root.resolve()) for root in arguments.headers]
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    print(*map(relative, wheels), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
