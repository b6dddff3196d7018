# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can do beside rendering."""

from __future__ import annotations

from . import cycles_settings, export_scene, select_culprit, self_test


def register() -> None:
    """Add the operators and their menu entries."""
    export_scene.register()
    cycles_settings.register()
    select_culprit.register()
    self_test.register()


def unregister() -> None:
    """Take them away."""
    self_test.unregister()
    select_culprit.unregister()
    cycles_settings.unregister()
    export_scene.unregister()
