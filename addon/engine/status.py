# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows of a render while it goes on."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from .. import compat

if TYPE_CHECKING:
    import basicrt


def show_status(engine: Any, progress: basicrt.Progress) -> None:
    """Progress bar, status line and memory."""
    engine.update_progress(progress.fraction)
    rate = progress.samples_per_second / 1e6
    remaining = time.strftime("%H:%M:%S", time.gmtime(progress.remaining_seconds))
    status = f"{rate:.2f} M samples/s | Remaining {remaining}"
    if progress.is_time_up:
        status = f"Time is up: {progress.samples_per_pixel:.0f} samples for each pixel"
    elif progress.is_done:
        status = f"{rate:.2f} M samples/s | {progress.samples_per_pixel:.0f} samples for each pixel"
    engine.update_stats("", status)
    peak = compat.peak_memory_megabytes()
    if peak is not None:
        engine.update_memory_stats(memory_used=peak, memory_peak=peak)
