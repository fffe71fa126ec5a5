"""`kinematify mcp`: the commands as tools of the Model Context Protocol, for coding agents that write models."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from kinematify import __version__
from kinematify.cli.options import examples
from kinematify.errors import InputError
from kinematify.versions import require

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

_LARGEST = 256e6
"""Of a file that a tool opens [bytes]."""
_SECONDS = 600.0
"""A command is stopped after so long."""
_MOST_FINDINGS = 60
"""In one answer, the most severe first: an agent repairs these and asks again."""
_FIELDS = ("check", "severity", "line", "link", "joint", "pair", "engine", "message", "remedy")
"""Fields of a finding in an answer."""
_INSTRUCTIONS = (
    "Kinematify checks and repairs robot descriptions (URDF, xacro, MJCF, SDF, USD) in simulation and finds the joints "
    "of meshes. Write a model, validate it, read each finding's message and remedy, change the file or call fix, and "
    "validate again until the verdict is pass. Look at the picture of a model before you say that it is right. Paths "
    "are relative to the root folder of this server."
)


@click.command(
    "mcp",
    epilog=examples("kinematify mcp robots/", "kinematify mcp ."),
)
@click.argument("root", type=click.Path(path_type=Path), default=".")
def command(*, root: Path) -> int:
    """Serve validate, explain, fix, infer, export and look over stdin and stdout, until the client goes away.

    The tools read and write below ROOT alone. Needs the extra mcp: pip install "kinematify[mcp]".
    """
    require("kinematify mcp", "mcp")
    if not root.is_dir():
        raise InputError(f"{root} is no folder. Give the folder whose models the tools may read and write.")
    server(root.resolve()).run("stdio")
    return 0


def server(root: Path) -> MCPServer:
    """The server with its tools; every call runs in a process of its own.

    Args:
        root: Folder, without links, that all paths must be below.
    """
    from mcp.server.mcpserver import Image, MCPServer

    async def answered(name: str, *words: str) -> dict[str, Any]:
        """Answer of a command as JSON, with paths relative to the root; its findings are an answer, too."""
        text = await _run(name, "--json", "-", *words, findings=True)
        return dict(json.loads(text.replace(f"{root}{os.sep}", "")))

    served = MCPServer("kinematify", version=__version__, instructions=_INSTRUCTIONS)

    @served.tool()
    async def validate(model: str, quick: bool = True, checks: str = "") -> dict[str, Any]:
        """Check a model: file, meshes, physics, joints in motion, engines. Gives the verdict and the findings.

        quick leaves out the slower checks; checks are patterns such as "KV3*,KV801".
        """
        chosen = ["--checks", checks] if checks else ["--quick"] if quick else []
        report = await answered("validate", *chosen, "--", _inside(root, model))
        found = [item for item in report["findings"] if item["suppressed"] is None and item["severity"] != "note"]
        shown = [{key: item[key] for key in _FIELDS if item.get(key) is not None} for item in found[:_MOST_FINDINGS]]
        return {"verdict": report["verdict"], "findings": shown, "not_shown": len(found) - len(shown)}

    @served.tool()
    async def explain(check: str) -> dict[str, Any]:
        """Explain a check, such as KV301: what it verifies, why it matters, how to repair what it finds."""
        return dict((await answered("explain", "--", check))["checks"][0])

    @served.tool()
    async def fix(model: str, out: str, kinematics: bool = False) -> dict[str, Any]:
        """Write a model as the URDF `out` with certain findings repaired; kinematics lets it change joints, too."""
        changed = ["--kinematics"] if kinematics else []
        place = _inside(root, out, new=True)
        found = await answered("fix", "-o", place, "--force", *changed, "--", _inside(root, model))
        return {key: value for key, value in found.items() if value and key != "named"}

    @served.tool()
    async def infer(meshes: str, out: str, hints: list[str] | None = None) -> dict[str, Any]:
        """Find the joints of segmented meshes and write the model folder `out`; a hint is "door:axis=z"."""
        given = [word for hint in hints or () for word in ("--hint", hint)]
        place = _inside(root, out, new=True)
        return await answered("infer", "-o", place, "--force", *given, "--", _inside(root, meshes))

    @served.tool()
    async def export(model: str, to: Literal["mjcf", "usd", "sdf", "urdf", "glb", "srdf"], out: str) -> dict[str, Any]:
        """Write a model in another format and list what that format cannot hold."""
        place = _inside(root, out, new=True)
        return await answered("export", "--to", to, "-o", place, "--force", "--", _inside(root, model))

    @served.tool(structured_output=False)
    async def look(model: str, positions: dict[str, float] | None = None) -> Any:
        """Draw a model with joints at the given positions [rad or m], the others at zero."""
        moved = [
            f"--{key}={value}" for name, q in (positions or {}).items() for key, value in (("joint", name), ("q", q))
        ]
        with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
            file = Path(folder, "picture.png")
            await _run("view", "--png", str(file), *moved, "--", _inside(root, model))
            return Image(data=file.read_bytes(), format="png")

    return served


def _inside(root: Path, name: str, *, new: bool = False) -> str:
    """A path of a client as one that commands take.

    Raises:
        ToolError: It leads outside of `root`, or there is no such file, or it is too large.
    """
    path = (root / name).resolve()
    if not path.is_relative_to(root) or (new and path == root):
        raise _refused(f"{name} is not below {root}, the root of this server. Give a path below it.")
    if not new and not path.exists():
        raise _refused(f"There is no {name} below {root}.")
    if path.is_file() and path.stat().st_size > _LARGEST:
        raise _refused(f"{name} has {path.stat().st_size / 1e6:.0f} MB; at most {_LARGEST / 1e6:.0f} are read.")
    return str(path)


async def _run(*words: str, findings: bool = False) -> str:
    """What a command prints; it is stopped when the client cancels the call.

    Raises:
        ToolError: It ends with another status than 0, or 1 where that means findings.
    """
    import asyncio

    command = [sys.executable, "-m", "kinematify", *words]
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    try:
        out, said = await asyncio.wait_for(process.communicate(), _SECONDS)
    except TimeoutError:
        raise _refused(f"kinematify {words[0]} was stopped after {_SECONDS:.0f} s.") from None
    finally:
        if process.returncode is None:
            process.kill()
    if process.returncode == 0 or (findings and process.returncode == 1 and out):
        return out.decode()
    raise _refused(said.decode(errors="replace").strip()[-2000:] or f"Ended with {process.returncode}.")


def _refused(message: str) -> Exception:
    """An exception whose message the client sees."""
    from mcp.server.mcpserver.exceptions import ToolError

    return ToolError(message)
