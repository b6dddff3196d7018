# SPDX-License-Identifier: GPL-3.0-or-later
"""More families of small scenes, with hair and points: see families.py."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
import stage
from families import ceiling_lamp, corner, family


def straws(points: Any, radius: float, material: bpy.types.Material) -> bpy.types.Object:
    """Curves of the same thickness all along: `points` is (curves, points, 3)."""
    points = np.asarray(points, np.float32)
    curves: Any = bpy.data.hair_curves.new("Straws")
    curves.add_curves([points.shape[1]] * len(points))
    curves.attributes["position"].data.foreach_set("vector", points.ravel())
    radii = np.full(points.shape[0] * points.shape[1], radius, np.float32)
    curves.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
    curves.materials.append(material)
    return stage.place(curves, "Straws")


@family
def bent_straws(scene: bpy.types.Scene) -> None:
    """Thick round arcs before the corner's box and ball, with their ends below the floor."""
    corner(scene)
    ceiling_lamp()
    angles = np.linspace(0, math.pi, 9)
    arcs = [
        [(x + 0.4 * math.cos(a), -1.2 - 0.2 * i, 1.4 * math.sin(a) - 0.3) for a in angles]
        for i, x in enumerate((-1.5, -0.7, 0.2, 1.1))
    ]
    straws(arcs, 0.09, stage.diffuse("Straw", (0.8, 0.5, 0.1)))
    scene.cycles_curves.shape = "THICK"


@family
def fur(scene: bpy.types.Scene) -> None:
    """Hair of a particle system on a ball: ribbons, with the Principled Hair BSDF."""
    corner(scene)
    ceiling_lamp()
    grown = stage.sphere("Grown", 0.35, (-0.2, -1.2, 0.5), stage.diffuse("Skin", (0.6, 0.4, 0.3)))
    hair = stage.new_material("Fur", "ShaderNodeBsdfHairPrincipled", Color=(0.6, 0.3, 0.1))
    node: Any = next(n for n in hair.node_tree.nodes if "Hair" in n.bl_idname)
    node.model, node.parametrization = "CHIANG", "COLOR"
    data: Any = grown.data
    data.materials.append(hair)
    grown.modifiers.new("Fur", "PARTICLE_SYSTEM")
    settings: Any = grown.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 300, 0.3
    settings.material, settings.radius_scale = 2, 0.03
    scene.cycles_curves.shape = "RIBBONS"
