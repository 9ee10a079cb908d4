"""Who may reach the workbench, and how it ends."""

from __future__ import annotations

import http.client
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlencode, urlsplit

import pytest
from browser import workbench


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with workbench(tmp_path_factory.mktemp("server")) as (_, said):
        yield said


def ask(
    address: str, path: str = "", method: str = "GET", body: bytes | None = None, **headers: str
) -> http.client.HTTPResponse:
    parts = urlsplit(address)
    connection = http.client.HTTPConnection(parts.netloc, timeout=20)
    given = path or f"{parts.path}?{parts.query}"
    connection.request(method, given, body, {k.replace("_", "-"): v for k, v in headers.items()})
    return connection.getresponse()


def at(address: str, path: str, **query: str) -> str:
    return f"/{path}?{urlsplit(address).query}&{urlencode(query)}"


def test_the_address_has_a_token_and_answers(address: str) -> None:
    parts = urlsplit(address)
    assert parts.hostname == "127.0.0.1"
    assert parts.query.startswith("token=") and len(parts.query) > 30
    answer = ask(address)
    assert answer.status == 200
    assert b"stribeck workbench" in answer.read()


@pytest.mark.parametrize(
    "path", ["/", "/data", "/do", "/progress", "/figures/data", "/static/bokeh.min.js", "/nowhere"]
)
@pytest.mark.parametrize("query", ["", "?token=", "?token=wrong"])
def test_nothing_answers_without_the_token(address: str, path: str, query: str) -> None:
    assert ask(address, path + query).status == 403
    assert ask(address, path + query, "POST", b"action=cancel").status == 403


def test_another_host_or_origin_is_refused(address: str) -> None:
    port = urlsplit(address).port
    assert ask(address, Host=f"evil.example:{port}").status == 403
    assert ask(address, Host="127.0.0.1:1").status == 403
    for origin in (
        "http://evil.example",
        "null",
        f"http://evil.example:{port}",
        "http://127.0.0.1:1",
    ):
        assert ask(address, Origin=origin).status == 403
        assert (
            ask(address, at(address, "do"), "POST", b"action=cancel", Origin=origin).status == 403
        )
    assert ask(address, Origin=f"http://127.0.0.1:{port}").status == 200
    assert ask(address, Host=f"localhost:{port}").status == 200


def test_a_websocket_of_another_origin_is_refused(address: str) -> None:
    upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec_WebSocket_Version": "13"}
    key = {"Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ=="}
    assert (
        ask(address, at(address, "ws"), Origin="http://evil.example", **upgrade, **key).status
        == 403
    )
    assert ask(address, at(address, "ws"), **upgrade, **key).status == 404


def test_pages_admit_no_other_script_and_no_frame(address: str) -> None:
    policy = ask(address).getheader("Content-Security-Policy") or ""
    assert "default-src 'none'" in policy and "script-src 'self';" in policy
    assert "frame-ancestors 'none'" in policy
    assert b"http://" not in ask(address).read() and b"https://" not in ask(address).read()


def test_files_are_served_by_name_alone(address: str) -> None:
    for name in ("static/../server.py", "static/..%2Fserver.py", "static/server.py", "written/0"):
        assert ask(address, at(address, name)).status in (403, 404)


def test_too_large_a_file_is_refused(address: str) -> None:
    answer = ask(address, at(address, "upload"), "POST", None, Content_Length=str(2**40))
    assert answer.status == 400


def test_an_error_is_one_sentence(address: str) -> None:
    body = urlencode({"action": "open", "path": "/nowhere.csv", "page": "data"}).encode()
    kind = "application/x-www-form-urlencoded"
    answer = ask(address, at(address, "do"), "POST", body, Content_Type=kind)
    assert answer.status == 303
    text = ask(address).read().decode()
    assert "/nowhere.csv: there is no such file: check the path" in text
    assert "Traceback" not in text


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_code_0(tmp_path: Path, number: signal.Signals) -> None:
    with workbench(tmp_path) as (process, said):
        assert ask(said).status == 200
        process.send_signal(number)
        assert process.wait(20) == 0


def test_a_port_that_is_taken_is_one_line(address: str) -> None:
    words = [sys.executable, "-m", "stribeck", "app", "--no-browser"]
    port = str(urlsplit(address).port)
    ended = subprocess.run(
        [*words, "--port", port], capture_output=True, text=True, env={**os.environ}, check=False
    )
    assert ended.returncode == 2 and ended.stdout == ""
    assert ended.stderr.count("\n") == 1 and "give another with --port" in ended.stderr
