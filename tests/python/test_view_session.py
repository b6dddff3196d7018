# SPDX-License-Identifier: GPL-3.0-or-later
"""ViewSession: pictures of views, edits between them, leases, errors and the end."""

import time

import numpy as np
import pytest

import basicrt
from basicrt import SceneError, ViewSession
from support.scenes import still_life

# However busy a machine is.
PATIENCE_SECONDS = 60.0


def last_picture(session: ViewSession) -> basicrt.ViewPicture:
    """The newest picture once nothing more comes."""
    newest = None
    end = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < end:
        is_done = session.status.is_done
        newest = session.take_picture() or newest
        if is_done:
            assert newest is not None
            return newest
        time.sleep(0.001)
    raise AssertionError("the view is not done")


def test_a_view_ends_with_the_values_of_a_render() -> None:
    scene = still_life(samples=3)
    session = ViewSession(2)
    session.set_scene(scene)
    session.set_view(scene.camera, scene.settings)
    picture = last_picture(session)
    assert picture.samples == 3
    assert picture.film_size == (scene.settings.width, scene.settings.height)
    np.testing.assert_array_equal(picture.pixels, basicrt.render(scene)["Combined"])


def test_an_edited_scene_is_shown_as_if_it_were_new() -> None:
    scene = still_life(samples=2)
    session = ViewSession(2)
    session.set_scene(scene)
    session.set_view(scene.camera, scene.settings)
    last_picture(session)
    moved = scene.instances[0]
    transform = np.array(moved.transform)
    transform[2, 3] += 0.1
    moved.transform = transform
    scene.instances[0] = moved
    session.set_scene(scene)
    np.testing.assert_array_equal(last_picture(session).pixels, basicrt.render(scene)["Combined"])


def test_pixels_outlive_the_session() -> None:
    scene = still_life(samples=1)
    session = ViewSession(1)
    session.set_scene(scene)
    session.set_view(scene.camera, scene.settings, "Normal")
    pixels = last_picture(session).pixels
    session.close()
    del session
    assert np.isfinite(pixels).all()
    assert (pixels[..., 3] == 1).all()


def test_pictures_bring_further_passes_along() -> None:
    scene = still_life(samples=2)
    names = ["Denoising Albedo", "Depth"]
    session = ViewSession(2)
    session.set_scene(scene)
    session.set_view(scene.camera, scene.settings, "Combined", names)
    picture = last_picture(session)
    assert picture.revision == session.revision == 2
    assert sorted(picture.further_passes) == sorted(names)
    scene.settings.passes = ["Combined", *names]
    whole = basicrt.render(scene)
    np.testing.assert_array_equal(picture.pixels, whole["Combined"])
    for name in names:
        np.testing.assert_array_equal(picture[name], whole[name])
    with pytest.raises(KeyError, match="Normal"):
        picture["Normal"]
    with pytest.raises(
        SceneError, match=r'set_view\.further_passes\[1\]: there is no pass "Nothing"'
    ):
        session.set_view(scene.camera, scene.settings, further_passes=["Depth", "Nothing"])
    assert session.revision == 2


def test_a_scene_can_be_changed_again_once_it_is_prepared() -> None:
    scene = still_life(samples=1)
    session = ViewSession(1)
    session.set_scene(scene)
    end = time.monotonic() + PATIENCE_SECONDS
    while session.status.is_preparing:
        assert time.monotonic() < end
        time.sleep(0.001)
    scene.lights.clear()
    assert len(scene.lights) == 0


def test_what_is_wrong_is_said_once() -> None:
    scene = still_life(samples=1)
    camera, scene.camera = scene.camera, None
    session = ViewSession(1)
    session.set_view(camera, scene.settings)
    session.set_scene(scene)
    with pytest.raises(SceneError, match="camera"):
        last_picture(session)
    assert session.status.is_done
    with pytest.raises(SceneError, match="Depht"):
        session.set_view(camera, scene.settings, "Depht")
    session.close()
    with pytest.raises(RuntimeError, match="closed"):
        session.take_picture()
