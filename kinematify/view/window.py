"""The page of a model: a server that shows it until it is closed."""

from __future__ import annotations

import html
import threading
from contextlib import redirect_stdout
from functools import partial
from io import StringIO
from typing import TYPE_CHECKING, Generic, TypeVar

from kinematify.model.output import MODEL_FILE, RECORD_FILE
from kinematify.robot.read import read_robot
from kinematify.versions import require
from kinematify.view.inference_view import ViewModel, declared_chains, shown_with
from kinematify.view.viewer_scene import ViewScene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    import viser

    from kinematify.view.inference_view import FindingMarker
    from kinematify.view.keep import ModelFolder
    from kinematify.view.piece_page import PiecePage
    from kinematify.view.server import ModelViewer

_Page = TypeVar("_Page", "ModelViewer", "PiecePage")
_PAGE_HEIGHT = 620
"""Of the frame in a notebook [pixels]."""


def read_model(urdf: Path, package_dirs: Sequence[Path]) -> ViewModel:
    """Read what is seen of a URDF, and what `inference.json` tells of its joints where that lies beside it.

    Raises:
        InputError: One of them cannot be read.
    """
    seen = read_robot(urdf, package_dirs=package_dirs, geometry="shown", appearance=True)
    scene = ViewScene(seen, partial(read_robot, urdf, package_dirs=package_dirs))
    record = urdf.parent / RECORD_FILE
    if not record.is_file():
        return ViewModel(scene=scene, chains=declared_chains(scene.robot))
    return shown_with(scene, record)


def _model_folder(urdf: Path) -> ModelFolder:
    """The folder of a model, to write in; it loads the inference, which takes longer than to show the page."""
    from kinematify.view.keep import ModelFolder  # noqa: PLC0415

    return ModelFolder(urdf.parent)


def model_window(
    urdf: Path,
    *,
    package_dirs: Sequence[Path] = (),
    sights: Sequence[FindingMarker] = (),
    host: str = "127.0.0.1",
    port: int = 8080,
) -> Window[ModelViewer]:
    """Start to serve a model.

    Args:
        urdf: The model.
        package_dirs: Where packages lie (``package://``).
        sights: Findings about it.
        host: ``0.0.0.0`` lets other machines in.
        port: Another one is taken if it is not free.

    Raises:
        InputError: The model cannot be read.
        EnvironmentFault: viser is not installed.
    """
    require("The viewer", "viser")
    from kinematify.view.server import ModelViewer  # noqa: PLC0415  # needs viser

    shown = read_model(urdf, package_dirs)
    viewer = partial(
        ModelViewer,
        shown=shown,
        sights=sights,
        open_folder=partial(_model_folder, urdf) if urdf.name == MODEL_FILE and shown.alternatives else None,
        reopen=lambda: read_model(urdf, package_dirs),
        changed_at=lambda: urdf.stat().st_mtime if urdf.is_file() else 0.0,
    )
    return Window(viewer, host=host, port=port)


class Window(Generic[_Page]):
    """A page that is being served."""

    def __init__(
        self, page: Callable[[viser.ViserServer], _Page], *, host: str = "127.0.0.1", port: int = 8080
    ) -> None:
        """Start to serve.

        Args:
            page: Builds what is seen.
            host: ``0.0.0.0`` lets other machines in.
            port: Another one is taken if it is not free.

        Raises:
            EnvironmentFault: viser is not installed.
        """
        require("The viewer", "viser")
        import viser  # noqa: PLC0415  # slow to load

        self._stop = threading.Event()
        with redirect_stdout(StringIO()):  # a banner of its own
            self.server = viser.ViserServer(host=host, port=port, label="kinematify view", verbose=False)
        """Of viser: what else is to stand on the page may be added to it."""
        self.server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="medium")
        self.viewer: _Page = page(self.server)
        name = "localhost" if host in ("127.0.0.1", "0.0.0.0") else host
        self.port: int = self.server.get_port()
        """The port that is served: another one than asked for if that is in use."""
        self.url = f"http://{name}:{self.port}"
        """Address of the page."""
        self.notes: tuple[str, ...] = ()
        """What a URDF does not hold of the file that is shown, one sentence each."""

    def run(self) -> None:
        """Serve until `close` is called."""
        self.viewer.run(self._stop)

    def run_aside(self) -> None:
        """Serve in a thread of its own, until `close` is called or Python ends."""
        threading.Thread(target=self.run, daemon=True, name="kinematify view").start()

    def close(self) -> None:
        """End the page."""
        self._stop.set()
        with redirect_stdout(StringIO()):
            self.server.stop()

    def _repr_html_(self) -> str:
        """The page in a notebook."""
        address = html.escape(self.url, quote=True)
        return f'<iframe src="{address}" width="100%" height="{_PAGE_HEIGHT}" frameborder="0"></iframe>'
