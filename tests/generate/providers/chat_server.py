"""A local server with the usual chat interface that answers from a script, its failures included."""

from __future__ import annotations

import json
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

KEY = "secret-key-0123456789"


class ChatServer:
    """Gives one line of the script per request, and the last one again and again.

    A line is what the model says; or a status; or one of ``drop`` (the connection ends), ``slow``, ``odd`` (no
    message), ``refusal``.
    """

    def __init__(self, *script: Any) -> None:
        self.script = list(script)
        self.requests: list[dict[str, Any]] = []
        server = self

        class Handler(BaseHTTPRequestHandler):
            def log_message(self, *_: Any) -> None:
                """Say nothing."""

            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers.get("Content-Length", "0")))
                server.requests.append(json.loads(body))
                line = server.script.pop(0) if len(server.script) > 1 else server.script[0]
                if self.headers.get("Authorization") != f"Bearer {KEY}":
                    line = 401
                if line == "drop":
                    self.connection.close()
                    return
                if line == "slow":
                    time.sleep(1.5)
                message: dict[str, Any] = {"content": line}
                if line == "refusal":
                    message = {"content": None, "refusal": "I do not design such things."}
                answer = {"choices": [{"message": message}], "usage": {"total_tokens": 1000}}
                self._send(line if isinstance(line, int) else 200, {"detail": "odd"} if line == "odd" else answer)

            def _send(self, status: int, answer: dict[str, Any]) -> None:
                data = json.dumps(answer).encode()
                try:
                    self.send_response(status)
                    self.send_header("Content-Length", str(len(data)))
                    self.end_headers()
                    self.wfile.write(data)
                except OSError:  # whoever asked did not wait
                    return

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}/v1"

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
