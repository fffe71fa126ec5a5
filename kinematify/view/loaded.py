"""A model opened in Python: `kinematify.load("robot.urdf")`."""

from __future__ import annotations

import importlib
import tempfile
import warnings
from collections.abc import Mapping
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import DescriptionError, InputError
from kinematify.model.output import urdf_of
from kinematify.robot.description import notes_of
from kinematify.robot.mesh_paths import CAD_SUFFIXES, MESH_SUFFIXES
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PIL.Image import Image
    from trimesh import Trimesh

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Robot
    from kinematify.view.server import ModelViewer
    from kinematify.view.window import Window

_AZIMUTH = -1.0
"""Of the camera of a picture [rad]: in front of the model, which looks along -y, and a little to its right."""
_SLACK = 1e-6
"""Share of a limit by which a value may pass it: files round their limits to six digits."""


def load(
    path: str | Path, *, package_dirs: Sequence[str | Path] = (), arguments: Mapping[str, str] | None = None
) -> LoadedModel:
    """Open a URDF, xacro, MJCF, SDF or USD, or the model folder of `kinematify infer` or `generate`.

    Args:
        path: The file or the folder.
        package_dirs: Where packages lie (``package://``).
        arguments: Of a xacro.

    Raises:
        InputError: There is no such file, or it cannot be read.
    """
    given = Path(path)
    if given.suffix.lower() in (*MESH_SUFFIXES, *CAD_SUFFIXES):
        raise InputError(
            f"{given} is a mesh and has no joints. kinematify.infer({str(given)!r}) finds them, and kinematify infer "
            f"{given} -o OUT writes a model folder, which can be loaded."
        )
    places = tuple(map(Path, package_dirs))
    return LoadedModel(urdf_of(given, places, arguments), places)


