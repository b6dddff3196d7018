# SPDX-License-Identifier: GPL-3.0-or-later
"""Each BSDF against Cycles: balls of many materials under a soft sun and an even sky, part by part.

A ball shows its material from every angle. Both engines render several seeds; the mean of a quarter of a ball
may differ by what the seeds' scatter explains, and a share for what is known to differ.
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
    render,
    set_world,
)
from support.cycles import assert_quarters_agree

COLUMNS, PIXELS = 6, 16  # balls in a row, and pixels along the side of a ball's square
SEEDS, SAMPLES = 4, 96

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]

TINT, EDGE = (0.8, 0.4, 0.1), (0.9, 0.5, 0.7)
DIFFUSE, GLOSSY = "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfAnisotropic"
METALLIC, GLASS = "ShaderNodeBsdfMetallic", "ShaderNodeBsdfGlass"
SUBSURFACE = "ShaderNodeSubsurfaceScattering"
WALK, SKIN = {"falloff": "RANDOM_WALK"}, {"falloff": "RANDOM_WALK_SKIN"}
SHEEN, TOON, PRINCIPLED = "ShaderNodeBsdfSheen", "ShaderNodeBsdfToon", "ShaderNodeBsdfPrincipled"

# name: the node, its properties, its inputs, and the share by which a quarter of the ball may differ.
BALLS: dict[str, tuple[str, dict[str, str], dict[str, Any], float]] = {
    "diffuse": (DIFFUSE, {}, {"Color": TINT}, 0.01),
    "diffuse, roughness .3": (DIFFUSE, {}, {"Color": TINT, "Roughness": 0.3}, 0.01),
    "diffuse, roughness 1": (DIFFUSE, {}, {"Color": TINT, "Roughness": 1.0}, 0.01),
    "translucent": ("ShaderNodeBsdfTranslucent", {}, {"Color": TINT}, 0.01),
    "sheen .2": (SHEEN, {}, {"Color": TINT, "Roughness": 0.2}, 0.01),
    "sheen .7": (SHEEN, {}, {"Color": TINT, "Roughness": 0.7}, 0.01),
    "sheen, Ashikhmin": (SHEEN, {"distribution": "ASHIKHMIN"}, {"Roughness": 0.5}, 0.01),
    "toon, diffuse": (TOON, {}, {"Size": 0.5, "Smooth": 0.2}, 0.01),
    "toon, glossy": (TOON, {"component": "GLOSSY"}, {"Size": 0.3, "Smooth": 0.2}, 0.01),
    "glossy, anisotropy .6": (GLOSSY, {}, {"Roughness": 0.5, "Anisotropy": 0.6}, 0.01),
    "glossy, anisotropy -.6, turned": (
        GLOSSY,
        {"distribution": "GGX"},
        {"Roughness": 0.5, "Anisotropy": -0.6, "Rotation": 0.1},
        0.01,
    ),
    "Ashikhmin and Shirley": (
        GLOSSY,
        {"distribution": "ASHIKHMIN_SHIRLEY"},
        {"Roughness": 0.5, "Anisotropy": 0.3},
        0.01,
    ),
    "metallic, edge tint": (
        METALLIC,
        {},
        {"Base_Color": TINT, "Edge_Tint": (0.2, 0.9, 0.4), "Roughness": 0.3},
        0.01,
    ),
    "metallic, stretched": (
        METALLIC,
        {},
        {"Roughness": 0.5, "Anisotropy": 0.8, "Rotation": 0.2},
        0.01,
    ),
    "metallic, measured": (
        METALLIC,
        {"fresnel_type": "PHYSICAL_CONDUCTOR"},
        {"IOR": (0.2, 0.9, 1.1), "Extinction": (3.9, 2.4, 2.1), "Roughness": 0.4},
        0.01,
    ),
    # The sensitivities behind thin films are analytic fits, Cycles' are tabulated.
    "metallic, film": (METALLIC, {}, {"Roughness": 0.3, "Thin_Film_Thickness": 350.0}, 0.03),
    "metallic, measured, film": (
        METALLIC,
        {"fresnel_type": "PHYSICAL_CONDUCTOR"},
        {"Roughness": 0.3, "Thin_Film_Thickness": 500.0},
        0.03,
    ),
    "glass, film": (GLASS, {}, {"Roughness": 0.3, "Thin_Film_Thickness": 400.0}, 0.03),
    "principled, rough diffuse": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Diffuse_Roughness": 1.0},
        0.01,
    ),
    "principled, sheen": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Sheen_Weight": 0.8, "Sheen_Tint": EDGE, "Sheen_Roughness": 0.4},
        0.01,
    ),
    "principled, coat": (
        PRINCIPLED,
        {},
        {
            "Base_Color": TINT,
            "Coat_Weight": 0.8,
            "Coat_Roughness": 0.2,
            "Coat_IOR": 1.8,
            "Coat_Tint": EDGE,
        },
        0.01,
    ),
    # Cycles' tables of what a rough dielectric reflects hold facets' reflectance without their shadowing: at a
    # roughness of .7 a coat leaves some percent more, which a dark colour shows.
    "principled, rough coat on metal": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Metallic": 1.0, "Coat_Weight": 1.0, "Coat_Roughness": 0.7},
        0.03,
    ),
    "principled, layered and shining": (
        PRINCIPLED,
        {},
        {
            "Base_Color": TINT,
            "Coat_Weight": 1.0,
            "Sheen_Weight": 1.0,
            "Emission_Color": EDGE,
            "Emission_Strength": 0.5,
        },
        0.01,
    ),
    "principled, specular tint": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Specular_Tint": EDGE, "Specular_IOR_Level": 0.9, "Roughness": 0.3},
        0.01,
    ),
    "principled, metal with edge tint": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Metallic": 0.8, "Specular_Tint": EDGE, "Roughness": 0.4},
        0.01,
    ),
    "principled, stretched": (
        PRINCIPLED,
        {},
        {
            "Base_Color": TINT,
            "Metallic": 0.5,
            "Anisotropic": 0.7,
            "Anisotropic_Rotation": 0.15,
            "Roughness": 0.5,
        },
        0.01,
    ),
    "principled, tinted glass": (
        PRINCIPLED,
        {},
        {
            "Base_Color": EDGE,
            "Transmission_Weight": 1.0,
            "Specular_Tint": TINT,
            "Roughness": 0.3,
        },
        0.015,
    ),
    "principled, film": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Roughness": 0.2, "Thin_Film_Thickness": 450.0},
        0.03,
    ),
    "principled, film on metal": (
        PRINCIPLED,
        {},
        {"Base_Color": TINT, "Metallic": 1.0, "Roughness": 0.2, "Thin_Film_Thickness": 300.0},
        0.03,
    ),
    "subsurface, wide": (SUBSURFACE, WALK, {"Color": TINT, "Scale": 0.7, "Roughness": 1.0}, 0.01),
    "subsurface, narrow": (SUBSURFACE, WALK, {"Color": TINT, "Scale": 0.05, "IOR": 1.8}, 0.01),
    "subsurface, forward": (
        SUBSURFACE,
        WALK,
        {"Color": TINT, "Scale": 0.5, "Anisotropy": 0.7},
        0.01,
    ),
    "subsurface, bright": (SUBSURFACE, WALK, {"Color": (0.97, 0.9, 0.8), "Scale": 0.2}, 0.01),
    "subsurface, one colour": (SUBSURFACE, WALK, {"Color": TINT, "Radius": (1, 0, 0)}, 0.01),
    "subsurface, skin": (SUBSURFACE, SKIN, {"Color": TINT, "Scale": 0.3}, 0.01),
    "principled, subsurface": (
        PRINCIPLED,
        {"subsurface_method": "RANDOM_WALK"},
        {
            "Base_Color": TINT,
            "Subsurface_Weight": 0.7,
            "Subsurface_Scale": 0.5,
            "Roughness": 0.3,
            "Specular_IOR_Level": 0.8,
        },
        0.01,
    ),
    "principled, skin": (
        PRINCIPLED,
        {"subsurface_method": "RANDOM_WALK_SKIN"},
        {
            "Base_Color": TINT,
            "Subsurface_Weight": 1.0,
            "Subsurface_Scale": 0.2,
            "Subsurface_IOR": 1.6,
            "Subsurface_Anisotropy": 0.3,
        },
        0.01,
    ),
}


def add_ball(index: int, material: Any) -> None:
    """A smooth ball in its square, turned so that its axes are no one else's."""
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=48,
        ring_count=24,
        radius=0.47,
        location=(index % COLUMNS + 0.5, index // COLUMNS + 0.5, 0),
        rotation=(0.5, 0.3, 0.2),
    )
    ball: Any = bpy.context.object
    ball.data.shade_smooth()
    ball.data.materials.append(material)


