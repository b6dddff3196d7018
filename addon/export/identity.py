# SPDX-License-Identifier: GPL-3.0-or-later
"""What tells Blender's datablocks apart."""

from __future__ import annotations

import functools
from typing import Any

import bpy


def random_number(b_instance: bpy.types.DepsgraphObjectInstance) -> float:
    """In [0, 1]: what Object Info calls random; of an object that is no instance, a hash of its name."""
    if b_instance.is_instance:
        return b_instance.random_id % 2**32 / 0xFFFFFFFF
    b_object: Any = b_instance.object
    return _random_of_name(b_object.name)


@functools.lru_cache(1 << 16)
def _random_of_name(name: str) -> float:
    hashed = 0
    for byte in name.encode():
        hashed = (hashed * 37 + byte) % 2**32
    return _mixed(hashed, 0) / 0xFFFFFFFF


def _mixed(x: int, y: int) -> int:
    """Jenkins 2006, lookup3, of two words."""
    a = b = c = (0xDEADBEEF + (2 << 2) + 13) % 2**32
    a, b = (a + x) % 2**32, (b + y) % 2**32
    for turns in (14, 11, 25, 16, 4, 14, 24):
        c = ((c ^ b) - (b << turns | b >> (32 - turns))) % 2**32
        a, b, c = b, c, a
    return b


def uid(b_id: bpy.types.ID) -> int:
    """The number of a datablock or of the original of its evaluated copy, which has none of its own."""
    original: Any = b_id.original
    return int(original.session_uid)
