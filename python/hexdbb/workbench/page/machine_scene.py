"""The machine in three dimensions; it follows the cursor along the circle."""

from __future__ import annotations

from typing import Literal

import numpy as np
from nicegui import ui
from nicegui.elements.scene.scene_object3d import Object3D
from numpy.typing import NDArray

from hexdbb.kinematics import guideway_ends, platform_points
from hexdbb.workbench.machine_view import MachineView, Stand
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.session import Session

Floats = NDArray[np.float64]
Colouring = Literal["force", "correction"]
GREY, POSITIVE, NEGATIVE, MOVED, STEEL = (0.72, 0.75, 0.78), (0.0, 0.45, 0.33), (0.72, 0.14, 0.1), "#7B3FA0", "#52606D"
"""Legs without force or correction; in tension or longer; in compression or shorter; what is displaced; the rest."""
LEG_MM, BALL_MM, PLATFORM_MM = 7.0, 10.0, 8.0
"""Radius of legs and balls, thickness of the platform, as drawn."""


CAMERA_INRADII = 5.5
"""Distance of the camera in radii of the base: the whole base triangle is in the picture."""


class MachineScene:
    """Guideways, sliders, legs coloured, platform, ball and cup; beside it the platform displaced, magnified."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._colouring: Colouring = "force"
        self._view: MachineView | None = None
        self._angle_deg = 0.0
        box = ui.expansion("The machine in 3D", caption="follows the cursor along the circle").props("dense")
        with box.props(mark("3d")):
            self._inside = ui.element("div").classes("wb-scene")
        box.on_value_change(lambda event: self._open() if event.value else self._close())

    def draw(self) -> None:
        """Take what is shown now: another circle, or another model."""
        if self._view is not None:
            self._view = MachineView(self._session.samples, self._session.selection, self._session.shown)
            self._say()
            self.move(self._angle_deg)

    def move(self, angle_deg: float) -> None:
        """Follow the cursor."""
        self._angle_deg = angle_deg
        if self._view is None:
            return
        stand = self._view.at(angle_deg)
        values = stand.forces if self._colouring == "force" else stand.corrections_um
        largest = self._view.largest_force if self._colouring == "force" else self._view.largest_correction_um
        for number in range(6):
            self._sliders[number].move(*stand.sliders[number])
            middle = (stand.sliders[number] + stand.joints[number]) / 2.0
            leg = self._legs[number].move(*middle).rotate_R(_along(stand.joints[number] - stand.sliders[number]))
            leg.material(_colour(float(values[number]) / largest if largest else 0.0))
        self._platform.move(*stand.position).rotate_R(stand.rotation.tolist())
        self._moved.move(*stand.moved_position).rotate_R(stand.moved_rotation.tolist())
        self._ball.move(*stand.ball)
        self._moved_ball.move(*stand.moved_ball)
        self._cup.move(*stand.cup)
        self._bar.move(*((stand.cup + stand.ball) / 2.0)).rotate_R(_along(stand.ball - stand.cup))

    def _open(self) -> None:
        self._view = MachineView(self._session.samples, self._session.selection, self._session.shown)
        with self._inside:
            with ui.row().classes("wb-choices"):
                choices = {"force": "legs by force", "correction": "legs by correction"}
                ui.toggle(choices, value=self._colouring, on_change=lambda event: self._colour_by(event.value)).props(
                    "no-caps dense outline"
                )
                self._legend = ui.label().classes("wb-small")
            self._build(self._view.at(self._angle_deg))
        self._say()
        self.move(self._angle_deg)

    def _close(self) -> None:
        self._view = None
        self._inside.clear()

    def _colour_by(self, colouring: Colouring) -> None:
        self._colouring = colouring
        self._say()
        self.move(self._angle_deg)

    def _say(self) -> None:
        assert self._view is not None
        meaning = "green: tension, red: compression"
        if self._colouring == "correction":
            meaning = f"green: longer, red: shorter than nominal, up to {self._view.largest_correction_um:.1f} µm"
        self._legend.set_text(f"{meaning}; violet: as the model displaces it, {self._view.magnification:g} times")

    def _build(self, stand: Stand) -> None:
        machine = self._session.samples.machine
        outline = platform_points(machine)[::2, :2].tolist()
        height_mm = float(platform_points(machine)[0, 2])
        camera = ui.scene.perspective_camera(fov=40, near=10.0, far=20.0 * machine.base.inradius_mm)
        self._scene = ui.scene(grid=False, camera=camera, background_color="#F7F9FA", fps=30).classes("wb-canvas")
        self._scene.props('role="img" aria-label="The machine at the angle of the cursor"')
        with self._scene:
            for start, end in guideway_ends(machine):
                self._rod(start, end, 5.0, STEEL)
            self._sliders = [ui.scene.box(34.0, 34.0, 26.0).material(STEEL) for _ in range(6)]
            self._legs = [
                ui.scene.cylinder(LEG_MM, LEG_MM, length_mm, 16).material("#B8BFC7")
                for length_mm in machine.legs.lengths_mm
            ]
            with ui.scene.group() as self._platform:
                ui.scene.extrusion(outline, PLATFORM_MM).move(z=height_mm).material("#9FB3C8", 0.85)
            with ui.scene.group() as self._moved:
                ui.scene.extrusion(outline, PLATFORM_MM).move(z=height_mm).material(MOVED, 0.35)
            self._bar = self._rod(stand.cup, stand.ball, 2.0, "#C08A00")
            self._ball = ui.scene.sphere(BALL_MM).material("#1F2933")
            self._moved_ball = ui.scene.sphere(BALL_MM).material(MOVED)
            self._cup = ui.scene.sphere(BALL_MM * 1.2).material("#C08A00")
        reach_mm = CAMERA_INRADII * machine.base.inradius_mm
        centre = (0.0, 0.0, 0.5 * float(stand.position[2]))
        self._scene.move_camera(0.55 * reach_mm, -0.7 * reach_mm, 0.65 * reach_mm, *centre, duration=0)

    def _rod(self, start: Floats, end: Floats, radius_mm: float, colour: str) -> Object3D:
        rod = ui.scene.cylinder(radius_mm, radius_mm, float(np.linalg.norm(end - start)), 12).material(colour)
        return rod.move(*((start + end) / 2.0)).rotate_R(_along(end - start))


def _along(direction: Floats) -> list[list[float]]:
    """Return a rotation that turns the axis of a cylinder, y, to a direction."""
    y = direction / np.linalg.norm(direction)
    x = np.cross(y, (0.0, 0.0, 1.0) if abs(y[2]) < 0.9 else (1.0, 0.0, 0.0))
    x /= np.linalg.norm(x)
    turned: list[list[float]] = np.column_stack([x, y, np.cross(x, y)]).tolist()
    return turned


def _colour(part: float) -> str:
    """Return the colour of a value as part of the largest, -1 to 1."""
    end = POSITIVE if part >= 0.0 else NEGATIVE
    mixed = [round(255 * (grey + (full - grey) * min(abs(part), 1.0))) for grey, full in zip(GREY, end, strict=True)]
    return "#" + "".join(f"{each:02X}" for each in mixed)
