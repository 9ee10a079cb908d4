"""The pages over HTTP, for one user on this computer.

Every request needs the token of the address; those with another host or origin are refused, so that
no other page in the browser and no name that points here can reach them. Nothing is loaded from
elsewhere.
"""

from __future__ import annotations

import asyncio
import hmac
import secrets
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode, urlsplit

import bokeh
from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler

from stribeck.base.errors import StribeckError
from stribeck.report.workbench.controller import Workbench
from stribeck.report.workbench.figures import Drawn
from stribeck.report.workbench.forms import act
from stribeck.report.workbench.views import PAGES, compile_pages, page
from stribeck.report.workbench.work import prepare

#: Largest file that can be sent, bytes. A larger one is opened by its path.
MOST_SENT = 256 * 2**20
#: Longest wait for a change before the page is told how far the work is, s.
PAUSE = 0.25
HOSTS = ("127.0.0.1", "localhost")
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; connect-src 'self'; form-action 'self'; base-uri 'none'; "
        "frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
_HERE = Path(__file__).parent
_BOKEH = Path(bokeh.__file__).parent / "server" / "static" / "js"
#: Files of the pages, and their types.
STATIC = {
    "bokeh.min.js": (_BOKEH / "bokeh.min.js", "text/javascript"),
    "offscreen.js": (_HERE.parent / "templates" / "offscreen.js", "text/javascript"),
    "repaint.js": (_HERE.parent / "templates" / "repaint.js", "text/javascript"),
    "workbench.js": (_HERE / "static" / "workbench.js", "text/javascript"),
    "workbench.css": (_HERE / "static" / "workbench.css", "text/css"),
    "style.css": (_HERE.parent / "templates" / "style.css", "text/css"),
}


class Handler(RequestHandler):
    """A request of the one user; all others are refused."""

    bench: Workbench
    drawn: Drawn
    token: str

    def initialize(self, bench: Workbench, drawn: Drawn, token: str) -> None:
        """What all requests share."""
        self.bench, self.drawn, self.token = bench, drawn, token

    def set_default_headers(self) -> None:
        """Of every answer, refusals too."""
        for name, said in HEADERS.items():
            self.set_header(name, said)

    def prepare(self) -> None:
        """Refuse another host, another origin, and a request without the token."""
        socket = self.request.connection.stream.socket  # type: ignore[union-attr]
        if socket is None:
            raise HTTPError(400, reason="the browser has closed the connection")
        own = {f"{host}:{socket.getsockname()[1]}" for host in HOSTS}
        origin = self.request.headers.get("Origin")
        if self.request.host not in own:
            raise HTTPError(403, reason="another host")
        if origin is not None and urlsplit(origin).netloc not in own:
            raise HTTPError(403, reason="another origin")
        given = self.get_query_argument("token", "")
        if not hmac.compare_digest(given.encode(), self.token.encode()):
            raise HTTPError(403, reason="the token of the address is missing")

    def link(self, path: str, **query: str) -> str:
        """The address of a path, with the token."""
        return f"/{path}?{urlencode({'token': self.token, **query})}"

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        """One sentence."""
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"stribeck: {self._reason}: open the address that `stribeck app` printed\n")

    def back(self) -> None:
        """Show the page that a form was sent from."""
        given = self.get_body_argument("page", "data")
        name = given if given in PAGES else "data"
        self.bench.state.page = name
        self.redirect(self.link(name), status=303)


class Page(Handler):
    """One of the pages."""

    def get(self, name: str) -> None:
        """Its HTML."""
        name = name or "data"
        self.write(page(self.bench, name, self.link, self.drawn.number(name)))


class Act(Handler):
    """A form."""

    def post(self) -> None:
        """Do what it says, and show its page again."""
        given = self.request.body_arguments
        fields = {name: [v.decode("utf-8", "replace") for v in given[name]] for name in given}
        try:
            act(self.bench, self.get_body_argument("action", ""), fields)
        except StribeckError as error:
            self.bench.fail(str(error))
        self.back()


class Upload(Handler):
    """Files that are sent."""

    def post(self) -> None:
        """Keep and open them."""
        try:
            files = self.request.files.get("file", [])
            if not files:
                raise StribeckError("no file is chosen: choose one first")
            self.bench.upload([(sent["filename"], sent["body"]) for sent in files])
        except StribeckError as error:
            self.bench.fail(str(error))
        self.back()


