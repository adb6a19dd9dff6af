# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a ball on a tilted plate, by a ray through each point of a pixel. Lengths in mm."""
import numpy as np


class Camera:
    def __init__(self, place, at, focal=1050.0, size=(640, 480)):
        """A pinhole at `place` that looks at `at`; `focal` in pixels."""
        self.place, self.size = np.array(place, float), size
        forward = np.array(at, float) - self.place
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.1, 1, 0])
        right /= np.linalg.norm(right)
        self.turn = np.stack([right, np.cross(forward, right), forward])  # rows: right, down, forward
        self.lens = np.array([[focal, 0, size[0] / 2], [0, focal, size[1] / 2], [0, 0, 1]])

    def pixel(self, point):
        u, v, w = self.lens @ self.turn @ (np.asarray(point, float) - self.place)
        return np.array([u / w, v / w])

    def rays(self, u, v):
        through = np.stack([u, v, np.ones_like(u)], axis=-1) @ np.linalg.inv(self.lens).T @ self.turn
        return through / np.linalg.norm(through, axis=-1, keepdims=True)


def turned(phi, theta):
    """R_y(phi) R_x(theta), by Rodrigues' formula."""
    def about(axis, angle):
        k = np.cross(np.eye(3), axis)
        return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    return about([0, 1, 0], phi) @ about([1, 0, 0], theta)


def shade(camera, u, v, turn, height, plate, ball, radius, texture, looks):
    """The light along rays: of the table, the plate or the ball."""
    rays = camera.rays(u, v) @ turn  # in the plate's frame
    place = camera.place @ turn
    at = place + rays * ((height - place[2]) / rays[..., 2])[..., None]
    on_plate = (abs(at[..., 0]) < plate[0] / 2) & (abs(at[..., 1]) < plate[1] / 2)
    light = np.where(on_plate[..., None], looks["plate"], looks["table"]).astype(float)
    if texture is not None:
        per_mm = texture.shape[0] / plate[0]
        column = np.clip(((at[..., 0] + plate[0] / 2) * per_mm).astype(int), 0, texture.shape[1] - 1)
        row = np.clip(((at[..., 1] + plate[1] / 2) * per_mm).astype(int), 0, texture.shape[0] - 1)
        light = np.where(on_plate[..., None], texture[row, column][..., None], light)
    to_center = np.array([ball[0], ball[1], height + radius]) - place
    beside = np.linalg.norm(np.cross(rays, to_center), axis=-1)
    return np.where((beside < radius)[..., None], looks["ball"], light)


LOOKS = {"table": (70, 70, 70), "plate": (205, 205, 205), "ball": (40, 40, 40)}  # blue, green, red


def picture(camera, angles, ball, plate, radius, height=0.0, noise=None, texture=None, looks=None, fine=4):
    """A picture; `fine` x `fine` points for each pixel near the ball, or of all with a texture."""
    turn, looks = turned(*angles), looks or LOOKS
    scene = (turn, height, plate, ball, radius, texture, {name: np.array(color) for name, color in looks.items()})
    u, v = (axis.astype(float) for axis in np.meshgrid(np.arange(camera.size[0]), np.arange(camera.size[1])))
    steps = (np.arange(fine) + 0.5) / fine - 0.5
    points = [(a, b) for a in steps for b in steps]
    if texture is not None:
        light = sum(shade(camera, u + a, v + b, *scene) for a, b in points) / fine**2
    else:
        light = shade(camera, u, v, *scene)
        middle = camera.pixel(turn @ [ball[0], ball[1], height + radius])
        low = np.maximum(middle.astype(int) - 60, 0)
        part = (slice(low[1], low[1] + 120), slice(low[0], low[0] + 120))
        light[part] = sum(shade(camera, u[part] + a, v[part] + b, *scene) for a, b in points) / fine**2
    if noise is not None:
        light = light + noise.normal(0, 3, light.shape)
    return np.clip(np.round(light), 0, 255).astype(np.uint8)
