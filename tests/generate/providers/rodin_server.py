"""A local HTTP server that speaks the generator's protocol as its public clients see it, its failures included."""

from __future__ import annotations

import json
import threading
from collections import Counter
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

KEY = "secret-key-0123456789"


def _last(path: str) -> str:
    return path.rsplit("/", maxsplit=1)[-1]


class RodinServer:
    """Answers from scripts: for each path a list of faults, one per request, then good answers.

    A fault is a status, or one of ``drop`` (the connection ends before the answer), ``garbage``, ``odd`` (JSON of
    another form), ``slow``, ``cut`` (a file ends early), ``failed`` (of a job), ``waiting``, ``empty`` (list).
    """

    def __init__(self, files: dict[str, bytes]) -> None:
        self.files = files
        self.faults: dict[str, list[Any]] = {}
        self.requests: Counter[str] = Counter()
        self.paid: Counter[str] = Counter()
        self.bodies: list[bytes] = []
        self.keys_at_links: list[str | None] = []
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}/api/v2"

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def _answer(self, path: str) -> dict[str, Any]:
        if path in ("/rodin", "/bang"):
            self.paid[path] += 1
            number = self.paid[path]
            return {"uuid": f"{path[1:]}-{number}", "jobs": {"uuids": ["a"], "subscription_key": f"key-{path[1:]}"}}
        if path == "/status":
            return {"jobs": [{"uuid": "a", "status": "Done"}, {"uuid": "b", "status": "Done"}]}
        base = self.url.removesuffix("/api/v2")
        return {"list": [{"name": name, "url": f"{base}/files/{_last(name)}"} for name in self.files]}

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        server = self

        class Handler(BaseHTTPRequestHandler):
            def log_message(self, *_: Any) -> None:
                """Say nothing."""

            def do_POST(self) -> None:
                path = self.path.removeprefix("/api/v2")
                server.bodies.append(self.rfile.read(int(self.headers.get("Content-Length", "0"))))
                server.requests[path] += 1
                if self.headers.get("Authorization") != f"Bearer {KEY}":
                    self._send(401, b'{"error": "unauthorised"}')
                    return
                self._with_fault(path, server.faults.get(path) or [])

            def _with_fault(self, path: str, faults: list[Any]) -> None:
                fault = faults.pop(0) if faults else None
                if isinstance(fault, int):
                    self._send(fault, f'{{"error": "{KEY} no"}}'.encode(), retry=fault == 429)
                elif fault == "drop":
                    server._answer(path)  # taken, and paid, but nobody hears of it
                    self.connection.close()
                elif fault == "garbage":
                    self._send(200, b"<html>maintenance</html>")
                elif fault == "odd":
                    self._send(200, b'["unexpected"]')
                elif fault in ("failed", "waiting"):
                    state = {"failed": "Failed", "waiting": "Generating"}[fault]
                    self._send(200, json.dumps({"jobs": [{"status": state}]}).encode())
                elif fault == "empty":
                    self._send(200, b'{"list": []}')
                else:
                    self._send(200, json.dumps(server._answer(path)).encode())

            def do_GET(self) -> None:
                name = _last(self.path)
                server.requests["link"] += 1
                server.keys_at_links.append(self.headers.get("Authorization"))
                faults = server.faults.get("link") or []
                fault = faults.pop(0) if faults else None
                if isinstance(fault, int):
                    self._send(fault, b"")
                    return
                content = next(content for path, content in server.files.items() if _last(path) == name)
                self._send(200, content[: len(content) // 2] if fault == "cut" else content)

            def _send(self, status: int, content: bytes, *, retry: bool = False) -> None:
                self.send_response(status)
                self.send_header("Content-Length", str(len(content)))
                if retry:
                    self.send_header("Retry-After", "0")
                self.end_headers()
                self.wfile.write(content)

        return Handler
