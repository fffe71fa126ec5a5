"""The valid models that are corrupted: one built here with a mesh of every format, and those of the benchmark."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import trimesh
from lxml import etree

from benchmarks.faults.base import write_base
from kinematify.errors import InputError
from kinematify.evaluation.datasets import find_objects

if TYPE_CHECKING:
    from pathlib import Path

MOST_BYTES = 1_500_000
"""Of the meshes of a model: larger ones say nothing more and take longer."""

_FORMATS = ("obj", "stl", "glb", "ply", "off", "dae", "3mf", "gltf")
_LINK = """\
  <link name="drawer_{suffix}">
    <inertial>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <mass value="1.2"/>
      <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.05"/>
    </inertial>
    <visual><geometry><mesh filename="meshes/drawer.{suffix}" scale="1 1 1"/></geometry></visual>
    <collision><origin xyz="0 0 0"/><geometry><mesh filename="meshes/drawer.{suffix}"/></geometry></collision>
  </link>
  <joint name="slide_{suffix}" type="prismatic">
    <origin xyz="0 0 {height}" rpy="0 0 0"/>
    <parent link="body"/>
    <child link="drawer_{suffix}"/>
    <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" effort="20" velocity="0.5"/>
    <dynamics damping="0.5" friction="0.1"/>
    {mimic}
  </joint>
"""
_FRAME = """\
<?xml version="1.0"?>
<robot name="drawers">
  <link name="body">
    <inertial><mass value="8"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="1"/></inertial>
    <visual><origin xyz="-0.22 0 0.5"/><geometry><box size="0.02 0.4 1"/></geometry></visual>
    <collision><origin xyz="-0.22 0 0.5"/><geometry><box size="0.02 0.4 1"/></geometry></collision>
  </link>
  <link name="knob"><visual><geometry><cylinder radius="0.02" length="0.03"/></geometry></visual></link>
  <joint name="turn" type="continuous">
    <origin xyz="0.23 0 0" rpy="0 1.5708 0"/>
    <parent link="drawer_obj"/>
    <child link="knob"/>
    <axis xyz="0 0 1"/>
    <limit effort="1" velocity="1"/>
  </joint>
"""


@dataclass(frozen=True, kw_only=True)
class Base:
    """A valid model."""

    name: str
    text: bytes = field(repr=False)
    """The URDF."""
    meshes: dict[str, Path]
    """File of every mesh by the path that the URDF writes."""


def built_base(folder: Path) -> Base:
    """A chest of drawers, every drawer with a mesh of another format; the last drawer mimics the first."""
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    parts = [_FRAME]
    meshes = {}
    for number, suffix in enumerate(_FORMATS):
        name = f"meshes/drawer.{suffix}"
        mesh = trimesh.creation.box(extents=(0.4, 0.36, 0.1))
        if suffix == "gltf":
            for file, content in trimesh.Scene(mesh).export(file_type="gltf").items():  # type: ignore[no-untyped-call]
                (folder / "meshes" / file.replace("model.gltf", "drawer.gltf")).write_bytes(content)
                meshes[f"meshes/{file.replace('model.gltf', 'drawer.gltf')}"] = folder / "meshes" / file
        else:
            mesh.export(folder / name)
        meshes[name] = folder / name
        mimic = f'<mimic joint="slide_{_FORMATS[0]}" multiplier="0.5"/>' if number == len(_FORMATS) - 1 else ""
        parts.append(_LINK.format(suffix=suffix, height=0.12 * number, mimic=mimic))
    meshes = {name: folder / name for name in meshes}
    return Base(name="drawers", text="".join([*parts, "</robot>\n"]).encode(), meshes=meshes)


def all_bases(folder: Path, data: str | Path | None) -> list[Base]:
    """The built model and the small ones of the benchmark, with mass and collision geometry.

    Args:
        folder: Where to write them.
        data: As `find_objects` takes it. Without any, the built model stays alone.
    """
    bases = [built_base(folder / "drawers")]
    try:
        items = find_objects(data)
    except InputError:
        return bases
    for item in items:
        used = {mesh.get("filename") or "" for mesh in etree.parse(item.urdf).iter("mesh")}
        meshes = {name: item.urdf.parent / name for name in sorted(used)}
        if sum(path.stat().st_size for path in meshes.values()) <= MOST_BYTES:
            model = write_base(item, folder)
            bases.append(Base(name=item.name, text=model.urdf.read_bytes(), meshes=copy.copy(meshes)))
    return bases
