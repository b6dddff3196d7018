# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays of vectors, in their last axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of length 1, or zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    made: NDArray[np.float64] = np.divide(
        vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0.0
    )
    return made
