"""How soon does the viewer show a model, and how soon does it answer a slider?

`kinematify view` of a model of ten parts is started as a user does, beside a browser that is open already and draws by
the processor, as a machine without a graphics card must. *Address*: from the command until it prints where the page is.
*Picture*: from the command until the page shows the parts. *Answer*: from a slider's message to the server until the
first answer is back on the page; ten in each start. The processor's time until the picture is beside the clock:
where the clock says much more, the machine was busy. The *empty* page is one box in viser without anything of ours,
which no change of ours makes faster.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import Field

from benchmarks.browser import open_browser
from benchmarks.study import Options, Study, explained
from kinematify.errors import EnvironmentFault
from kinematify.evaluation.result_record import grouped, table
from kinematify.generate.sentence import from_text
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Page, WebSocket

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

SENTENCE = "a kitchen cabinet with three doors above six drawers, 80 cm wide"
GOALS = {"picture": 2.0, "answer": 0.05}
"""[s]."""
PAGES = ("model", "empty")
_PORT = 18500
_EMPTY = f"""
import time, viser
server = viser.ViserServer(port={_PORT}, verbose=False)
server.scene.add_box("/box", color=(30, 30, 90), dimensions=(2.0, 2.0, 2.0))
print("http://localhost:{_PORT}", flush=True)
time.sleep(3600)
"""
_PATIENCE = 120_000.0
"""For a page on a busy machine [ms]."""
_KEYS = 10
"""Times that a slider is moved in each start."""
_STILL = 500.0
"""Until a page has nothing left to do [ms]."""
_SHOWN = """
() => new Promise(done => {
  const look = () => {
    const [seen] = [...document.querySelectorAll('canvas')].sort((a, b) => b.width - a.width);
    if (seen && seen.width > 300) {
      const small = document.createElement('canvas');
      [small.width, small.height] = [64, 48];
      const context = small.getContext('2d');
      context.drawImage(seen, 0, 0, 64, 48);
      const pixels = context.getImageData(12, 8, 40, 32).data;
      let dark = 0;
      for (let i = 0; i < pixels.length; i += 4)
        if (pixels[i + 3] > 200 && Math.min(pixels[i], pixels[i + 1], pixels[i + 2]) < 190) dark++;
      if (dark > 60) return done();
    }
    setTimeout(look, 50);
  };
  look();
})
"""
"""Until something stands in the middle of the pale page; looking oftener would keep the processor from drawing."""
_COLUMNS = {
    "address": "address [s]",
    "picture": "picture [s]",
    "command": "processor: command until address [s]",
    "server": "processor: server after that [s]",
    "browser": "processor: browser [s]",
}


class ViewerOptions(Options):
    """How often."""

    repeats: int = Field(5, ge=1, description="Starts of each page.")


@dataclass(frozen=True, kw_only=True)
class Start:
    """One start of a page."""

    page: str
    """Of `PAGES`."""
    number: int
    model: Path


def measure(options: ViewerOptions, work: Work) -> Measured:
    """Start both pages in turn, so that they meet the same machine."""
    model = work.folder / "model"
    write_inference(infer(from_text(SENTENCE).build().assembly), model, preview=False, overwrite=True)
    asked = {
        f"{page} {number}": Start(page=page, number=number, model=model)
        for number in range(options.repeats)
        for page in PAGES
    }
    records = list(work.each(started, asked, workers=1).values())
    return records, {"cores": len(os.sched_getaffinity(0)), "load": os.getloadavg()[0]}


def started(asked: Start) -> Record:
    """Start a page once; move the first slider of a model."""
    view = ["-m", "kinematify", "view", str(asked.model), "--port", str(_PORT)]
    with open_browser() as browser:
        page = browser.new_page(viewport={"width": 1200, "height": 800})
        page.set_default_timeout(_PATIENCE)
        record: Record = {"page": asked.page, "start": asked.number}
        start = time.perf_counter()
        with _serving(view if asked.page == "model" else ["-c", _EMPTY]) as (server, address):
            record["address"] = time.perf_counter() - start
            record["command"], before = _processor_time(server), _processor_time(os.getpid(), without=server)
            messages = _messages(page)
            page.goto(address, wait_until="commit")
            page.evaluate(_SHOWN)
            record["picture"] = time.perf_counter() - start
            record["server"] = _processor_time(server) - record["command"]
            record["browser"] = _processor_time(os.getpid(), without=server) - before
            if asked.page == "model":
                record["answers"] = _answers(page, messages)
    return record


@contextmanager
def _serving(arguments: list[str]) -> Iterator[tuple[int, str]]:
    """Run a server in Python; yield its process and the address, once that is printed."""
    server = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        yield server.pid, next(line for line in server.stdout if line.startswith("http")).split()[0]
    finally:
        server.terminate()
        server.wait()


def _messages(page: Page) -> list[tuple[str, float]]:
    """What the page says and hears from now on, each with its time [s], as it comes."""
    messages: list[tuple[str, float]] = []

    def listen(socket: WebSocket) -> None:
        socket.on("framesent", lambda _: messages.append(("sent", time.perf_counter())))
        socket.on("framereceived", lambda _: messages.append(("received", time.perf_counter())))

    page.on("websocket", listen)
    return messages


def _answers(page: Page, messages: list[tuple[str, float]]) -> list[float]:
    """Times from messages of a slider to what comes back [s]."""
    page.get_by_text("Nothing collides").first.wait_for()
    page.wait_for_timeout(3.0 * _STILL)
    page.locator("[role=slider]").first.focus()
    answers = []
    for _ in range(_KEYS):
        messages.clear()
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(_STILL)
        sent = next((at for kind, at in messages if kind == "sent"), None)
        back = next((at for kind, at in messages if kind == "received" and sent is not None and at > sent), None)
        if sent is None or back is None:
            raise EnvironmentFault("The page heard nothing after a slider was moved. Measure on a quieter machine.")
        answers.append(back - sent)
    return answers


def _processor_time(root: int, *, without: int = 0) -> float:
    """Of a process and its offspring [s]; one of them can be omitted."""
    used, parents = {}, {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        pid = int(path.parent.name)
        parents[pid], used[pid] = int(fields[1]), sum(map(int, fields[11:13]))
    family, found = {root}, {root}
    while found:
        found = {pid for pid, parent in parents.items() if parent in found and pid != without}
        family |= found
    return sum(used[pid] for pid in family) / os.sysconf("SC_CLK_TCK")


def report(found: Report[Record]) -> list[str]:
    """A line per start, the medians, and what was asked for."""
    rows = [(item["page"], *(f"{item[name]:.2f}" for name in _COLUMNS), _slowest(item)) for item in found.records]
    pages = grouped(found.records, by=lambda item: str(item["page"]))
    for page, items in pages.items():
        medians = (f"{statistics.median(item[name] for item in items):.2f}" for name in _COLUMNS)
        rows.append((f"**{page}, median**", *medians, ""))
    models = pages["model"]
    picture = statistics.median(item["picture"] for item in models)
    answer = statistics.median(answer for item in models for answer in item["answers"])
    said = (
        f"Medians: a model is seen after {picture:.1f} s (goal {GOALS['picture']:.0f}) and answers within "
        f"{1000.0 * answer:.0f} ms (goal {1000.0 * GOALS['answer']:.0f}). {found.summary['cores']} cores, load "
        f"{found.summary['load']:.1f} at the end."
    )
    return [explained(__doc__), said, table(("page", *_COLUMNS.values(), "slowest answer [ms]"), rows)]


def _slowest(item: Record) -> str:
    return f"{1000.0 * max(item['answers']):.0f}" if "answers" in item else ""


STUDY = Study(title="How soon the viewer shows a model", options=ViewerOptions, measure=measure, report=report)