def make_scene() -> tuple[Any, int]:
    """All balls, seen from above, and how many rows they make."""
    rows = -(-len(BALLS) // COLUMNS)
    scene = new_scene(COLUMNS * PIXELS, rows * PIXELS, SAMPLES)
    add_camera((COLUMNS / 2, rows / 2, 5), (0, 0, 0), "ORTHO", ortho_scale=max(COLUMNS, rows))
    add_lamp("SUN", (0, 0, 5), (0.7, 0.5, 0), energy=2, angle=0.4)
    set_world((0.3, 0.35, 0.4))
    for index, (name, (bl_idname, properties, inputs, _)) in enumerate(BALLS.items()):
        material = new_material(bl_idname, name, **inputs)
        node: Any = next(n for n in material.node_tree.nodes if n.bl_idname == bl_idname)
        for key, value in properties.items():
            setattr(node, key, value)
        add_ball(index, material)
    # Light that goes from ball to ball is no matter of this test.
    scene.basicrt.max_bounces = 2
    scene.basicrt.diffuse_bounces = scene.basicrt.glossy_bounces = 0
    make_cycles_neutral(scene)
    return scene, rows


def quarters(scene: Any, engine: str, rows: int, folder: Path) -> np.ndarray:
    """(SEEDS, balls, 4, 3) means of balls' quarters."""
    scene.render.engine = engine
    means = []
    for seed in range(SEEDS):
        scene.basicrt.seed = scene.cycles.seed = seed
        picture = render(folder)[..., :3].astype(float)
        half = PIXELS // 2
        blocks = picture.reshape(rows, 2, half, COLUMNS, 2, half, 3).mean(axis=(2, 5))
        balls = blocks.transpose(0, 2, 1, 3, 4).reshape(-1, 4, 3)
        means.append(balls[: len(BALLS)])
    return np.array(means)


@pytest.fixture(scope="module")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> tuple[np.ndarray, np.ndarray]:
    folder = tmp_path_factory.mktemp("bsdfs")
    scene, rows = make_scene()
    ours = quarters(scene, "BASICRT", rows, folder)
    return ours, quarters(scene, "CYCLES", rows, folder)


@pytest.mark.parametrize("name", BALLS)
def test_ball_is_as_in_cycles(name: str, rendered: tuple[np.ndarray, np.ndarray]) -> None:
    index = list(BALLS).index(name)
    ours, theirs = (picture[:, index] for picture in rendered)
    assert_quarters_agree(name, ours, theirs, BALLS[name][3])