class LoadedModel:
    """The robot of a file: poses, meshes, a viewer, and models of MuJoCo, PyBullet and Pinocchio.

    A configuration maps joint names to values [rad or m]. The name of a link selects the joint above it. Joints that
    are not named are at zero; mimic joints follow their leader.
    """

    def __init__(self, urdf: Path, package_dirs: tuple[Path, ...]) -> None:
        """Read the file; see `load`."""
        self.path = urdf.resolve()
        """The URDF."""
        self.robot: Robot = read_robot(urdf, package_dirs=package_dirs, appearance=True)
        """Links, joints and meshes."""
        self._package_dirs = package_dirs
        for note in (*notes_of(urdf), *self.robot.notes):
            warnings.warn(note, stacklevel=3)

    def __repr__(self) -> str:
        """Name, file and joints that move."""
        return f"<{self.robot.name}: {len(self.robot.links)} links, joints {', '.join(self.joints)}>"

    @property
    def joints(self) -> dict[str, Joint]:
        """Joints that move by themselves, by name, in the order of the file."""
        return {joint.name: joint for joint in self.robot.leaders}

    def pose(self, q: Mapping[str, float] | None = None) -> dict[str, FloatArray]:
        """Return T_world_link of every link, shape (4, 4); the root link's frame is the world.

        Args:
            q: The configuration; all joints at zero if absent.

        Raises:
            InputError: A name is neither a joint nor a link that a joint moves, or a value is no number or lies outside
                the limits of its joint.
        """
        return forward_kinematics(self.robot, self._by_joint(q or {}))

    def meshes(self, q: Mapping[str, float] | None = None) -> dict[str, Trimesh]:
        """Return what is seen of every link that has geometry, world frame [m], with the mean colour of each triangle.

        Args:
            q: The configuration; all joints at zero if absent.

        Raises:
            InputError: As for `pose`.
        """
        import trimesh  # noqa: PLC0415  # takes longer than all else here

        poses = self.pose(q)
        found = {}
        for link in self.robot.links:
            parts = [_colored(trimesh, mesh) for mesh in link.meshes if len(mesh.faces)]
            if parts:
                whole: Any = trimesh.util.concatenate(parts)
                whole.apply_transform(poses[link.name])
                found[link.name] = whole
        return found

    def picture(self, q: Mapping[str, float] | None = None, *, azimuth: float = _AZIMUTH) -> Image:
        """Return a picture of the model, drawn without a window.

        Args:
            q: The configuration; all joints at zero if absent.
            azimuth: Of the camera, from x towards y [rad].

        Raises:
            InputError: As for `pose`, or the model has no geometry.
        """
        from kinematify.render.model_picture import draw_robot  # noqa: PLC0415  # half a second

        poses = self.pose(q)
        if not any(len(mesh.faces) for link in self.robot.links for mesh in link.meshes):
            raise InputError(f"{self.path} has no geometry that can be drawn.")
        return draw_robot(self.robot, poses, azimuth)

    def to_mujoco(self) -> Any:
        """Return a `mujoco.MjModel` of this model, with its colours, and a motor for each joint that has an effort.

        Raises:
            EnvironmentFault: MuJoCo is not installed.
            InputError: The model cannot be simulated.
        """
        mujoco = _engine("mujoco", "mujoco")
        from kinematify.formats.export_model import export  # noqa: PLC0415  # loads the collision geometry

        with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
            file = Path(folder, "model.xml")
            export(self.path, "mjcf", file, package_dirs=self._package_dirs)
            return mujoco.MjModel.from_xml_path(str(file))

    def to_pybullet(self, client: int = 0) -> int:
        """Load this file into a world of PyBullet, its root fixed; returns the body's number.

        Closed loops, which a URDF cannot tell PyBullet, are closed with `createConstraint`, and the default motors of
        the joints that they move are off.

        Args:
            client: The number that `pybullet.connect` returned.

        Raises:
            EnvironmentFault: PyBullet is not installed.
            InputError: PyBullet refuses the file.
        """
        _engine("pybullet", "pybullet")
        from kinematify.simulation.engine import Unloadable  # noqa: PLC0415  # with PyBullet
        from kinematify.simulation.pybullet_engine import load_with_loops  # noqa: PLC0415

        try:
            return load_with_loops(client, self.robot, self.path)
        except Unloadable as refusal:
            raise InputError(f"PyBullet does not load {self.path}: {refusal}") from refusal

    def show(self, q: Mapping[str, float] | None = None, *, port: int = 8080) -> Window[ModelViewer]:
        """Show the model in a browser, as `kinematify view` does; in a notebook the answer is the page itself.

        Args:
            q: The configuration to start from; at rest if absent.
            port: Another one is taken if it is not free.

        Returns:
            The window; its `url` is the address, `close()` ends it.

        Raises:
            EnvironmentFault: viser is not installed.
            InputError: As for `pose`.
        """
        from kinematify.view.window import model_window  # noqa: PLC0415  # loads the collision geometry

        values = self._by_joint(q or {})
        window = model_window(self.path, package_dirs=self._package_dirs, port=port)
        window.viewer.set(values)
        window.run_aside()
        return window

    def _by_joint(self, q: Mapping[str, float]) -> dict[str, float]:
        """A configuration by the names of joints, each value within its limits."""
        if not isinstance(q, Mapping):
            raise InputError(f"A configuration maps joint names to numbers [rad or m]; {q!r} is a {type(q).__name__}.")
        above = {link: joint.name for link, joint in self.robot.joint_above.items()}
        named = {name if name in self.robot.joint_by_name else above.get(name, name): q[name] for name in q}
        unknown = sorted(set(named) - set(self.robot.joint_by_name))
        if unknown:
            raise DescriptionError(
                f"{self.path} has no joint {unknown[0]}, and no link of that name hangs on one. Its joints are "
                f"{', '.join(self.joints) or 'none'}."
            )
        return {name: self._within(self.robot.joint_by_name[name], value) for name, value in named.items()}

    def _within(self, joint: Joint, value: object) -> float:
        """`value` as a number within the limits of `joint`."""
        unit = "rad" if joint.kind.turns else "m"
        if isinstance(value, bool) or not isinstance(value, Real) or not np.isfinite(number := float(value)):
            raise InputError(f"The value of the joint {joint.name} is {value!r}; give a finite number in {unit}.")
        slack = _SLACK * max(1.0, abs(joint.lower), abs(joint.upper))
        inside = joint.lower - slack <= number <= joint.upper + slack
        if joint.leads and not joint.endless and not inside:
            raise InputError(
                f"The joint {joint.name} moves from {joint.lower:g} to {joint.upper:g} {unit}; {number:g} {unit} lies "
                "outside. Give a value within the limits, or change them in the file."
            )
        return number


def _colored(trimesh: Any, mesh: Any) -> Any:
    """A mesh of a link with a colour for each of its triangles where any is known."""
    built = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    if mesh.appearance is not None:
        middle = np.full((len(mesh.faces), 3), 1.0 / 3.0)
        colors = mesh.appearance.colors_at(np.arange(len(mesh.faces)), middle)
        built.visual.face_colors = np.round(255.0 * colors).astype(np.uint8)
    return built


def _engine(module: str, package: str) -> Any:
    require(f"A model of {module}", package)
    return importlib.import_module(module)
