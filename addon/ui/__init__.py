# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: BasicRT's own, and Blender's that suit it."""

from __future__ import annotations

from . import (
    aov_panel,
    bake_panels,
    core_panels,
    light_group_panels,
    light_linking_panels,
    panels,
)


def register() -> None:
    """Show the panels."""
    panels.register()
    bake_panels.register()
    aov_panel.register()
    light_group_panels.register()
    light_linking_panels.register()
    core_panels.register()


def unregister() -> None:
    """Hide them again."""
    core_panels.unregister()
    light_linking_panels.unregister()
    light_group_panels.unregister()
    aov_panel.unregister()
    bake_panels.unregister()
    panels.unregister()
