# SPDX-License-Identifier: GPL-3.0-or-later
"""BasicRT as a Blender Extension: registers the render engine BASICRT with its settings and panels."""

from __future__ import annotations

from . import engine, operators, preferences, properties, ui

# Lowest layer first; taken down in the opposite order.
_LAYERS = (properties, preferences, engine, operators, ui)


def register() -> None:
    """Called by Blender when the extension is enabled."""
    for layer in _LAYERS:
        layer.register()


def unregister() -> None:
    """Called by Blender when the extension is disabled; leaves nothing of it behind."""
    for layer in reversed(_LAYERS):
        layer.unregister()
