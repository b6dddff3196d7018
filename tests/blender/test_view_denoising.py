# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising in viewports: which pictures, with which values, that nobody waits for it, and what is said without it."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np
import pytest
from addon.engine import view_denoiser
from addon.engine.view_denoiser import DenoisedPicture, ViewDenoiser
from addon.export import denoising
from addon.export.denoising import Denoising, ViewDenoising
from addon.properties.choice import copy_from_cycles

import basicrt
from support.blender import new_scene
from support.scenes import still_life

ALBEDO, NORMAL = "Denoising Albedo", "Denoising Normal"
PATIENCE_SECONDS = 60.0


def options(
    passes: tuple[str, ...] = (ALBEDO,), start: int = 1, quality: str = "balanced"
) -> ViewDenoising:
    return ViewDenoising(Denoising(passes, "fast", quality), start)


@dataclass
class Noisy:
    """As much of a ViewPicture as is read."""

    samples: int
    revision: int = 1
    pixels: np.ndarray = field(default_factory=lambda: np.zeros((2, 3, 4), np.float32))
    rect: tuple[int, int, int, int] = (0, 0, 3, 2)
    film_size: tuple[int, int] = (3, 2)

    def __getitem__(self, name: str) -> np.ndarray:
        return np.zeros((2, 3, 3), np.float32)


def wait_until(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_SECONDS
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.001)


class Rig:
    """A denoiser whose library is asked by a test, which lets it work step by step."""

    def __init__(self) -> None:
        self.denoiser = ViewDenoiser()
        self.denoiser.set_options(options())
        self.seen: list[dict[str, Any]] = []
        self.may_end = threading.Semaphore(0)

    def denoise(self, pictures: Any, **how: Any) -> np.ndarray:
        """In the library's place, on the denoiser's thread."""
        self.seen.append({"passes": tuple(pictures), **how})
        assert self.may_end.acquire(timeout=PATIENCE_SECONDS)
        made: np.ndarray = pictures["Combined"] + 1
        return made

    def offer(self, samples: int, revision: int = 1, *, is_at_rest: bool = False) -> int:
        """How many pictures were begun so far, with this one."""
        made: Any = Noisy(samples, revision)
        self.denoiser.add(made)
        self.denoiser.work(revision, 1, is_at_rest=is_at_rest)
        job = self.denoiser._job
        if job is not None:
            wait_until(lambda: len(self.seen) > 0 or job.is_done)
        return len(self.seen)

    def take(self, revision: int = 1) -> DenoisedPicture | None:
        """What comes of the picture that is being denoised."""
        self.may_end.release()
        wait_until(lambda: self.denoiser.is_ready)
        return self.denoiser.take(revision)


@pytest.fixture
def rig(monkeypatch: pytest.MonkeyPatch) -> Iterator[Rig]:
    made = Rig()
    monkeypatch.setattr(view_denoiser, "denoise", made.denoise)
    monkeypatch.setattr(basicrt, "check_denoiser", lambda _hint: None)
    yield made
    made.may_end.release()


def samples_of(picture: DenoisedPicture | None) -> int:
    assert picture is not None
    return picture.samples


def test_pictures_are_denoised_when_their_samples_have_doubled(rig: Rig) -> None:
    begun = []
    for samples in range(1, 18):
        rig.offer(samples)
        if rig.denoiser.is_busy:
            begun.append(samples_of(rig.take()))
    assert begun == [1, 2, 4, 8, 16]


def test_the_newest_picture_follows_one_that_took_long(rig: Rig) -> None:
    for samples in (1, 2, 3, 7):
        assert rig.offer(samples) == 1
    assert samples_of(rig.take()) == 1
    rig.denoiser.work(1, 1, is_at_rest=False)
    assert samples_of(rig.take()) == 7


def test_the_last_picture_is_denoised_once_however_many_samples_it_has(rig: Rig) -> None:
    rig.denoiser.set_options(options(start=100))
    rig.offer(5)
    assert not rig.denoiser.is_busy
    rig.offer(6, is_at_rest=True)
    assert samples_of(rig.take()) == 6
    rig.denoiser.work(1, 1, is_at_rest=True)
    assert not rig.denoiser.is_busy
    rig.offer(7, is_at_rest=True)  # after a pause
    assert samples_of(rig.take()) == 7


@pytest.mark.parametrize("start", [0, 1, 6])
def test_denoising_begins_with_the_start_sample(rig: Rig, start: int) -> None:
    rig.denoiser.set_options(options(start=start))
    for samples in range(12):
        rig.offer(samples)
        if rig.denoiser.is_busy:
            break
    assert samples_of(rig.take()) == max(start, 1)


def test_coarse_pictures_are_not_denoised(rig: Rig) -> None:
    assert rig.offer(0, is_at_rest=True) == 0
    assert not rig.denoiser.is_busy


