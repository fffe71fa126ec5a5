"""Write the cabinet of `make demo`: six parts as OBJ files, metres, z up, front towards -y.

    .venv/bin/python examples/make_cabinet.py [FOLDER]

Two doors hang on barrel hinges, two drawers slide in their bays, and a knob turns in a rosette of the right door.
JOINTS is the truth that an inference can be compared with.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from trimesh import Trimesh
from trimesh.creation import annulus, box, cylinder

WIDTH, DEPTH, HEIGHT = 0.90, 0.42, 0.80
PANEL = 0.018  # thickness of every board [m]
LEG = 0.10  # height of the legs [m]
GAP = 0.0015  # clearance around doors and drawers [m]
FRONT = -DEPTH / 2
SHELF = 0.582  # underside of the board between doors and drawers [m]
INNER = WIDTH / 2 - PANEL  # inner face of the side boards, |x| [m]
HINGE_Y = FRONT - 0.0065  # hinge axes stand before the front face, knuckles 0.5 mm clear of it [m]
HINGE_HEIGHTS = (0.19, 0.51)
KNOB = (0.07, 0.47)  # x and z of the knob's axis [m]
SECTIONS = 32  # of what turns; other rods are coarser


@dataclass(frozen=True)
class TrueJoint:
    """A joint of the cabinet: the positive direction opens."""

    parent: str
    child: str
    kind: str
    axis: tuple[float, float, float]
    pivot: tuple[float, float, float]


JOINTS = (
    TrueJoint("body", "door_left", "revolute", (0, 0, -1), (-INNER, HINGE_Y, 0)),
    TrueJoint("body", "door_right", "revolute", (0, 0, 1), (INNER, HINGE_Y, 0)),
    TrueJoint("body", "drawer_left", "prismatic", (0, -1, 0), (0, 0, 0)),
    TrueJoint("body", "drawer_right", "prismatic", (0, -1, 0), (0, 0, 0)),
    TrueJoint("door_right", "knob", "continuous", (0, 1, 0), (KNOB[0], 0, KNOB[1])),
)


def build_cabinet() -> dict[str, Trimesh]:
    """Return the mesh of every part by name, world frame [m]."""
    return {
        "body": _body(),
        "door_left": _door(-1),
        "door_right": _join(_door(1), _rosette()),
        "drawer_left": _drawer(-1),
        "drawer_right": _drawer(1),
        "knob": _knob(),
    }


def _body() -> Trimesh:
    half, back = WIDTH / 2, DEPTH / 2
    boards = [
        _board((-half, half), (FRONT, back), (LEG, LEG + PANEL)),
        _board((-half, half), (FRONT, back), (HEIGHT - PANEL, HEIGHT)),
        _board((-half, -INNER), (FRONT, back), (LEG + PANEL, HEIGHT - PANEL)),
        _board((INNER, half), (FRONT, back), (LEG + PANEL, HEIGHT - PANEL)),
        _board((-INNER, INNER), (back - PANEL, back), (LEG + PANEL, HEIGHT - PANEL)),
        _board((-INNER, INNER), (FRONT, back - PANEL), (SHELF, SHELF + PANEL)),
        _board((-INNER, INNER), (FRONT + 0.06, back - PANEL), (0.34, 0.34 + PANEL)),
        _board((-PANEL / 2, PANEL / 2), (FRONT, back - PANEL), (SHELF + PANEL, HEIGHT - PANEL)),
    ]
    legs = [
        _rod((x, y, 0), (x, y, LEG), 0.02) for x in (-half + 0.06, half - 0.06) for y in (FRONT + 0.06, back - 0.06)
    ]
    hinges = [_fixed_hinge(side, z) for side in (-1, 1) for z in HINGE_HEIGHTS]
    return _join(*boards, *legs, *hinges)


def _fixed_hinge(side: int, z: float) -> Trimesh:
    """Pin, two outer knuckles and their leaf on the side board; the leaf leaves room for the door's knuckle."""
    x = side * INNER
    parts = [
        _board((x + side * 0.007, x + side * 0.016), (FRONT - 0.0015, FRONT), (z - 0.0305, z + 0.0305)),
        _rod((x, HINGE_Y, z - 0.033), (x, HINGE_Y, z + 0.033), 0.0029, sections=SECTIONS),
    ]
    for low in (z - 0.0305, z + 0.0105):
        finger = _board((x, x + side * 0.007), (FRONT - 0.0015, FRONT), (low, low + 0.02))
        parts += [finger, _knuckle(x, low, low + 0.02)]
    return _join(*parts)


