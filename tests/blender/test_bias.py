# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether both engines mean the same picture, over the scenes of scenes/blender/families.py, graphs.py and strands.py.

Each engine renders each scene with several seeds. A block of 16 x 16 pixels gives a Welch z score of the engines' means
over the seeds: over all blocks these must scatter like a normal distribution. `BASICRT_BIAS_SCALE=4` makes the pictures
larger, and with them the number of blocks and what a difference may hide in.
"""

import importlib
import math
import os
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import make_cycles_neutral, new_scene, render

SCENES = Path(__file__).resolve().parents[2] / "scenes" / "blender"
SCALE = int(os.environ.get("BASICRT_BIAS_SCALE", "1"))
SEEDS = 8
BLOCK = 16  # pixels along a side
ROUNDING = 1e-4  # of a block's brightness: what single precision may differ by

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]


def families() -> dict[str, Any]:
    """The functions that build the scenes."""
    sys.path.insert(0, str(SCENES))
    try:
        return dict(importlib.import_module("graphs").SCENES)
    finally:
        sys.path.remove(str(SCENES))


def block_means(picture: np.ndarray) -> np.ndarray:
    """The brightness of each block."""
    height, width = (n // BLOCK * BLOCK for n in picture.shape[:2])
    cut = picture[:height, :width, :3].astype(float).mean(axis=2)
    return cut.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean(axis=(1, 3)).ravel()


def render_seeds(scene: Any, engine: str, folder: Path) -> np.ndarray:
    """(SEEDS, blocks)"""
    scene.render.engine = engine
    blocks = []
    for seed in range(SEEDS):
        scene.basicrt.seed = scene.cycles.seed = seed
        blocks.append(block_means(render(folder)))
    return np.array(blocks)


def normal_scores(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Welch's t of each block, as the normal score that is as rare (Wallace's approximation)."""
    parts = [blocks.var(axis=0, ddof=1) / SEEDS for blocks in (ours, theirs)]
    rounding = (ROUNDING * theirs.mean(axis=0)) ** 2 + 1e-14
    variance = parts[0] + parts[1] + rounding
    freedom = variance**2 / ((parts[0] ** 2 + parts[1] ** 2) / (SEEDS - 1) + rounding**2)
    freedom = np.clip(freedom, SEEDS - 1, 1000)
    t = (ours.mean(axis=0) - theirs.mean(axis=0)) / np.sqrt(variance)
    z = np.sqrt(freedom * np.log1p(t**2 / freedom)) * (8 * freedom + 1) / (8 * freedom + 3)
    return np.copysign(z, t)


SCORES: dict[str, np.ndarray] = {}


@pytest.mark.parametrize("name", list(families()))
def test_family_is_as_in_cycles(name: str, tmp_path: Path) -> None:
    scene = new_scene()
    families()[name](scene)
    scene.render.resolution_x *= SCALE
    scene.render.resolution_y *= SCALE
    make_cycles_neutral(scene)
    ours, theirs = (render_seeds(scene, engine, tmp_path) for engine in ("BASICRT", "CYCLES"))
    SCORES[name] = normal_scores(ours, theirs)
    brightness = ours.mean() / theirs.mean() - 1
    error = math.hypot(*(b.mean(axis=1).std(ddof=1) / b.mean() for b in (ours, theirs)))
    error /= math.sqrt(SEEDS)
    print(
        f"{name}: brighter by {brightness:+.3%} ± {error:.3%}, "
        f"rms z {math.sqrt(np.mean(SCORES[name] ** 2)):.2f}, largest {np.abs(SCORES[name]).max():.1f}"
    )
    # By chance one of 1e5 scenes differs by so much more than 0.3 %, and one of 3e5 blocks has such a score.
    assert abs(brightness) < 0.003 + 4.4 * error
    assert np.abs(SCORES[name]).max() < 4.7


def test_scores_of_all_families_scatter_like_noise() -> None:
    if len(SCORES) < len(families()):
        pytest.skip("only together with all families")
    scores = np.concatenate(list(SCORES.values()))
    share = float(np.mean(np.abs(scores) > 2))
    rms = math.sqrt(np.mean(scores**2))
    print(f"{scores.size} blocks: |z| > 2 in {share:.1%}, rms {rms:.3f}")
    # Engines that mean the same have a share of 0.0455 and an rms of 1: these bounds are 4 standard deviations away,
    # taking the blocks of a picture for independent. By chance one run of 15 000 exceeds one of them.
    assert share < 0.0455 + 4 * math.sqrt(0.0455 * 0.9545 / scores.size)
    assert rms < 1 + 4 / math.sqrt(2 * scores.size)
