# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can do beside rendering."""

from __future__ import annotations

from . import export_scene


def register() -> None:
    """Add the operators and their menu entries."""
    export_scene.register()


def unregister() -> None:
    """Take them away."""
    export_scene.unregister()
