"""Cabinets on disk for tests of the benchmark, whose names must not reach an inference, and requests for them."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

from kinematify.evaluation.benchmark_job import JobResult
from kinematify.evaluation.result_record import Report
from kinematify.evaluation.run_benchmark import run_benchmark

BOX = '<visual><geometry><box size="{size}"/></geometry></visual>'


def link(name: str, size: str) -> str:
    return f'<link name="{name}">{BOX.format(size=size)}</link>'


def joint(name: str, kind: str, child: str, *, xyz: str, axis: str, upper: float) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="secret_body"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/><limit lower="0" upper="{upper}" effort="1" velocity="1"/></joint>'
    )


def write_object(folder: Path, *, with_knob: bool) -> None:
    """A body with a door on a vertical hinge and a drawer, and a knob or not."""
    text = (
        '<robot name="secret_cabinet">'
        + link("secret_body", "1 1 1")
        + link("secret_door", "0.02 0.5 1")
        + joint("secret_hinge", "revolute", "secret_door", xyz="0.52 0 0", axis="0 0 1", upper=1.5)
    )
    if with_knob:
        text += link("secret_drawer", "0.5 0.4 0.2")
        text += joint("secret_slide", "prismatic", "secret_drawer", xyz="0 0.7 0", axis="1 0 0", upper=0.4)
    folder.mkdir(parents=True)
    (folder / "model.urdf").write_text(text + "</robot>")
    facts = {"kind": "everyday", "category": "cabinet"}
    (folder / "source.json").write_text(json.dumps(facts))


def request(data: Path, work: Path, infer: str, **changes: Any) -> partial[Report[JobResult]]:
    settings = {"jobs": 2, "infer": f"quick_inference:{infer}", "timeout": 60.0, **changes}
    return partial(run_benchmark, data, work=work, **settings)
