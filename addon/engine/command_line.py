# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's command line says behind `--`: settings of this process, which no file keeps."""

from __future__ import annotations

import argparse
import difflib
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

import bpy

from ..report import ExportError

if TYPE_CHECKING:
    import basicrt

_PREFIX = "--basicrt-"
_STRICT = f"{_PREFIX}strict"
_MEMORY_LIMIT = f"{_PREFIX}memory-limit"


@dataclass(frozen=True)
class Overrides:
    """Settings that count before a scene's own and its view layers'; what is None stays as the scene has it."""

    samples: int | None = None
    seed: int | None = None
    threads: int | None = None  # 0 is one for each processor
    samples_from: int | None = None
    samples_to: int | None = None
    memory_limit: float | None = None  # GB of 2^30 bytes; 0 is none
    fails_on_warnings: bool = False

    def apply(self, settings: basicrt.RenderSettings, b_scene: bpy.types.Scene) -> None:
        """Put them into exported settings; threads, memory and warnings are none."""
        from ..export.settings import seed_of_frame

        if self.samples is not None:
            settings.samples = self.samples
        if self.seed is not None:
            settings.seed = seed_of_frame(self.seed, b_scene)
        if self.samples_from is not None:
            settings.samples_from = self.samples_from
        if self.samples_to is not None:
            settings.samples_to = self.samples_to


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise ExportError(message.removeprefix("argument "))


def _whole_number(least: int, most: int) -> Callable[[str], int]:
    def convert(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = least - 1
        if not least <= number <= most:
            raise argparse.ArgumentTypeError(
                f'must be a whole number from {least} to {most}, is "{text}"'
            )
        return number

    return convert


def _gigabytes(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1
    if not 0 <= number < math.inf:
        raise argparse.ArgumentTypeError(f'must be a number of GB, at least 0, is "{text}"')
    return number


# Each with the least and the most that it may be.
_LIMITS = {
    "samples": (1, 1 << 24),
    "seed": (0, (1 << 31) - 1),
    "threads": (0, 1024),
    "samples_from": (0, 1 << 24),
    "samples_to": (1, 1 << 24),
}


def parse(arguments: Sequence[str]) -> Overrides:
    """Of a whole command line what is ours: behind `--`, and begins with `--basicrt-`.

    Raises ExportError for a flag or a value that there can't be; others' flags are left alone.
    """
    parser = _Parser(add_help=False, allow_abbrev=False)
    for name, limits in _LIMITS.items():
        parser.add_argument(_flag(name), dest=name, type=_whole_number(*limits), metavar="NUMBER")
    parser.add_argument(_MEMORY_LIMIT, dest="memory_limit", type=_gigabytes, metavar="GB")
    parser.add_argument(_STRICT, dest="fails_on_warnings", action="store_true")
    behind = arguments[arguments.index("--") + 1 :] if "--" in arguments else ()
    known, others = parser.parse_known_args(behind)
    for other in others:
        if other.startswith(_PREFIX):
            raise ExportError(_unknown(other.partition("=")[0]))
    return Overrides(**vars(known))


def _flag(name: str) -> str:
    return _PREFIX + name.replace("_", "-")


def _unknown(flag: str) -> str:
    flags = [*map(_flag, _LIMITS), _MEMORY_LIMIT, _STRICT]
    nearest = difflib.get_close_matches(flag, flags, n=1, cutoff=0.8)
    advice = f"did you mean {nearest[0]}?" if nearest else f"there are {', '.join(flags)}"
    return f"{flag}: unknown option; {advice}"


def overrides() -> Overrides:
    """Those of this process. Raises ExportError."""
    return parse(sys.argv)


def check() -> None:
    """End a Blender that runs without windows where its command line is wrong, with exit status 1.

    It would fail once for each frame. One with windows, or in another program, fails when it renders.
    """
    if bpy.app.background and bpy.app.binary_path:
        try:
            overrides()
        except ExportError as error:
            sys.exit(f"BasicRT: {error}")
