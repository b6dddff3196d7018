# SPDX-License-Identifier: GPL-3.0-or-later
"""Decides what is exported, and when."""
