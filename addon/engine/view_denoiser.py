# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising of a viewport's pictures, on a thread of its own: nothing in Blender's waits for it."""

from __future__ import annotations

import os
import sys
import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import basicrt
from basicrt.denoising import denoise

from .denoise import install_hint

if TYPE_CHECKING:
    from ..export.denoising import Denoising, ViewDenoising

# Beneath Blender's own thread, like those that render; those of the denoiser inherit it.
_NICENESS = 10


@dataclass(frozen=True)
class DenoisedPicture:
    """A ViewPicture without its noise."""

    pixels: NDArray[np.float32]
    rect: tuple[int, int, int, int]
    film_size: tuple[int, int]
    samples: int
    revision: int


class _Job:
    """The denoising of one picture; has neither a way to cancel it nor one of Blender's objects."""

    def __init__(self, picture: basicrt.ViewPicture, how: Denoising, threads: int) -> None:
        self.revision, self.samples = picture.revision, picture.samples
        self.made: DenoisedPicture | None = None
        self.error: Exception | None = None
        self._hint = install_hint()
        # Blender waits for it when it quits: the library is not taken away from under it.
        self._thread = threading.Thread(
            target=self._run, args=(picture, how, threads), name="BasicRT denoising"
        )
        self._thread.start()

    @property
    def is_done(self) -> bool:
        return not self._thread.is_alive()

    def _run(self, picture: basicrt.ViewPicture, how: Denoising, threads: int) -> None:
        try:
            _lower_priority()
            basicrt.check_denoiser(self._hint)
            pictures = {"Combined": picture.pixels, **{name: picture[name] for name in how.passes}}
            pixels = denoise(
                pictures, prefilter=how.prefilter, quality=how.quality, threads=threads
            )
            self.made = DenoisedPicture(
                pixels, picture.rect, picture.film_size, picture.samples, picture.revision
            )
        except Exception as error:  # told by Blender's thread
            self.error = error


class ViewDenoiser:
    """Denoises the first picture that has enough samples, then each that has twice as many as the last one
    or after which no more come. What a session's revision has left behind is dropped.
    """

    def __init__(self) -> None:
        self._options: ViewDenoising | None = None
        self._newest: basicrt.ViewPicture | None = None
        self._job: _Job | None = None
        # Revision and samples of the picture that was denoised last or is being, and of the one taken last.
        self._begun = self._shown = (-1, 0)
        self._error: Exception | None = None
        self._is_out_of_order = False

    def set_options(self, options: ViewDenoising | None) -> None:
        """How pictures that come from now on are denoised; after other options than before it is tried again
        where it failed.
        """
        if options != self._options:
            self._is_out_of_order = False
        self._options = options
        if options is None:
            self.forget()

    def forget(self) -> None:
        """All pictures, of a session that is no more."""
        self._newest = self._job = None
        self._begun = self._shown = (-1, 0)

    def add(self, picture: basicrt.ViewPicture) -> None:
        """The session's newest one."""
        if self._options is not None:
            self._newest = picture

    def work(self, revision: int, threads: int, *, is_at_rest: bool) -> None:
        """Begin with the newest picture where it is due; the session is at that revision, and at rest where
        no more pictures come.
        """
        options, newest = self._options, self._newest
        if options is None or newest is None or self._job is not None or self._is_out_of_order:
            return
        if newest.revision != revision or newest.samples == 0:  # no longer seen, or coarse
            return
        begun = self._begun[1] if self._begun[0] == revision else 0
        due = begun + 1 if is_at_rest else max(options.start_sample, 2 * begun)
        if newest.samples >= due:
            self._begun = (revision, newest.samples)
            self._job = _Job(newest, options.how, threads)

    @property
    def is_busy(self) -> bool:
        """Whether there is a picture that is being denoised, or that was not taken yet."""
        return self._job is not None

    @property
    def is_ready(self) -> bool:
        """Whether there is something to take."""
        return self._job is not None and self._job.is_done

    def take(self, revision: int) -> DenoisedPicture | None:
        """The picture that was made since, None where there is none or it is of another revision."""
        job = self._job
        if job is None or not job.is_done:
            return None
        self._job = None
        if job.error is not None:
            self._error, self._is_out_of_order = job.error, True
        if job.made is None or job.revision != revision:
            return None
        self._shown = (revision, job.samples)
        return job.made

    def take_error(self) -> Exception | None:
        """Why nothing is denoised any more, once."""
        error, self._error = self._error, None
        return error

    def samples_shown(self, revision: int) -> int:
        """Those of the denoised picture of this revision that was taken last; 0: none was."""
        return self._shown[1] if self._shown[0] == revision else 0


def _lower_priority() -> None:
    """Of this thread. Python can in Linux alone, which has it for each thread, whatever POSIX says of processes."""
    if sys.platform == "linux":
        thread = threading.get_native_id()
        os.setpriority(
            os.PRIO_PROCESS, thread, max(os.getpriority(os.PRIO_PROCESS, thread), _NICENESS)
        )
