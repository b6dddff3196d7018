# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDFs on strands against Cycles: thick curves of many materials under a soft sun and an even sky.

As test_bsdfs.py does with balls: the mean of a quarter of a strand's square may differ by what the
seeds' scatter explains, and a share for what is known to differ.
"""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import (
    add_camera,
    add_lamp,
    make_cycles_neutral,
    new_material,
    new_scene,
    place,
    render,
    set_world,
)
from support.cycles import assert_quarters_agree

PIXELS = 16  # along the side of a strand's square
SEEDS, SAMPLES = 4, 256

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]

PRINCIPLED, HAIR = "ShaderNodeBsdfHairPrincipled", "ShaderNodeBsdfHair"
TINT = (0.6, 0.3, 0.1)
CHIANG = {"model": "CHIANG", "parametrization": "COLOR"}

# name: the node, its properties, its inputs, and the share by which a quarter may differ.
STRANDS: dict[str, tuple[str, dict[str, str], dict[str, Any], float]] = {
    "diffuse": ("ShaderNodeBsdfDiffuse", {}, {"Color": TINT}, 0.01),
    "glossy": ("ShaderNodeBsdfAnisotropic", {}, {"Color": TINT, "Roughness": 0.5}, 0.01),
    "hair, colour": (PRINCIPLED, CHIANG, {"Color": TINT}, 0.01),
    "hair, rough": (
        PRINCIPLED,
        CHIANG,
        {"Color": TINT, "Roughness": 0.7, "Radial_Roughness": 0.6},
        0.01,
    ),
    "hair, tilted": (PRINCIPLED, CHIANG, {"Color": TINT, "Offset": 0.3, "IOR": 1.7}, 0.01),
    "hair, absorption": (
        PRINCIPLED,
        {"model": "CHIANG", "parametrization": "ABSORPTION"},
        {"Absorption_Coefficient": (0.1, 0.5, 2.0)},
        0.01,
    ),
    "hair, melanin": (
        PRINCIPLED,
        {"model": "CHIANG", "parametrization": "MELANIN"},
        {"Melanin": 0.4, "Melanin_Redness": 0.3, "Tint": (0.9, 0.5, 0.7)},
        0.01,
    ),
    "hair, random": (
        PRINCIPLED,
        {"model": "CHIANG", "parametrization": "MELANIN"},
        {"Melanin": 0.3, "Random_Color": 0.8, "Random_Roughness": 0.5},
        0.01,
    ),
    "hair, coat": (PRINCIPLED, CHIANG, {"Color": TINT, "Coat": 0.5}, 0.02),
    # At the fibre's edges highlights reach behind the surface that is seen, where Cycles' lamps don't see them.
    "reflection": (
        HAIR,
        {"component": "Reflection"},
        {"Color": TINT, "Offset": 0.2, "RoughnessV": 0.4},
        0.07,
    ),
    "wide reflection": (HAIR, {"component": "Reflection"}, {"Color": TINT}, 0.07),
    "transmission": (
        HAIR,
        {"component": "Transmission"},
        {"Color": TINT, "RoughnessU": 0.3, "RoughnessV": 0.5},
        0.01,
    ),
}


def make_scene(shape: str) -> Any:
    """All strands side by side, seen from above."""
    scene = new_scene(len(STRANDS) * PIXELS, PIXELS, SAMPLES)
    scene.cycles_curves.shape = shape
    add_camera((len(STRANDS) / 2, 0.5, 5), (0, 0, 0), "ORTHO", ortho_scale=len(STRANDS))
    add_lamp("SUN", (0, 0, 5), (0.7, 0.5, 0), energy=2, angle=0.4)
    set_world((0.3, 0.35, 0.4))
    for index, (name, (bl_idname, properties, inputs, _)) in enumerate(STRANDS.items()):
        material = new_material(bl_idname, name, **inputs)
        node: Any = next(n for n in material.node_tree.nodes if n.bl_idname == bl_idname)
        for key, value in properties.items():
            setattr(node, key, value)
        # Its ends, which are round here and open there, are out of sight.
        curves: Any = bpy.data.hair_curves.new(name)
        curves.add_curves([5])
        points = [(index + 0.45 + 0.02 * i, -1.0 + 0.75 * i, 0.1 * i) for i in range(5)]
        curves.attributes["position"].data.foreach_set(
            "vector", np.array(points, np.float32).ravel()
        )
        radii = curves.attributes.new("radius", "FLOAT", "POINT")
        radii.data.foreach_set("value", [0.35] * 5)
        curves.materials.append(material)
        place(curves)
    # Light that goes from strand to strand is no matter of this test.
    scene.basicrt.max_bounces = 2
    scene.basicrt.diffuse_bounces = scene.basicrt.glossy_bounces = 0
    make_cycles_neutral(scene)
    return scene


def quarters(scene: Any, engine: str, folder: Path) -> np.ndarray:
    """(SEEDS, strands, 4, 3) means of the squares' quarters."""
    scene.render.engine = engine
    means = []
    for seed in range(SEEDS):
        scene.basicrt.seed = scene.cycles.seed = seed
        picture = render(folder)[..., :3].astype(float)
        half = PIXELS // 2
        blocks = picture.reshape(2, half, len(STRANDS), 2, half, 3).mean(axis=(1, 4))
        means.append(blocks.transpose(1, 0, 2, 3).reshape(len(STRANDS), 4, 3))
    return np.array(means)


@pytest.fixture(scope="module", params=["THICK", "RIBBONS"])
def rendered(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[np.ndarray, np.ndarray]:
    folder = tmp_path_factory.mktemp("hair")
    scene = make_scene(request.param)
    return quarters(scene, "BASICRT", folder), quarters(scene, "CYCLES", folder)


@pytest.mark.parametrize("name", STRANDS)
def test_strand_is_as_in_cycles(name: str, rendered: tuple[np.ndarray, np.ndarray]) -> None:
    index = list(STRANDS).index(name)
    ours, theirs = (picture[:, index] for picture in rendered)
    assert_quarters_agree(name, ours, theirs, STRANDS[name][3])
