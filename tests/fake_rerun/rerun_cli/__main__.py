"""A stand-in for Rerun's server: takes what the stand-in for `rerun` logs and serves a page."""

from __future__ import annotations

import argparse
import os
import socket
import sys
import threading


def take(connection: socket.socket) -> None:
    from rerun import PIECE

    stream = connection.makefile("rb")
    while kind := stream.read(1):
        if kind == b"L":
            stream.read(PIECE)
        else:
            connection.sendall(b"A")


def serve_page(server: socket.socket) -> None:
    while True:
        with server.accept()[0] as browser:
            browser.sendall(b"HTTP/1.0 200 OK\r\n\r\na page\n")


def main() -> None:
    if os.environ.get("FAKE_SERVER") == "never":
        sys.exit(3)
    parser = argparse.ArgumentParser()
    for name in ("bind", "port", "web-viewer-port", "server-memory-limit", "cors-allow-origin"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--serve-web", action="store_true", required=True)
    asked = parser.parse_args()
    page = socket.create_server((asked.bind, int(asked.web_viewer_port)))
    threading.Thread(target=serve_page, args=(page,), daemon=True).start()
    data = socket.create_server((asked.bind, int(asked.port)), backlog=128)
    while True:  # without a descriptor left it ends, as the real one does
        threading.Thread(target=take, args=(data.accept()[0],), daemon=True).start()


main()