def _door(side: int) -> Trimesh:
    edge, middle = side * (INNER - GAP), side * GAP / 2
    parts = [
        _board((edge, middle), (FRONT, FRONT + PANEL), (LEG + PANEL + GAP, SHELF - GAP)),
        _handle((side * 0.035, 0.30), (side * 0.035, 0.42)),
    ]
    for z in HINGE_HEIGHTS:
        inner = (side * (INNER - 0.028), side * (INNER - GAP / 2))
        parts += [
            _board(inner, (FRONT - 0.0015, FRONT), (z - 0.01, z + 0.01)),
            _knuckle(side * INNER, z - 0.01, z + 0.01),
        ]
    return _join(*parts)


def _drawer(side: int) -> Trimesh:
    near, far = side * (PANEL / 2 + GAP), side * (INNER - GAP)
    low, high, back, side_height = SHELF + PANEL + GAP, HEIGHT - PANEL - GAP, 0.17, 0.74
    wall = side * 0.012
    inside = FRONT + PANEL
    return _join(
        _board((near, far), (FRONT, inside), (low, high)),
        _board((near, near + wall), (inside, back), (low, side_height)),
        _board((far - wall, far), (inside, back), (low, side_height)),
        _board((near + wall, far - wall), (back - 0.012, back), (low, side_height)),
        _board((near + wall, far - wall), (inside, back - 0.012), (low, low + 0.006)),
        _handle((side * 0.15, 0.69), (side * 0.29, 0.69)),
    )


def _rosette() -> Trimesh:
    ring = annulus(r_min=0.0062, r_max=0.016, height=0.012, sections=SECTIONS)
    return _turned_to_front(ring, FRONT - 0.006)


def _knob() -> Trimesh:
    stem = _turned_to_front(cylinder(radius=0.006, height=0.026, sections=SECTIONS), FRONT - 0.0135)
    head = _turned_to_front(cylinder(radius=0.024, height=0.014, sections=SECTIONS), FRONT - 0.0335)
    x, z = KNOB
    grip = _board((x - 0.005, x + 0.005), (FRONT - 0.0525, FRONT - 0.0405), (z - 0.024, z + 0.024))
    return _join(stem, head, grip)


def _turned_to_front(solid: Trimesh, y: float) -> Trimesh:
    """Turn a solid about z into one about y, at the knob's axis and depth `y`."""
    solid.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    solid.apply_translation((KNOB[0], y, KNOB[1]))
    return solid


def _handle(start: tuple[float, float], end: tuple[float, float]) -> Trimesh:
    """Build a bar on two posts before the front face; `start` and `end` are x and z."""
    (x0, z0), (x1, z1) = start, end
    reach = FRONT - 0.03
    posts = [_rod((x, FRONT, z), (x, reach, z), 0.004) for x, z in (start, end)]
    along = np.sign([x1 - x0, z1 - z0]) * 0.012
    bar = _rod((x0 - along[0], reach, z0 - along[1]), (x1 + along[0], reach, z1 + along[1]), 0.006)
    return _join(bar, *posts)


def _knuckle(x: float, low: float, high: float) -> Trimesh:
    ring = annulus(r_min=0.003, r_max=0.006, height=high - low, sections=SECTIONS)
    ring.apply_translation((x, HINGE_Y, (low + high) / 2))
    return ring


def _board(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Trimesh:
    ranges = np.sort([x, y, z], axis=1)
    return box(bounds=ranges.T)


def _rod(
    start: tuple[float, float, float], end: tuple[float, float, float], radius: float, *, sections: int = 16
) -> Trimesh:
    return cylinder(radius=radius, segment=[start, end], sections=sections)


def _join(*solids: Trimesh) -> Trimesh:
    return trimesh.util.concatenate(list(solids))


def write_cabinet(folder: Path) -> None:
    """Write one OBJ file per part into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in build_cabinet().items():
        lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in mesh.vertices]
        lines += [f"f {a} {b} {c}" for a, b, c in mesh.faces + 1]
        (folder / f"{name}.obj").write_text("\n".join([f"o {name}", *lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "cabinet"
    write_cabinet(target)
    print(f"Wrote the parts of the cabinet to {target}.")