class Progress(Handler):
    """How far the work is."""

    async def get(self) -> None:
        """As JSON, at once when something changed, or after `PAUSE`."""
        known = self.get_query_argument("version", "")
        until = time.monotonic() + PAUSE
        while str(self.bench.state.version) == known and time.monotonic() < until:
            await asyncio.sleep(0.02)
        work = self.bench.work
        left = None
        if work is not None and work.title in self.bench.took:
            left = max(self.bench.took[work.title] - work.seconds, 0.0)
        self.write(
            {
                "version": self.bench.state.version,
                "busy": work is not None,
                "title": "" if work is None else work.title,
                "said": "" if work is None else self.bench.spell(work.said),
                "seconds": 0.0 if work is None else work.seconds,
                "left": left,
            }
        )


class Figures(Handler):
    """The figures of a page."""

    async def get(self, name: str) -> None:
        """As JSON of BokehJS."""
        loop = asyncio.get_running_loop()
        shown = self.get_query_argument("known", "")
        made = await loop.run_in_executor(None, self.drawn.answer, name, shown)
        self.set_header("Content-Type", "application/json")
        self.write(made)


class Window(Handler):
    """The samples of a stretch of time."""

    async def get(self, name: str) -> None:
        """Those that are drawn."""
        try:
            start, end = (float(self.get_query_argument(key)) for key in ("start", "end"))
        except ValueError:
            raise HTTPError(400, reason="start and end are times in s") from None
        loop = asyncio.get_running_loop()
        self.write(await loop.run_in_executor(None, self.drawn.window, name, start, end))


class Static(Handler):
    """Scripts and styles that the package ships."""

    def get(self, name: str) -> None:
        """One file."""
        if name not in STATIC:
            raise HTTPError(404, reason="there is no such file")
        path, kind = STATIC[name]
        self.set_header("Content-Type", f"{kind}; charset=utf-8")
        # The library is large and does not change while the server runs.
        self.set_header("Cache-Control", "private, max-age=3600")
        self.write(path.read_bytes())


class Written(Handler):
    """A file that the workbench wrote."""

    def get(self, number: str) -> None:
        """To keep in the browser's downloads."""
        written = self.bench.state.written
        if int(number) >= len(written):
            raise HTTPError(404, reason="there is no such file")
        path = written[int(number)]
        self.set_header("Content-Type", "application/octet-stream")
        self.set_header("Content-Disposition", f'attachment; filename="{path.name}"')
        self.write(path.read_bytes())


class Nowhere(Handler):
    """Any other path."""

    def prepare(self) -> None:
        """Refused like all others, and then not found."""
        super().prepare()
        raise HTTPError(404, reason="there is no such page")


def application(bench: Workbench, token: str) -> Application:
    """The pages of a workbench."""
    shared = {"bench": bench, "drawn": Drawn(bench), "token": token}
    names = "|".join(PAGES)
    return Application(
        [
            (rf"/({names}|)", Page, shared),
            (r"/do", Act, shared),
            (r"/upload", Upload, shared),
            (r"/progress", Progress, shared),
            (rf"/figures/({names})", Figures, shared),
            (rf"/window/({names})", Window, shared),
            (r"/static/([a-z.-]+)", Static, shared),
            (r"/written/(\d{1,6})", Written, shared),
        ],
        default_handler_class=Nowhere,
        default_handler_args=shared,
        log_function=lambda handler: None,
    )


def serve(bench: Workbench, port: int, told: Callable[[str], None]) -> None:
    """Serve until Ctrl-C or SIGTERM.

    Parameters
    ----------
    port
        0: any that is free.
    told : callable
        Called with the address once it answers.

    Raises
    ------
    StribeckError
        The port is taken.
    """
    asyncio.run(_serve(bench, port, told))


async def _serve(bench: Workbench, port: int, told: Callable[[str], None]) -> None:
    token = secrets.token_urlsafe(24)
    try:
        sockets = bind_sockets(port, "127.0.0.1")
    except OSError as error:
        raise StribeckError(
            f"port {port} cannot be used ({error.strerror or error}): give another with --port"
        ) from None
    server = HTTPServer(
        application(bench, token), max_body_size=MOST_SENT, max_buffer_size=MOST_SENT
    )
    server.add_sockets(sockets)
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, ended.set)
    told(f"http://127.0.0.1:{sockets[0].getsockname()[1]}/?token={token}")
    await loop.run_in_executor(None, prepare)
    await loop.run_in_executor(None, compile_pages)
    await ended.wait()
    bench.cancel()
    server.stop()
