"""The stage `geometry`: collision at rest and along the motion by exact geometry, without an engine (KV30x to KV33x).

Work is done once and shared: bodies, their FCL trees and signed distances, what touches at rest, the sweep of every
joint. Where time runs out, the checks say what they left out.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.scene import read_scene, simplified, visible_shapes
from kinematify.geometry.sweep import Sweeper
from kinematify.geometry.together import joint_pairs, looked_at, random_rows
from kinematify.robot.joint_type import JointType
from kinematify.validation.catalogue.geometry import CHECKS
from kinematify.validation.engine_results import EXACT
from kinematify.validation.engines.configurations import write_poses
from kinematify.validation.geometry import judge_motion
from kinematify.validation.geometry.exact_contacts import exact_contacts
from kinematify.validation.geometry.hulls import HullView, seen_by_engines
from kinematify.validation.geometry.judge_motion import MotionCase
from kinematify.validation.geometry.judge_rest import (
    allowed_pairs,
    allowed_table,
    hovering,
    neighbours,
    pair_table,
    strangers,
)
from kinematify.validation.geometry.judge_together import free_configurations, in_each_others_way
from kinematify.validation.left_model import model_of
from kinematify.validation.report import JointSummary

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from kinematify.geometry.scene import Scene
    from kinematify.geometry.sweep import JointSweep
    from kinematify.geometry.together import Configurations
    from kinematify.validation.geometry.remark import Remark
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

_HULL_SAMPLES = 24


def run(request: StageRequest, recorder: Recorder) -> None:
    """Look at the model at rest and in motion; see `kinematify.validation.stage`."""
    if not recorder.wants(*(check.id for check in CHECKS)):
        return
    model = model_of(request)
    scene = read_scene(model, request.settings.geometry)
    if len(scene.bodies) < 2:
        _skip(recorder, tuple(check.id for check in CHECKS), "fewer than two bodies have geometry")
        return
    looks = _Looks(scene, request)
    _tell_rest(recorder, looks)
    if not scene.travels:
        _skip(recorder, _IN_MOTION, "no joint moves")
        return
    _tell_motion(recorder, looks)
    reasons = allowed_pairs(scene, looks.allowance, looks.random)
    recorder.summarise(pair_table(scene, looks.allowance, reasons, looks.sweeps))
    _tell_together(recorder, looks)
    _tell_hulls(recorder, looks)
    if recorder.wants("KV604") and looks.in_time:
        write_poses(request.work, EXACT, exact_contacts(scene, looks.overlap, request.settings))


_IN_MOTION = ("KV310", "KV311", "KV312", "KV320", "KV321", "KV330", "KV331", "KV332")


def _skip(recorder: Recorder, checks: tuple[str, ...], reason: str) -> None:
    for name in checks:
        with recorder.check(name) as check:
            check.skip(reason)


class _Looks:
    """What several checks look at, measured when first asked for."""

    def __init__(self, scene: Scene, request: StageRequest) -> None:
        self.scene, self.request = scene, request
        self.overlap = Overlap(scene)
        self.allowance = Allowance(scene, self.overlap)
        self.sweeper = Sweeper(scene, self.overlap, self.allowance)
        self._sweep_of: dict[int, JointSweep] = {}

    @property
    def in_time(self) -> bool:
        return self.request.remaining > 0.0

    @cached_property
    def sweeps(self) -> list[JointSweep]:
        """Sweeps of the joints, as many as there is time for."""
        found = []
        for leader in range(len(self.scene.travels)):
            if not self.in_time:
                break
            found.append(self.sweep(leader))
        return found

    @cached_property
    def visible(self) -> _Looks | None:
        """The same of the visual geometry; None where the collision geometry is a copy of it."""
        if not simplified(self.scene.model):
            return None
        scene = read_scene(self.scene.model, self.scene.settings, visible_shapes)
        same = [body.group for body in scene.bodies] == [body.group for body in self.scene.bodies]
        return _Looks(scene, self.request) if same else None

    def sweep(self, leader: int) -> JointSweep:
        """Sweep of one joint."""
        if leader not in self._sweep_of:
            self._sweep_of[leader] = self.sweeper.sweep(leader)
        return self._sweep_of[leader]

    @cached_property
    def late(self) -> str | None:
        """Which joints were left out."""
        left = [travel.joint for travel in self.scene.travels[len(self.sweeps) :]]
        return f"time ran out before {len(left)} joints: {', '.join(left)}" if left else None

    @cached_property
    def cases(self) -> list[MotionCase]:
        return [
            MotionCase(
                scene=self.scene,
                overlap=self.overlap,
                allowance=self.allowance,
                sweep=sweep,
                visible=self.visible.sweep if self.visible else None,
            )
            for sweep in self.sweeps
        ]

    @cached_property
    def random(self) -> Configurations | None:
        """Quasi-random configurations; None where no joint moves or time is up."""
        if not self.scene.travels or not self.in_time:
            return None
        return looked_at(self.scene, self.overlap, self.allowance, random_rows(self.scene, self.request.settings.seed))


def _tell(recorder: Recorder, name: str, remarks: Callable[[], Iterable[Remark]], *, late: str | None = None) -> None:
    with recorder.check(name) as check:
        if late is not None:
            check.skip(late)
        for remark in remarks():
            remark.add_to(check)


def _tell_rest(recorder: Recorder, looks: _Looks) -> None:
    scene, allowance = looks.scene, looks.allowance
    visible = looks.visible.allowance if looks.visible else None
    _tell(recorder, "KV301", lambda: strangers(scene, allowance, visible))
    _tell(recorder, "KV302", lambda: neighbours(scene, looks.overlap, allowance, visible))
    _tell(recorder, "KV303", lambda: hovering(scene, allowance))
    with recorder.check("KV304") as check:
        reasons = allowed_pairs(scene, allowance, looks.random)
        for remark in allowed_table(scene, allowance, reasons):
            remark.add_to(check)
        check.measured["bodies"] = len(scene.bodies)
        check.measured["tolerated_pairs"] = len(reasons)
        check.measured["deepest_at_rest"] = max((allowance.at_rest(pair) for pair in reasons), default=0.0)


def _tell_motion(recorder: Recorder, looks: _Looks) -> None:
    for sweep in looks.sweeps:
        recorder.summarise(_summary(looks.scene, sweep))
    judges: dict[str, Callable[[MotionCase], Iterator[Remark]]] = {
        "KV310": judge_motion.through_parent,
        "KV311": judge_motion.into_others,
        "KV312": judge_motion.beyond_free_travel,
        "KV320": judge_motion.lost_contact,
        "KV321": judge_motion.out_of_guide,
    }
    for name, judge in judges.items():
        with recorder.check(name) as check:
            if looks.late is not None:
                check.skip(looks.late)
            check.measured["joints"] = len(looks.sweeps)
            for case in looks.cases:
                for remark in judge(case):
                    remark.add_to(check)


def _summary(scene: Scene, sweep: JointSweep) -> JointSummary:
    joint = scene.model.kinematics.joint_by_name[sweep.travel.joint]
    limited = joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    return JointSummary(
        joint=joint.name,
        kind=joint.kind.value,
        declared_limits=(joint.lower, joint.upper) if limited else None,
        free_travel=sweep.free,
    )


def _tell_together(recorder: Recorder, looks: _Looks) -> None:
    scene = looks.scene
    with recorder.check("KV330") as check:
        if len(scene.travels) < 2 or looks.late is not None:
            check.skip(looks.late or "only one joint moves")
        else:
            alone = [frozenset(m.pair for side in sweep.sides for m in side.meetings) for sweep in looks.sweeps]
            found, left = joint_pairs(scene, looks.overlap, looks.allowance, alone, lambda: looks.in_time)
            check.measured["pairs_left_out"] = left
            for remark in in_each_others_way(scene, found):
                remark.add_to(check)
    with recorder.check("KV331") as check:
        _tell_random(check, looks)


def _tell_random(check: OpenCheck, looks: _Looks) -> None:
    if looks.random is None:
        check.skip("time ran out")
        return
    check.measured["free_share"] = float(np.mean(~looks.random.meeting.any(axis=1)))
    for remark in free_configurations(looks.scene, looks.random):
        remark.add_to(check)


def _tell_hulls(recorder: Recorder, looks: _Looks) -> None:
    with recorder.check("KV332") as check:
        if not seen_by_engines(looks.scene):
            check.skip("fewer than two bodies have collision geometry")
            return
        view = HullView(looks.scene, looks.sweeper, looks.allowance)
        for done, sweep in enumerate(looks.sweeps):
            if not looks.in_time:
                check.skip(f"time ran out before {len(looks.sweeps) - done} joints")
                return
            for remark in view.blocked(sweep, _HULL_SAMPLES):
                remark.add_to(check)