def test_what_is_no_longer_to_be_seen_is_dropped(rig: Rig) -> None:
    rig.offer(8)
    assert rig.denoiser.samples_shown(1) == 0
    assert rig.take(revision=2) is None
    assert rig.denoiser.samples_shown(2) == 0
    # A picture that was made before the view changed, and taken afterwards.
    late: Any = Noisy(9, revision=1)
    rig.denoiser.add(late)
    rig.denoiser.work(2, 1, is_at_rest=True)
    assert not rig.denoiser.is_busy
    rig.offer(1, revision=2)
    assert samples_of(rig.take(revision=2)) == 1
    assert rig.denoiser.samples_shown(2) == 1
    assert rig.denoiser.samples_shown(3) == 0


def test_a_session_that_is_closed_leaves_nothing(rig: Rig) -> None:
    rig.offer(8)
    rig.denoiser.forget()
    rig.may_end.release()
    rig.denoiser.work(1, 1, is_at_rest=True)
    assert not rig.denoiser.is_busy
    assert rig.denoiser.take(1) is None


def test_nothing_is_done_or_kept_without_the_option(rig: Rig) -> None:
    rig.denoiser.set_options(None)
    assert rig.offer(8, is_at_rest=True) == 0
    assert rig.denoiser._newest is None


def test_a_failure_is_told_once_and_tried_again_after_other_options(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise basicrt.DenoiserError("out of order")

    with monkeypatch.context() as patch:
        patch.setattr(view_denoiser, "denoise", fail)
        rig.offer(1)
        assert rig.take() is None
    assert str(rig.denoiser.take_error()) == "out of order"
    assert rig.denoiser.take_error() is None
    rig.offer(8, is_at_rest=True)
    assert not rig.denoiser.is_busy
    rig.denoiser.set_options(options())  # the same
    rig.offer(8)
    assert not rig.denoiser.is_busy
    rig.denoiser.set_options(options(start=2))
    rig.may_end = threading.Semaphore(0)
    rig.offer(8)
    assert samples_of(rig.take()) == 8


def test_settings_follow_cycles_by_the_rule_of_all_settings() -> None:
    scene = new_scene()
    assert denoising.convert_view(scene, "Combined") is None
    scene.cycles.use_preview_denoising = True
    assert denoising.convert_view(scene, "Combined") == options()
    assert denoising.convert_view(scene, "Normal") is None
    scene.cycles.preview_denoising_input_passes = "RGB_ALBEDO_NORMAL"
    scene.cycles.preview_denoising_prefilter = "ACCURATE"
    scene.cycles.preview_denoising_quality = "FAST"
    scene.cycles.preview_denoising_start_sample = 5
    of_cycles = ViewDenoising(Denoising((ALBEDO, NORMAL), "accurate", "fast"), 5)
    assert denoising.convert_view(scene, "Combined") == of_cycles
    scene.basicrt.preview_denoising_start_sample = 3
    scene.basicrt.preview_denoising_input_passes = "RGB"
    of_both = ViewDenoising(Denoising((), "accurate", "fast"), 3)
    assert denoising.convert_view(scene, "Combined") == of_both
    copy_from_cycles(scene)
    assert denoising.convert_view(scene, "Combined") == of_cycles
    scene.basicrt.use_preview_denoising = False
    assert denoising.convert_view(scene, "Combined") is None


def test_our_defaults_are_those_of_cycles() -> None:
    scene: Any = new_scene()
    kinds = ("input_passes", "prefilter", "quality", "start_sample")
    for name in ("use_preview_denoising", *(f"preview_denoising_{kind}" for kind in kinds)):
        assert getattr(scene.basicrt, name) == getattr(scene.cycles, name), name


class Engine:
    """What a viewport asks of its engine."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def update_stats(self, _title: str, text: str) -> None:
        self.texts.append(text)

    def tag_redraw(self) -> None:
        pass


class Texture:
    """Notes what it is to show."""

    def __init__(self) -> None:
        self.pictures: list[Any] = []

    def set(self, picture: Any) -> None:
        self.pictures.append(picture)


class Shown:
    """A viewport without a window: its parts, called as Blender's redraws and timers would."""

    def __init__(self, scene: basicrt.Scene, how: ViewDenoising) -> None:
        from addon.engine.viewport import Viewport

        self.engine, self.texture = Engine(), Texture()
        engine: Any = self.engine
        self.viewport: Any = Viewport(engine)
        self.viewport._texture = self.texture
        self.session = self.viewport._session = basicrt.ViewSession(1)
        self.scene, self.how = scene, how
        self.seconds: list[float] = []  # of each redraw while a picture is denoised
        self.session.set_scene(scene)
        self.look(scene.settings)

    def look(self, settings: basicrt.RenderSettings) -> None:
        """What Viewport._look() does."""
        self.viewport._denoiser.set_options(self.how)
        self.session.set_view(self.scene.camera, settings, "Combined", list(self.how.how.passes))

    def draw(self) -> bool:
        """Whether there is more to wait for."""
        begin, is_busy = time.perf_counter(), self.viewport._denoiser.is_busy
        depsgraph: Any = bpy.context.evaluated_depsgraph_get()
        has_more: bool = self.viewport._has_more()
        self.viewport._take_pictures(self.session, depsgraph)
        self.viewport._show_status()
        if is_busy:
            self.seconds.append(time.perf_counter() - begin)
        return has_more

    def rest(self) -> Any:
        """The picture that is shown when nothing more comes."""
        end = time.monotonic() + PATIENCE_SECONDS
        while self.draw():
            assert time.monotonic() < end
            time.sleep(0.002)
        return self.texture.pictures[-1]


@pytest.fixture
def shown() -> Iterator[Callable[..., Shown]]:
    """Makes viewports."""
    made: list[Shown] = []

    def make(scene: basicrt.Scene, how: ViewDenoising) -> Shown:
        made.append(Shown(scene, how))
        return made[-1]

    yield make
    for viewport in made:
        viewport.viewport.close()


def final(scene: basicrt.Scene, how: ViewDenoising) -> np.ndarray:
    """What denoising of a final render with the same samples gives."""
    scene.settings.passes = ["Combined", *how.how.passes]
    pictures = basicrt.render(scene)
    return basicrt.denoise(pictures, prefilter=how.how.prefilter, quality=how.how.quality)


@pytest.mark.parametrize("passes", [(), (ALBEDO,), (ALBEDO, NORMAL)])
def test_a_view_at_rest_shows_what_final_denoising_gives(
    shown: Callable[..., Shown], passes: tuple[str, ...]
) -> None:
    pytest.importorskip("pyoidn")
    scene, how = still_life(samples=3), options(passes, start=2)
    scene.settings.film_transparent = True
    viewport = shown(scene, how)
    picture = viewport.rest()
    assert isinstance(picture, DenoisedPicture)
    assert picture.film_size == (scene.settings.width, scene.settings.height)
    assert viewport.engine.texts[-1] == "Sample 3/3 | Denoised at 3"
    np.testing.assert_array_equal(picture.pixels, final(scene, how))
    assert picture.pixels[..., 3].min() < 1


def test_a_border_is_denoised_alone(shown: Callable[..., Shown]) -> None:
    pytest.importorskip("pyoidn")
    scene, how = still_life(samples=2), options()
    width, height = scene.settings.width, scene.settings.height
    scene.settings.border_x, scene.settings.border_y = width // 4, height // 4
    scene.settings.border_width, scene.settings.border_height = width // 2, height // 2
    viewport = shown(scene, how)
    picture = viewport.rest()
    assert picture.rect == (width // 4, height // 4, width // 2, height // 2)
    rows = slice(height // 4, height // 4 + height // 2)
    columns = slice(width // 4, width // 4 + width // 2)
    scene.settings.passes = ["Combined", ALBEDO]
    whole = basicrt.render(scene)
    part = {name: np.ascontiguousarray(whole[name][rows, columns]) for name in whole}
    made = basicrt.denoise(part, prefilter="fast", quality="balanced")
    np.testing.assert_array_equal(picture.pixels, made)


def test_a_view_that_turns_shows_the_noisy_picture_of_what_is_seen(
    shown: Callable[..., Shown],
) -> None:
    pytest.importorskip("pyoidn")
    scene = still_life(samples=2)
    viewport = shown(scene, options())
    assert isinstance(viewport.rest(), DenoisedPicture)
    count = len(viewport.texture.pictures)
    settings = scene.settings
    settings.exposure = 2.0
    viewport.look(settings)
    viewport.rest()
    later = viewport.texture.pictures[count:]
    assert isinstance(later[0], basicrt.ViewPicture)
    assert isinstance(later[-1], DenoisedPicture)
    assert {picture.revision for picture in later} == {viewport.session.revision}
    # Noisy pictures come back never once a denoised one was shown.
    kinds = [isinstance(picture, DenoisedPicture) for picture in later]
    assert kinds == sorted(kinds)


@pytest.mark.alone
def test_blender_waits_for_no_denoiser(shown: Callable[..., Shown]) -> None:
    """Callbacks go on, and quickly, while the library works."""
    pytest.importorskip("pyoidn")
    scene = still_life(samples=1)
    scene.settings.width, scene.settings.height = 1280, 720
    viewport = shown(scene, options((ALBEDO, NORMAL), quality="high"))
    assert isinstance(viewport.rest(), DenoisedPicture)
    print(f"{len(viewport.seconds)} redraws, the longest {1e3 * max(viewport.seconds):.1f} ms")
    assert len(viewport.seconds) >= 10
    # The system may take the processor away from any one of them.
    assert np.percentile(viewport.seconds, 90) < 0.05


def test_without_a_denoiser_the_view_stays_noisy_with_one_warning(
    shown: Callable[..., Shown], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    b_scene = new_scene()
    scene = still_life(samples=2)
    viewport = shown(scene, options())
    assert isinstance(viewport.rest(), basicrt.ViewPicture)
    viewport.look(scene.settings)
    picture = viewport.rest()
    scene.settings.passes = ["Combined"]
    np.testing.assert_array_equal(picture.pixels, basicrt.render(scene)["Combined"])
    (warning,) = [record.message for record in caplog.records]
    assert warning.startswith(
        f'scene "{b_scene.name}": denoising needs Intel Open Image Denoise: install it with `'
    )
    assert warning.endswith("the picture stays noisy")
