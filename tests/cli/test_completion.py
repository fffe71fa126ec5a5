"""What a shell completes is what there is."""

from __future__ import annotations

from pathlib import Path

from click.shell_completion import ShellComplete

from kinematify.cli.app import cli


def completed(words: list[str], begun: str) -> list[str]:
    return [item.value for item in ShellComplete(cli, {}, "kinematify", "_X").get_completions(words, begun)]


def test_categories_checks_and_joints_are_completed(tmp_path: Path) -> None:
    assert completed(["generate", "--category"], "cabin") == ["cabinet"]
    assert completed(["explain"], "kv31")[0] == "KV310"
    model = tmp_path / "door.urdf"
    model.write_text(
        '<robot name="d"><link name="a"/><link name="b"/><joint name="hinge" type="continuous"><parent link="a"/>'
        '<child link="b"/></joint></robot>'
    )
    assert completed(["view", str(model), "--joint"], "h") == ["hinge"]
    assert completed(["view", "none.urdf", "--joint"], "h") == []
    assert "--hint" in completed(["infer"], "--h")
