# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading scene files."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from . import _native
from ._native import Scene
from .images import read_combined


def load_scene(
    path: str | os.PathLike[str], *, override: str | Mapping[str, Any] | None = None
) -> Scene:
    """The scene of a JSON file; docs/scene_format.md describes it. Relative paths in it are relative to the file.

    `override`, JSON text or a mapping, is merged into the file's JSON first (RFC 7386). Raises SceneError: for
    malformed JSON with line and column, for an unknown key with the nearest valid name. Warns with SceneWarning.
    """
    text = override if isinstance(override, str) else json.dumps(override) if override else ""
    return _native.load_scene(path, text, read_combined)
