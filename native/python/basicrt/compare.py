# SPDX-License-Identifier: GPL-3.0-or-later
"""How much two pictures differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._native import SceneError
from .images import Picture


@dataclass(frozen=True)
class Difference:
    """Of two pictures; `flip` is None where flip-evaluator is not installed."""

    mse: float
    relmse: float
    flip: float | None


def compare(picture: Picture, reference: Picture) -> Difference:
    """The differences of two Combined passes of the same size; alpha does not count. Raises SceneError."""
    a, b = _rgb(picture), _rgb(reference)
    if a.shape != b.shape:
        raise SceneError(f"pictures of unlike sizes: {_size(a)} and {_size(b)}")
    return Difference(mse(a, b), relmse(a, b), flip(a, b))


def mse(picture: Picture, reference: Picture) -> float:
    """The mean squared difference of all channels. NaN where a value is not finite."""
    difference = picture.astype(np.float64) - reference
    return float(np.mean(difference**2))


def relmse(picture: Picture, reference: Picture) -> float:
    """The mean of squared differences over squared reference values, with 0.01 added to these for the dark ones.

    As in Rousselle et al. 2011, "Adaptive sampling and reconstruction using greedy error minimization".
    """
    target = reference.astype(np.float64)
    return float(np.mean((picture - target) ** 2 / (target**2 + 1e-2)))


def flip(picture: Picture, reference: Picture) -> float | None:
    """The mean HDR-FLIP error in [0, 1] (Andersson et al. 2021), or None without flip-evaluator.

    NaN where a value is not finite. Negative values count as 0, as FLIP needs it.
    """
    try:
        import flip_evaluator
    except ImportError:
        return None
    if not (np.isfinite(picture).all() and np.isfinite(reference).all()):
        return float("nan")
    a, b = (np.ascontiguousarray(np.maximum(p, 0), dtype=np.float32) for p in (picture, reference))
    # FLIP takes its exposures from the reference, and ends the process where that is black.
    parameters = {} if b.any() else {"startExposure": 0.0, "stopExposure": 0.0}
    return float(flip_evaluator.evaluate(b, a, "HDR", applyMagma=False, parameters=parameters)[1])


def _rgb(picture: Picture) -> Picture:
    if picture.ndim != 3 or picture.shape[2] < 3:
        raise SceneError(f"needs (height, width, 3 or 4) values, has {picture.shape}")
    return picture[..., :3]


def _size(picture: Picture) -> str:
    return f"{picture.shape[1]} x {picture.shape[0]}"
