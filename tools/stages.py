# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of `make test`: what each one runs. run_tests.py runs them and adds up their counts."""

from __future__ import annotations

import os
import platform
import shlex
import signal
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import bootstrap
import lint
import pythons
import real_blenders
from build_extension import build_extension, build_repository
from build_wheel import build_foreign_wheel, build_wheel, install_wheel
from project import (
    DIST,
    REPORTS,
    ROOT,
    Command,
    ToolError,
    build_environment,
    generator,
    output_of,
)

# Longer than anything takes that is not stuck.
TIMEOUT_SECONDS = 30 * 60


@dataclass
class Counts:
    """How many checks passed, failed and were skipped, and why."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    notes: list[str] = field(default_factory=list)

    def add(self, other: Counts) -> None:
        """Add another's counts to these."""
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.notes += other.notes

    def add_check(self, succeeded: bool) -> bool:
        """Count one check; hands its result on."""
        self.passed += succeeded
        self.failed += not succeeded
        return succeeded


def skipped(reason: str) -> Counts:
    """The counts of a stage that could not run."""
    return Counts(skipped=1, notes=[reason])


@dataclass
class Context:
    """Where a stage writes, and what it was asked to do."""

    name: str
    log: IO[str]
    build_only: bool = False

    def execute(self, command: Command, environment: Mapping[str, str] | None = None) -> bool:
        """Run a command with its output in the log; whether it exited with 0."""
        words = [str(word) for word in command]
        self.log.write(f"$ {shlex.join(words)}\n")
        self.log.flush()
        process = subprocess.Popen(
            words,
            cwd=ROOT,
            env={**build_environment(), **(environment or {})},
            stdin=subprocess.DEVNULL,
            stdout=self.log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            status = process.wait(TIMEOUT_SECONDS)
        except BaseException as error:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            if not isinstance(error, subprocess.TimeoutExpired):
                raise
            self.log.write(f"\nstopped after {TIMEOUT_SECONDS} s\n")
            return False
        if status != 0:
            self.log.write(f"\nexit status {status}\n")
        return status == 0

    def report_file(self, part: str = "") -> Path:
        """A fresh JUnit report of this stage."""
        REPORTS.mkdir(parents=True, exist_ok=True)
        path = REPORTS / f"{self.name}{part}.xml"
        path.unlink(missing_ok=True)
        return path


Stage = Callable[[Context], Counts]


# ---- helpers -----------------------------------------------------------------------------------


def read_report(path: Path, succeeded: bool) -> Counts:
    """Counts from a JUnit report. A runner that failed without a failed test counts as one failure."""
    counts = Counts()
    if path.is_file():
        for suite in ElementTree.parse(path).getroot().iter("testsuite"):
            number = {
                key: int(suite.get(key, 0))
                for key in ("tests", "failures", "errors", "skipped", "disabled")
            }
            failed = number["failures"] + number["errors"]
            left_out = number["skipped"] + number["disabled"]
            counts.add(Counts(number["tests"] - failed - left_out, failed, left_out))
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            reason = case.find("skipped")
            if reason is not None:
                counts.notes.append(f"skipped {case.get('name')}: {reason.get('message', '')}")
    if not succeeded and counts.failed == 0:
        counts.failed = 1
    return counts


def worker_count() -> int:
    """How many processes tests are shared out to: renders of tests have two threads, but Blender itself one."""
    processors = os.cpu_count() or 1
    return max(min(processors, 2), processors // 2)


def files_with(mark: str, folders: Sequence[str]) -> list[str]:
    """Test files in which some test has a mark."""
    files = [path for name in folders for path in sorted((ROOT / name).rglob("test_*.py"))]
    found = [path for path in files if f"mark.{mark}" in path.read_text(encoding="utf-8")]
    return [str(path.relative_to(ROOT)) for path in found]


def pytest(context: Context, python: Path, folders: Sequence[str], *options: str) -> Counts:
    """Run pytest over those of the folders that exist."""
    present = [name for name in folders if any((ROOT / name).rglob("test_*.py"))]
    if not present:
        return skipped(f"no tests in {', '.join(folders)}")
    return run_pytest(context, context.report_file(), python, *options, *present)


def shared_pytest(context: Context, python: Path, folders: Sequence[str], *options: str) -> Counts:
    """The same in several processes, and then those tests that measure time in one."""
    sharing = ["-n", str(worker_count()), "--dist", "worksteal", "-m", "not alone"]
    counts = pytest(context, python, folders, *sharing, *options)
    if measuring := files_with("alone", folders):
        report = context.report_file("-alone")
        counts.add(run_pytest(context, report, python, "-m", "alone", *options, *measuring))
    return counts


def run_pytest(context: Context, report: Path, python: Path, *arguments: str) -> Counts:
    """One run of pytest."""
    environment = {"BASICRT_BUILD_DIR": str(ROOT / "build"), "PYTHONFAULTHANDLER": "1"}
    command: Command = [python, "-m", "pytest", "-q", "--durations=30", "--junitxml", report]
    return read_report(report, context.execute([*command, *arguments], environment))


def build_and_test(context: Context, preset: str, build: Path, prefix: Command = ()) -> Counts:
    """Configure, compile and run the C++ tests of one CMake preset."""
    bootstrap.ensure_build_tools()
    counts = Counts()
    configure = ["cmake", "--preset", preset, *generator(build)]
    compile_all: Command = [*prefix, "cmake", "--build", build]
    if not counts.add_check(context.execute(configure) and context.execute(compile_all)):
        return counts
    if not context.build_only:
        report = context.report_file()
        run_all: Command = [*prefix, "ctest", "--test-dir", build, "--output-junit", report]
        succeeded = context.execute([*run_all, "--output-on-failure"])
        counts.add(read_report(report, succeeded))
    return counts


# ---- stages ------------------------------------------------------------------------------------


def run_lint(context: Context) -> Counts:
    """Formatters, linters, types, layers."""
    counts = Counts()
    for name, command in lint.checks().items():
        if not counts.add_check(context.execute(command)):
            counts.notes.append(f"failed: {name}")
    return counts


def run_native(context: Context) -> Counts:
    """The C++ core, the renderer and the C++ tests."""
    return build_and_test(context, "release", ROOT / "build")


def run_asan(context: Context) -> Counts:
    """The C++ tests under the address and undefined-behaviour sanitizers."""
    return build_and_test(context, "asan", ROOT / "build-asan")


def run_tsan(context: Context) -> Counts:
    """The C++ tests under the thread sanitizer."""
    # Older thread sanitizers cannot cope with highly randomised addresses.
    command = ["setarch", platform.machine(), "-R"]
    return build_and_test(
        context,
        "tsan",
        ROOT / "build-tsan",
        command if output_of([*command, "true"]) is not None else (),
    )


def run_wheels(_context: Context) -> Counts:
    """One wheel per Python version."""
    counts = Counts()
    for version in pythons.PYTHON_VERSIONS:
        if version in pythons.available_pythons():
            counts.add_check(build_wheel(version).exists())
        else:
            counts.add(skipped(f"no Python {version} here"))
    return counts


def run_stubs(context: Context) -> Counts:
    """Whether the committed type stubs are those of the module."""
    counts = Counts()
    counts.add_check(context.execute([sys.executable, ROOT / "tools/generate_stubs.py", "--check"]))
    return counts


def run_python(context: Context) -> Counts:
    """The wheel without Blender: unit tests and golden images."""
    return shared_pytest(context, install_wheel("test"), ["tests/python", "tests/golden"])


def foreign_roots() -> list[Path]:
    """Folders of real Blenders whose Python none of ours can compile for."""
    found = []
    for root in real_blenders.roots():
        headers = next(root.glob("usr/include/python3.*/Python.h"), None)
        if (
            headers
            and headers.parent.name.removeprefix("python") not in pythons.available_pythons()
        ):
            found.append(root)
    return found


def run_extension(context: Context) -> Counts:
    """The installable zip with a wheel for each Python, checked by Blender's validator."""
    if not (ROOT / "addon" / "blender_manifest.toml").exists():
        return skipped("there is no addon/ yet")
    for version in usable_blenders():
        bootstrap.ensure_venv(f"bpy-{version}")
    wheels = [build_wheel(version) for version in pythons.available_pythons()]
    wheels += [build_foreign_wheel(root) for root in foreign_roots()]
    extension = build_extension(wheels)
    context.log.write(f"{extension}\n{build_repository(extension)}\n")
    return Counts(passed=1)


def usable_blenders() -> list[str]:
    """The Blender versions whose Python is here."""
    return [v for v, python in bootstrap.BLENDERS.items() if python in pythons.available_pythons()]


def extension_zip() -> dict[str, str]:
    """Tells the tests where the extension is."""
    zips = sorted(DIST.glob("basicrt-*.zip"), key=lambda path: path.stat().st_mtime)
    return {"BASICRT_EXTENSION": str(zips[-1])} if zips else {}


def blender_stage(version: str) -> Stage:
    """The tests inside Blender's Python module of one version."""

    def run_blender(context: Context) -> Counts:
        if version not in usable_blenders():
            return skipped(
                f"Blender {version} needs Python {bootstrap.BLENDERS[version]}, which is not here"
            )
        os.environ.update(extension_zip())
        return shared_pytest(
            context,
            install_wheel(f"bpy-{version}"),
            ["tests/blender"],
            "--ignore=tests/blender/executable",
        )

    run_blender.__doc__ = f"Inside Blender {version} as a Python module."
    return run_blender


def name_executables() -> bool:
    """Tell the tests which real Blenders there are; whether there are any."""
    os.environ["BASICRT_BLENDER"] = os.pathsep.join(real_blenders.commands())
    return bool(os.environ["BASICRT_BLENDER"])


def run_executables(context: Context) -> Counts:
    """Installed into real Blender executables."""
    if not name_executables():
        return skipped("no Blender executable: name some in BASICRT_BLENDER (separated by colons)")
    os.environ.update(extension_zip())
    return pytest(context, install_wheel("test"), ["tests/blender/executable"])


def run_readme(context: Context) -> Counts:
    """Every command in the README."""
    name_executables()
    return pytest(context, install_wheel("test"), ["tests/readme"])


STAGES: dict[str, Stage] = {
    "lint": run_lint,
    "native": run_native,
    "wheels": run_wheels,
    "stubs": run_stubs,
    "python": run_python,
    "extension": run_extension,
    **{f"blender-{version}": blender_stage(version) for version in ("5.0", "4.2", "4.5", "5.2")},
    "executables": run_executables,
    "asan": run_asan,
    "tsan": run_tsan,
    "readme": run_readme,
}


def prefetch() -> None:
    """Download the large things that later stages need, while earlier stages compile."""
    try:
        bootstrap.ensure_system()
        for version in usable_blenders():
            bootstrap.ensure_venv(f"bpy-{version}")
        real_blenders.roots()
    except ToolError as error:
        print(f"-- preparing Blender: {error}", file=sys.stderr)
