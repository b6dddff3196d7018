# SPDX-License-Identifier: GPL-3.0-or-later
"""A booth for each kind of lamp, with a ball in it that throws a shadow; a low sun and a dim sky over all of them."""

from __future__ import annotations

import math

import bpy
import stage

WIDTH = 1.6
BOOTHS = 6


def build(scene: bpy.types.Scene) -> None:
    """Build it into an empty scene."""
    white = stage.diffuse("White", (0.7, 0.7, 0.7))
    blue = stage.diffuse("Blue", (0.2, 0.3, 0.6))
    half = WIDTH * BOOTHS / 2
    stage.rectangle("Floor", [(-half, -3, 0), (half, -3, 0), (half, 1, 0), (-half, 1, 0)], white)
    stage.rectangle("Back Wall", [(-half, 1, 0), (half, 1, 0), (half, 1, 2), (-half, 1, 2)], white)
    for index in range(BOOTHS + 1):
        stage.box(f"Partition {index}", (0.04, 2, 2), (index * WIDTH - half, 0, 0), 0, white)
    for index in range(BOOTHS):
        stage.sphere(f"Ball {index}", 0.3, (center_of(index), 0.2, 0.3), blue)
    build_lamps()
    stage.set_world((0.5, 0.7, 1.0), 0.03)
    stage.camera((0, -9, 2.2), (0, 0, 0.85), lens=32.0)
    stage.set_picture(scene, 800, 240, samples=128)


def center_of(booth: int) -> float:
    """The middle of a booth."""
    return (booth + 0.5 - BOOTHS / 2) * WIDTH


def build_lamps() -> None:
    """One in each booth, at the height of 1.7 m."""
    down = (0, 0, 0)

    def at(booth: int) -> tuple[float, float, float]:
        return center_of(booth), 0.0, 1.7

    stage.lamp("POINT", "Point", at(0), down, 25.0, shadow_soft_size=0.0)
    ball = stage.lamp(
        "POINT", "Ball Lamp", at(1), down, 25.0, shadow_soft_size=0.15, use_soft_falloff=False
    )
    ball.visible_camera = True
    stage.lamp(
        "SPOT",
        "Spot",
        at(2),
        (10, 0, 0),
        60.0,
        shadow_soft_size=0.05,
        spot_size=math.radians(50),
        spot_blend=0.4,
    )
    area = stage.lamp(
        "AREA", "Rectangle", at(3), down, 18.0, shape="RECTANGLE", size=0.9, size_y=0.2
    )
    area.visible_camera = True
    stage.lamp("AREA", "Disk", at(4), down, 18.0, shape="DISK", size=0.5, color=(1.0, 0.7, 0.4))
    stage.lamp(
        "AREA",
        "Narrow",
        at(5),
        down,
        8.0,
        shape="ELLIPSE",
        size=0.5,
        size_y=0.3,
        spread=math.radians(50),
    )
    stage.lamp(
        "SUN", "Sun", (0, -5, 5), (55, 0, 25), 0.4, angle=math.radians(2), color=(1.0, 0.8, 0.6)
    )
