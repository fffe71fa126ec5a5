"""The questions as a page in a browser, for a person: a click on a picture answers.

It serves this machine alone and ends when all questions are answered or the person says so.
"""

from __future__ import annotations

import base64
import html
import io
import json
import secrets
import threading
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

from kinematify.vision.pictures import CAPTION, COLUMNS
from kinematify.vision.question import Answer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.vision.question import JointQuestion

_LONGEST = 1 << 16  # bytes of an answer
_STYLE = """
body { font: 16px/1.4 system-ui, sans-serif; margin: 0 auto; max-width: 980px; padding: 1rem; color: #1e222a; }
section { margin: 0 0 3rem; } .sheet { position: relative; display: inline-block; } .sheet img { max-width: 100%; }
.sheet button { position: absolute; background: none; border: 3px solid transparent; cursor: pointer; }
.sheet button:hover, .sheet button:focus { border-color: #1a6; } button { font: inherit; }
button.chosen { border: 3px solid #1a6; background: #1a62; }
.words button { margin: .3rem .5rem .3rem 0; padding: .4rem .9rem; }
"""
_SCRIPT = """
const key = location.search.slice(1);
const post = (body) => fetch('/answer?' + key, {method: 'POST', body: JSON.stringify(body)});
document.querySelectorAll('[data-choice]').forEach((button) => button.addEventListener('click', async () => {
  const section = button.closest('section');
  await post({question: Number(section.dataset.question), choice: button.dataset.choice});
  section.querySelectorAll('.chosen').forEach((other) => other.classList.remove('chosen'));
  button.classList.add('chosen');
}));
document.getElementById('done').addEventListener('click', async () => {
  await post({done: true});
  document.body.innerHTML = '<h1>Thank you</h1><p>The answers are used now; this page can be closed.</p>';
});
"""


@dataclass
class QuestionPage:
    """Asks a person; whoever answers is believed."""

    said: Callable[[str], None]
    """Is given the address of the page."""
    port: int = 0
    """A free one if 0."""
    name: str = "A person"
    at_once: int = 1000
    """Questions of one page."""

    def ask(self, questions: Sequence[JointQuestion]) -> list[Answer]:
        """See `JointOracle`; returns when the person has ended the page."""
        if not questions:
            return []
        answers = [Answer() for _ in questions]
        ended, key = threading.Event(), secrets.token_urlsafe(8)
        server = ThreadingHTTPServer(("127.0.0.1", self.port), _handler(questions, answers, ended, key))
        server.daemon_threads = True
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        self.said(f"http://127.0.0.1:{server.server_port}/?{key}")
        try:
            while not ended.wait(0.5):
                pass
        finally:
            server.shutdown()
            server.server_close()
        return answers


def _handler(
    questions: Sequence[JointQuestion], answers: list[Answer], ended: threading.Event, key: str
) -> type[BaseHTTPRequestHandler]:
    page = question_page(questions).encode()

    class Handler(BaseHTTPRequestHandler):
        def log_message(self, *_: Any) -> None:
            """Print nothing."""

        def do_GET(self) -> None:
            if self.path == f"/?{key}":
                self._reply(200, page)
            else:
                self._reply(404, b"The address needs the key behind the question mark.")

        def do_POST(self) -> None:
            given = _json_of(self.rfile.read(min(int(self.headers.get("Content-Length") or 0), _LONGEST)))
            if self.path != f"/answer?{key}" or given is None:
                self._reply(404, b"")
                return
            if given.get("done"):
                self._reply(200, b"")
                ended.set()
                return
            place, choice = given.get("question"), given.get("choice")
            if isinstance(place, int) and 0 <= place < len(questions) and choice in questions[place].choices:
                answers[place] = Answer(choice=str(choice), confidence=1.0)
                self._reply(200, b"")
            else:
                self._reply(400, b"This was not offered.")

        def _reply(self, status: int, content: bytes) -> None:
            self.send_response(status)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

    return Handler


def _json_of(body: bytes) -> dict[str, Any] | None:
    try:
        given = json.loads(body)
    except ValueError:
        return None
    return given if isinstance(given, dict) else None


def question_page(questions: Sequence[JointQuestion]) -> str:
    """The page, complete in itself."""
    sections = "".join(_section(place, question) for place, question in enumerate(questions))
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>How do these parts move?</title>'
        f"<style>{_STYLE}</style><h1>How does the red part move?</h1>"
        "<p>Click on the picture of the motion that the red part has against the blue one, or on a word below it. "
        "Questions without a click stay as they are.</p>"
        f'{sections}<p><button id="done">Use these answers</button></p><script>{_SCRIPT}</script></html>'
    )


def _section(place: int, question: JointQuestion) -> str:
    file = io.BytesIO()
    question.picture.save(file, format="PNG")
    source = f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"
    areas = "".join(_area(question, number) for number in range(len(question.options)))
    words = "".join(
        f'<button data-choice="{html.escape(word)}">{html.escape(word)}</button>' for word in question.choices
    )
    title = html.escape(f"{question.child} against {question.parent}")
    sheet = f'<div class="sheet"><img src="{source}" alt="possible motions">{areas}</div>'
    return f'<section data-question="{place}"><h2>{title}</h2>{sheet}<p class="words">{words}</p></section>'


def _area(question: JointQuestion, number: int) -> str:
    """A button over the picture of an option, placed in shares of the sheet."""
    width, height = question.picture.size
    side = width // COLUMNS
    column, row = number % COLUMNS, number // COLUMNS + 1
    left, top = 100.0 / COLUMNS * column, 100.0 * row * (side + CAPTION) / height
    size = f"width:{100.0 / COLUMNS:.3f}%;height:{100.0 * (side + CAPTION) / height:.3f}%"
    label = f'aria-label="motion {number + 1}"'
    return f'<button data-choice="{number + 1}" {label} style="left:{left:.3f}%;top:{top:.3f}%;{size}"></button>'
