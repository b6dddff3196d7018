# SPDX-License-Identifier: GPL-3.0-or-later
"""Noisy pictures of ours and of the Cycles in the same Blender, and how alike their means are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .blender import new_scene, render

SEEDS = 4


def neutral_scene(size: int = 16, samples: int = 64) -> Any:
    """A scene whose Cycles settings, which both engines read, are neutral."""
    scene = new_scene(size, size)
    scene.basicrt.property_unset("samples")
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    return scene


def both(scene: Any, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Ours and Cycles' pictures: (seeds, height, width, 4)."""
    pictures = []
    for engine in ("BASICRT", "CYCLES"):
        scene.render.engine = engine
        pictures.append(pictures_of(scene, folder))
    return pictures[0], pictures[1]


def pictures_of(scene: Any, folder: Path) -> np.ndarray:
    """One for each seed: (seeds, height, width, 4)."""
    stack = []
    for seed in range(SEEDS):
        scene.cycles.seed = seed
        stack.append(render(folder).astype(float))
    return np.array(stack)


def expect_alike(ours: np.ndarray, theirs: np.ndarray, relative: float, cells: int = 4) -> None:
    """Means over cells agree within the seeds' scatter and a share of the picture's mean."""
    count, height, width, channels = ours.shape
    means = [
        p.reshape(count, cells, height // cells, cells, width // cells, channels).mean(axis=(2, 4))
        for p in (ours, theirs)
    ]
    difference = means[0].mean(axis=0) - means[1].mean(axis=0)
    variance = sum(m.var(axis=0, ddof=1) for m in means)
    error = np.sqrt(np.maximum(variance, variance.mean() / 4) / count)
    tolerance = 5 * error + relative * np.abs(means[1]).mean()
    worst = np.unravel_index((np.abs(difference) / tolerance).argmax(), difference.shape)
    assert (np.abs(difference) <= tolerance).all(), (
        f"cell {worst}: {means[0].mean(axis=0)[worst]:.5g}, Cycles {means[1].mean(axis=0)[worst]:.5g}"
    )


def assert_quarters_agree(name: str, ours: np.ndarray, theirs: np.ndarray, allowed: float) -> None:
    """Of something's (seeds, 4, 3) means of quarters: but for the noise, and an allowed share of them."""
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    variance = ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)
    # Of few seeds, a single quarter's scatter is a poor estimate.
    error = np.sqrt(np.maximum(variance, variance.mean()) / len(ours))
    tolerance = 5 * error + allowed * theirs.mean(axis=0)
    worst = np.unravel_index((np.abs(difference) / tolerance).argmax(), difference.shape)
    print(
        f"{name}: all of it {ours.mean() / theirs.mean() - 1:+.3%}, worst quarter "
        f"{difference[worst] / theirs.mean(axis=0)[worst]:+.2%} ± {error[worst] / theirs.mean(axis=0)[worst]:.2%}"
    )
    assert (np.abs(difference) <= tolerance).all(), (
        f"quarter {worst} differs by {difference[worst]}"
    )
