"""Write examples/cupboard.step, a CAD assembly with names, colours, instances and exact cylinders.

It needs the CAD kernel: `pip install cadquery-ocp-novtk`, in an environment of its own. Lengths are millimetres.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

Point = tuple[float, float, float]
TURNED = math.radians(17.0)
"""The cupboard stands askew, so that its axes are not those of the world."""
UP = (0.0, 0.0, 1.0)


def box(low: Point, high: Point) -> TopoDS_Shape:
    return BRepPrimAPI_MakeBox(gp_Pnt(*low), gp_Pnt(*high)).Shape()


def cylinder(foot: Point, axis: Point, radius: float, length: float) -> TopoDS_Shape:
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(*foot), gp_Dir(*axis)), radius, length).Shape()


def joined(first: TopoDS_Shape, *others: TopoDS_Shape) -> TopoDS_Shape:
    for other in others:
        first = BRepAlgoAPI_Fuse(first, other).Shape()
    return first


def without(first: TopoDS_Shape, *others: TopoDS_Shape) -> TopoDS_Shape:
    for other in others:
        first = BRepAlgoAPI_Cut(first, other).Shape()
    return first


def carcass() -> TopoDS_Shape:
    """A box with a compartment for two drawers beside one for the door, and two hinge pins."""
    whole = box((0, 0, 0), (600, 350, 400))
    hollow = without(
        whole,
        box((18, -1, 18), (291, 332, 191)),
        box((18, -1, 209), (291, 332, 382)),
        box((309, -1, 18), (582, 332, 382)),
    )
    pins = []
    for foot in (60.0, 300.0):
        bracket = box((586, -30, foot - 14), (600, 0, foot))
        pins += [bracket, cylinder((593, -15, foot - 14), UP, 4, 54)]
    return joined(hollow, *pins)


def drawer() -> TopoDS_Shape:
    """With its front flush with the carcass; it slides out along -y."""
    return without(
        joined(box((0, 0, 0), (271, 300, 150)), box((0, -18, 0), (271, 0, 171))), box((12, 12, 12), (259, 288, 151))
    )


def door() -> TopoDS_Shape:
    """A leaf with knuckles around the pins, and a hole for the knob."""
    leaf = box((302, -25, 4), (580, -7, 396))
    knuckles = []
    for foot in (60.0, 300.0):
        knuckles += [cylinder((593, -15, foot + 0.5), UP, 9, 39), box((578, -20, foot + 0.5), (593, -10, foot + 39.5))]
    holes = [cylinder((593, -15, foot - 1), UP, 4.2, 42) for foot in (60.0, 300.0)]
    return without(joined(leaf, *knuckles), *holes, cylinder((330, 0, 200), (0, -1, 0), 6.2, 40))


def knob() -> TopoDS_Shape:
    """A disc with a grip on a shaft through the door."""
    return joined(
        cylinder((330, -2, 200), (0, -1, 0), 6, 26),
        cylinder((330, -26, 200), (0, -1, 0), 20, 12),
        box((327, -50, 182), (333, -38, 218)),
        cylinder((330, -2, 200), (0, -1, 0), 11, 4.5),
    )


def placed(at: Point = (0.0, 0.0, 0.0), turn: float = 0.0) -> TopLoc_Location:
    turned, moved = gp_Trsf(), gp_Trsf()
    turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(*UP)), turn)
    moved.SetTranslation(gp_Vec(*at))
    return TopLoc_Location(moved.Multiplied(turned))


def named(label: TDF_Label, name: str) -> TDF_Label:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
    return label


def write(path: Path) -> None:
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())

    def part(shape: TopoDS_Shape, name: str, color: Point) -> TDF_Label:
        label = named(shapes.AddShape(shape, False), name)
        shade = Quantity_Color(*color, Quantity_TypeOfColor.Quantity_TOC_sRGB)
        colors.SetColor(label, shade, XCAFDoc_ColorType.XCAFDoc_ColorGen)
        return label

    def assembly(name: str) -> TDF_Label:
        empty = TopoDS_Compound()
        BRep_Builder().MakeCompound(empty)
        return named(shapes.AddShape(empty, True), name)

    one_drawer = part(drawer(), "drawer", (0.85, 0.45, 0.15))
    closed_door = assembly("door with knob")
    named(shapes.AddComponent(closed_door, part(door(), "door", (0.2, 0.45, 0.75)), placed()), "door")
    named(shapes.AddComponent(closed_door, part(knob(), "knob", (0.8, 0.8, 0.1)), placed()), "knob")
    cupboard = assembly("cupboard")
    named(shapes.AddComponent(cupboard, part(carcass(), "carcass", (0.75, 0.7, 0.6)), placed()), "carcass")
    named(shapes.AddComponent(cupboard, one_drawer, placed((19, 0, 19))), "lower drawer")
    named(shapes.AddComponent(cupboard, one_drawer, placed((19, 0, 210))), "upper drawer")
    named(shapes.AddComponent(cupboard, closed_door, placed()), "door with knob")
    room = assembly("room")
    named(shapes.AddComponent(room, cupboard, placed((120, 80, 0), TURNED)), "cupboard")
    shapes.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    writer.Transfer(document)
    writer.Write(str(path))
    # The same file each time: the writer states when it ran.
    text = re.sub(r"'\d{4}-\d\d-\d\dT[\d:]+'", "'2026-01-01T00:00:00'", path.read_text(encoding="utf-8"))
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write(Path(__file__).parent / "cupboard.step")
