# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts single Blender datablocks into BasicRT's; each module says how for one kind."""
