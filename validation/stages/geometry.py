"""The stage `geometry`: collision at rest and along the motion by exact geometry, without an engine (KV30x to KV33x).

Where time runs out, the checks say what they omitted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.checks import checks_of
from kinematify.validation.summary import summary_of

if TYPE_CHECKING:
    from kinematify.validation.check import Check
    from kinematify.validation.geometry.look import GeometryContext
    from kinematify.validation.stage import Recorder, StageRequest

AT_REST, IN_MOTION, TOGETHER = checks_of("KV30"), checks_of("KV31", "KV32"), checks_of("KV33")


def run(request: StageRequest, recorder: Recorder) -> None:
    """Look at the model at rest and in motion; see `kinematify.validation.stage`."""
    from kinematify.geometry.scene import colliding_shapes, read_scene
    from kinematify.validation.geometry.look import GeometryContext
    from kinematify.validation.model_cache import model_of

    every = (*AT_REST, *IN_MOTION, *TOGETHER)
    if not recorder.is_selected(*(entry.id for entry in every)):
        return
    scene = read_scene(model_of(request), request.settings.geometry, colliding_shapes, thin=True)
    if len(scene.bodies) < 2:
        recorder.skip(every, "fewer than two bodies have geometry")
        return
    look = GeometryContext(
        scene,
        seed=request.settings.seed,
        in_time=lambda: request.remaining > 0.0,
        compare_visible=True,
    )
    for entry in AT_REST:
        recorder.run(entry, look)
    if not scene.travels:
        recorder.skip((*IN_MOTION, *TOGETHER), "no joint moves")
        return
    for sweep in look.sweeps:
        joint = scene.model.joint_by_name[sweep.travel.joint]
        recorder.summarise(summary_of(joint, free_travel=sweep.free))
    for entry in IN_MOTION:
        _tell_motion(entry, look, recorder)
    recorder.summarise(look.pair_table())
    for entry in TOGETHER:
        recorder.run(entry, look)


def _tell_motion(entry: Check, look: GeometryContext, recorder: Recorder) -> None:
    """Run a check for one joint after the other."""
    if not recorder.is_selected(entry.id):
        return
    with recorder.check(entry.id) as result:
        if look.late is not None:
            result.skip(look.late)
        result.measured["joints"] = len(look.sweeps)
        for motion in look.motions:
            entry.run(result, motion)
