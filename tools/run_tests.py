# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the stages of `make test`: a line for each with its time, the log of what failed, the sum at the end.

tools/run_tests.py                    all stages
tools/run_tests.py lint native        some of them
tools/run_tests.py --list             their names and what they do
"""

from __future__ import annotations

import argparse
import sys
import threading
import time

import bootstrap
from project import REPORTS, ToolError, relative, say
from stages import STAGES, Context, Counts, prefetch

# Without these, later stages would only repeat the same failure.
NEEDED_BY_ALL = {"wheels": {"stubs", "python", "extension", "blender", "executables", "readme"}}
# How much of a failed stage's log is shown; all of it is in the file.
LOG_LINES = 200


def run_stage(name: str, build_only: bool) -> Counts:
    """One stage, with its log shown if anything failed."""
    REPORTS.mkdir(parents=True, exist_ok=True)
    log_path = REPORTS / f"{name}.log"
    say(f"{name}: {(STAGES[name].__doc__ or '').strip()}")
    start = time.monotonic()
    with log_path.open("w", encoding="utf-8") as log:
        try:
            counts = STAGES[name](Context(name, log, build_only))
        except ToolError as error:
            log.write(f"{error}\n")
            counts = Counts(failed=1)
    if counts.failed:
        lines = log_path.read_text(encoding="utf-8", errors="replace").splitlines()
        print(*lines[-LOG_LINES:], sep="\n", flush=True)
    for note in counts.notes:
        print(f"   {note}")
    word = "FAILED" if counts.failed else "ok"
    seconds = time.monotonic() - start
    numbers = f"{counts.passed} passed, {counts.failed} failed, {counts.skipped} skipped"
    print(
        f"   {word:<6} {name:<12} {seconds:7.1f} s   {numbers}   log: {relative(log_path)}",
        flush=True,
    )
    return counts


def main() -> int:
    """Run what was asked for and add it up."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "stage", nargs="*", metavar="stage", help="stages to run, in the order given"
    )
    parser.add_argument("--build-only", action="store_true", help="compile, but run no C++ tests")
    parser.add_argument("--list", action="store_true", help="name the stages")
    arguments = parser.parse_args()
    if arguments.list:
        for name, stage in STAGES.items():
            print(f"{name:<12} {(stage.__doc__ or '').strip()}")
        return 0
    chosen = arguments.stage or list(STAGES)
    if unknown := [name for name in chosen if name not in STAGES]:
        parser.error(f"unknown stage {unknown[0]}; there are {', '.join(STAGES)}")

    start = time.monotonic()
    try:
        bootstrap.ensure_system()
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    if not arguments.stage:
        threading.Thread(target=prefetch, daemon=True).start()

    total = Counts()
    blocked: set[str] = set()
    for name in chosen:
        if name.split("-")[0] in blocked:
            print(f"   not run: {name}, because an earlier stage that it needs failed")
            total.add(Counts(skipped=1))
            continue
        counts = run_stage(name, arguments.build_only)
        if counts.failed:
            blocked |= NEEDED_BY_ALL.get(name, set())
        total.add(counts)
    say(f"all of it took {time.monotonic() - start:.0f} s")
    print(f"{total.passed} passed, {total.failed} failed, {total.skipped} skipped", flush=True)
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main())
