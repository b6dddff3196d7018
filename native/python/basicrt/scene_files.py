# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading scene files."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import Scene, SceneError
from .images import read_exr


def load_scene(
    path: str | os.PathLike[str], *, override: str | Mapping[str, Any] | None = None
) -> Scene:
    """The scene of a JSON file; docs/scene_format.md describes it. Relative paths in it are relative to the file.

    `override`, JSON text or a mapping, is merged into the file's JSON first (RFC 7386). Raises SceneError: for
    malformed JSON with line and column, for an unknown key with the nearest valid name. Warns with SceneWarning.
    """
    text = override if isinstance(override, str) else json.dumps(override) if override else ""
    return _native.load_scene(path, text, _read_texture)


def _read_texture(path: str | os.PathLike[str]) -> npt.NDArray[np.float32]:
    pictures = read_exr(path)
    if "Combined" not in pictures:
        raise SceneError(f"{Path(path)}: has no channels R, G and B")
    return pictures["Combined"]
