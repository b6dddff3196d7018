# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes against Cycles: the same picture in expectation, region by region.

Cycles is made neutral (no clamping, no glossy filter, no denoising, no adaptive sampling, no shifted
shadow rays). Both engines render several seeds; regions' means may differ by what the seeds' scatter
explains and a share for what else there is.
"""

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import make_cycles_neutral, render

SCENES = Path(__file__).resolve().parents[2] / "scenes" / "blender"
SEEDS = 6
SAMPLES = (
    128  # Cycles' first sample is at the pixel's centre: with few of them it is biased at edges
)
REGIONS = 4  # along each side

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]


def region_means(picture: np.ndarray) -> np.ndarray:
    """(REGIONS * REGIONS, 3) means over equal rectangles."""
    rows = np.array_split(picture[..., :3].astype(float), REGIONS, axis=0)
    return np.array(
        [part.mean(axis=(0, 1)) for row in rows for part in np.array_split(row, REGIONS, axis=1)]
    )


def render_seeds(scene: Any, engine: str, folder: Path) -> np.ndarray:
    """(SEEDS, regions, 3)."""
    scene.render.engine = engine
    means = []
    for seed in range(SEEDS):
        scene.basicrt.seed = scene.cycles.seed = seed
        means.append(region_means(render(folder)))
    return np.array(means)


@pytest.mark.parametrize(
    ("name", "percentage"),
    [("cornell_glass", 12), ("materials", 12), ("lights", 10), ("instances", 12)],
)
def test_demo_scene_is_as_in_cycles(name: str, percentage: int, tmp_path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    scene = bpy.context.scene
    scene.render.resolution_percentage = percentage
    scene.basicrt.samples = SAMPLES
    make_cycles_neutral(scene)
    ours = render_seeds(scene, "BASICRT", tmp_path)
    theirs = render_seeds(scene, "CYCLES", tmp_path)
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    variance = ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)
    # Caustics make seeds' scatter a poor estimate in single regions: not less than a quarter of the mean one.
    error = np.sqrt(np.maximum(variance, variance.mean() / 16) / SEEDS)
    tolerance = 5 * error + 0.01 * theirs.mean(axis=0)
    worst = np.unravel_index((np.abs(difference) / tolerance).argmax(), difference.shape)
    print(
        f"{name}: whole picture {ours.mean() / theirs.mean() - 1:+.3%} "
        f"± {math.sqrt(variance.mean() / SEEDS / variance.size) / theirs.mean():.3%}, "
        f"worst region {worst}: {difference[worst] / theirs.mean(axis=0)[worst]:+.2%}"
    )
    assert (np.abs(difference) <= tolerance).all(), f"region {worst} differs by {difference[worst]}"
