"""Newton (extra ``newton``), its XPBD solver on the processor: raw files only. The first run compiles for minutes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import newton
import numpy as np
import warp
from scipy.spatial.transform import Rotation

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engine import Refused
from kinematify.simulation.raw_model import MovesFreely, Reproductions, RunningFile, Unloadable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.engine import EngineModel
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.raw_model import Start

_LOAD = """import newton, numpy as np, warp; warp.config.log_level = warp.LOG_WARNING
builder = newton.ModelBuilder(); builder.add_urdf({path!r}, floating=False, package_dirs={folders})
model = builder.finalize(device="cpu"); now, after = model.state(), model.state()
"""
_JOINTS = (
    _LOAD
    + """for name, kind, k in zip(model.joint_label, model.joint_type.numpy(), model.joint_qd_start.numpy()): \
kind == newton.JointType.FIXED or print(name.partition("/")[2], \
*(ends[k] if abs(ends[k]) < 1e9 else np.copysign(np.inf, ends[k]) \
for ends in (model.joint_limit_lower.numpy(), model.joint_limit_upper.numpy())))
"""
)
_SET = """def put(q, v): model.joint_q.assign(q); model.joint_qd.assign(v); \
newton.eval_fk(model, model.joint_q, model.joint_qd, now)
def get(): newton.eval_ik(model, now, model.joint_q, model.joint_qd); \
return model.joint_q.numpy().astype(float), model.joint_qd.numpy().astype(float)
rest = np.array({values}); put(rest, 0.0 * rest); pipeline = newton.CollisionPipeline(model); \
contacts = pipeline.contacts(); solver, control = newton.solvers.SolverXPBD(model), model.control()
def step(touch=True): global now, after; now.clear_forces(); touch and pipeline.collide(now, contacts); \
solver.step(now, after, control, contacts if touch else None, {step!r}); now, after = after, now
"""
_OVERLAP = (
    _LOAD
    + _SET
    + """pipeline.collide(now, contacts); n = int(contacts.rigid_contact_count.numpy()[0])
shape, body, at = model.shape_body.numpy(), model.body_label, now.body_q.numpy(); spot = lambda k, p: \
np.array(warp.transform_point(warp.transform(*at[k]), warp.vec3(*p)))
first, second, normal, p, q, s, t = (getattr(contacts, "rigid_contact_" + name).numpy()[:n] for name in \
("shape0", "shape1", "normal", "point0", "point1", "margin0", "margin1"))
print(max(s[k] + t[k] - normal[k] @ (spot(shape[second[k]], q[k]) - spot(shape[first[k]], p[k])) for k in range(n) \
if {{body[shape[first[k]]].partition("/")[2], body[shape[second[k]]].partition("/")[2]}} == {links}))
"""
)
_REST = (
    _LOAD
    + _SET
    + """seen = [get()[0][{joint}] for _ in range({steps}) if step() is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + _SET
    + """model.set_gravity((0.0, 0.0, 0.0)); seen, push = [rest[{joint}]], 0.0; v = 0.0 * rest; force = 0.0 * rest
moved, ratios, weights = {moved}, np.array({ratios}), np.array({weights})
for _ in range({steps}): slow = {speed!r} - v[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
force[{joint}] = np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); control.joint_f.assign(force); \
step({touch}); got, speed = get(); q, v = rest.copy(), 0.0 * rest; \
q[moved] += ratios * (weights @ (got - rest)[moved]); v[moved] = ratios * (weights @ speed[moved]); \
put(q, v); seen.append(q[{joint}])
print({farthest}(seen))
"""
)
_RELEASE = (
    _LOAD
    + _SET
    + """put(rest, np.array({speeds})); mass, centre, tensor = (getattr(model, "body_" + name).numpy() \
for name in ("mass", "com", "inertia")); turn = lambda pose: \
np.reshape(warp.quat_to_matrix(warp.quat(*pose[3:])), (3, 3))
energy = lambda: sum(9.81 * m * (p[2] + (turn(p) @ c)[2]) + 0.5 * m * u[:3] @ u[:3] + 0.5 * u[3:] @ turn(p) @ i @ \
turn(p).T @ u[3:] for p, u, m, c, i in zip(now.body_q.numpy(), now.body_qd.numpy(), mass, centre, tensor))
seen = [energy()] + [energy() for k in range({steps}) if step(False) is None and k % 8 == 7]
print(max(seen) - seen[0])
"""
)
_TIME_STEP = 2e-3
"""Of the engine [s]; its own examples take 1 to 2 ms."""
_EVERYWHERE = 1e9
"""Limits beyond it are none [rad or m]."""


class NewtonEngine:
    """Implementation of `kinematify.simulation.engine.Engine`; it loads no prepared models."""

    def __init__(self, settings: EngineSettings, log: Path) -> None:
        """Need nothing."""
        del settings, log

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> NewtonFile:
        """Load a file as users do."""
        del root
        return NewtonFile(urdf, package_dirs)

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> EngineModel:
        """Refuse (`EngineEntry.prepared`)."""
        del mechanism
        raise Refused(f"{prepared.urdf.name}: prepared models do not run in Newton")

    def messages(self) -> list[str]:
        """None."""
        return []


