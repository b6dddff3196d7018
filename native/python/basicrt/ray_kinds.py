# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rays see an instance, as in Blender's Ray Visibility."""

from enum import IntFlag


class RayKind(IntFlag):
    """Bits of Instance.visibility: those of native/src/math/ray.h."""

    CAMERA = 1 << 0
    DIFFUSE = 1 << 1
    GLOSSY = 1 << 2
    TRANSMISSION = 1 << 3
    VOLUME = 1 << 4
    SHADOW = 1 << 5
    ALL = (1 << 32) - 1
