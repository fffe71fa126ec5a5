"""`kinematify mcp`, driven by the protocol's own client over stdin and stdout."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("mcp", reason="the extra mcp is not installed")

from mcp import Client
from mcp.client.stdio import StdioServerParameters

from tests.places import ROOT

_BODY = """<link name="{name}">
    <inertial><origin xyz="{x} 0 0"/><mass value="{mass}"/>
      <inertia ixx="0.4" iyy="0.44" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="{x} 0 0"/><geometry>{shape}</geometry></visual>
    <collision><origin xyz="{x} 0 0"/><geometry><box size="{size}"/></geometry></collision>
  </link>"""
_DOOR = """<robot name="door">
  {frame}
  {leaf}
  <joint name="hinge" type="revolute">
    <parent link="{parent}"/><child link="leaf"/><origin xyz="0.06 0 0"/><axis xyz="0 0 1"/>
    <limit lower="{lower}" upper="{upper}" effort="20" velocity="2"/>
  </joint>
</robot>
"""


def door(*, mass: float = 5.0, mesh: str = "", parent: str = "frame", limits: tuple[float, float] = (0.0, 1.5)) -> str:
    shape = f'<mesh filename="{mesh}"/>' if mesh else '<box size="0.5 0.02 0.9"/>'
    frame = _BODY.format(name="frame", x=0, mass=5, shape='<box size="0.1 0.1 1"/>', size="0.1 0.1 1")
    leaf = _BODY.format(name="leaf", x=0.25, mass=mass, shape=shape, size="0.5 0.02 0.9")
    return _DOOR.format(frame=frame, leaf=leaf, parent=parent, lower=limits[0], upper=limits[1])


def with_client(root: Path, work: Callable[[Client], Awaitable[None]]) -> None:
    """Start the server for `root`, as an agent's program does, and let `work` call its tools."""

    async def run() -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        server = StdioServerParameters(
            command=sys.executable, args=["-m", "kinematify", "mcp", str(root)], env=environment
        )
        async with Client(server) as client:
            await work(client)

    asyncio.run(run())


async def call(client: Client, tool: str, **arguments: object) -> dict[str, Any]:
    answer = await client.call_tool(tool, arguments)
    assert not answer.is_error, answer.content
    found = answer.structured_content
    assert found is not None
    return found


async def refusal(client: Client, tool: str, **arguments: object) -> str:
    answer = await client.call_tool(tool, arguments)
    assert answer.is_error
    return str(answer.content)


def test_an_agent_brings_broken_models_to_pass(tmp_path: Path) -> None:
    broken = {
        "swapped": (door(limits=(1.5, 0.0), mesh="leaf.stl"), "KV137"),
        "lost": (door(parent="frme"), "KV12"),
    }

    async def repair(client: Client) -> None:
        for name, (text, check) in broken.items():
            file = tmp_path / f"{name}.urdf"
            file.write_text(text)
            before = await call(client, "validate", model=file.name)
            assert before["verdict"] != "pass"
            assert any(item["check"].startswith(check) and item["remedy"] for item in before["findings"])
            if name == "lost":  # what no repair can know, the message says
                assert any("frme" in item["message"] for item in before["findings"])
                file.write_text(text.replace("frme", "frame"))
            else:
                assert any("leaf.stl" in item["message"] for item in before["findings"])
                file = tmp_path / f"{name}_fixed.urdf"
                await call(client, "fix", model=f"{name}.urdf", out=file.name, kinematics=True)
            assert await call(client, "validate", model=file.name, quick=name != "lost") == {
                "verdict": "pass",
                "findings": [],
                "not_shown": 0,
            }
        answer = await client.call_tool("look", {"model": "swapped_fixed.urdf", "positions": {"hinge": 0.7}})
        assert [item.type for item in answer.content] == ["image"]

    with_client(tmp_path, repair)


def test_paths_outside_of_the_root_and_huge_files_are_refused_and_calls_run_side_by_side(tmp_path: Path) -> None:
    root = tmp_path / "root"
    root.mkdir()
    (tmp_path / "door.urdf").write_text(door())
    (root / "door.urdf").write_text(door())
    (root / "link.urdf").symlink_to(tmp_path / "door.urdf")
    with (root / "huge.urdf").open("wb") as file:
        file.truncate(2**30)

    async def try_all(client: Client) -> None:
        for name in ("../door.urdf", str(tmp_path / "door.urdf"), "link.urdf"):
            assert "not below" in await refusal(client, "validate", model=name)
        assert "not below" in await refusal(client, "export", model="door.urdf", to="mjcf", out="../door.xml")
        assert "1074 MB" in await refusal(client, "validate", model="huge.urdf")
        assert "nothing.urdf" in await refusal(client, "look", model="nothing.urdf")
        _, explained = await asyncio.gather(
            call(client, "export", model="door.urdf", to="mjcf", out="door.xml"), call(client, "explain", check="KV301")
        )
        assert explained["id"] == "KV301"
        assert (root / "door.xml").is_file()

    with_client(root, try_all)
    assert not (tmp_path / "door.xml").exists()


_GONE = """
import asyncio, sys
from pathlib import Path
from tests.cli.test_mcp import call, with_client
with_client(Path(sys.argv[1]), lambda client: call(client, "validate", model="door.urdf", quick=False))
"""


def processes_at(root: Path) -> list[str]:
    """Command lines of running processes that name a folder."""
    found = []
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            found.append(file.read_bytes().replace(b"\0", b" ").decode(errors="replace"))
    return [line for line in found if str(root) in line]


def waited(condition: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + 120.0
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.1)
    return condition()


def test_a_client_that_goes_away_leaves_no_process(tmp_path: Path) -> None:
    (tmp_path / "door.urdf").write_text(door())
    client = subprocess.Popen([sys.executable, "-c", _GONE, str(tmp_path)], env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert waited(lambda: any(" validate " in line for line in processes_at(tmp_path)))
    client.kill()
    client.wait()
    assert waited(lambda: not processes_at(tmp_path))
