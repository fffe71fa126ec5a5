"""The MuJoCo stage: load, pose, contacts at rest, hold, drive, push, release, drop; and `poses-mujoco.npz`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.robot.mechanism import Mechanism
from kinematify.robot.read import read_without_geometry
from kinematify.simulation.prepared import load_prepared
from kinematify.validation.catalogue.engines import CHECKS
from kinematify.validation.engines.configurations import EnginePoses, agreement_configurations, write_poses
from kinematify.validation.engines.loading import LoadedJoint, LoadedModel, compare_with_file
from kinematify.validation.engines.mujoco_checks import ENGINE, MujocoWork, simulate_all
from kinematify.validation.engines.mujoco_measure import measure
from kinematify.validation.engines.mujoco_model import Refused, compiled, parse
from kinematify.validation.engines.outcome import find_overlaps
from kinematify.validation.engines.placed import find_misplaced, link_poses
from kinematify.validation.engines.touching import touching
from kinematify.validation.finding import Blame, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredModel
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.mujoco_model import MujocoModel, Source
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

_IDS = tuple(check.id for check in CHECKS if ENGINE in check.engines)


def run(request: StageRequest, recorder: Recorder) -> None:
    """Tell all MuJoCo checks; see `kinematify.validation.stage`."""
    messages: list[str] = []
    mujoco.set_mju_user_warning(messages.append)  # else they go into a file in the working directory
    declared, prepared = read_without_geometry(request.urdf), load_prepared(request.work)
    mechanism = Mechanism(description=declared.kinematics)
    threads = len(os.sched_getaffinity(0))
    opened = _load(request, recorder, declared, prepared, mechanism)
    if opened is None:
        _block(recorder, _IDS[1:], "MuJoCo does not load the model as it is in the file (KV401)")
        return
    source, measuring = opened
    work = MujocoWork(
        request=request,
        declared=declared,
        prepared=prepared,
        mechanism=mechanism,
        source=source,
        measuring=measuring,
        threads=threads,
        said=messages,
    )
    _compare_poses(recorder, work)
    if not recorder.wants(*_IDS[2:]):
        return
    _look_at_rest(recorder, work)
    if work.sweep is None or work.seen is None:
        _block(recorder, _IDS[3:], "the contacts at rest could not be measured (KV403)")
        return
    if recorder.wants(*_IDS[3:]):
        simulate_all(recorder, work, work.seen, work.sweep)


def _load(
    request: StageRequest, recorder: Recorder, declared: DeclaredModel, prepared: Prepared, mechanism: Mechanism
) -> tuple[Source, MujocoModel] | None:
    opened = None
    with recorder.check("KV401", ENGINE) as check:
        try:
            source = parse(prepared.urdf, mechanism, step=request.settings.engines.time_step)
            loaded = compiled(source)
        except Refused as refusal:
            check.find(
                f"MuJoCo refuses the model: {refusal}.",
                "Mend what MuJoCo's message names, and the other findings of the file.",
            )
            return None
        compare_with_file(check, declared, prepared, _summary(loaded, mechanism), request.settings.engines.same)
        _compare_axes(check, loaded, mechanism, request.settings.engines.same)
        if loaded.balanced:
            check.find(
                "MuJoCo refuses an inertia tensor whose largest principal moment exceeds the sum of the others, even "
                "by a rounding error; all tensors were balanced for the other checks.",
                "Write the tensors with more digits, or make the largest moment a little smaller.",
                severity=Severity.WARNING,
                blame=Blame.PHYSICS,
            )
        opened = (source, loaded) if loaded.complete else None
    return opened


def _summary(loaded: MujocoModel, mechanism: Mechanism) -> LoadedModel:
    model = loaded.model
    joints = {
        name: LoadedJoint(
            turns=bool(model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE),
            lower=float(model.jnt_range[joint, 0]) if model.jnt_limited[joint] else -np.inf,
            upper=float(model.jnt_range[joint, 1]) if model.jnt_limited[joint] else np.inf,
        )
        for name, joint in zip(mechanism.joints, loaded.joint.tolist(), strict=True)
        if joint >= 0
    }
    masses = {
        name: float(model.body_mass[body])
        for name, body in zip(mechanism.links, loaded.body.tolist(), strict=True)
        if body >= 0
    }
    return LoadedModel(joints=joints, masses=masses, total_mass=float(model.body_mass.sum()))


def _compare_axes(check: OpenCheck, loaded: MujocoModel, mechanism: Mechanism, same: float) -> None:
    for name, joint in zip(mechanism.joints, loaded.joint.tolist(), strict=True):
        declared = mechanism.description.joint_by_name[name].axis
        found = loaded.model.jnt_axis[joint] if joint >= 0 else declared
        if np.abs(found - declared).max() > same:
            check.find(
                f"The axis of the joint {name} is {_vector(declared)} in the file and {_vector(found)} in MuJoCo.",
                "Write the axis as a unit vector with plain decimal numbers.",
                joint=name,
                value=np.abs(found - declared).max(),
                limit=same,
            )


def _vector(values: FloatArray) -> str:
    return "(" + ", ".join(f"{value:.6g}" for value in values) + ")"


def _compare_poses(recorder: Recorder, work: MujocoWork) -> None:
    """Tell KV402, and leave what the agreement checks compare."""
    request = work.request
    with recorder.check("KV402", ENGINE) as check:
        rows = agreement_configurations(work.declared.kinematics, request.settings.agreement, request.settings.seed)
        seen = measure(work.measuring, rows.q, dynamic=rows.dynamic, threads=work.threads)
        find_misplaced(
            check,
            rows,
            ours=link_poses(work.declared.kinematics, rows),
            theirs=seen.T_world_link,
            size=work.size,
            settings=request.settings.engines,
        )
        model = work.measuring.model
        write_poses(
            request.work,
            ENGINE,
            EnginePoses(
                links=rows.links,
                joints=rows.joints,
                q=rows.q,
                T_world_link=seen.T_world_link,
                masses=model.body_mass[work.measuring.body],
                total_mass=float(model.body_mass.sum()),
                mass_matrix=seen.inertia,
                gravity=seen.gravity[: rows.dynamic],
                contacts=np.column_stack([seen.contacts.row, seen.contacts.links]),
                contact_depth=seen.contacts.depth,
            ),
        )


def _look_at_rest(recorder: Recorder, work: MujocoWork) -> None:
    """Tell KV403; the contacts along the sweep of every joint are measured here once for all checks."""
    settings = work.request.settings.engines
    with recorder.check("KV403", ENGINE) as check:
        rows = work.mechanism.sweep(settings.sweep_samples)
        work.seen = measure(work.measuring, work.mechanism.all_values(rows), dynamic=1, threads=work.threads)
        sweep = touching(
            work.seen.contacts,
            work.mechanism,
            work.prepared,
            rows=len(rows),
            tolerance=settings.contact_depth * work.size,
        )
        find_overlaps(check, work.case(sweep))
        work.sweep = sweep


def _block(recorder: Recorder, names: Iterable[str], reason: str) -> None:
    for name in names:
        with recorder.check(name, ENGINE) as check:
            check.block(reason)
