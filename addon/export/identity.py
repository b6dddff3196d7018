# SPDX-License-Identifier: GPL-3.0-or-later
"""What tells Blender's datablocks apart."""

from __future__ import annotations

from typing import Any

import bpy


def uid(b_id: bpy.types.ID) -> int:
    """The number of a datablock or of the original of its evaluated copy, which has none of its own."""
    original: Any = b_id.original
    return int(original.session_uid)
