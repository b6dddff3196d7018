# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates Blender's shader nodes into BasicRT's: one small function for each node."""

from __future__ import annotations

from .translate import Emission, emission_of, translate_surface

__all__ = ["Emission", "emission_of", "translate_surface"]
