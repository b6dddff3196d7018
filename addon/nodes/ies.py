# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads photometric files as ANSI/IES LM-63 has them: how much light a luminaire sends where."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Candela into the watts that a lamp of the same intensity has in Blender: all around, of the white D65, which gives
# 177.83 lm to the watt.
_WATTS_PER_CANDELA = 4.0 * math.pi / 177.83
_TYPES = {1: "C", 2: "B", 3: "A"}
_TILT = re.compile(r"^[ \t]*TILT[ \t]*=[ \t]*(.*?)[ \t]*$", re.IGNORECASE | re.MULTILINE)

Angles = NDArray[np.float64]


class IesError(ValueError):
    """The file is not as the standard has it."""


@dataclass(frozen=True)
class Photometry:
    """A luminaire's light over the sphere.

    horizontal (H,) and vertical (V,) in radians, ascending: about z from -y towards -x, and from -z; values (H, V) in
    the watts of Blender's lamps.
    """

    horizontal: Angles
    vertical: Angles
    values: NDArray[np.float64]


def parse(text: str) -> Photometry:
    """What a file says. Raises IesError, saying what is wrong with it."""
    tilt = _TILT.search(text)
    if tilt is None:
        raise IesError("it has no line TILT=")
    numbers = _numbers(text[tilt.end() :])
    if tilt[1].upper() == "INCLUDE":
        next(numbers)  # how the lamp is placed
        _take(numbers, 2 * _count(next(numbers), "tilt angles"))
    _lamps, _lumens, factor = _take(numbers, 3)
    vertical_count = _count(next(numbers), "vertical angles")
    horizontal_count = _count(next(numbers), "horizontal angles")
    kind = _TYPES.get(int(next(numbers)))
    if kind is None:
        raise IesError("its photometric type is none of 1, 2 and 3")
    _unit, _width, _length, _height, ballast, future, _watts = _take(numbers, 7)
    vertical = np.array(_take(numbers, vertical_count))
    horizontal = np.array(_take(numbers, horizontal_count))
    candela = np.array(_take(numbers, horizontal_count * vertical_count))
    values = candela.reshape(horizontal_count, vertical_count)
    for name, angles in (("vertical", vertical), ("horizontal", horizontal)):
        if (np.diff(angles) < 0.0).any():
            raise IesError(f"its {name} angles don't ascend")
    horizontal, vertical, values = _AS_SPHERES[kind](horizontal, vertical, values)
    scale = factor * ballast * future * _WATTS_PER_CANDELA
    scaled = values * scale
    if not (np.abs(scaled) < np.finfo(np.float32).max).all():
        raise IesError("its values are too large")
    return Photometry(np.radians(horizontal), np.radians(vertical), scaled)


def _numbers(text: str) -> Iterator[float]:
    """All numbers, one by one; IesError where something else or nothing stands."""
    for word in text.replace(",", " ").split():
        try:
            number = float(word)
        except ValueError:
            raise IesError(f'"{word[:20]}" is not a number') from None
        if not math.isfinite(number):
            raise IesError(f'"{word[:20]}" is not finite')
        yield number
    raise IesError("it ends too early")


def _take(numbers: Iterator[float], count: int) -> list[float]:
    return [next(numbers) for _ in range(count)]


def _count(number: float, what: str) -> int:
    if not 1 <= number <= 1e6 or number != int(number):
        raise IesError(f"it can't have {number:g} {what}")
    return int(number)


# ---- each type's angles as those of Photometry, in degrees ----------------------------------------

Sphere = tuple[Angles, Angles, NDArray[np.float64]]


def _is_near(a: float, b: float) -> bool:
    return abs(a - b) < 1e-4


def _mirrored(angles: Angles, values: NDArray[np.float64], axis: int) -> tuple[Angles, Angles]:
    """From 0 to 90 degrees and back on the other side, or from -90 on: moved to begin at 0."""
    if not _is_near(angles[0], 0.0):
        return angles + 90.0, values
    other = np.flip(np.delete(values, 0, axis), axis)
    return np.concatenate([90.0 - angles[:0:-1], 90.0 + angles]), np.concatenate(
        [other, values], axis
    )


def _type_a(horizontal: Angles, vertical: Angles, values: NDArray[np.float64]) -> Sphere:
    """Automotive: both angles from the beam, which is level."""
    turned, rows = 180.0 - horizontal[::-1], values[::-1]
    if _is_near(horizontal[0], 0.0):
        turned = np.concatenate([turned, 180.0 + horizontal[1:]])
        rows = np.concatenate([rows, values[1:]])
    return turned, vertical + 90.0, rows


def _type_b(horizontal: Angles, vertical: Angles, values: NDArray[np.float64]) -> Sphere:
    """Floodlights: the axis is level; as Blender has it, it is stood up and the lamp may be turned."""
    across, rows = _mirrored(vertical, values.T, 0)
    up, rows = _mirrored(horizontal, rows, 1)
    return across, up, rows


def _type_c(horizontal: Angles, vertical: Angles, values: NDArray[np.float64]) -> Sphere:
    """Most luminaires: about the axis that points down. Symmetric ones have a part of the circle."""
    if _is_near(horizontal[0], 90.0):
        horizontal = horizontal - 90.0
    if len(horizontal) == 1:
        return np.array([0.0, 360.0]), vertical, np.repeat(values, 2, axis=0)
    for half in (90.0, 180.0):
        if _is_near(horizontal[-1], half):
            horizontal = np.concatenate([horizontal, 2.0 * half - horizontal[-2::-1]])
            values = np.concatenate([values, values[-2::-1]])
    gap = 360.0 - horizontal[-1]
    steps = horizontal[1] - horizontal[0], horizontal[-1] - horizontal[-2]
    # Some files leave out the last angle, which is the first again.
    if _is_near(horizontal[0], 0.0) and gap > 1e-4 and any(_is_near(step, gap) for step in steps):
        horizontal = np.append(horizontal, 360.0)
        values = np.concatenate([values, values[:1]])
    return horizontal, vertical, values


_AS_SPHERES = {"A": _type_a, "B": _type_b, "C": _type_c}
