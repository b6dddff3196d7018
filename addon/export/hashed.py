# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of curves and points, by their places in an array."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def random_numbers(count: int) -> NDArray[np.float32]:
    """(count,) in [0, 1], the same as Cycles has.

    Jenkins 2006, lookup3, of two words: the place and 0.
    """
    start = np.uint32((0xDEADBEEF + (2 << 2) + 13) % 2**32)
    a = np.arange(count, dtype=np.uint32) + start
    b, c = np.full(count, start), np.full(count, start)
    for turns in (14, 11, 25, 16, 4, 14, 24):
        turned = (b << np.uint32(turns)) | (b >> np.uint32(32 - turns))
        c = (c ^ b) - turned
        a, b, c = b, c, a
    return (b / np.float64(0xFFFFFFFF)).astype(np.float32)