class NewtonFile(RunningFile):
    """Implementation of `RunningFile`: a file as `ModelBuilder.add_urdf` loads it, its base fixed.

    XPBD keeps joints by constraints on bodies in single precision: they give a little.
    """

    code = Reproductions(
        joints=_JOINTS,
        overlap=_OVERLAP,
        rest=_REST,
        push=_PUSH.replace("{touch}", "True"),
        push_alone=_PUSH.replace("{touch}", "False"),
        release=_RELEASE,
    )
    look_steps = 8
    time_step = _TIME_STEP

    def __init__(self, urdf: Path, package_dirs: Sequence[Path]) -> None:
        """Load it.

        Raises:
            Unloadable: Newton does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        warp.config.log_level = warp.LOG_WARNING
        folders = [str(folder) for folder in package_dirs] or None
        self._file = {"path": str(urdf), "folders": folders, "step": _TIME_STEP}
        try:
            builder = newton.ModelBuilder()
            builder.add_urdf(str(urdf), floating=False, package_dirs=folders)
            self._model = model = builder.finalize(device="cpu")
        except (ValueError, RuntimeError, KeyError, OSError, ImportError, TypeError, IndexError) as error:
            lines = _LOAD.format(**self._file)
            raise Unloadable(f"{type(error).__name__}: {error}", lines) from error
        kinds = model.joint_type.numpy().tolist()
        moving = [k for k, kind in enumerate(kinds) if kind != newton.JointType.FIXED]
        single = {int(newton.JointType.REVOLUTE), int(newton.JointType.PRISMATIC)}
        if any(kinds[k] not in single for k in moving):
            raise MovesFreely(_JOINTS.format(**self._file))
        self.joints = tuple(_name(model.joint_label[k]) for k in moving)
        lower, upper = model.joint_limit_lower.numpy().tolist(), model.joint_limit_upper.numpy().tolist()
        self.limits = {
            name: (low if low > -_EVERYWHERE else -np.inf, high if high < _EVERYWHERE else np.inf)
            for name, low, high in zip(self.joints, lower, upper, strict=True)
        }
        self._solver, self._control = newton.solvers.SolverXPBD(model), model.control()
        self._pipeline = newton.CollisionPipeline(model)
        self._contacts = self._pipeline.contacts()
        self._now, self._after, self._touch = model.state(), model.state(), True

    def _start(self, start: Start) -> None:
        self._touch = start.contacts
        self._model.set_gravity((0.0, 0.0, -GRAVITY if start.gravity else 0.0))
        self._control.joint_f.zero_()
        self.set_state(start.q, start.v)

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Implement `RunningFile`."""
        for done in range(1, count + 1):
            self._now.clear_forces()
            if self._touch:
                self._pipeline.collide(self._now, self._contacts)
            contacts = self._contacts if self._touch else None
            self._solver.step(self._now, self._after, self._control, contacts, self.time_step)
            self._now, self._after = self._after, self._now
            if done % every == 0:
                yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `RunningFile`."""
        model = self._model
        newton.eval_ik(model, self._now, model.joint_q, model.joint_qd)
        return model.joint_q.numpy().astype(np.float64), model.joint_qd.numpy().astype(np.float64)

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `RunningFile`."""
        model = self._model
        model.joint_q.assign(q)
        model.joint_qd.assign(v)
        newton.eval_fk(model, model.joint_q, model.joint_qd, self._now)

    def apply(self, joint: int, force: float) -> None:
        """Implement `RunningFile`."""
        forces = np.zeros(len(self.joints))
        forces[joint] = force
        self._control.joint_f.assign(forces)

    def energy(self) -> tuple[float, float]:
        """Implement `RunningFile`."""
        model, at, speed = self._model, self._now.body_q.numpy(), self._now.body_qd.numpy()
        mass, centre, tensor = model.body_mass.numpy(), model.body_com.numpy(), model.body_inertia.numpy()
        potential = kinetic = 0.0
        for pose, motion, m, c, inertia in zip(at, speed, mass, centre, tensor, strict=True):
            R = Rotation.from_quat(pose[3:]).as_matrix()
            turning = R.T @ motion[3:]
            potential += float(m) * GRAVITY * float(pose[2] + (R @ c)[2])
            kinetic += 0.5 * float(m * motion[:3] @ motion[:3] + turning @ inertia @ turning)
        return potential, kinetic

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """Implement `RunningFile`."""
        if not self._touch:
            return
        self._pipeline.collide(self._now, self._contacts)
        count = int(self._contacts.rigid_contact_count.numpy()[0])
        names = ("shape0", "shape1", "normal", "point0", "point1", "margin0", "margin1")
        arrays = (getattr(self._contacts, f"rigid_contact_{name}").numpy()[:count] for name in names)
        body, at = self._model.shape_body.numpy(), self._now.body_q.numpy()
        for shape0, shape1, normal, *points, margin0, margin1 in zip(*arrays, strict=True):
            bodies = [int(body[shape]) for shape in (shape0, shape1)]
            places = [
                Rotation.from_quat(at[k][3:]).apply(point) + at[k][:3] for k, point in zip(bodies, points, strict=True)
            ]
            depth = float(margin0 + margin1 - normal @ (places[1] - places[0]))
            first, second = sorted(_name(self._model.body_label[k]) for k in bodies)
            if depth > 0.0:
                yield first, second, depth

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Implement `RunningFile`."""
        self.begin(values, contacts=True)
        count = len(self.joints)
        matrix = newton.eval_mass_matrix(self._model, self._now).numpy().astype(np.float64)[0, :count, :count]
        return np.asarray(1.0 / np.diagonal(np.linalg.inv(matrix)))

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return set(links)


def _name(label: str) -> str:
    """Name of a joint or link, without that of the model before it."""
    return label.partition("/")[2]
